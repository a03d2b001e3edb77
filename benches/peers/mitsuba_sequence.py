"""A short animation by Mitsuba 3, with the passes that `denoise` reads, with references, and with where the cameras are.

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

mi.set_variant('scalar_rgb')  # llvm_ad_rgb is faster, where there is an LLVM
FOV = 50.0  # horizontal, in degrees


def camera(frame, frames):
    """Where it stands, and what it looks at."""
    t = frame / max(frames - 1, 1)
    return np.array([-0.6 + 1.2 * t, 0.4, 3.6]), np.array([0.1 * t, -0.1, 0.0])


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
    # The first names of `aovs` are the user's own: these are known to `denoise`.
    box['integrator'] = {
        'type': 'aov',
        'aovs': 'albedo:albedo,nn:sh_normal,dd:depth,id:shape_index',
        'image': {'type': 'path', 'max_depth': 6},
    }
    metal = {'type': 'roughconductor', 'material': 'Au', 'alpha': 0.15}
    box['ball'] = {'type': 'sphere', 'center': [0.3 - 0.5 * frame / frames, -0.2, 0.9], 'radius': 0.25, 'bsdf': metal}
    return mi.load_dict(box)


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
            # Another seed in each frame, or noise stands still and no average over time lessens it.
            mi.render(made, spp=samples, seed=seed + frame)
            made.sensors()[0].film().bitmap().write(str(folder / f'frame_{frame + 1:04d}.exr'))
        eye, target = camera(frame, asked.frames)
        forward = (target - eye) / np.linalg.norm(target - eye)
        right = np.cross(forward, [0, 1, 0])
        right /= np.linalg.norm(right)
        up = np.cross(right, forward)
        cameras.append({'o': eye.tolist(), 'fw': forward.tolist(), 'r': right.tolist(), 'up': up.tolist(), 'th': math.tan(math.radians(FOV / 2))})
    (folders[0] / 'manifest.json').write_text(json.dumps({'cameras': cameras}))


main()
