"""Makes room.glb, the report's scene with textures: python3 make.py

Everything in it comes from this file, which needs nothing but Python: planks, wallpaper, a rug, a plant whose leaves are
cut out by alpha, a globe of gold and glaze by a metallic-roughness texture, a lamp in the ceiling, and a camera that goes
aside and back.
"""
import json
import math
import struct
import zlib
from pathlib import Path

FLOAT, SHORT = 5126, 5123
WIDTH = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3}


def noise(*key):
    """A number of 0…1 that depends on its arguments only."""
    return zlib.crc32(repr(key).encode()) / 2**32


def png(size, pixel):
    """A picture of size² pixels; `pixel(u, v)` is a tuple of three or four numbers of 0…1, u and v are 0…1."""
    rows = [[pixel((x + 0.5) / size, (y + 0.5) / size) for x in range(size)] for y in range(size)]
    byte = lambda value: min(max(round(255 * value), 0), 255)
    raw = b''.join(b'\0' + bytes(byte(c) for color in row for c in color) for row in rows)
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    header = struct.pack('>IIBBBBB', size, size, 8, 2 if len(rows[0][0]) == 3 else 6, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', zlib.compress(raw, 9)) + chunk(b'IEND', b'')


def scaled(color, factor):
    return tuple(c * factor for c in color)


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


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def unit(a):
    length = math.sqrt(sum(x * x for x in a)) or 1
    return [x / length for x in a]


def surface(point, columns, rows, repeat=(1, 1)):
    """A grid over point(u, v), u to the right and v up where it faces us, with the normals of a smooth surface."""
    step = 1e-4
    vertices = []
    for j in range(rows + 1):
        for i in range(columns + 1):
            u, v = i / columns, j / rows
            # Poles have no normal: their neighbours' is taken.
            s, t = min(max(u, step), 1 - step), min(max(v, 1e-3), 1 - 1e-3)
            right = sub(point(s + step, t), point(s - step, t))
            up = sub(point(s, t + step), point(s, t - step))
            vertices.append((point(u, v), unit(cross(right, up)), (repeat[0] * u, repeat[1] * (1 - v))))
    corner = lambda i, j: j * (columns + 1) + i
    quads = [(corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1))
             for j in range(rows) for i in range(columns)]
    return vertices, [k for a, b, c, d in quads for k in (a, b, c, a, c, d)]


def joined(parts):
    vertices, indices = [], []
    for some, order in parts:
        indices += [len(vertices) + k for k in order]
        vertices += some
    return vertices, indices


def quad(origin, right, up, repeat=(1, 1)):
    return surface(lambda u, v: [o + u * r + v * w for o, r, w in zip(origin, right, up)], 1, 1, repeat)


def box(low, high):
    (a, b, c), (d, e, f) = low, high
    x, y, z = d - a, e - b, f - c
    return joined([
        quad([a, b, f], [x, 0, 0], [0, y, 0]), quad([d, b, c], [-x, 0, 0], [0, y, 0]),
        quad([a, b, c], [0, 0, z], [0, y, 0]), quad([d, b, f], [0, 0, -z], [0, y, 0]),
        quad([a, e, f], [x, 0, 0], [0, 0, -z]), quad([a, b, c], [x, 0, 0], [0, 0, z]),
    ])


def turned(profile, columns):
    """A body of revolution; `profile(v)` is its radius and height, from below."""
    def point(u, v):
        radius, height = profile(v)
        return [radius * math.sin(2 * math.pi * u), height, radius * math.cos(2 * math.pi * u)]
    return surface(point, columns, 12)


def frond(angle, reach, height):
    """A leaf that arches outwards from the top of the pot."""
    outwards = [math.sin(angle), 0, math.cos(angle)]
    aside = [math.cos(angle), 0, -math.sin(angle)]

    def point(u, v):
        along, rise, width = reach * v, height * (2 * v - 1.1 * v * v), 0.26 * (u - 0.5)
        return [along * outwards[0] + width * aside[0], rise, along * outwards[2] + width * aside[2]]
    return surface(point, 1, 6)


class Glb:
    def __init__(self):
        self.data, self.views, self.accessors = b'', [], []
        self.root = {'asset': {'version': '2.0', 'generator': 'assets/textured/make.py'}, 'scene': 0}
        for kind in ('images', 'textures', 'materials', 'meshes', 'nodes'):
            self.root[kind] = []

    def add(self, kind, **thing):
        self.root[kind].append(thing)
        return len(self.root[kind]) - 1

    def view(self, data):
        self.data += b'\0' * (-len(self.data) % 4)
        self.views.append({'buffer': 0, 'byteOffset': len(self.data), 'byteLength': len(data)})
        self.data += data
        return len(self.views) - 1

    def numbers(self, rows, kind, component=FLOAT):
        rows = [row if isinstance(row, (list, tuple)) else [row] for row in rows]
        flat = [number for row in rows for number in row]
        view = self.view(struct.pack(f'<{len(flat)}{"f" if component == FLOAT else "H"}', *flat))
        accessor = {'bufferView': view, 'componentType': component, 'count': len(rows), 'type': kind}
        # As they are stored: bounds may not be narrower than the numbers.
        stored = [struct.unpack('<f', struct.pack('<f', n))[0] if component == FLOAT else n for n in flat]
        columns = [stored[i::WIDTH[kind]] for i in range(WIDTH[kind])]
        accessor |= {'min': [min(c) for c in columns], 'max': [max(c) for c in columns]}
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def texture(self, size, pixel):
        image = self.add('images', bufferView=self.view(png(size, pixel)), mimeType='image/png', name=pixel.__name__)
        return {'index': self.add('textures', source=image)}

    def material(self, name, color=(1, 1, 1), roughness=1.0, metal=0.0, texture=None, polish=None, **more):
        pbr = {'baseColorFactor': [*color, 1], 'roughnessFactor': roughness, 'metallicFactor': metal}
        if texture:
            pbr['baseColorTexture'] = texture
        if polish:
            pbr['metallicRoughnessTexture'] = polish
        return self.add('materials', name=name, pbrMetallicRoughness=pbr, **more)

    def place(self, name, shape, material, at=(0, 0, 0)):
        vertices, indices = shape
        positions, normals, places = zip(*vertices)
        attributes = {'POSITION': self.numbers(positions, 'VEC3'), 'NORMAL': self.numbers(normals, 'VEC3'),
                      'TEXCOORD_0': self.numbers(places, 'VEC2')}
        primitive = {'attributes': attributes, 'indices': self.numbers(indices, 'SCALAR', SHORT), 'material': material}
        mesh = self.add('meshes', name=name, primitives=[primitive])
        return self.add('nodes', name=name, mesh=mesh, translation=list(at))

    def write(self, path):
        self.root |= {'scenes': [{'nodes': list(range(len(self.root['nodes'])))}], 'accessors': self.accessors,
                      'bufferViews': self.views, 'buffers': [{'byteLength': len(self.data)}]}
        text = json.dumps(self.root, separators=(',', ':')).encode()
        text += b' ' * (-len(text) % 4)
        data = self.data + b'\0' * (-len(self.data) % 4)
        chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(data), b'BIN\0') + data
        path.write_bytes(struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks)


def looking(eye, target):
    """The quaternion that turns −z from `eye` towards `target`, upright."""
    x, y, z = unit(sub(target, eye))
    pitch, yaw = 0.5 * math.asin(y), 0.5 * math.atan2(-x, -z)
    a, b, c, d = math.cos(yaw), math.sin(yaw), math.cos(pitch), math.sin(pitch)
    return [a * d, b * c, -b * d, a * c]


def room():
    glb = Glb()
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
