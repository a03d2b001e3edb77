#define_import_path asvgf::history_taps

// The last frame's history: what a pixel's own texel holds (STILL), or the bilinear taps around the place where its surface was.

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
#ifdef FEEDBACK
@group(0) @binding(8) var feedback_previous: texture_2d<u32>;
#endif

// What is read at several taps, see `Feature::StorageReads`. Four storage textures are all that is sure to be had.
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
    // Sum of the weights of the taps that were accepted.
    weight: f32,
#ifdef STEADY
    // The last output there.
    output: vec3<f32>,
#endif
}

#ifdef STILL
// The pixel's own, in an image that stands still.
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
// Where the surface was, less where it is, and the depth that it had.
fn motion_of(pixel: vec2<i32>, depth: f32) -> vec3<f32> {
#ifdef HOST_MOTION
    return unpack_motion(host_motion(pixel, depth).packed);
#else
    return unpack_motion(textureLoad(motion, pixel, 0).xy);
#endif
}

// The surface as it was.
fn origin_at(pixel: vec2<i32>, moved: vec3<f32>, normal: vec3<f32>) -> Origin {
#ifdef OBJECTS
    let here = textureLoad(object, pixel, 0).x;
#else
    let here = 0u;
#endif
    return origin_of(vec2<f32>(pixel), moved, normal, here);
}

struct Taps {
    color: vec3<f32>,
    mean: f32,
    square: f32,
    variance: f32,
    length: f32,
    weight: f32,
#ifdef MISSING_SAMPLES
    // Sum of the weights of all taps on the surface, also of those that have seen no sample yet.
    surface: f32,
#endif
#ifdef STEADY
    output: vec3<f32>,
#endif
}

fn add_tap(sum: ptr<function, Taps>, origin: Origin, place: vec2<i32>, bilinear: f32) {
    let tap = clamp(place, vec2(0), vec2<i32>(frame.size) - 1);
#ifdef OBJECTS
    let there = textureLoad(object_previous, tap, 0).x;
#else
    let there = 0u;
#endif
    let valid = bilinear >= 1e-4 && inside(place)
        && same_surface(origin, tap, guide_at(tap), there);
    var weight = select(0.0, bilinear, valid);
    let h = history_at(tap);
#ifdef MISSING_SAMPLES
    (*sum).surface += weight;
    weight = select(0.0, weight, history_length(h) > 0.0);
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

// The pixel at the upper left of a point's four. A motion that is whole but for rounding does not reach the next pixel.
fn corner_of(point: vec2<f32>) -> vec2<i32> {
    return vec2<i32>(floor(point + 1e-4));
}

fn bilinear_taps(origin: Origin, point: vec2<f32>) -> Taps {
    let base = corner_of(point);
    let f = max(point - vec2<f32>(base), vec2(0.0));
    var sum = Taps();
    add_tap(&sum, origin, base, (1.0 - f.x) * (1.0 - f.y));
    add_tap(&sum, origin, base + vec2(1, 0), f.x * (1.0 - f.y));
    add_tap(&sum, origin, base + vec2(0, 1), (1.0 - f.x) * f.y);
    add_tap(&sum, origin, base + vec2(1, 1), f.x * f.y);
    return sum;
}

// Their weighted mean; nothing where they weigh next to nothing.
fn mean_of(sum: Taps) -> History {
    if sum.weight <= 0.01 {
        return History();
    }
    let scale = 1.0 / sum.weight;
    let mean = sum.mean * scale;
    // The taps' own variances and the spread of their means.
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
