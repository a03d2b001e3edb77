// Blends the last output into this one. A running mean still moves as 1/n, and what the spatial filter makes of it moves with its
// weights; the eye sees such a shimmer before it sees an error.
//
//   O = C + b·(clamp(ρ·O′, lo, hi) − C),  lo = max(min(μ − 1.5·s, C), C − 2·σ),  hi = min(max(μ + 1.5·s, C), C + 2·σ)
//
//   C  filtered colour
//   O′ last output where the surface was, rescaled by the history ratio ρ
//   b  weight of the last output, see `steadiness` in temporal.wgsl
//   σ  deviation of the noise that is left in C
//   μ, s  mean and deviation of C over the 3×3 pixels that see the same surface and are at most twice or half as bright
//
// O is kept for the next frame's O′ and never enters the history, so no blur builds up.
//
// Failure: what a cold start had blurred of a highlight stayed for a dozen frames, a halo as bright as a lamp beside a sun. Reason:
// the bounds held the highlight, and did not ask for the noise. Rule: bounds from pixels that are alike, and no farther than 2·σ. C
// itself is always within, because a steady highlight of one pixel would otherwise lose a third.

#import asvgf::frame::{frame, inside}
#import asvgf::color::luminance
#import asvgf::reproject::SAME_NORMAL
#import asvgf::packing::{pack_rgb, tap_color, unpack_normal, unpack_tap_deviation}

#ifdef STORAGE_READS
@group(0) @binding(1) var guide: texture_storage_2d<rg32uint, read>;
@group(0) @binding(2) var color: texture_storage_2d<rg32uint, read>;

fn guide_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(guide, pixel).xy;
}

fn color_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(color, pixel).xy;
}
#else
@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var color: texture_2d<u32>;

fn guide_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(guide, pixel, 0).xy;
}

fn color_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(color, pixel, 0).xy;
}
#endif
// The last output, reprojected, and its weight b.
@group(0) @binding(3) var reprojected: texture_2d<u32>;
@group(0) @binding(4) var output_out: texture_storage_2d<rg32uint, write>;

// Deviations s of the neighbourhood within which the last output is believed.
const DEVIATIONS: f32 = 1.5;

// Deviations σ of the noise within which the last output is believed. docs/filter.md compares 2, 4 and 8.
const NOISE: f32 = 2.0;

// Greatest ratio of two luminances that belong to one neighbourhood.
const ALIKE: f32 = 2.0;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let g = guide_at(pixel);
    let here = color_at(pixel);
    let own = tap_color(here);
    let own_brightness = luminance(own);
    let normal = unpack_normal(g.x);
    // Moments of the differences from the own colour, so that their squares do not cancel.
    var sum = vec3(0.0);
    var squares = vec3(0.0);
    var count = 1.0;
    for (var i = 0; i < 9; i++) {
        let place = pixel + vec2(i % 3, i / 3) - 1;
        let there = guide_at(place);
        let neighbour = tap_color(color_at(place));
        let brightness = luminance(neighbour);
        let alike = max(brightness, own_brightness) <= ALIKE * min(brightness, own_brightness);
        let surface = inside(place) && there.y != 0u && dot(normal, unpack_normal(there.x)) >= SAME_NORMAL;
        let same = i != 4 && surface && alike;
        let difference = select(vec3(0.0), neighbour - own, same);
        sum += difference;
        squares += difference * difference;
        count += select(0.0, 1.0, same);
    }
    let mean = sum / count;
    let reach = DEVIATIONS * sqrt(max(squares / count - mean * mean, vec3(0.0)));
    let last = textureLoad(reprojected, pixel, 0).xy;
    let noise = vec3(NOISE * unpack_tap_deviation(here));
    let bounded = clamp(tap_color(last) - own, min(mean - reach, vec3(0.0)), max(mean + reach, vec3(0.0)));
    let step = clamp(bounded, -noise, noise);
    let output = max(own + unpack_tap_deviation(last) * step, vec3(0.0));
    textureStore(output_out, pixel, vec4(select(vec2(0u), pack_rgb(output), g.y != 0u), 0u, 0u));
}
