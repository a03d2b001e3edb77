"""Shapes, pictures and the container of the scenes in this folder. Needs nothing but Python."""
import json
import math
import struct
import zlib

FLOAT, SHORT = 5126, 5123
WIDTH = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}


def noise(*key):
    """A number of 0…1 that depends on its arguments only."""
    return zlib.crc32(repr(key).encode()) / 2**32


def png(size, pixel):
    """A picture of size² pixels; `pixel(u, v)` is a tuple of three or four numbers of 0…1, u and v are 0…1."""
    rows = [[pixel((x + 0.5) / size, (y + 0.5) / size) for x in range(size)] for y in range(size)]
    byte = lambda value: min(max(round(255 * value), 0), 255)
    lines = [bytes(byte(c) for color in row for c in color) for row in rows]
    channels = len(rows[0][0])
    # Each byte, or how far it is from the one of the pixel to the left: whichever is shorter.
    differences = lambda line: bytes((a - b) % 256 for a, b in zip(line, bytes(channels) + line))
    packed = [zlib.compress(b''.join(kind + change(line) for line in lines), 9) for kind, change in ((b'\0', bytes), (b'\1', differences))]
    chunk = lambda kind, data: struct.pack('>I', len(data)) + kind + data + struct.pack('>I', zlib.crc32(kind + data))
    header = struct.pack('>IIBBBBB', size, size, 8, 2 if channels == 3 else 6, 0, 0, 0)
    return b'\x89PNG\r\n\x1a\n' + chunk(b'IHDR', header) + chunk(b'IDAT', min(packed, key=len)) + chunk(b'IEND', b'')


def scaled(color, factor):
    return tuple(c * factor for c in color)


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


class Glb:
    def __init__(self, generator):
        self.data, self.views, self.accessors = b'', [], []
        self.root = {'asset': {'version': '2.0', 'generator': generator}, 'scene': 0}
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

    def primitive(self, shape, material, textured=True):
        vertices, indices = shape
        positions, normals, places = zip(*vertices)
        attributes = {'POSITION': self.numbers(positions, 'VEC3'), 'NORMAL': self.numbers(normals, 'VEC3')}
        if textured:
            attributes['TEXCOORD_0'] = self.numbers(places, 'VEC2')
        return {'attributes': attributes, 'indices': self.numbers(indices, 'SCALAR', SHORT), 'material': material}

    def place(self, name, shape, material, at=(0, 0, 0), textured=True, **more):
        mesh = self.add('meshes', name=name, primitives=[self.primitive(shape, material, textured)])
        return self.add('nodes', name=name, mesh=mesh, translation=list(at), **more)

    def write(self, path):
        children = {child for node in self.root['nodes'] for child in node.get('children', [])}
        roots = [node for node in range(len(self.root['nodes'])) if node not in children]
        self.root |= {'scenes': [{'nodes': roots}], 'accessors': self.accessors,
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
