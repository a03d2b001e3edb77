// Blends the last output into this one: what is averaged over frames in the history still moves as 1/n, and what the spatial filter makes
// of it moves with its weights. The eye sees such a shimmer before it sees an error.
//
//   O = C + b·(clamp(ρ·O', lo, hi) − C),  lo = max(min(μ − 1.5·s, C), C − 2·σ),  hi = min(max(μ + 1.5·s, C), C + 2·σ)
//
// with the filtered colour C, the last output O' where the surface was, rescaled by the history ratio ρ, the deviation σ of the noise that is
// left in C, and mean and deviation μ, s of C over those of the 3×3 pixels that see the same surface and are at most twice or half as
// bright. b is the weight that temporal.wgsl found. Nothing of O enters the history, so that no blur can build up.
//
// Why so narrow: a cold start blurs what it does not know yet. Were a highlight within its neighbours' bounds, or nothing asked of the
// noise, that blur would stay for a dozen frames, beside a sun as bright as a lamp. C itself is within, as a steady highlight of one pixel
// would otherwise lose a third.

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
// Last output, reprojected, and its weight.
@group(0) @binding(3) var reprojected: texture_2d<u32>;
@group(0) @binding(4) var output_out: texture_storage_2d<rg32uint, write>;

// Deviations of the neighbourhood within which the last output is believed.
const DEVIATIONS: f32 = 1.5;

// Deviations of the noise that is left in C.
const NOISE: f32 = 2.0;

// Ratio of luminances up to which two pixels are taken for one neighbourhood.
const ALIKE: f32 = 2.0;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let g = guide_at(pixel);
    let here = color_at(pixel);
    let own = tap_color(here);
    let own_brightness = luminance(own);
    let normal = unpack_normal(g.x);
    // As differences from the own colour, of which the squares do not cancel.
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
