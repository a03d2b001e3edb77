"""Renders a short animation with Blender's Cycles: the passes that `denoise` reads, the result of Cycles' own denoiser, and references.

usage: python blender_sequence.py OUT [--samples 1] [--reference 1024] [--frames 12] [--size 160x90]
needs: Python 3.11, pip install bpy==5.0.1 OpenEXR numpy; on Debian libxkbcommon0 libsm6 libice6 libxi6 libxxf86vm1 libxfixes3 libgl1 libegl1

Writes OUT/frames/0001.exr, … (half floats, multilayer, another seed in each frame), OUT/references/0001.exr, … and OUT/cycles/0001.exr, …:
the result of Cycles' denoiser (OIDN with albedo and normals, high quality), taken from the frames. Then:

cargo run --release --example denoise -- OUT/frames --out OUT/asvgf
cargo run --release --example score -- OUT/asvgf OUT/frames OUT/references
cargo run --release --example score -- OUT/cycles OUT/frames OUT/references
"""
import argparse
import math
from pathlib import Path

import bpy
import numpy as np
import OpenEXR


def material(name, color, roughness=0.5, metallic=0.0, transmission=0.0, texture=None, scale=4.0):
    """Makes a principled surface, with a procedural texture for its colour."""
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    shader = made.node_tree.nodes['Principled BSDF']
    shader.inputs['Base Color'].default_value = (*color, 1)
    shader.inputs['Roughness'].default_value = roughness
    shader.inputs['Metallic'].default_value = metallic
    shader.inputs['Transmission Weight'].default_value = transmission
    if texture:
        node = made.node_tree.nodes.new(texture)
        node.inputs['Scale'].default_value = scale
        made.node_tree.links.new(node.outputs['Color'], shader.inputs['Base Color'])
    return made


def add(kind, surface, smooth=False, **where):
    getattr(bpy.ops.mesh, f'primitive_{kind}_add')(**where)
    if smooth:
        bpy.ops.object.shade_smooth()
    bpy.context.object.data.materials.append(surface)
    return bpy.context.object


def move(thing, frames, **values):
    """Sets keys of properties in the first and the last frame."""
    for name, (first, last) in values.items():
        for frame, value in ((1, first), (frames, last)):
            setattr(thing, name, value)
            thing.keyframe_insert(name, frame=frame)


def build(frames):
    """Builds a textured floor, plastic, glass, steel, and a moving head before a moving camera."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    add('plane', material('floor', (0.5, 0.5, 0.5), 0.15, texture='ShaderNodeTexNoise'), size=30)
    add('cube', material('brick', (0.6, 0.3, 0.2), 0.8, texture='ShaderNodeTexBrick', scale=3), size=1.6, location=(-2, 1, 0.8), rotation=(0, 0, 0.5))
    add('uv_sphere', material('plastic', (0.7, 0.1, 0.1), 0.12), True, radius=0.8, location=(0, 0, 0.8), segments=48, ring_count=24)
    add('uv_sphere', material('glass', (1, 1, 1), 0, 0, 1), True, radius=0.7, location=(1.8, 0.6, 0.7), segments=48, ring_count=24)
    add('cylinder', material('steel', (0.8, 0.8, 0.8), 0.3, 1), True, radius=0.5, depth=2, location=(3.2, -0.4, 1))
    head = add('monkey', material('clay', (0.3, 0.5, 0.3), 0.6), True, size=1.2, location=(-1, -1.6, 0.7))
    move(head, frames, location=((-1, -1.6, 0.7), (0.4, -1.6, 0.7)))
    sky = bpy.data.worlds.new('sky')
    scene.world = sky
    sky.use_nodes = True
    sky.node_tree.nodes['Background'].inputs['Color'].default_value = (0.35, 0.5, 0.8, 1)
    sky.node_tree.nodes['Background'].inputs['Strength'].default_value = 0.6
    bpy.ops.object.light_add(type='SUN', rotation=(0.7, 0.3, 0.4))
    bpy.context.object.data.energy, bpy.context.object.data.angle = 2.5, 0.05
    bpy.ops.object.light_add(type='AREA', location=(-3, -3, 3), rotation=(0.8, 0, -0.8))
    bpy.context.object.data.energy, bpy.context.object.data.size = 150, 0.6
    bpy.ops.object.camera_add()
    scene.camera = bpy.context.object
    turned = lambda down, side: (math.radians(down), 0, side)
    move(scene.camera, frames, location=((-2.2, -7, 2.4), (-0.6, -7, 2.2)), rotation_euler=(turned(74, -0.25), turned(75, 0)))
    return scene


def render(scene, folder, samples, frames, first_seed, denoised):
    """The passes to tick in View Layer Properties are Combined, Z, Normal, Vector, Emission and Denoising Data."""
    scene.render.engine, scene.cycles.device, scene.cycles.samples = 'CYCLES', 'CPU', samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising, scene.cycles.denoiser = denoised, 'OPENIMAGEDENOISE'
    layer = scene.view_layers[0]
    layer.use_pass_z = layer.use_pass_normal = layer.use_pass_vector = layer.use_pass_emit = denoised
    layer.cycles.denoising_store_passes = denoised
    settings = scene.render.image_settings
    if hasattr(settings, 'media_type'):  # Blender 5
        settings.media_type = 'MULTI_LAYER_IMAGE'
    settings.file_format, settings.color_depth = 'OPEN_EXR_MULTILAYER', '16' if denoised else '32'
    for frame in range(1, frames + 1):
        scene.frame_set(frame)
        scene.cycles.seed = first_seed + frame  # or tick Animate Seed, the clock beside it
        scene.render.filepath = str(folder / f'{frame:04d}.exr')
        bpy.ops.render.render(write_still=True)


def take_combined(source, target):
    """Copies Combined, the result of Cycles' denoiser; its input is in Noisy Image."""
    channels = {}
    for part in OpenEXR.File(str(source), separate_channels=True).parts:
        channels |= {name: channel.pixels for name, channel in part.channels.items()}
    found = {c: next(pixels for name, pixels in channels.items() if name.endswith(f'.Combined.{c}')) for c in 'RGB'}
    header = {'compression': OpenEXR.ZIP_COMPRESSION, 'type': OpenEXR.scanlineimage}
    OpenEXR.File(header, {c: np.ascontiguousarray(pixels) for c, pixels in found.items()}).write(str(target))


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('out', type=Path)
    parser.add_argument('--samples', type=int, default=1)
    parser.add_argument('--reference', type=int, default=1024)
    parser.add_argument('--frames', type=int, default=12)
    parser.add_argument('--size', default='160x90')
    asked = parser.parse_args()
    scene = build(asked.frames)
    scene.render.resolution_x, scene.render.resolution_y = map(int, asked.size.split('x'))
    scene.render.resolution_percentage = 100
    frames, references, cycles = (asked.out / name for name in ('frames', 'references', 'cycles'))
    cycles.mkdir(parents=True, exist_ok=True)
    render(scene, frames, asked.samples, asked.frames, 0, True)
    for path in sorted(frames.glob('*.exr')):
        take_combined(path, cycles / path.name)
    render(scene, references, asked.reference, asked.frames, 10_000, False)


main()
