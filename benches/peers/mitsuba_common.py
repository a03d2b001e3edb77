"""Comparisons of this crate's path tracer with Mitsuba 3: the camera, a rendering by `render`, and means of blocks of pixels."""
import subprocess

import mitsuba as mi
import numpy as np


def sensor(eye, target, fov_y, size, samples):
    return {
        'type': 'perspective', 'fov': fov_y, 'fov_axis': 'y', 'near_clip': 1e-3,
        'to_world': mi.ScalarTransform4f().look_at(origin=eye, target=target, up=[0, 1, 0]),
        'film': {'type': 'hdrfilm', 'width': size[0], 'height': size[1], 'rfilter': {'type': 'box'}, 'pixel_format': 'rgb', 'component_format': 'float32'},
        'sampler': {'type': 'independent', 'sample_count': samples},
    }


def ours(render, scene, size, samples, out, *options):
    """The images of as many frames of `render` as eight samples each give."""
    # All samples of a frame are at one place of their pixels, which jitter moves from frame to frame. Few frames would see a lamp that is
    # smaller than a pixel in a mirror either too often or too seldom.
    samples_of_frame = 8
    subprocess.run([
        render, scene, '--size', f'{size[0]}x{size[1]}', '--frames', str(max(samples // samples_of_frame, 1)), '--spp', str(samples_of_frame),
        '--jitter', '--outputs', 'noisy', '--format', 'exr', '--out', out, *options,
    ], check=True, stdout=subprocess.DEVNULL)
    read = lambda path: np.array(mi.Bitmap(str(path)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32))
    return np.array([read(path) for path in sorted(out.glob('noisy_*.exr'))])


def blocks(image):
    """Means of 4×4 pixels."""
    height, width = (side // 4 * 4 for side in image.shape[:2])
    return image[:height, :width].reshape(height // 4, 4, width // 4, 4, *image.shape[2:]).mean((1, 3))


def write(out, **images):
    for name, image in images.items():
        mi.Bitmap(image.astype(np.float32)).write(str(out / f'{name}.exr'))
        mi.util.write_bitmap(str(out / f'{name}.png'), image.astype(np.float32))
