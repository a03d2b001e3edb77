"""Makes still_life.glb: python3 make.py

A table before a wall of bricks, with a lamp and a window beside it: three tulips in a glazed vase, a green bottle, a tumbler, a ball of blue
glass, a bowl of hammered copper, lemons, and fallen leaves. Everything in it comes from this file and ../glb.py, which need nothing but Python.

| what it shows | where |
|---|---|
| glass with thickness: clear, tinted by length, tinted at the surface | tumbler, ball, bottle |
| gloss | vase, table |
| rough metal | bowl |
| normal maps | wall, bowl, lemons |
| a mask | leaves |
| skins | the three stems share a mesh and have five joints each |
| morph targets | blossoms |
"""
import math
import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent.parent))
from glb import FLOAT, SHORT, Glb, box, cross, joined, looking, noise, quad, scaled, sub, surface, unit

PERIOD = 4.0
# Heights of a stem's joints above its foot.
JOINTS = [0.0, 0.08, 0.15, 0.21, 0.26]
STEM, WIDTH = 0.285, 0.0035
BLOSSOM = 0.062


def smooth(edge, other, x):
    t = min(max((x - edge) / (other - edge), 0), 1)
    return t * t * (3 - 2 * t)


def relief(height, strength):
    """A normal map of a height of a texture's coordinates; green points against v, upwards where v runs downwards."""
    def normal(u, v):
        step = 1 / 1024
        here = height(u, v)
        slope_u, slope_v = ((height(u + x, v + y) - here) / step for x, y in ((step, 0), (0, step)))
        return [0.5 + 0.5 * c for c in unit([-strength * slope_u, strength * slope_v, 1])]
    normal.__name__ = height.__name__
    return normal


ROWS, BRICKS = 12, 4


def brick(u, v):
    """Row and column of a brick, and the distance to its edge in heights of a row."""
    row = math.floor(ROWS * v)
    along = BRICKS * u + 0.5 * (row % 2)
    column = math.floor(along) % BRICKS
    x, y = along - math.floor(along), ROWS * v - row
    return row % ROWS, column, min(3.0 * min(x, 1 - x), min(y, 1 - y))


def waves(u, v, seed, count, low, high):
    """A bumpy number of about −1…1 that repeats with the texture."""
    total = 0
    for i in range(count):
        a, b = (round(low + (high - low) * noise(seed, i, axis)) for axis in 'uv')
        total += math.sin(2 * math.pi * (a * u + (b if i % 2 else -b) * v + noise(seed, i)))
    return total / math.sqrt(count)


def bricks(u, v):
    row, column, edge = brick(u + 0.003 * waves(u, v, 'crooked', 3, 2, 6), v + 0.0015 * waves(u, v, 'uneven', 3, 2, 6))
    proud = 0.75 + 0.4 * noise('proud', row, column)
    return proud * smooth(0.03, 0.2, edge) + 0.05 * waves(u, v, 'rough', 5, 4, 13)


def brick_colors(u, v):
    row, column, edge = brick(u + 0.003 * waves(u, v, 'crooked', 3, 2, 6), v + 0.0015 * waves(u, v, 'uneven', 3, 2, 6))
    shade = 0.86 + 0.14 * noise('shade', row, column)
    red = noise('hue', row, column)
    stone = scaled((0.50 + 0.02 * red, 0.57, 0.55 - 0.02 * red), shade)
    mortar, part = (0.43, 0.46, 0.44), smooth(0.05, 0.14, edge)
    return tuple(m + part * (s - m) for m, s in zip(mortar, stone))


def boards(u, v):
    """Boards that lie along u."""
    board = math.floor(4 * v) % 4
    across = 4 * v - math.floor(4 * v)
    bend = 0.35 * math.sin(2 * math.pi * (u + noise(board))) + 0.12 * math.sin(2 * math.pi * (3 * u + noise(board, 1)))
    grain = math.sin(2 * math.pi * (7 * across + bend)) + 0.5 * math.sin(2 * math.pi * (17 * across + 2 * bend))
    seam = 0.45 + 0.55 * smooth(0, 0.025, min(across, 1 - across))
    return scaled((0.40, 0.235, 0.14), seam * (0.86 + 0.22 * noise('board', board)) * (1 + 0.09 * grain))


def hammered(u, v):
    """Shallow round dents, side by side as in a comb; half of the bowl."""
    best = 9
    x, y = 14 * u, 8 * v
    for row in (math.floor(y) - 1, math.floor(y), math.floor(y) + 1):
        for column in range(math.floor(x) - 1, math.floor(x) + 2):
            key = ('dent', row % 8, column % 14)
            a = column + 0.5 * (row % 2) + 0.5 + 0.3 * (noise(*key, 0) - 0.5)
            b = row + 0.5 + 0.3 * (noise(*key, 1) - 0.5)
            best = min(best, (x - a) ** 2 + (y - b) ** 2)
    return min(best, 0.6)


def pitted(u, v):
    return waves(u, v, 'peel', 16, 7, 17)


def lemon_skin(u, v):
    end = abs(2 * v - 1) ** 6
    return tuple(a + end * (b - a) for a, b in zip((0.93, 0.78, 0.16), (0.62, 0.66, 0.16)))


def leaf(u, v):
    """A pointed leaf, from its stem at v = 1 up; the rest is cut out."""
    v = 1 - v
    side = abs(2 * u - 1)
    teeth = 0.05 * abs(math.sin(math.pi * 11 * v))
    outline = 0.92 * math.sin(math.pi * min(v, 1) ** 0.8) ** 0.75 - teeth
    vein = side < 0.035 or abs((8 * (v - 0.45 * side)) % 1 - 0.5) > 0.46
    autumn = smooth(0.2, 0.9, 0.5 * side + 0.5 * v)
    green = tuple(a + autumn * (b - a) for a, b in zip((0.42, 0.46, 0.12), (0.72, 0.30, 0.08)))
    return *scaled(green, 1.18 if vein else 1), float(side < 0.03 and v < 0.97 or side < outline)


def blade(u, v):
    """A long green leaf with parallel veins; the rest is cut out."""
    v = 1 - v
    side = abs(2 * u - 1)
    outline = min(1, 2.6 * (1 - v)) ** 0.6 * (0.55 + 0.45 * smooth(0, 0.35, v))
    return *scaled((0.22, 0.46, 0.16), 1 + 0.1 * math.cos(2 * math.pi * 6 * u)), float(side < outline)


def petal(u, v):
    """From the yellow foot at v = 1 to the tip."""
    tip = smooth(0.0, 0.35, 1 - v)
    rim = 1 - 0.16 * (2 * u - 1) ** 2
    return tuple(a + tip * (b * rim - a) for a, b in zip((0.93, 0.76, 0.2), (0.94, 0.33, 0.20)))


def spline(points, steps):
    """A curve through points, with `steps` parts from one to the next (Catmull and Rom)."""
    curve = []
    for i in range(len(points) - 1):
        a, b, c, d = (points[min(max(i + k, 0), len(points) - 1)] for k in (-1, 0, 1, 2))
        for step in range(steps):
            t = step / steps
            curve.append([0.5 * (2 * q + t * (r - p) + t * t * (2 * p - 5 * q + 4 * r - s) + t ** 3 * (3 * q - p - 3 * r + s))
                          for p, q, r, s in zip(a, b, c, d)])
    return curve + [list(points[-1])]


def lathe(profile, columns, repeat=(1, 1)):
    """A closed body of revolution: the profile goes from its lowest point on the axis to the last one on the axis, outer side first."""
    rows = len(profile)
    lengths = [0.0]
    for (r, y), (s, z) in zip(profile, profile[1:]):
        lengths.append(lengths[-1] + math.hypot(s - r, z - y))
    vertices = []
    for j, (radius, height) in enumerate(profile):
        before, after = profile[max(j - 1, 0)], profile[min(j + 1, rows - 1)]
        out, up = after[1] - before[1], before[0] - after[0]
        if radius < 1e-6:
            out, up = 0, 1 if j else -1
        for i in range(columns + 1):
            # The last column is where the first is, to the bit, so that the body is closed.
            angle = 2 * math.pi * (i % columns) / columns
            around = (math.sin(angle), math.cos(angle))
            normal = unit([out * around[0], up, out * around[1]])
            place = (repeat[0] * i / columns, repeat[1] * (1 - lengths[j] / lengths[-1]))
            vertices.append(([radius * around[0], height, radius * around[1]], normal, place))
    corner = lambda i, j: j * (columns + 1) + i
    indices = []
    for j in range(rows - 1):
        for i in range(columns):
            a, b, c, d = corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)
            indices += (a, b, c) * (profile[j][0] > 1e-6) + (a, c, d) * (profile[j + 1][0] > 1e-6)
    return vertices, indices


def ball(radius, rings, columns, stretch=lambda y: 1.0):
    arc = [math.pi * j / rings for j in range(rings + 1)]
    profile = [(radius * math.sin(a) * (0 < j < rings), -radius * math.cos(a) * stretch(-math.cos(a))) for j, a in enumerate(arc)]
    return lathe(profile, columns)


def moved(shape, place):
    vertices, indices = shape
    return [(place(p), n, t) for p, n, t in vertices], indices


def strip(length, width, arch, columns=2, rows=10):
    """A leaf that lies along −z, arched upwards, with its sides raised a little."""
    def point(u, v):
        x = width * (u - 0.5)
        return [x, arch * math.sin(math.pi * min(0.15 + 0.9 * v, 1)) + 0.9 * x * x / width, -length * v]
    return surface(point, columns, rows)


def stem():
    """A tube upwards, closed at its top by the blossom."""
    sides, rings = 8, 16
    def point(u, v):
        angle = 2 * math.pi * u
        return [WIDTH * math.sin(angle), STEM * v, WIDTH * math.cos(angle)]
    return surface(point, sides, rings)


def stem_leaf(angle, foot, length, width, lean):
    """A blade that rises beside the stem and bends away from it."""
    outwards, aside = (math.sin(angle), math.cos(angle)), (math.cos(angle), -math.sin(angle))
    def point(u, v):
        x = width * (u - 0.5)
        away = WIDTH + lean * v * v + 1.2 * x * x / width
        rise = foot + length * (v - 0.28 * v * v * lean / length * 3)
        return [away * outwards[0] + x * aside[0], rise, away * outwards[1] + x * aside[1]]
    return surface(point, 2, 10)


def blossom(opening):
    """Six petals in two rings about the stem's top; `opening` is 0 for a bud."""
    def one(angle, inner):
        def point(u, v):
            bulge = math.sin(math.pi * min(0.1 + 0.78 * v, 1))
            radius = 0.002 + (0.021 - 0.002 * inner) * bulge + opening * 0.024 * v ** 1.6
            spread = 0.62 * math.sin(math.pi * (0.12 + 0.8 * v)) ** 0.7 * (1 - 0.25 * opening * v)
            turn = angle + 2 * spread * (u - 0.5)
            rise = BLOSSOM * (v - opening * 0.25 * v * v) - 0.004 * v * (2 * u - 1) ** 2
            return [radius * math.sin(turn), STEM + rise, radius * math.cos(turn)]
        return surface(point, 4, 7)
    return joined([one(2 * math.pi * i / 6, i % 2) for i in range(6)])


def bending(height):
    """The two joints that a height of the stem follows, and their weights."""
    later = next((i for i, joint in enumerate(JOINTS) if joint > height), len(JOINTS))
    first = max(later - 1, 0)
    second = min(first + 1, len(JOINTS) - 1)
    part = smooth(JOINTS[first], JOINTS[second], height) if second > first else 0.0
    # A joint turns the part above it.
    return [first, second, 0, 0], [1 - part, part, 0.0, 0.0]


def skinned(glb, shape, material, target=None):
    primitive = glb.primitive(shape, material)
    joints, weights = zip(*(bending(max(position[1], 0)) for position, _, _ in shape[0]))
    primitive['attributes'] |= {'JOINTS_0': glb.numbers(joints, 'VEC4', SHORT), 'WEIGHTS_0': glb.numbers(weights, 'VEC4')}
    if target:
        offsets = [[sub(b[k], a[k]) for a, b in zip(shape[0], target[0])] for k in (0, 1)]
        primitive['targets'] = [{'POSITION': glb.numbers(offsets[0], 'VEC3'), 'NORMAL': glb.numbers(offsets[1], 'VEC3')}]
    return primitive


def turned_by(axis, angle):
    return [math.sin(angle / 2) * a for a in axis] + [math.cos(angle / 2)]


def product(p, q):
    (a, b, c, d), (e, f, g, h) = p, q
    return [d * e + a * h + b * g - c * f, d * f - a * g + b * h + c * e, d * g + a * f - b * e + c * h, d * h - a * e - b * f - c * g]


class Animation:
    def __init__(self, glb, name):
        self.glb, self.root = glb, {'name': name, 'samplers': [], 'channels': []}
        glb.root.setdefault('animations', []).append(self.root)

    def move(self, node, path, times, values, kind, interpolation='LINEAR'):
        sampler = {'input': self.glb.numbers(times, 'SCALAR'), 'output': self.glb.numbers(values, kind), 'interpolation': interpolation}
        self.root['samplers'].append(sampler)
        self.root['channels'].append({'sampler': len(self.root['samplers']) - 1, 'target': {'node': node, 'path': path}})


def tulips(glb, at, green, blades, petals):
    """Three tulips. Returns their chains of joints with the angles at which these bend at rest, and the nodes of the blossoms."""
    stalk = [skinned(glb, stem(), green), skinned(glb, joined([stem_leaf(0.7, 0.03, 0.25, 0.042, 0.1), stem_leaf(3.9, 0.05, 0.2, 0.036, 0.075)]), blades)]
    plant = glb.add('meshes', name='tulip', primitives=stalk)
    flower = glb.add('meshes', name='blossom', primitives=[skinned(glb, blossom(0.15), petals, blossom(1.0))], weights=[0.0])
    binds = glb.numbers([[1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, -y, 0, 1] for y in JOINTS], 'MAT4')
    chains, blossoms = [], []
    for i, (turn, lean) in enumerate(((1.3, 0.085), (3.4, 0.045), (5.0, 0.075))):
        joints = []
        for j, height in enumerate(JOINTS):
            rest = product(turned_by((0, 1, 0), turn), turned_by((1, 0, 0), lean)) if j == 0 else turned_by((1, 0, 0), lean)
            place = list(at) if j == 0 else [0, height - JOINTS[j - 1], 0]
            joints.append((glb.add('nodes', name=f'tulip {i} joint {j}', translation=place, rotation=rest), rest))
        for (parent, _), (child, _) in zip(joints, joints[1:]):
            glb.root['nodes'][parent]['children'] = [child]
        skin = {'joints': [node for node, _ in joints], 'inverseBindMatrices': binds}
        glb.root.setdefault('skins', []).append(skin)
        glb.add('nodes', name=f'tulip {i}', mesh=plant, skin=i)
        blossoms.append(glb.add('nodes', name=f'blossom {i}', mesh=flower, skin=i))
        chains.append(joints)
    return chains, blossoms


def sway(animation, chains, blossoms):
    times = [PERIOD * k / 16 for k in range(17)]
    # The last pose is the first one, to the bit.
    phase = lambda time: 2 * math.pi * (time % PERIOD) / PERIOD
    for i, joints in enumerate(chains):
        for j, (node, rest) in enumerate(joints):
            size = 0.05 + 0.035 * j
            bend = lambda t: product(turned_by((0, 0, 1), size * math.sin(phase(t) - 0.5 * j + 0.9 * i)),
                                     turned_by((1, 0, 0), 0.5 * size * math.sin(2 * phase(t) - 0.5 * j + 2.0 * i)))
            animation.move(node, 'rotation', times, [product(rest, bend(t)) for t in times], 'VEC4')
        animation.move(blossoms[i], 'weights', times, [0.5 - 0.5 * math.cos(phase(t) + 2.1 * i) for t in times], 'SCALAR')


def blink(animation, lamp):
    """Without its size a lamp has no light."""
    sizes = [[s, s, s] for s in (1.0, 1e-3, 1.0, 1e-3, 1.0)]
    animation.move(lamp, 'scale', [PERIOD * k / 4 for k in range(5)], sizes, 'VEC3', 'STEP')


def aside(animation, camera, eye):
    places = [[eye[0] + x, eye[1] + y, eye[2]] for x, y in ((0, 0), (0.12, 0.03), (0, 0), (-0.12, -0.03), (0, 0))]
    animation.move(camera, 'translation', [PERIOD * k / 4 for k in range(5)], places, 'VEC3')


def materials(glb):
    matte = {'extensions': {'KHR_materials_specular': {'specularFactor': 0}}}
    relieved = lambda height, strength, size: {'normalTexture': glb.texture(size, relief(height, strength))}
    glass = lambda index, **volume: {'extensions': {
        'KHR_materials_transmission': {'transmissionFactor': 1}, 'KHR_materials_ior': {'ior': index},
        'KHR_materials_volume': {'thicknessFactor': 0.01, **volume}}}
    light = lambda color, strength: {'emissiveFactor': color, 'extensions': {
        'KHR_materials_specular': {'specularFactor': 0}, 'KHR_materials_emissive_strength': {'emissiveStrength': strength}}}
    cut = {'alphaMode': 'MASK', 'alphaCutoff': 0.5, 'doubleSided': True, **matte}
    glb.root['extensionsUsed'] = ['KHR_materials_specular', 'KHR_materials_transmission', 'KHR_materials_ior', 'KHR_materials_volume',
                                  'KHR_materials_emissive_strength']
    return {
        'bricks': glb.material('bricks', texture=glb.texture(256, brick_colors), **relieved(bricks, 0.013, 256), **matte),
        'plaster': glb.material('plaster', (0.42, 0.40, 0.38), **matte),
        'floor': glb.material('floor', (0.25, 0.17, 0.12), **matte),
        'table': glb.material('table', texture=glb.texture(256, boards), roughness=0.38),
        'glaze': glb.material('glaze', (0.02, 0.07, 0.23), 0.16),
        'copper': glb.material('copper', (0.93, 0.56, 0.40), 0.34, 1.0, **relieved(hammered, 0.03, 128)),
        'lemon': glb.material('lemon', texture=glb.texture(32, lemon_skin), roughness=0.42, **relieved(pitted, 0.002, 128)),
        'clear': glb.material('clear glass', (1, 1, 1), 0.0, **glass(1.5)),
        'blue': glb.material('blue glass', (1, 1, 1), 0.0, **glass(1.5, attenuationColor=[0.42, 0.72, 0.95], attenuationDistance=0.06)),
        'green': glb.material('green glass', (0.62, 0.86, 0.66), 0.0, **glass(1.5)),
        'stalk': glb.material('stalk', (0.24, 0.44, 0.16), **matte),
        'blades': glb.material('blades', texture=glb.texture(64, blade), **cut),
        'leaves': glb.material('leaves', texture=glb.texture(128, leaf), **cut),
        'petals': glb.material('petals', texture=glb.texture(32, petal), doubleSided=True, **matte),
        'lamp': glb.material('lamp', (0.5, 0.5, 0.5), **light([1, 0.72, 0.42], 220)),
        'window': glb.material('window', (0.5, 0.5, 0.5), **light([0.55, 0.76, 1], 11)),
    }


def room(glb, m):
    left, right, low, high, back, front = -1.5, 1.6, -0.72, 1.5, -0.42, 2.3
    wide, tall, deep = right - left, high - low, front - back
    glb.place('bricks', quad([left, low, back], [wide, 0, 0], [0, tall, 0], (3.1, 3.7)), m['bricks'])
    walls = [
        quad([left, low, front], [0, 0, -deep], [0, tall, 0]), quad([right, low, back], [0, 0, deep], [0, tall, 0]),
        quad([right, low, front], [-wide, 0, 0], [0, tall, 0]), quad([left, high, back], [wide, 0, 0], [0, 0, deep]),
    ]
    glb.place('plaster', joined(walls), m['plaster'], textured=False)
    glb.place('floor', quad([left, low, front], [wide, 0, 0], [0, 0, -deep]), m['floor'], textured=False)
    top = quad([-0.85, 0, 0.4], [1.7, 0, 0], [0, 0, -0.78], (1.6, 1))
    glb.place('table', joined([top, quad([-0.85, -0.04, 0.4], [1.7, 0, 0], [0, 0.04, 0], (1.6, 0.05)),
                               quad([-0.85, -0.04, -0.38], [1.7, 0, 0], [0, 0, 0.78], (1.6, 1))]), m['table'])
    panes = [quad([0.004, y, z], [0, 0, -0.36], [0, 0.46, 0]) for y in (0.12, 0.62) for z in (0.5, 0.9, 1.3)]
    glb.place('window', joined(panes), m['window'], (left, 0, 0), textured=False)


def lamp(glb, m):
    """A disc above the table's right front, turned towards the fruit."""
    sides, radius = 24, 0.11
    rim = [[radius * math.cos(2 * math.pi * i / sides), radius * math.sin(2 * math.pi * i / sides), 0] for i in range(sides)]
    vertices = [(p, [0, 0, -1], (0, 0)) for p in [[0, 0, 0], *rim]]
    fan = [k for i in range(sides) for k in (0, 1 + (i + 1) % sides, 1 + i)]
    at = (0.72, 0.88, 0.5)
    return glb.place('lamp', (vertices, fan), m['lamp'], at, textured=False, rotation=looking(list(at), [0, 0.05, -0.1]))


def things(glb, m):
    vase = spline([(0.038, 0.0), (0.043, 0.006), (0.058, 0.04), (0.072, 0.095), (0.062, 0.15), (0.034, 0.19), (0.03, 0.212), (0.042, 0.235),
                   (0.043, 0.238), (0.04, 0.237), (0.027, 0.212), (0.031, 0.19), (0.058, 0.15), (0.066, 0.095), (0.04, 0.02)], 3)
    glb.place('vase', lathe([(0, 0), (0.036, 0), *vase, (0, 0.018)], 48), m['glaze'], (-0.2, 0, -0.14), textured=False)
    bottle = spline([(0.034, 0.0), (0.0385, 0.006), (0.039, 0.02), (0.039, 0.1), (0.0385, 0.17), (0.033, 0.2), (0.018, 0.228), (0.0135, 0.25),
                     (0.0132, 0.3), (0.0155, 0.303), (0.0155, 0.318), (0.013, 0.321), (0.0105, 0.318), (0.0104, 0.25), (0.0148, 0.227),
                     (0.029, 0.199), (0.0345, 0.17), (0.0352, 0.1), (0.0352, 0.022), (0.031, 0.014), (0.016, 0.018)], 2)
    glb.place('bottle', lathe([(0, 0.006), (0.02, 0.003), (0.031, 0.0005), *bottle, (0, 0.026)], 48), m['green'], (0.015, 0.0005, -0.2), textured=False)
    tumbler = spline([(0.026, 0.0), (0.0295, 0.003), (0.031, 0.012), (0.0345, 0.06), (0.0375, 0.102), (0.0365, 0.1045), (0.0352, 0.102),
                      (0.0322, 0.06), (0.0285, 0.02), (0.022, 0.0145)], 4)
    glb.place('tumbler', lathe([(0, 0.0005), (0.022, 0.0002), *tumbler, (0, 0.0135)], 48), m['clear'], (0.075, 0.0005, 0.03), textured=False)
    glb.place('ball', ball(0.036, 24, 48), m['blue'], (-0.085, 0.0365, 0.125), textured=False)
    bowl = spline([(0.05, 0.0), (0.055, 0.004), (0.085, 0.028), (0.112, 0.062), (0.124, 0.088), (0.122, 0.0905), (0.118, 0.088),
                   (0.106, 0.062), (0.08, 0.032), (0.045, 0.009)], 3)
    glb.place('bowl', lathe([(0, 0), (0.045, 0), *bowl, (0, 0.007)], 48, (2, 1)), m['copper'], (0.25, 0, -0.1))
    tip = lambda y: 1.12 + 0.2 * smooth(0.72, 1.0, abs(y))
    lemon = ball(0.03, 20, 28, tip)
    fruit = glb.add('meshes', name='lemon', primitives=[glb.primitive(lemon, m['lemon'])])
    for axis, angle, at in (((1, 0, 0.3), 1.35, (0.21, 0.062, -0.06)), ((0.2, 0, 1), 1.2, (0.285, 0.063, -0.11)), ((0, 0.5, 0.9), 1.75, (0.235, 0.065, -0.155)),
                            ((0.4, 0.1, 0.9), 1.45, (0.25, 0.105, -0.095)), ((0.55, 0, 0.85), 1.52, (0.185, 0.0305, 0.12))):
        glb.add('nodes', name='lemon', mesh=fruit, translation=list(at), rotation=turned_by(unit(list(axis)), angle))
    foliage = glb.add('meshes', name='leaf', primitives=[glb.primitive(strip(0.085, 0.05, 0.012), m['leaves'])])
    for turn, roll, at in ((2.2, 0.1, (-0.25, 0.003, 0.04)), (0.6, -0.15, (-0.16, 0.003, 0.17)), (-1.9, 0.1, (0.3, 0.003, 0.12))):
        rotation = product(turned_by((0, 1, 0), turn), turned_by((0, 0, 1), roll))
        glb.add('nodes', name='leaf', mesh=foliage, translation=list(at), rotation=rotation)


def still_life():
    glb = Glb('assets/still_life/make.py')
    m = materials(glb)
    room(glb, m)
    light = lamp(glb, m)
    things(glb, m)
    chains, blossoms = tulips(glb, (-0.2, 0.1, -0.14), m['stalk'], m['blades'], m['petals'])
    eye, target = [0.0, 0.34, 1.16], [0.015, 0.18, -0.08]
    glb.root['cameras'] = [{'type': 'perspective', 'perspective': {'yfov': 0.435, 'znear': 0.02}}]
    camera = glb.add('nodes', name='camera', camera=0, translation=eye, rotation=looking(eye, target))
    sway(Animation(glb, 'sway'), chains, blossoms)
    blink(Animation(glb, 'blink'), light)
    aside(Animation(glb, 'move-camera'), camera, eye)
    together = Animation(glb, 'all')
    sway(together, chains, blossoms)
    blink(together, light)
    aside(together, camera, eye)
    return glb


if __name__ == '__main__':
    still_life().write(Path(__file__).with_name('still_life.glb'))
