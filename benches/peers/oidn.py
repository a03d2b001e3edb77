"""Runs Intel Open Image Denoise on the sequences that `report --sequences` writes, as baselines for `report --baseline`.

usage: python oidn.py SEQUENCES OUT
needs: pip install pyoidn numpy OpenEXR

SEQUENCES is report's DIR/sequences. Writes OUT/NAME/SEQUENCE/denoised_0022.exr, … and times.txt for NAME in oidn-fast, oidn-balanced,
oidn-high, and average-oidn-high, which filters a moving average along the motion; the times exclude that average. The emission of
surfaces is subtracted before and added after, because OIDN would otherwise blur small lamps over their surroundings.
"""
import os
import sys
import time
from pathlib import Path

import numpy as np
import OpenEXR
from pyoidn.denoise import denoise

ALPHA = 0.2


def read(path):
    """Reads the layers of a frame, by name; the colour's name is ''."""
    channels = OpenEXR.File(str(path), separate_channels=True).channels()
    layer = lambda name, axes: np.stack([channels[f'{name}.{a}' if name else a].pixels for a in axes], -1).astype(np.float32)
    wanted = {'': 'RGB', 'albedo': 'RGB', 'emission': 'RGB', 'normal': 'XYZ', 'motion': 'XY', 'id': 'I'}
    frame = {n: layer(n, axes) for n, axes in wanted.items() if (f'{n}.{axes[0]}' if n else axes[0]) in channels}
    frame.setdefault('emission', np.zeros_like(frame['']))
    frame[''] = np.maximum(frame[''] - frame['emission'], 0)
    return frame


def average(frame, before, history):
    """Blends a frame with its surfaces' history; new surfaces start anew."""
    color = frame['']
    if history is None:
        return color
    height, width = color.shape[:2]
    y, x = np.mgrid[0:height, 0:width]
    motion = frame.get('motion', np.zeros((height, width, 2)))
    u, v = (np.floor(at + 0.5 + motion[..., axis]).astype(int) for axis, at in enumerate((x, y)))
    known = (u >= 0) & (v >= 0) & (u < width) & (v < height)
    u, v = np.clip(u, 0, width - 1), np.clip(v, 0, height - 1)
    if 'id' in frame:
        known &= (before['id'][v, u] == frame['id'])[..., 0]
    return np.where(known[..., None], ALPHA * color + (1 - ALPHA) * history[v, u], color).astype(np.float32)


def run(folder, out, quality, averaged):
    out.mkdir(parents=True, exist_ok=True)
    times, before, history = [], None, None
    for path in sorted(folder.glob('frame_*.exr')):
        frame = read(path)
        history = average(frame, before, history) if averaged else frame['']
        before = frame
        guides = {name: np.ascontiguousarray(frame[name]) for name in ('albedo', 'normal')}
        filtered = lambda: denoise(np.ascontiguousarray(history), **guides, hdr=True, quality=quality)
        if not times:
            filtered()  # warms up
        # OIDN shares NumPy's images on the processor. The time is that of all threads over the cores, because other
        # work disturbs it less.
        start = time.process_time()
        image = filtered()
        times.append(1e3 * (time.process_time() - start) / os.cpu_count())
        image = image + frame['emission']
        header = {'compression': OpenEXR.ZIP_COMPRESSION, 'type': OpenEXR.scanlineimage}
        channels = {name: np.ascontiguousarray(image[..., i]) for i, name in enumerate('RGB')}
        OpenEXR.File(header, channels).write(str(out / path.name.replace('frame', 'denoised')))
    (out / 'times.txt').write_text(''.join(f'{ms:.4f}\n' for ms in times))


if __name__ == '__main__':
    sequences, out = map(Path, sys.argv[1:3])
    for folder in sorted(path for path in sequences.iterdir() if path.is_dir()):
        for quality in ('fast', 'balanced', 'high'):
            run(folder, out / f'oidn-{quality}' / folder.name, quality, averaged=False)
        run(folder, out / 'average-oidn-high' / folder.name, 'high', averaged=True)
        print(folder.name)
