"""Compares the path tracer with Mitsuba 3 by assets/still_life, at one time of its animation.

usage: python mitsuba_still_life.py OUT RENDER [--samples 4096] [--size 64x36] [--time 1.8] [--own-maps]
needs: pip install mitsuba numpy pillow, and LLVM 16 or later (DRJIT_LIBLLVM_PATH); RENDER is the program, as target/release/examples/render

Prints for each material how far the means of blocks of 4×4 pixels are apart, and how far the two halves of each renderer's own samples
are. Blocks with light that reaches them through glass are counted apart, because this path tracer has no caustics.
"""
import argparse
from pathlib import Path

import drjit as dr
import mitsuba as mi
import numpy as np

mi.set_variant('llvm_ad_rgb')
from mitsuba_common import blocks, ours, write  # noqa: E402
from mitsuba_gltf import Gltf, load  # noqa: E402

SCENE = Path(__file__).parent.parent.parent / 'assets/still_life/still_life.glb'
GLASS = ('clear glass', 'blue glass', 'green glass')
# Samples of a pass, and of the search for what each block shows.
PASS, SEARCH = 256, 256
# Part of a block that one material covers, and part of the light through glass from which on caustics count.
COVERED, CAUSTIC = 0.9, 0.005


def mitsuba(gltf, size, samples, own_maps):
    """Images of `PASS` samples each."""
    scene, _ = load(gltf, size, PASS, own_maps=own_maps)
    return np.array([np.array(mi.render(scene, spp=PASS, seed=seed)) for seed in range(max(samples // PASS, 2))])


def seen(gltf, size):
    """For each block the part of each material in it, and the part of the lamps' light that reaches it through glass."""
    (whole, names), (bare, _) = load(gltf, size, 1), load(gltf, size, 1, GLASS)
    width, height = size
    count = width * height * SEARCH
    sampler = mi.load_dict({'type': 'independent'})
    sampler.seed(1, count)
    pixel = dr.arange(mi.UInt32, count) // SEARCH
    corner = mi.Point2f(mi.Float(pixel % width), mi.Float(pixel // width))
    ray, _ = whole.sensors()[0].sample_ray(0, 0, (corner + sampler.next_2d()) / mi.Point2f(width, height), mi.Point2f(0.5))
    hit = whole.ray_intersect(ray)
    mean = lambda values: np.array(values).reshape(height, width, SEARCH).mean(2)
    parts = {}
    for shape, name in zip(whole.shapes(), names):
        parts[name] = parts.get(name, 0) + blocks(mean(dr.select(hit.shape == mi.ShapePtr(shape), mi.Float(1), mi.Float(0))))
    # All that is not glass may get light through glass.
    lamp, weight = whole.sample_emitter_direction(hit, sampler.next_2d(), False)
    light = mi.luminance(weight) * dr.maximum(dr.dot(hit.n, lamp.d), 0)
    shadow = hit.spawn_ray_to(lamp.p)
    light = dr.select(bare.ray_test(shadow), 0, light)
    through = dr.select(whole.ray_test(shadow), light, 0)
    return parts, blocks(mean(through)) / np.maximum(blocks(mean(light)), 1e-6)


def difference(a, b):
    """Relative differences of blocks, of the sum of the channels."""
    a, b = (blocks(image).sum(-1) for image in (a, b))
    return np.abs(a - b) / b


def main():
    arguments = argparse.ArgumentParser()
    arguments.add_argument('out', type=Path)
    arguments.add_argument('render')
    arguments.add_argument('--samples', type=int, default=4096)
    arguments.add_argument('--size', default='64x36')
    arguments.add_argument('--time', type=float, default=1.8)
    arguments.add_argument('--own-maps', action='store_true', help="take Mitsuba's own normal maps for matte surfaces")
    given = arguments.parse_args()
    size = [int(side) for side in given.size.split('x')]
    given.out.mkdir(parents=True, exist_ok=True)
    gltf = Gltf(SCENE)
    gltf.at('sway', given.time)
    gltf.write(given.out / 'pose.glb')
    b = mitsuba(gltf, size, given.samples, given.own_maps)
    parts, through = seen(gltf, size)
    a = ours(given.render, given.out / 'pose.glb', size, given.samples, given.out / 'ours', '--bounces', '8')
    write(given.out, ours=a.mean(0), mitsuba=b.mean(0))
    apart = difference(a.mean(0), b.mean(0))
    noise = [difference(x[::2].mean(0), x[1::2].mean(0)) / 2 for x in (a, b)]
    caustic = through > CAUSTIC
    covers = {name: part >= COVERED for name, part in parts.items()}
    glass = sum(parts[name] for name in GLASS) > 0.02
    rows = {name: mask & ~caustic & ~glass for name, mask in covers.items()}
    rows['several, without glass'] = ~np.any(list(covers.values()), axis=0) & ~glass & ~caustic
    rows['all without glass and caustics'] = ~glass & ~caustic
    rows['lit through glass'] = caustic & ~glass
    rows['glass'] = glass
    rows['everything'] = np.ones_like(glass)
    print('| part | blocks | mean | median | largest | ours over Mitsuba | noise of ours | noise of Mitsuba |\n|---|--:|--:|--:|--:|--:|--:|--:|')
    percent = lambda x: f'{100 * x:.2f} %'
    sums = [blocks(x.mean(0)).sum(-1) for x in (a, b)]
    for name, mask in rows.items():
        if mask.any():
            own = [percent(n[mask].mean()) for n in noise]
            ratio = sums[0][mask].sum() / sums[1][mask].sum()
            print(f'| {name} | {mask.sum()} | {percent(apart[mask].mean())} | {percent(np.median(apart[mask]))} | {percent(apart[mask].max())} '
                  f'| {ratio:.4f} | {own[0]} | {own[1]} |')
    np.savez(given.out / 'blocks.npz', apart=apart, ours=sums[0], mitsuba=sums[1], through=through, **parts)


if __name__ == '__main__':
    main()
