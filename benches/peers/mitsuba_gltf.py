"""Reads a binary glTF scene into Mitsuba 3: meshes at one time of an animation, materials, lamps and the camera.

Written for comparisons with this crate's path tracer: it reads what assets/still_life has, and no more. Surfaces with gloss get `GltfSurface`,
the reflection model of glTF's specification (appendix B), because none of Mitsuba's own models is the same. Matte surfaces with a normal
map get `MappedLambert`. The rest are plugins of Mitsuba: `diffuse`, `dielectric` with an absorbing medium, `mask`, `normalmap`, `area`.
"""
import io
import json
import math
import struct
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np
from mitsuba_common import sensor
from PIL import Image

KINDS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {'SCALAR': 1, 'VEC2': 2, 'VEC3': 3, 'VEC4': 4, 'MAT4': 16}
# Texels of a mask's copy for each texel of the file: the copy has the edge of the interpolated opacity.
FINER = 8


class GltfSurface(mi.BSDF):
    """Lambert below a GGX coat, or metal: f = F·D·V + (1 − F)·base·(1 − metal)/π with Schlick's F and Smith's height-correlated V."""

    def __init__(self, properties):
        mi.BSDF.__init__(self, properties)
        self.base = properties.get_texture('base')
        self.metal = float(properties['metal'])
        self.width = max(float(properties['roughness']) ** 2, 1e-3)
        flags = [mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide, mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide]
        self.m_components, self.m_flags = flags, flags[0] | flags[1]

    def facets(self):
        return mi.MicrofacetDistribution(mi.MicrofacetType.GGX, self.width, True)

    def colors(self, si, active):
        base = self.base.eval(si, active)
        return base * (1 - self.metal), 0.04 * (1 - self.metal) + base * self.metal

    def share(self, diffuse, f0, wi):
        """The probability of the specular lobe."""
        specular = mi.luminance(f0 + (1 - f0) * (1 - dr.clip(wi.z, 0, 1)) ** 5)
        matte = mi.luminance(diffuse)
        return dr.select(matte <= 0, 1.0, dr.clip(specular / (specular + matte), 0.1, 0.9))

    def eval_pdf(self, context, si, wo, active=True):
        diffuse, f0 = self.colors(si, active)
        active &= (si.wi.z > 0) & (wo.z > 0)
        half = dr.normalize(si.wi + wo)
        fresnel = f0 + (1 - f0) * (1 - dr.clip(dr.dot(si.wi, half), 0, 1)) ** 5
        facets, a2 = self.facets(), self.width ** 2
        lambda_ = lambda z: 0.5 * (dr.sqrt(1 + a2 * (1 - z * z) / (z * z)) - 1)
        masking = 1 / (1 + lambda_(si.wi.z) + lambda_(wo.z))
        specular = fresnel * facets.eval(half) * masking / (4 * si.wi.z)
        value = specular + diffuse * (1 - fresnel) * wo.z / math.pi
        share = self.share(diffuse, f0, si.wi)
        density = share * facets.pdf(si.wi, half) / (4 * dr.dot(si.wi, half)) + (1 - share) * wo.z / math.pi
        return dr.select(active, value, 0.0), dr.select(active, density, 0.0)

    def eval(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[0]

    def pdf(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[1]

    def sample(self, context, si, choice, u, active=True):
        diffuse, f0 = self.colors(si, active)
        active &= si.wi.z > 0
        specular = choice < self.share(diffuse, f0, si.wi)
        normal, _ = self.facets().sample(si.wi, u)
        sample = mi.BSDFSample3f()
        sample.wo = dr.select(specular, mi.reflect(si.wi, normal), mi.warp.square_to_cosine_hemisphere(u))
        value, sample.pdf = self.eval_pdf(context, si, sample.wo, active)
        sample.eta = 1.0
        sample.sampled_component = dr.select(specular, mi.UInt32(1), mi.UInt32(0))
        sample.sampled_type = dr.select(specular, mi.UInt32(+mi.BSDFFlags.GlossyReflection), mi.UInt32(+mi.BSDFFlags.DiffuseReflection))
        active &= sample.pdf > 0
        return sample, dr.select(active, value / sample.pdf, 0.0)

    def to_string(self):
        return f'GltfSurface[metal={self.metal}, width={self.width}]'


class MappedLambert(mi.BSDF):
    """Lambert with a normal map, lit wherever light arrives above the true and the mapped normal.

    `normalmap` also is black for viewers below the mapped normal. glTF does not say so.
    """

    def __init__(self, properties):
        mi.BSDF.__init__(self, properties)
        self.base, self.map = properties.get_texture('base'), properties.get_texture('map')
        self.m_components = [mi.BSDFFlags.DiffuseReflection | mi.BSDFFlags.FrontSide]
        self.m_flags = self.m_components[0]

    def normal(self, si, active):
        n = dr.normalize(self.map.eval_3(si, active) * 2 - 1)
        frame = si.sh_frame
        tangent = dr.normalize(si.dp_du - frame.n * dr.dot(frame.n, si.dp_du))
        return si.to_local(tangent * n.x + dr.cross(frame.n, tangent) * n.y + frame.n * n.z)

    def eval_pdf(self, context, si, wo, active=True):
        active &= (si.wi.z > 0) & (wo.z > 0)
        value = self.base.eval(si, active) * (dr.maximum(dr.dot(self.normal(si, active), wo), 0) / math.pi)
        return dr.select(active, value, 0.0), dr.select(active, wo.z / math.pi, 0.0)

    def eval(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[0]

    def pdf(self, context, si, wo, active=True):
        return self.eval_pdf(context, si, wo, active)[1]

    def sample(self, context, si, choice, u, active=True):
        sample = mi.BSDFSample3f()
        sample.wo = mi.warp.square_to_cosine_hemisphere(u)
        value, sample.pdf = self.eval_pdf(context, si, sample.wo, active)
        sample.eta, sample.sampled_component = 1.0, mi.UInt32(0)
        sample.sampled_type = mi.UInt32(+mi.BSDFFlags.DiffuseReflection)
        return sample, dr.select(active & (sample.pdf > 0), value / sample.pdf, 0.0)

    def to_string(self):
        return 'MappedLambert'


def turn(a, b, part):
    """Spherical linear interpolation of quaternions."""
    cosine = float(np.dot(a, b))
    a, cosine = (-a, -cosine) if cosine < 0 else (a, cosine)
    angle = math.acos(min(cosine, 1.0))
    if angle < 1e-6:
        return b
    return (math.sin((1 - part) * angle) * a + math.sin(part * angle) * b) / math.sin(angle)


class Gltf:
    def __init__(self, path):
        data = Path(path).read_bytes()
        length = struct.unpack_from('<I', data, 12)[0]
        self.root = json.loads(data[20:20 + length])
        self.blob = data[28 + length:]

    def write(self, path):
        text = json.dumps(self.root).encode()
        text += b' ' * (-len(text) % 4)
        chunks = struct.pack('<I4s', len(text), b'JSON') + text + struct.pack('<I4s', len(self.blob), b'BIN\0') + self.blob
        Path(path).write_bytes(struct.pack('<4sII', b'glTF', 2, 12 + len(chunks)) + chunks)

    def numbers(self, index):
        accessor = self.root['accessors'][index]
        view = self.root['bufferViews'][accessor['bufferView']]
        width = WIDTHS[accessor['type']]
        flat = np.frombuffer(self.blob, KINDS[accessor['componentType']], accessor['count'] * width, view.get('byteOffset', 0) + accessor.get('byteOffset', 0))
        return flat if width == 1 else flat.reshape(-1, width)

    def image(self, texture):
        image = self.root['images'][self.root['textures'][texture['index']]['source']]
        view = self.root['bufferViews'][image['bufferView']]
        start = view.get('byteOffset', 0)
        return bitmap(self.blob[start:start + view['byteLength']])

    def at(self, animation, time):
        """Makes the pose at a time of an animation the pose at rest, and removes all animations."""
        chosen = next(a for a in self.root['animations'] if a['name'] == animation)
        for channel in chosen['channels']:
            sampler, target = chosen['samplers'][channel['sampler']], channel['target']
            times, values = self.numbers(sampler['input']), self.numbers(sampler['output'])
            values = values.reshape(len(times), -1)
            k = min(max(int(np.searchsorted(times, time, 'right')) - 1, 0), len(times) - 2)
            part = min(max((time - times[k]) / (times[k + 1] - times[k]), 0), 1) if sampler['interpolation'] == 'LINEAR' else float(time >= times[k + 1])
            a, b = values[k].astype(float), values[k + 1].astype(float)
            value = turn(a, b, part) if target['path'] == 'rotation' else a + part * (b - a)
            self.root['nodes'][target['node']][target['path']] = [float(x) for x in value]
        self.root['animations'] = []

    def worlds(self):
        """The matrix of each node."""
        worlds = {}

        def visit(node, parent):
            n = self.root['nodes'][node]
            x, y, z, w = n.get('rotation', (0, 0, 0, 1))
            rotation = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                                 [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                                 [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
            local = np.eye(4)
            local[:3, :3] = rotation * np.array(n.get('scale', (1, 1, 1)))
            local[:3, 3] = n.get('translation', (0, 0, 0))
            worlds[node] = parent @ local
            for child in n.get('children', []):
                visit(child, worlds[node])

        for node in self.root['scenes'][0]['nodes']:
            visit(node, np.eye(4))
        return worlds

    def shapes(self):
        """All triangles where they are: positions, normals, texture coordinates or None, corners, material."""
        worlds = self.worlds()
        for number, node in enumerate(self.root['nodes']):
            if 'mesh' not in node:
                continue
            mesh = self.root['meshes'][node['mesh']]
            for primitive in mesh['primitives']:
                attributes = primitive['attributes']
                positions, normals = (self.numbers(attributes[name]).astype(float) for name in ('POSITION', 'NORMAL'))
                for weight, target in zip(node.get('weights', mesh.get('weights', [])), primitive.get('targets', [])):
                    positions = positions + weight * self.numbers(target['POSITION'])
                    normals = normals + weight * self.numbers(target['NORMAL'])
                if 'skin' in node:
                    skin = self.root['skins'][node['skin']]
                    binds = self.numbers(skin['inverseBindMatrices']).reshape(-1, 4, 4).transpose(0, 2, 1)
                    joints = np.array([worlds[joint] @ bind for joint, bind in zip(skin['joints'], binds)])
                    places = np.einsum('vk,vkij->vij', self.numbers(attributes['WEIGHTS_0']), joints[self.numbers(attributes['JOINTS_0'])])
                else:
                    places = np.broadcast_to(worlds[number], (len(positions), 4, 4))
                positions = np.einsum('vij,vj->vi', places[:, :3, :3], positions) + places[:, :3, 3]
                normals = np.einsum('vji,vj->vi', np.linalg.inv(places[:, :3, :3]), normals)
                normals /= np.maximum(np.linalg.norm(normals, axis=1, keepdims=True), 1e-30)
                uv = self.numbers(attributes['TEXCOORD_0']) if 'TEXCOORD_0' in attributes else None
                yield positions, normals, uv, self.numbers(primitive['indices']).reshape(-1, 3), primitive['material']

    def camera(self):
        """Eye, target and vertical field of view in degrees."""
        number = next(i for i, node in enumerate(self.root['nodes']) if 'camera' in node)
        world = self.worlds()[number]
        return world[:3, 3].tolist(), (world[:3, 3] - world[:3, 2]).tolist(), math.degrees(self.root['cameras'][0]['perspective']['yfov'])


def bitmap(png):
    return np.array(Image.open(io.BytesIO(png)).convert('RGBA'), np.float32) / 255


def linear(srgb):
    return np.where(srgb <= 0.04045, srgb / 12.92, ((srgb + 0.055) / 1.055) ** 2.4)


def texture(values, **more):
    return {'type': 'bitmap', 'bitmap': mi.Bitmap(np.ascontiguousarray(values, np.float32)), 'raw': True, **more}


def finer(values):
    """A picture with `FINER` texels for each, interpolated as textures are, and repeated as they are."""
    for axis in (0, 1):
        count = values.shape[axis]
        at = (np.arange(FINER * count) + 0.5) / FINER - 0.5
        low, part = np.floor(at).astype(int), at - np.floor(at)
        part = part.reshape([-1 if k == axis else 1 for k in range(values.ndim)])
        values = (1 - part) * values.take(low % count, axis) + part * values.take((low + 1) % count, axis)
    return values


def material(gltf, number, own_maps):
    """A BSDF, the radiance of an emitter or None, and the absorption inside or None."""
    m = gltf.root['materials'][number]
    pbr, extensions = m['pbrMetallicRoughness'], m.get('extensions', {})
    base = np.array(pbr['baseColorFactor'][:3])
    rgb = lambda value: {'type': 'rgb', 'value': [float(x) for x in value]}
    if 'KHR_materials_transmission' in extensions:
        volume = extensions['KHR_materials_volume']
        absorption = -np.log(volume.get('attenuationColor', [1, 1, 1])) / volume.get('attenuationDistance', math.inf)
        glass = {'type': 'dielectric', 'int_ior': extensions['KHR_materials_ior']['ior'], 'ext_ior': 1.0, 'specular_transmittance': rgb(base)}
        return glass, None, absorption if absorption.any() else None
    picture = gltf.image(pbr['baseColorTexture']) if 'baseColorTexture' in pbr else None
    color = rgb(base) if picture is None else texture(linear(picture[..., :3]) * base)
    if extensions.get('KHR_materials_specular', {}).get('specularFactor', 1) == 0:
        bsdf = {'type': 'diffuse', 'reflectance': color}
    else:
        bsdf = {'type': 'gltf', 'base': color, 'metal': pbr['metallicFactor'], 'roughness': pbr['roughnessFactor']}
    if 'normalTexture' in m and bsdf['type'] == 'diffuse' and not own_maps:
        bsdf = {'type': 'mapped', 'base': color, 'map': texture(gltf.image(m['normalTexture'])[..., :3])}
    elif 'normalTexture' in m:
        bsdf = {'type': 'normalmap', 'normalmap': texture(gltf.image(m['normalTexture'])[..., :3]), 'bsdf': bsdf}
    bsdf = {'type': 'twosided', 'bsdf': bsdf}
    if m.get('alphaMode') == 'MASK':
        seen = (finer(picture[..., 3]) >= m['alphaCutoff']).astype(np.float32)
        bsdf = {'type': 'mask', 'opacity': texture(seen[..., None], filter_type='nearest'), 'bsdf': bsdf}
    emission = None
    if 'emissiveFactor' in m:
        strength = extensions.get('KHR_materials_emissive_strength', {}).get('emissiveStrength', 1)
        emission = rgb(strength * np.array(m['emissiveFactor']))
    return bsdf, emission, None


def load(gltf, size, samples, without=(), own_maps=False):
    """Mitsuba's scene of a file, and the material of each of its shapes.

    Materials named in `without` are left out with their meshes. `own_maps` takes Mitsuba's `normalmap` for matte surfaces, too.
    """
    mi.register_bsdf('gltf', GltfSurface)
    mi.register_bsdf('mapped', MappedLambert)
    eye, target, fov = gltf.camera()
    names = []
    scene = {
        'type': 'scene',
        'integrator': {'type': 'volpath', 'max_depth': 64, 'rr_depth': 8},
        'sensor': sensor(eye, target, fov, size, samples),
    }
    for number, (positions, normals, uv, corners, at) in enumerate(gltf.shapes()):
        if gltf.root['materials'][at]['name'] in without:
            continue
        names.append(gltf.root['materials'][at]['name'])
        bsdf, emission, absorption = material(gltf, at, own_maps)
        properties = mi.Properties()
        properties['bsdf'] = mi.load_dict(bsdf)
        if emission:
            properties['emitter'] = mi.load_dict({'type': 'area', 'radiance': emission})
        if absorption is not None:
            properties['interior'] = mi.load_dict({
                'type': 'homogeneous', 'albedo': {'type': 'rgb', 'value': 0.0}, 'scale': float(absorption.max()),
                'sigma_t': {'type': 'rgb', 'value': (absorption / absorption.max()).tolist()}})
        mesh = mi.Mesh(f'shape{number}', len(positions), len(corners), properties, has_vertex_normals=True, has_vertex_texcoords=uv is not None)
        parameters = mi.traverse(mesh)
        parameters['vertex_positions'] = mi.Float(positions.astype(np.float32).reshape(-1))
        parameters['vertex_normals'] = mi.Float(normals.astype(np.float32).reshape(-1))
        if uv is not None:
            parameters['vertex_texcoords'] = mi.Float(uv.astype(np.float32).reshape(-1))
        parameters['faces'] = mi.UInt32(corners.astype(np.uint32).reshape(-1))
        parameters.update()
        scene[f'shape{number}'] = mesh
    return mi.load_dict(scene, parallel=False), names
