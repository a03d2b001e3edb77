"""Renders a short animation with Mitsuba 3: the passes that `denoise` reads, references, and the cameras.

usage: python mitsuba_sequence.py OUT [--samples 1] [--reference 1024] [--frames 12] [--size 160x90]
needs: pip install mitsuba numpy

Writes OUT/frames/frame_0001.exr, …, OUT/frames/manifest.json and OUT/references/frame_0001.exr, …. Then:

cargo run --release --example denoise -- OUT/frames --out OUT/asvgf
cargo run --release --example score -- OUT/asvgf OUT/frames OUT/references
"""
import argparse
import json
import math
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant('scalar_rgb')  # llvm_ad_rgb is faster if LLVM is installed
FOV = 50.0  # horizontal, in degrees


def camera(frame, frames):
    """Returns the camera's position and its target."""
    t = frame / max(frames - 1, 1)
    return np.array([-0.6 + 1.2 * t, 0.4, 3.6]), np.array([0.1 * t, -0.1, 0.0])


def ball(frame, frames):
    return np.array([0.3 - 0.5 * frame / frames, -0.2, 0.9])


def scene(frame, frames, size):
    eye, target = camera(frame, frames)
    box = mi.cornell_box()
    box['sensor'] = {
        'type': 'perspective',
        'fov': FOV,
        'fov_axis': 'x',
        'to_world': mi.ScalarTransform4f().look_at(origin=eye.tolist(), target=target.tolist(), up=[0, 1, 0]),
        'film': {'type': 'hdrfilm', 'width': size[0], 'height': size[1], 'rfilter': {'type': 'box'}, 'pixel_format': 'rgb', 'component_format': 'float32'},
        'sampler': {'type': 'independent'},
    }
    # The user chooses the first part of each name of `aovs`: `denoise` knows these.
    box['integrator'] = {
        'type': 'aov',
        'aovs': 'albedo:albedo,nn:sh_normal,dd:depth,id:shape_index,pp:position',
        'image': {'type': 'path', 'max_depth': 6},
    }
    metal = {'type': 'roughconductor', 'material': 'Au', 'alpha': 0.15}
    box['ball'] = {'type': 'sphere', 'center': ball(frame, frames).tolist(), 'radius': 0.25, 'bsdf': metal}
    return mi.load_dict(box)


def axes(frame, frames):
    """Returns the camera's position, and its directions forward, right and up."""
    eye, target = camera(frame, frames)
    forward = (target - eye) / np.linalg.norm(target - eye)
    right = np.cross(forward, [0, 1, 0])
    right /= np.linalg.norm(right)
    return eye, forward, right, np.cross(right, forward)


def project(points, frame, frames, size):
    """Returns the pixel that shows a point, x right, y down."""
    eye, forward, right, up = axes(frame, frames)
    offset = points - eye
    half = math.tan(math.radians(FOV / 2)) * (offset @ forward)
    with np.errstate(divide='ignore', invalid='ignore'):
        x, y = (offset @ right) / half, (offset @ up) / half * size[0] / size[1]
    return np.stack([(x + 1) / 2 * size[0], (1 - y) / 2 * size[1]], -1)


def with_motion(bitmap, frame, frames, size):
    """Adds motion vectors, which Mitsuba lacks: they follow from positions, from the cameras, and from the ball's movement."""
    names = [bitmap.struct_()[i].name for i in range(bitmap.channel_count())]
    image = np.array(bitmap)
    channel = lambda *wanted: np.stack([image[..., names.index(name)] for name in wanted], -1).astype(np.float64)
    points, depth = channel('pp.X', 'pp.Y', 'pp.Z'), channel('dd.T')[..., 0]
    before = max(frame - 1, 0)
    is_ball = np.linalg.norm(points - ball(frame, frames), axis=-1) < 0.26
    then = points - is_ball[..., None] * (ball(frame, frames) - ball(before, frames))
    motion = project(then, before, frames, size) - project(points, frame, frames, size)
    motion[depth <= 0] = 0
    kept = [i for i, name in enumerate(names) if not name.startswith(('pp.', 'image.'))]
    data = np.concatenate([image[..., kept], motion.astype(np.float32)], -1)
    return mi.Bitmap(data, mi.Bitmap.PixelFormat.MultiChannel, [names[i] for i in kept] + ['motion.X', 'motion.Y'])


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument('out', type=Path)
    parser.add_argument('--samples', type=int, default=1)
    parser.add_argument('--reference', type=int, default=1024)
    parser.add_argument('--frames', type=int, default=12)
    parser.add_argument('--size', default='160x90')
    asked = parser.parse_args()
    size = tuple(map(int, asked.size.split('x')))
    folders = [asked.out / name for name in ('frames', 'references')]
    cameras = []
    for folder in folders:
        folder.mkdir(parents=True, exist_ok=True)
    for frame in range(asked.frames):
        made = scene(frame, asked.frames, size)
        for folder, samples, seed in zip(folders, (asked.samples, asked.reference), (0, 10_000)):
            # Each frame takes another seed; otherwise noise stands still, and no average over time reduces it.
            if samples > 0:
                mi.render(made, spp=samples, seed=seed + frame)
                bitmap = made.sensors()[0].film().bitmap()
                if folder == folders[0]:
                    bitmap = with_motion(bitmap, frame, asked.frames, size)
                bitmap.write(str(folder / f'frame_{frame + 1:04d}.exr'))
        eye, forward, right, up = axes(frame, asked.frames)
        cameras.append({'o': eye.tolist(), 'fw': forward.tolist(), 'r': right.tolist(), 'up': up.tolist(), 'th': math.tan(math.radians(FOV / 2))})
    (folders[0] / 'manifest.json').write_text(json.dumps({'cameras': cameras}))


main()
