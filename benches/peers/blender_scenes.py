"""Compares the path tracer with Blender's Cycles on small scenes, one for each kind of thing that Blender writes into glTF files.

usage: python blender_scenes.py OUT RENDER [--samples 256] [--only NAME ...]
needs: pip install bpy numpy; RENDER is the program, as target/release/examples/render

Each scene is a room with a lamp and one thing in it. Cycles renders OUT/NAME/cycles.exr at frame 15 and exports OUT/NAME/scene.gltf, RENDER
renders that file, and a line tells how far the means of blocks of 4×4 pixels are apart: on average, at most, and in the sum of all light.
"""
import argparse
import math
import subprocess
from pathlib import Path

import bpy
import numpy as np

SIZE, FRAME = (64, 48), 15
SCENES = {}


def scene(build):
    SCENES[build.__name__] = build
    return build


def material(color, roughness=1.0, metallic=0.0, specular=0.0, **inputs):
    made = bpy.data.materials.new('material')
    made.use_nodes = True
    inputs |= {'Base Color': (*color, 1), 'Roughness': roughness, 'Metallic': metallic, 'Specular IOR Level': specular}
    for name, value in inputs.items():
        surface(made).inputs[name.replace('_', ' ')].default_value = value
    return made


def surface(of):
    return of.node_tree.nodes['Principled BSDF']


def emitter(color, strength):
    return material((0, 0, 0), Emission_Color=(*color, 1), Emission_Strength=strength)


def plane(of, place, turn, size):
    bpy.ops.mesh.primitive_plane_add(size=size, location=place, rotation=turn)
    bpy.context.object.data.materials.append(of)
    return bpy.context.object


def ball(of, place=(0, 0, 0.7), radius=0.7):
    bpy.ops.mesh.primitive_uv_sphere_add(radius=radius, location=place, segments=64, ring_count=32)
    bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(of)
    return bpy.context.object


def room(has_lamp=True):
    plane(material((0.6, 0.6, 0.6)), (0, 0, 0), (0, 0, 0), 6)
    plane(material((0.7, 0.7, 0.7)), (0, 3, 3), (math.pi / 2, 0, 0), 6)
    plane(material((0.6, 0.1, 0.1)), (-3, 0, 3), (0, math.pi / 2, 0), 6)
    plane(material((0.1, 0.5, 0.1)), (3, 0, 3), (0, -math.pi / 2, 0), 6)
    if has_lamp:
        plane(emitter((1, 0.9, 0.7), 20), (0, -0.5, 4), (math.pi, 0, 0), 1.6)


def image(texel, size=64, is_color=True):
    """An image node for a material, with the texels `texel(x, y)`."""
    made = bpy.data.images.new('image', size, size, alpha=True)
    made.colorspace_settings.name = 'sRGB' if is_color else 'Non-Color'
    made.pixels = [c for y in range(size) for x in range(size) for c in texel((x + 0.5) / size, (y + 0.5) / size)]
    made.pack()
    return made


def textured(of, texels, output='Color', socket='Base Color'):
    node = of.node_tree.nodes.new('ShaderNodeTexImage')
    node.image = texels
    of.node_tree.links.new(node.outputs[output], surface(of).inputs[socket])
    return node


def light(kind, energy, place, turn=(0, 0, 0), **fields):
    bpy.ops.object.light_add(type=kind, location=place, rotation=turn)
    data = bpy.context.object.data
    for name, value in {'energy': energy, **fields}.items():
        setattr(data, name, value)


BLUE = (0.2, 0.4, 0.8)


@scene
def matte():
    room()
    ball(material(BLUE))


@scene
def plastic():
    room()
    ball(material(BLUE, 0.3, specular=0.5))


@scene
def smooth_plastic():
    room()
    ball(material(BLUE, 0.08, specular=0.5))


@scene
def more_specular():
    room()
    ball(material(BLUE, 0.3, specular=1.0))


@scene
def index_of_2():
    room()
    ball(material(BLUE, 0.2, specular=0.5, IOR=2.0))


@scene
def metal():
    room()
    ball(material((0.9, 0.7, 0.3), 0.3, 1.0, 0.5))


@scene
def coat_on_matte():
    room()
    ball(material((0.1, 0.2, 0.7), Coat_Weight=1, Coat_Roughness=0.1))


@scene
def coat_on_metal():
    room()
    ball(material((0.8, 0.2, 0.1), 0.5, 1.0, Coat_Weight=1, Coat_Roughness=0.03))


@scene
def blend():
    room()
    veil = material(BLUE, Alpha=0.3)
    veil.surface_render_method = 'BLENDED'
    ball(veil)


@scene
def mask():
    room()
    chequered = material(BLUE)
    node = textured(chequered, image(lambda x, y: [0.8, 0.5, 0.2, (int(x * 8) + int(y * 8)) % 2]))
    node.interpolation = 'Closest'
    cut = chequered.node_tree.nodes.new('ShaderNodeMath')
    cut.operation = 'ROUND'
    chequered.node_tree.links.new(node.outputs['Alpha'], cut.inputs[0])
    chequered.node_tree.links.new(cut.outputs[0], surface(chequered).inputs['Alpha'])
    plane(chequered, (0, 0, 1), (1, 0, 0.3), 2)


@scene
def normal_map():
    def texel(x, y):
        n = np.array([0.5 * math.sin(12 * x), 0.5 * math.cos(12 * y), 1])
        return [*(n / np.linalg.norm(n) / 2 + 0.5), 1]

    room()
    relief = material((0.7, 0.7, 0.7))
    node = relief.node_tree.nodes.new('ShaderNodeTexImage')
    node.image = image(texel, 128, False)
    normals = relief.node_tree.nodes.new('ShaderNodeNormalMap')
    relief.node_tree.links.new(node.outputs['Color'], normals.inputs['Color'])
    relief.node_tree.links.new(normals.outputs['Normal'], surface(relief).inputs['Normal'])
    plane(relief, (0, 0, 1), (0.9, 0, 0.3), 2.4)


@scene
def base_texture():
    room()
    gradient = material((1, 1, 1))
    textured(gradient, image(lambda x, y: [x, y, 0.3, 1]))
    plane(gradient, (0, 0, 1), (0.9, 0, 0.3), 2.4)


@scene
def lit_window():
    room(False)
    window = emitter((1, 1, 1), 60)
    pattern = image(lambda x, y: [1, 0.8, 0.5, 1] if 0.4 < x < 0.6 and 0.7 < y < 0.8 else [0, 0, 0, 1])
    textured(window, pattern, socket='Emission Color').interpolation = 'Closest'
    plane(window, (-0.5, 0, 1.5), (1.2, 0, 0.3), 2.4)
    ball(material((0.8, 0.8, 0.8)), (1.5, -0.5, 0.5), 0.5)


@scene
def sun():
    room(False)
    light('SUN', 3, (0, 0, 5), (0.5, 0.3, 0), angle=0)
    ball(material(BLUE))


@scene
def point_light():
    room(False)
    light('POINT', 300, (0, -1, 3), shadow_soft_size=0)
    ball(material(BLUE))


@scene
def spot_light():
    # A sharp cone, because glTF and Blender soften edges by different curves.
    room(False)
    light('SPOT', 1000, (0, -1, 3.5), (0.2, 0, 0), spot_size=1.0, spot_blend=0, shadow_soft_size=0)
    ball(material(BLUE))


@scene
def skin():
    room()
    bpy.ops.mesh.primitive_cylinder_add(radius=0.3, depth=2, location=(0, 0, 1), vertices=32)
    worm = bpy.context.object
    bpy.ops.object.mode_set(mode='EDIT')
    bpy.ops.mesh.subdivide(number_cuts=8)
    bpy.ops.object.mode_set(mode='OBJECT')
    worm.data.materials.append(material((0.8, 0.5, 0.2)))
    bpy.ops.object.armature_add(location=(0, 0, 0))
    bones = bpy.context.object
    bpy.ops.object.mode_set(mode='EDIT')
    lower = bones.data.edit_bones[0]
    lower.head, lower.tail = (0, 0, 0), (0, 0, 1)
    upper = bones.data.edit_bones.new('upper')
    upper.head, upper.tail, upper.parent, upper.use_connect = (0, 0, 1), (0, 0, 2), lower, True
    bpy.ops.object.mode_set(mode='OBJECT')
    worm.select_set(True)
    bones.select_set(True)
    bpy.context.view_layer.objects.active = bones
    bpy.ops.object.parent_set(type='ARMATURE_AUTO')
    joint = bones.pose.bones['upper']
    joint.rotation_mode = 'XYZ'
    for frame, angle in ((0, 0), (30, 1.0)):
        joint.rotation_euler = (angle, 0, 0.3 * angle)
        joint.keyframe_insert('rotation_euler', frame=frame)


@scene
def shape_key():
    room()
    body = ball(material((0.8, 0.5, 0.2)))
    body.shape_key_add(name='rest')
    key = body.shape_key_add(name='tall')
    for vertex in key.data:
        vertex.co.z *= 1.4
        vertex.co.x *= 0.6
    for frame, value in ((0, 0), (30, 1)):
        key.value = value
        key.keyframe_insert('value', frame=frame)


@scene
def parent_that_moves():
    room()
    parent = bpy.data.objects.new('parent', None)
    bpy.context.collection.objects.link(parent)
    ball(material((0.8, 0.5, 0.2))).parent = parent
    for frame, t in ((0, 0), (30, 1)):
        parent.location, parent.scale, parent.rotation_euler = (t, 0, 0.5 * t), (1, 1 - 0.5 * t, 1), (0, 0, t)
        for path in ('location', 'scale', 'rotation_euler'):
            parent.keyframe_insert(path, frame=frame)


@scene
def mirrored_placement():
    room()
    bpy.ops.mesh.primitive_monkey_add(size=1.5, location=(0, 0, 1), rotation=(0, 0, 0.5))
    bpy.context.object.scale = (-1, 1, 1.2)
    bpy.context.object.data.materials.append(material((0.8, 0.5, 0.2), 0.4, specular=0.5))


@scene
def vertex_colors():
    room()
    painted = material((1, 1, 1))
    body = ball(painted)
    colors = body.data.color_attributes.new('Color', 'FLOAT_COLOR', 'POINT')
    for vertex, color in zip(body.data.vertices, colors.data):
        color.color = (abs(vertex.co.x), abs(vertex.co.y), 0.2, 1)
    node = painted.node_tree.nodes.new('ShaderNodeVertexColor')
    node.layer_name = 'Color'
    painted.node_tree.links.new(node.outputs['Color'], surface(painted).inputs['Base Color'])


@scene
def instances():
    room()
    first = ball(material((0.8, 0.5, 0.2), 0.4, specular=0.5), (-1, 0, 0.4), 0.4)
    for i in range(4):
        copy = bpy.data.objects.new('copy', first.data)
        copy.location, copy.scale = (0.6 * i - 0.4, 0.3 * i, 0.4 + 0.3 * i), (1, 1, 1 - 0.15 * i)
        bpy.context.collection.objects.link(copy)


def prepare(samples):
    """Sets the camera, and Cycles to points at the pixels' centres, four bounces and no clamps."""
    bpy.ops.object.camera_add(location=(0, -6, 1.6), rotation=(math.radians(85), 0, 0))
    current = bpy.context.scene
    current.camera = bpy.context.object
    current.camera.data.angle = math.radians(40)
    current.render.fps, current.frame_start, current.frame_end = 30, 0, 30
    current.render.resolution_x, current.render.resolution_y, current.render.resolution_percentage = *SIZE, 100
    current.render.image_settings.file_format, current.render.image_settings.color_depth = 'OPEN_EXR', '32'
    current.view_settings.view_transform = 'Raw'
    cycles = current.cycles
    cycles.samples, cycles.use_denoising, cycles.use_adaptive_sampling = samples, False, False
    # A box filter would ignore its width.
    cycles.pixel_filter_type, cycles.filter_width = 'GAUSSIAN', 0.01
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = 4
    cycles.sample_clamp_indirect = cycles.blur_glossy = 0


def pixels(path):
    read = bpy.data.images.load(str(path))
    read.colorspace_settings.name = 'Non-Color'
    width, height = read.size
    return np.array(read.pixels[:], dtype=float).reshape(height, width, read.channels)[..., :3]


def blocks(picture):
    height, width = picture.shape[:2]
    return picture.reshape(height // 4, 4, width // 4, 4, 3).mean((1, 3))


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument('out', type=Path)
    parser.add_argument('render', type=Path)
    parser.add_argument('--samples', type=int, default=256)
    parser.add_argument('--only', nargs='*', default=list(SCENES))
    args = parser.parse_args()
    print('| scene | mean | largest | all light |\n|---|--:|--:|--:|')
    for name in args.only:
        folder = args.out.resolve() / name
        folder.mkdir(parents=True, exist_ok=True)
        bpy.ops.wm.read_factory_settings(use_empty=True)
        current = bpy.context.scene
        current.render.engine = 'CYCLES'
        SCENES[name]()
        prepare(args.samples)
        # Lights in W/sr and W/m², as this library takes them.
        bpy.ops.export_scene.gltf(
            filepath=str(folder / 'scene.gltf'), export_format='GLTF_SEPARATE', export_cameras=True, export_lights=True,
            export_import_convert_lighting_mode='COMPAT', export_anim_slide_to_zero=False)
        current.frame_set(FRAME)
        current.render.filepath = str(folder / 'cycles.exr')
        bpy.ops.render.render(write_still=True)
        subprocess.run(
            [args.render, folder / 'scene.gltf', '--size', f'{SIZE[0]}x{SIZE[1]}', '--frames', '1', '--start-frame', str(FRAME),
             '--bounces', '4', '--reference', str(args.samples), '--outputs', 'noisy', '--format', 'exr', '--out', folder],
            check=True, capture_output=True)
        theirs, ours = blocks(pixels(folder / 'cycles.exr')), blocks(pixels(folder / f'reference_{FRAME:04d}.exr'))
        apart = np.abs(ours - theirs).mean(-1) / (theirs.mean(-1) + 0.02 * theirs.mean())
        row = f'| {name} | {100 * apart.mean():.2f} % | {100 * apart.max():.1f} % | {ours.sum() / theirs.sum():.4f} |'
        print(row.replace('_', ' '), flush=True)


main()
