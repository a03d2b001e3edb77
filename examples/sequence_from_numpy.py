"""Writes frames for `denoise` from NumPy arrays: replace `frames` by your own renderer's.

usage: python sequence_from_numpy.py OUT
needs: pip install numpy OpenEXR

cargo run --release --example denoise -- OUT --out OUT/denoised
"""
import json
import math
import sys
from pathlib import Path

import numpy as np
import OpenEXR

WIDTH, HEIGHT, FRAMES, FOV_Y = 160, 90, 8, math.radians(45)


def write(path, **layers):
    """Arrays of height × width (× components) as 32-bit floats: color, albedo, emission, normal, depth, motion, id. Leave out those that you lack."""
    components = dict(color='RGB', albedo='RGB', emission='RGB', normal='XYZ', depth='Z', motion='XY', id='I')
    channels = {}
    for name, image in layers.items():
        image = np.asarray(image, np.float32).reshape(*image.shape[:2], -1)
        for k, component in enumerate(components[name]):
            full = component if name == 'color' else f'{name}.{component}'
            channels[full] = np.ascontiguousarray(image[..., k])
    OpenEXR.File({'compression': OpenEXR.ZIP_COMPRESSION, 'type': OpenEXR.scanlineimage}, channels).write(str(path))


def frames():
    """A floor of checks and a wall behind it, seen by a camera that moves to the right, with the noise of one path per pixel."""
    rng = np.random.default_rng(1)
    tangent = math.tan(FOV_Y / 2)
    y, x = np.mgrid[:HEIGHT, :WIDTH] + 0.5
    # The ray of each pixel, with one unit along the view axis: x right, y up, −z forward.
    ray = np.stack([(2 * x / WIDTH - 1) * tangent * WIDTH / HEIGHT, (1 - 2 * y / HEIGHT) * tangent, -np.ones_like(x)], -1)
    for frame in range(FRAMES):
        eye = np.array([0.05 * frame, 1.0, 0.0])
        to_floor = np.where(ray[..., 1] < 0, -eye[1] / np.minimum(ray[..., 1], -1e-9), np.inf)
        is_floor = to_floor < 6.0
        depth = np.where(is_floor, to_floor, 6.0)
        point = eye + depth[..., None] * ray
        normal = np.where(is_floor[..., None], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0])
        checks = (np.floor(point[..., 0]) + np.floor(point[..., 2])) % 2
        albedo = np.where(is_floor, 0.2 + 0.6 * checks, 0.7)[..., None] * np.ones(3)
        light = 1.0 / (1.0 + 0.1 * np.sum((point - [0.0, 2.0, -4.0]) ** 2, -1))
        noise = rng.exponential(size=(HEIGHT, WIDTH))  # other noise in each frame
        # previous − current position in pixels, x right, y down: the camera was 0.05 to the left, so everything was further right.
        moved = 0.05 / depth / (tangent * WIDTH / HEIGHT) * WIDTH / 2
        motion = np.stack([moved, np.zeros_like(moved)], -1)
        yield dict(color=albedo * (light * noise)[..., None], albedo=albedo, normal=normal, depth=depth, motion=motion), eye


def main():
    out = Path(sys.argv[1])
    out.mkdir(parents=True, exist_ok=True)
    cameras = []
    for number, (layers, eye) in enumerate(frames()):
        write(out / f'frame_{number:04d}.exr', **layers)
        slope = math.tan(FOV_Y / 2) * WIDTH / HEIGHT  # of half the horizontal field of view
        cameras.append(dict(o=eye.tolist(), fw=[0, 0, -1], r=[1, 0, 0], up=[0, 1, 0], th=slope))
    (out / 'manifest.json').write_text(json.dumps(dict(cameras=cameras)))


main()
