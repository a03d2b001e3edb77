"""Makes room.glb, the report's scene with textures: python3 make.py

Everything in it comes from this file and ../glb.py, which need nothing but Python: planks, wallpaper, a rug, a plant whose leaves are
cut out by alpha, a globe of gold and glaze by a metallic-roughness texture, a lamp in the ceiling, and a camera that goes
aside and back.
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
from glb import Glb, box, joined, looking, noise, quad, scaled, surface, turned


def planks(u, v):
    """Four planks across, each with a shade, a grain and joints of its own."""
    plank = math.floor(4 * v)
    along, across = u + noise(plank), 4 * v - plank
    board = math.floor(2 * along) % 2
    dark = across < 0.03 or (2 * along) % 1 < 0.01
    shade = 0.75 + 0.35 * noise(plank, board)
    # The grain repeats with the texture: whole numbers of waves.
    wave = math.sin(2 * math.pi * (9 * across + 0.5 * math.sin(2 * math.pi * (along + noise(plank, 1)))))
    grain = 1 + 0.06 * round(2 * wave) / 2
    return scaled((0.62, 0.42, 0.26), 0.35 if dark else shade * grain)


def wallpaper(u, v):
    stripe = (4 * u) % 1 < 0.5
    x, y = (4 * u) % 1 - 0.25, (4 * v) % 1 - 0.5
    flower = stripe and math.hypot(x, y) < 0.1 + 0.05 * math.cos(5 * math.atan2(y, x))
    return (0.62, 0.45, 0.28) if flower else (0.78, 0.8, 0.74) if stripe else (0.66, 0.71, 0.66)


def rug(u, v):
    edge = min(u, v, 1 - u, 1 - v)
    if edge < 0.08:
        return (0.8, 0.74, 0.6) if edge > 0.03 else (0.3, 0.06, 0.06)
    return (0.55, 0.12, 0.1) if (math.floor(10 * u) + math.floor(10 * v)) % 2 else (0.12, 0.16, 0.34)


def leaf(u, v):
    """A feathered leaf, from its stem at v = 0 up; what is not leaf is cut out."""
    side = abs(2 * u - 1)
    outline = math.sin(math.pi * min(v * 1.02, 1)) ** 0.6 * (1 - 0.35 * v)
    slit = (9 * (v - 0.35 * side)) % 1 < 0.22 and side > 0.15
    green = (0.16, 0.42, 0.12) if side > 0.06 else (0.4, 0.55, 0.25)
    return *green, float(side < 0.06 or side < outline and not slit)


def gilded(u, v):
    """Whether a point of the globe is gold: bands, and meridians between them."""
    return (8 * v) % 1 < 0.3 or (12 * u) % 1 < 0.12


def glaze(u, v):
    return (0.95, 0.72, 0.32) if gilded(u, v) else (0.08, 0.2, 0.45)


def polish(u, v):
    """Roughness in green and metal in blue."""
    return (0, 0.3, 1) if gilded(u, v) else (0, 0.12, 0)


def frond(angle, reach, height):
    """A leaf that arches outwards from the top of the pot."""
    outwards = [math.sin(angle), 0, math.cos(angle)]
    aside = [math.cos(angle), 0, -math.sin(angle)]

    def point(u, v):
        along, rise, width = reach * v, height * (2 * v - 1.1 * v * v), 0.26 * (u - 0.5)
        return [along * outwards[0] + width * aside[0], rise, along * outwards[2] + width * aside[2]]
    return surface(point, 1, 6)


def room():
    glb = Glb('assets/textured/make.py')
    wood = glb.texture(128, planks)
    parquet = glb.material('parquet', texture=wood, roughness=0.35)
    paper = glb.material('wallpaper', texture=glb.texture(64, wallpaper))
    plaster = glb.material('plaster', (0.8, 0.79, 0.76))
    carpet = glb.material('rug', texture=glb.texture(64, rug))
    clay = glb.material('clay', (0.6, 0.27, 0.16), 0.6)
    leaves = glb.material('leaves', texture=glb.texture(64, leaf), roughness=0.7, alphaMode='MASK', alphaCutoff=0.5,
                          doubleSided=True)
    globe = glb.material('globe', texture=glb.texture(96, glaze), polish=glb.texture(96, polish), metal=1.0)
    lamp = glb.material('lamp', (0.5, 0.5, 0.5), emissiveFactor=[1, 0.86, 0.68],
                        extensions={'KHR_materials_emissive_strength': {'emissiveStrength': 16}})
    glb.root['extensionsUsed'] = ['KHR_materials_emissive_strength']

    glb.place('floor', quad([-2, 0, 2], [4, 0, 0], [0, 0, -4], (2, 2)), parquet)
    glb.place('ceiling', quad([-2, 2.6, -2], [4, 0, 0], [0, 0, 4]), plaster)
    glb.place('back', quad([-2, 0, -2], [4, 0, 0], [0, 2.6, 0], (4, 2.6)), paper)
    glb.place('left', quad([-2, 0, 2], [0, 0, -4], [0, 2.6, 0], (4, 2.6)), paper)
    glb.place('right', quad([2, 0, -2], [0, 0, 4], [0, 2.6, 0]), plaster)
    glb.place('lamp', quad([-0.4, 0, -0.4], [0.8, 0, 0], [0, 0, 0.8]), lamp, (0.3, 2.58, -0.4))
    glb.place('rug', quad([-0.9, 0, 0.6], [1.8, 0, 0], [0, 0, -1.2]), carpet, (0.2, 0.006, 0.3))
    table = [box([-0.4, 0.42, -0.4], [0.4, 0.48, 0.4])]
    table += [box([x - 0.03, 0, z - 0.03], [x + 0.03, 0.42, z + 0.03]) for x in (-0.34, 0.34) for z in (-0.34, 0.34)]
    glb.place('table', joined(table), parquet, (0.75, 0, -0.7))
    ball = lambda v: (0.34 * math.sin(math.pi * v), -0.34 * math.cos(math.pi * v))
    glb.place('globe', turned(ball, 32), globe, (0.75, 0.82, -0.7))
    pot = lambda v: (0.17 + 0.11 * v ** 0.7 + 0.03 * (v > 0.84), 0.42 * v)
    glb.place('pot', turned(pot, 24), clay, (-1.05, 0, -0.9))
    fronds = [frond(2.4 * i, 0.35 + 0.4 * noise('reach', i), 0.5 + 0.6 * noise('height', i)) for i in range(13)]
    glb.place('plant', joined(fronds), leaves, (-1.05, 0.4, -0.9))

    eye, target = [0.0, 1.35, 3.6], [0.0, 0.85, -0.6]
    perspective = {'yfov': 0.72, 'znear': 0.05}
    glb.root['cameras'] = [{'type': 'perspective', 'perspective': perspective}]
    camera = glb.add('nodes', name='camera', camera=0, translation=eye, rotation=looking(eye, target))
    aside = [[x, eye[1] + y, eye[2]] for x, y in ((0, 0), (0.5, 0.1), (0, 0), (-0.5, -0.1), (0, 0))]
    sampler = {'input': glb.numbers([0.0, 1.0, 2.0, 3.0, 4.0], 'SCALAR'), 'output': glb.numbers(aside, 'VEC3')}
    channel = {'sampler': 0, 'target': {'node': camera, 'path': 'translation'}}
    glb.root['animations'] = [{'name': 'move-camera', 'samplers': [sampler], 'channels': [channel]}]
    return glb


if __name__ == '__main__':
    room().write(Path(__file__).with_name('room.glb'))
