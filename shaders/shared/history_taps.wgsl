#define_import_path asvgf::history_taps

// The last frame's history: the pixel's own texel in an image that stands still (STILL), else the bilinear taps around the place
// where its surface was.

#import asvgf::frame::{frame, inside}
#import asvgf::color::luminance
#import asvgf::history::{history_color, history_variance, history_length}
#import asvgf::packing::unpack_rgb
#ifndef STILL
#import asvgf::reproject::{Origin, origin_of, same_surface}
#import asvgf::packing::unpack_motion
#ifdef HOST_MOTION
#import asvgf::host_motion::host_motion
#else
@group(0) @binding(3) var motion: texture_2d<u32>;
#endif
#endif

#ifdef OBJECTS
@group(0) @binding(4) var object: texture_2d<u32>;
@group(0) @binding(5) var object_previous: texture_2d<u32>;
#endif
#ifdef SPECULAR_SIGNAL
#import asvgf::gloss::{Reflection, unpack_reflection}

@group(0) @binding(30) var reflection: texture_2d<u32>;

// The reflection that a pixel shows, see reflection.wgsl.
fn reflection_at(pixel: vec2<i32>) -> Reflection {
    return unpack_reflection(textureLoad(reflection, pixel, 0).xy);
}
#endif
#ifdef FEEDBACK
@group(0) @binding(8) var feedback_previous: texture_2d<u32>;
#endif

// Images that are read at several taps are bound as storage, see `Feature::StorageReads`; every device has four storage textures.
#ifdef STORAGE_READS
@group(0) @binding(7) var history_previous: texture_storage_2d<rg32uint, read>;

fn history_at(tap: vec2<i32>) -> vec2<u32> {
    return textureLoad(history_previous, tap).xy;
}
#ifndef STILL
@group(0) @binding(2) var guide_previous: texture_storage_2d<rg32uint, read>;

fn guide_at(tap: vec2<i32>) -> vec2<u32> {
    return textureLoad(guide_previous, tap).xy;
}
#endif
#else
@group(0) @binding(7) var history_previous: texture_2d<u32>;
#ifndef STILL
@group(0) @binding(2) var guide_previous: texture_2d<u32>;

fn guide_at(tap: vec2<i32>) -> vec2<u32> {
    return textureLoad(guide_previous, tap, 0).xy;
}
#endif

fn history_at(tap: vec2<i32>) -> vec2<u32> {
    return textureLoad(history_previous, tap, 0).xy;
}
#endif

#ifdef STEADY
@group(0) @binding(15) var output_previous: texture_2d<u32>;

fn output_at(tap: vec2<i32>) -> vec3<f32> {
    return unpack_rgb(textureLoad(output_previous, tap, 0).xy);
}
#endif

struct History {
    color: vec3<f32>,
    mean: f32,
    variance: f32,
    length: f32,
    // Sum of the weights of the taps on the same surface; 0 if there is no history.
    weight: f32,
#ifdef STEADY
    // The last output at the same taps.
    output: vec3<f32>,
#endif
}

#ifdef STILL
// The history of the pixel itself, in an image that stands still.
fn own_history(pixel: vec2<i32>) -> History {
    let h = history_at(pixel);
    let length = history_length(h);
#ifdef FEEDBACK
    let color = unpack_rgb(textureLoad(feedback_previous, pixel, 0).xy);
    let mean = history_color(h).x;
#else
    let color = history_color(h);
    let mean = luminance(color);
#endif
    var history = History();
    history.color = color;
    history.mean = mean;
    history.variance = history_variance(h);
    history.length = length;
    history.weight = select(0.0, 1.0, length > 0.0);
#ifdef STEADY
    history.output = output_at(pixel);
#endif
    return history;
}
#else
// Motion of the surface: its former place less its place, in pixels, and its former depth.
fn motion_of(pixel: vec2<i32>, depth: f32) -> vec3<f32> {
#ifdef HOST_MOTION
    return unpack_motion(host_motion(pixel, depth).packed);
#else
    return unpack_motion(textureLoad(motion, pixel, 0).xy);
#endif
}

// The pixel's surface as it was in the last frame.
fn origin_at(pixel: vec2<i32>, moved: vec3<f32>, normal: vec3<f32>) -> Origin {
#ifdef OBJECTS
    let here = textureLoad(object, pixel, 0).x;
#else
    let here = 0u;
#endif
    return origin_of(vec2<f32>(pixel), moved, normal, here);
}

// Weighted sums over the taps on one surface.
struct TapSum {
    color: vec3<f32>,
    mean: f32,
    square: f32,
    variance: f32,
    length: f32,
    weight: f32,
#ifdef MISSING_SAMPLES
    // Sum of the weights of all taps on the surface, those that have seen no sample yet included.
    surface: f32,
#endif
#ifdef STEADY
    output: vec3<f32>,
#endif
}

// A tap below this bilinear weight is outside of the surface's footprint but for rounding.
const LEAST_TAP: f32 = 1e-4;

fn add_tap(sum: ptr<function, TapSum>, origin: Origin, place: vec2<i32>, bilinear: f32) {
    let tap = clamp(place, vec2(0), vec2<i32>(frame.size) - 1);
#ifdef OBJECTS
    let there = textureLoad(object_previous, tap, 0).x;
#else
    let there = 0u;
#endif
    let valid = bilinear >= LEAST_TAP && inside(place)
        && same_surface(origin, tap, guide_at(tap), there);
    var weight = select(0.0, bilinear, valid);
    let h = history_at(tap);
#ifdef MISSING_SAMPLES
    (*sum).surface += weight;
    weight = select(0.0, weight, history_length(h) > 0.0);
#else
#ifdef SPECULAR_SIGNAL
    // A part of the surface without a specular lobe has no history.
    weight = select(0.0, weight, history_length(h) > 0.0);
#endif
#endif
#ifdef FEEDBACK
    let color = unpack_rgb(textureLoad(feedback_previous, tap, 0).xy);
    let mean = history_color(h).x;
#else
    let color = history_color(h);
    let mean = luminance(color);
#endif
    (*sum).color += weight * color;
    (*sum).mean += weight * mean;
    (*sum).square += weight * mean * mean;
    (*sum).variance += weight * history_variance(h);
    (*sum).length += weight * history_length(h);
    (*sum).weight += weight;
#ifdef STEADY
    (*sum).output += weight * output_at(tap);
#endif
}

// Rounding errors of a motion, in pixels.
const ROUNDING: f32 = 1e-4;

// The upper left pixel of the four around a point. A motion that is whole but for rounding errors stays on its pixel: points a
// 10⁴th below the next pixel count as that pixel.
fn corner_of(point: vec2<f32>) -> vec2<i32> {
    return vec2<i32>(floor(point + ROUNDING));
}

fn bilinear_taps(origin: Origin, point: vec2<f32>) -> TapSum {
    let base = corner_of(point);
    let f = max(point - vec2<f32>(base), vec2(0.0));
    var sum = TapSum();
    add_tap(&sum, origin, base, (1.0 - f.x) * (1.0 - f.y));
    add_tap(&sum, origin, base + vec2(1, 0), f.x * (1.0 - f.y));
    add_tap(&sum, origin, base + vec2(0, 1), (1.0 - f.x) * f.y);
    add_tap(&sum, origin, base + vec2(1, 1), f.x * f.y);
    return sum;
}

// Sum of weights up to which no surface lies under the taps: a hundredth of the four bilinear weights' sum.
const LEAST_WEIGHT: f32 = 0.01;

// The taps' weighted mean; no history where the surface does not lie under them.
fn mean_of(sum: TapSum) -> History {
    if sum.weight <= LEAST_WEIGHT {
        return History();
    }
    let scale = 1.0 / sum.weight;
    let mean = sum.mean * scale;
    // Law of total variance: the mean of the taps' variances plus the variance of their means.
    let variance = sum.variance * scale + max(sum.square * scale - mean * mean, 0.0);
    var history = History();
    history.color = sum.color * scale;
    history.mean = mean;
    history.variance = variance;
    history.length = sum.length * scale;
    history.weight = sum.weight;
#ifdef STEADY
    history.output = sum.output * scale;
#endif
    return history;
}
#endif
