"""Compares the path tracer's glass with Mitsuba 3: a ball and a block of glass, a frosted ball, and a floor under a white sky.

usage: python mitsuba_glass.py OUT RENDER [--samples 1024] [--size 96x72]
needs: pip install mitsuba numpy; RENDER is the program, as target/release/examples/render

Writes OUT/scene.gltf, lets both render it, and prints how far the means of blocks of 4×4 pixels are apart. The sky is the only light, so that
light which goes straight through glass to the floor, as light samples here do, brings as much as light that is refracted.
"""
import argparse
import base64
import json
import math
from pathlib import Path

import mitsuba as mi
import numpy as np
from mitsuba_common import blocks, ours, sensor, write

mi.set_variant('scalar_rgb')  # llvm_ad_rgb is faster if LLVM is installed
EYE, TARGET, FOV_Y = [0.0, 1.1, 3.2], [0.0, 0.35, 0.0], 40.0
FLOOR, GLASS, FROSTED = 0, 1, 2
INDEX, ROUGHNESS = 1.5, 0.4


def ball(center, radius, rings=48, sides=96):
    """Returns positions, normals and triangles of a sphere."""
    polar, around = np.meshgrid(np.linspace(0, math.pi, rings + 1), np.linspace(0, 2 * math.pi, sides, endpoint=False), indexing='ij')
    normals = np.stack([np.sin(polar) * np.cos(around), np.cos(polar), np.sin(polar) * np.sin(around)], -1).reshape(-1, 3)
    at = lambda ring, side: ring * sides + side % sides
    quads = [(at(r, s), at(r, s + 1), at(r + 1, s + 1), at(r + 1, s)) for r in range(rings) for s in range(sides)]
    triangles = [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))]
    return normals * radius + np.array(center), normals, np.array(triangles)


def box(low, high):
    """Returns positions, normals and triangles of a box."""
    positions, normals, triangles = [], [], []
    for axis in range(3):
        for side in (0, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            corners = [(0, 0), (1, 0), (1, 1), (0, 1)]
            first = len(positions)
            for cu, cv in corners if side else corners[::-1]:
                p = [0.0, 0.0, 0.0]
                p[axis], p[u], p[v] = (low, high)[side][axis], (low, high)[cu][u], (low, high)[cv][v]
                positions.append(p)
                normals.append([(2 * side - 1) * float(i == axis) for i in range(3)])
            triangles += [(first, first + 1, first + 2), (first, first + 2, first + 3)]
    return np.array(positions), np.array(normals), np.array(triangles)


def shapes():
    floor = (np.array([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9.0]]), np.array([[0, 1, 0.0]] * 4), np.array([(0, 1, 2), (0, 2, 3)]))
    return [
        (floor, FLOOR),
        (ball([-0.75, 0.42, 0.0], 0.4), GLASS),
        (box([-0.2, 0.02, -0.3], [0.4, 0.9, 0.2]), GLASS),
        (ball([0.95, 0.42, 0.1], 0.4), FROSTED),
    ]


def write_gltf(path):
    blob, views, accessors, meshes, nodes = b'', [], [], [], []

    def add(array, kind, component):
        nonlocal blob
        views.append({'buffer': 0, 'byteOffset': len(blob), 'byteLength': array.nbytes})
        accessors.append({'bufferView': len(views) - 1, 'componentType': component, 'count': len(array.reshape(-1)) if kind == 'SCALAR' else len(array), 'type': kind})
        if kind == 'VEC3':
            accessors[-1] |= {'min': array.min(0).tolist(), 'max': array.max(0).tolist()}
        blob += array.tobytes()
        return len(accessors) - 1

    for (positions, normals, triangles), material in shapes():
        attributes = {'POSITION': add(positions.astype(np.float32), 'VEC3', 5126), 'NORMAL': add(normals.astype(np.float32), 'VEC3', 5126)}
        indices = add(triangles.astype(np.uint32).reshape(-1), 'SCALAR', 5125)
        meshes.append({'primitives': [{'attributes': attributes, 'indices': indices, 'material': material}]})
        nodes.append({'mesh': len(meshes) - 1})
    glass = lambda roughness: {
        'pbrMetallicRoughness': {'metallicFactor': 0, 'roughnessFactor': roughness},
        'extensions': {
            'KHR_materials_transmission': {'transmissionFactor': 1},
            'KHR_materials_ior': {'ior': INDEX},
            'KHR_materials_volume': {'thicknessFactor': 1},
        },
    }
    matte = {
        'pbrMetallicRoughness': {'baseColorFactor': [0.6, 0.4, 0.2, 1], 'metallicFactor': 0, 'roughnessFactor': 1},
        'extensions': {'KHR_materials_specular': {'specularFactor': 0}},
    }
    path.write_text(json.dumps({
        'asset': {'version': '2.0'},
        'extensionsUsed': ['KHR_materials_transmission', 'KHR_materials_ior', 'KHR_materials_volume', 'KHR_materials_specular'],
        'buffers': [{'byteLength': len(blob), 'uri': 'data:application/octet-stream;base64,' + base64.b64encode(blob).decode()}],
        'bufferViews': views, 'accessors': accessors, 'meshes': meshes, 'nodes': nodes,
        'materials': [matte, glass(0.0), glass(ROUGHNESS)],
        'scenes': [{'nodes': list(range(len(nodes)))}], 'scene': 0,
    }))


def mitsuba(size, samples, out):
    bsdfs = {
        FLOOR: {'type': 'twosided', 'bsdf': {'type': 'diffuse', 'reflectance': {'type': 'rgb', 'value': [0.6, 0.4, 0.2]}}},
        GLASS: {'type': 'dielectric', 'int_ior': INDEX, 'ext_ior': 1.0},
        FROSTED: {'type': 'roughdielectric', 'distribution': 'ggx', 'alpha': ROUGHNESS ** 2, 'int_ior': INDEX, 'ext_ior': 1.0},
    }
    scene = {
        'type': 'scene',
        # Boundaries count as bounces there.
        'integrator': {'type': 'path', 'max_depth': 40, 'rr_depth': 1000},
        'sky': {'type': 'constant', 'radiance': 1.0},
        'sensor': sensor(EYE, TARGET, FOV_Y, size, samples),
    }
    for number, ((positions, normals, triangles), material) in enumerate(shapes()):
        mesh = mi.Mesh(f'shape{number}', len(positions), len(triangles), has_vertex_normals=True)
        parameters = mi.traverse(mesh)
        parameters['vertex_positions'] = positions.astype(np.float32).reshape(-1)
        parameters['vertex_normals'] = normals.astype(np.float32).reshape(-1)
        parameters['faces'] = triangles.astype(np.uint32).reshape(-1)
        parameters.update()
        file = out / f'shape{number}.ply'
        mesh.write_ply(str(file))
        scene[f'shape{number}'] = {'type': 'ply', 'filename': str(file), 'bsdf': bsdfs[material]}
    return np.array(mi.render(mi.load_dict(scene), spp=samples))


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument('out', type=Path)
    arguments.add_argument('render')
    arguments.add_argument('--samples', type=int, default=1024)
    arguments.add_argument('--size', default='96x72')
    given = arguments.parse_args()
    size = [int(side) for side in given.size.split('x')]
    given.out.mkdir(parents=True, exist_ok=True)
    write_gltf(given.out / 'scene.gltf')
    mi.Bitmap(np.ones((2, 4, 3), np.float32)).write(str(given.out / 'sky.exr'))
    look = lambda place: ','.join(map(str, place))
    a = ours(given.render, given.out / 'scene.gltf', size, given.samples, given.out / 'ours', '--bounces', '36',
             '--environment', given.out / 'sky.exr', f'--eye={look(EYE)}', f'--target={look(TARGET)}', '--fov-y', str(FOV_Y)).mean(0)
    b = mitsuba(size, given.samples, given.out)
    write(given.out, ours=a, mitsuba=b)
    apart = np.abs(blocks(a) - blocks(b)) / blocks(b)
    # The frosted ball is in the right third. Mitsuba's loses the light that one scattering loses.
    for name, part in (('smooth glass', apart[:, :apart.shape[1] * 5 // 8]), ('frosted glass', apart[:, apart.shape[1] * 5 // 8:])):
        print(f'{name}: blocks of 4×4 are {100 * part.mean():.2f} % apart on average, {100 * np.median(part):.2f} % median, {100 * part.max():.1f} % at most')
    print(f'mean of the picture: ours {a.mean():.4f}, Mitsuba {b.mean():.4f}')


if __name__ == '__main__':
    main()
