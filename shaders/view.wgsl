// Shows one intermediate image: as numbers in a float target, as a picture in an rgba8unorm one.

#import asvgf::frame::{frame, inside, project, sample_point, seen_position}
#import asvgf::color::{is_finite, luminance}
#import asvgf::packing::{unpack_rgb, unpack_motion, unpack_normal}
#import asvgf::random::hash
#if VIEW == 0
#import asvgf::history::filtered_color
#endif
#if VIEW >= 10
#if VIEW <= 11
#import asvgf::history::{history_length, history_variance}
#endif
#endif
#if VIEW == 12
#import asvgf::history::filtered_color
#endif
#if VIEW >= 17
#if VIEW <= 18
#import asvgf::strata::{is_sample_pixel, place_now, place_before, stratum_of}
#endif
#endif

#if VIEW == 0
// Denoised.
@group(0) @binding(1) var color: texture_2d<u32>;
#ifdef BACKGROUND
@group(0) @binding(2) var radiance: texture_2d<u32>;
@group(0) @binding(5) var guide: texture_2d<u32>;
#endif
#endif
#if VIEW == 1
// Noisy.
@group(0) @binding(2) var radiance: texture_2d<u32>;
#endif
#if VIEW <= 2
#ifdef ALBEDO
// Albedo, and what the two above are multiplied with.
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif
#endif
#if VIEW <= 1
#ifdef DIRECT_EMISSION
@group(0) @binding(4) var emission: texture_2d<u32>;
#endif
#endif
#if VIEW == 3
@group(0) @binding(5) var guide: texture_2d<u32>;
#endif
#if VIEW == 4
@group(0) @binding(5) var guide: texture_2d<u32>;
#endif
#if VIEW == 5
@group(0) @binding(6) var visibility: texture_2d<u32>;
#endif
#if VIEW == 6
@group(0) @binding(7) var motion: texture_2d<u32>;
#endif
#if VIEW == 14
// Error of the motion.
@group(0) @binding(5) var guide: texture_2d<u32>;
@group(0) @binding(7) var motion: texture_2d<u32>;
#endif
#if VIEW == 15
@group(0) @binding(4) var emission: texture_2d<u32>;
#endif
#if VIEW == 16
@group(0) @binding(6) var object: texture_2d<u32>;
#endif
#if VIEW >= 17
#if VIEW <= 18
// The gradient's pairs: now, then before.
@group(0) @binding(1) var samples: texture_2d<u32>;
@group(0) @binding(2) var radiance: texture_2d<u32>;
#ifdef ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif
#endif
#endif
#if VIEW == 19
// Sum over the samples so far, and their count.
@group(0) @binding(1) var sum: texture_2d<f32>;
#endif
#if VIEW == 7
#ifndef UNCHANGED
// Gradient.
@group(0) @binding(8) var gradient: texture_2d<u32>;
#endif
#endif
#if VIEW >= 8
#if VIEW <= 9
// α and λ.
@group(0) @binding(8) var weights: texture_2d<f32>;
#endif
#endif
#if VIEW == 20
// α, below zero where the sample is an outlier.
@group(0) @binding(8) var weights: texture_2d<f32>;
#endif
#if VIEW >= 10
#if VIEW <= 11
// History length, variance.
@group(0) @binding(9) var history: texture_2d<u32>;
#endif
#endif
#if VIEW == 13
// Rays.
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif
#if VIEW == 12
// Not finite.
@group(0) @binding(1) var color: texture_2d<u32>;
#endif

#ifdef TARGET_PICTURE
@group(0) @binding(10) var target_out: texture_storage_2d<rgba8unorm, write>;
#else
#ifdef TARGET_F16
@group(0) @binding(10) var target_out: texture_storage_2d<rgba16float, write>;
#else
@group(0) @binding(10) var target_out: texture_storage_2d<rgba32float, write>;
#endif
#endif

struct Show {
    // Factor on radiance before tone mapping.
    exposure: f32,
    // What is shown as white: depth, pixels of motion, frames of history.
    range: f32,
}

@group(0) @binding(11) var<uniform> show: Show;

fn value(pixel: vec2<i32>) -> vec3<f32> {
#if VIEW == 0
    var c = filtered_color(textureLoad(color, pixel, 0).xy);
#ifdef BACKGROUND
    if textureLoad(guide, pixel, 0).y == 0u {
        c = unpack_rgb(textureLoad(radiance, pixel, 0).xy);
    }
#endif
#ifdef ALBEDO
    c *= textureLoad(albedo, pixel, 0).xyz;
#endif
#ifdef DIRECT_EMISSION
    c += unpack_rgb(textureLoad(emission, pixel, 0).xy);
#endif
    return c;
#endif
#if VIEW == 1
    var c = unpack_rgb(textureLoad(radiance, pixel, 0).xy);
#ifdef ALBEDO
    c *= textureLoad(albedo, pixel, 0).xyz;
#endif
#ifdef DIRECT_EMISSION
    c += unpack_rgb(textureLoad(emission, pixel, 0).xy);
#endif
    return c;
#endif
#if VIEW == 2
    return textureLoad(albedo, pixel, 0).xyz;
#endif
#if VIEW == 3
    let g = textureLoad(guide, pixel, 0).xy;
    return unpack_normal(g.x);
#endif
#if VIEW == 4
    return vec3(bitcast<f32>(textureLoad(guide, pixel, 0).y));
#endif
#if VIEW == 5
    // 24 bits fit a float exactly: the low 16 and the rest.
    let id = textureLoad(visibility, pixel, 0).x;
    return vec3(f32(id & 0xffffu), f32(id >> 16u), select(1.0, 0.0, id == 0xffffffffu));
#endif
#if VIEW == 6
    return unpack_motion(textureLoad(motion, pixel, 0).xy);
#endif
#if VIEW == 7
#ifdef UNCHANGED
    return vec3(0.0);
#else
    let g = bitcast<vec2<f32>>(textureLoad(gradient, pixel / 3, 0).xy);
    return vec3(clamp(abs(g.x) / max(g.y, 1e-30) - frame.dead_zone, 0.0, 1.0));
#endif
#endif
#if VIEW == 8
    return vec3(textureLoad(weights, pixel, 0).y);
#endif
#if VIEW == 9
    // Below zero is the weight of an outlier.
    return vec3(abs(textureLoad(weights, pixel, 0).x));
#endif
#if VIEW == 10
    return vec3(history_length(textureLoad(history, pixel, 0).xy));
#endif
#if VIEW == 11
    return vec3(history_variance(textureLoad(history, pixel, 0).xy));
#endif
#if VIEW == 12
    let c = filtered_color(textureLoad(color, pixel, 0).xy);
    let ok = is_finite(c.x) && is_finite(c.y) && is_finite(c.z);
    return vec3(select(1.0, 0.0, ok));
#endif
#if VIEW == 13
    return vec3(textureLoad(albedo, pixel, 0).w);
#endif
#if VIEW == 14
    let depth = bitcast<f32>(textureLoad(guide, pixel, 0).y);
    let point = sample_point(frame.camera, vec2<f32>(pixel));
    let rest = project(frame.previous, seen_position(frame.camera, point, depth));
    let implied = vec3(rest.xy - point, rest.z);
    return select(vec3(0.0), unpack_motion(textureLoad(motion, pixel, 0).xy) - implied, depth > 0.0 && rest.z > 0.0);
#endif
#if VIEW == 15
    return unpack_rgb(textureLoad(emission, pixel, 0).xy);
#endif
#if VIEW == 16
    let id = textureLoad(object, pixel, 0).x;
    return vec3(f32(id & 0xffffu), f32(id >> 16u), 1.0);
#endif
#if VIEW >= 17
#if VIEW <= 18
    let stratum = vec2<i32>(stratum_of(vec2<u32>(pixel)));
    let record = textureLoad(samples, stratum, 0);
    if !is_sample_pixel(record, vec2<u32>(pixel)) {
        return vec3(-1.0);
    }
#if VIEW == 17
    let place = place_now(record, stratum);
#else
    let place = place_before(record, stratum);
#endif
    var r = unpack_rgb(textureLoad(radiance, place, 0).xy);
#ifdef ALBEDO
    r *= textureLoad(albedo, pixel, 0).xyz;
#endif
    return r;
#endif
#endif
#if VIEW == 20
    return vec3(select(0.0, 1.0, textureLoad(weights, pixel, 0).x < 0.0));
#endif
#if VIEW == 19
    let s = textureLoad(sum, pixel, 0);
    return s.xyz / max(s.w, 1.0);
#endif
}

#ifdef TARGET_PICTURE
// Khronos PBR Neutral tone mapper (2024): colours up to 0.76 stay as they are, highlights are compressed.
fn tone_map(radiance: vec3<f32>) -> vec3<f32> {
    let start = 0.76;
    let low = min(radiance.x, min(radiance.y, radiance.z));
    let offset = select(0.04, low - 6.25 * low * low, low < 0.08);
    let c = radiance - offset;
    let peak = max(c.x, max(c.y, c.z));
    if peak < start {
        return c;
    }
    let d = 1.0 - start;
    let mapped = 1.0 - d * d / (peak + d - start);
    let desaturation = 1.0 - 1.0 / (0.15 * (peak - mapped) + 1.0);
    return mix(c * (mapped / peak), vec3(mapped), desaturation);
}

// IEC 61966-2-1.
fn linear_to_srgb(c: vec3<f32>) -> vec3<f32> {
    return select(1.055 * pow(max(c, vec3(1e-6)), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, c <= vec3(0.0031308));
}

fn developed(radiance: vec3<f32>) -> vec3<f32> {
    let exposed = clamp(radiance * show.exposure, vec3(0.0), vec3(1e6));
    return linear_to_srgb(clamp(tone_map(exposed), vec3(0.0), vec3(1.0)));
}

fn color_of(id: u32) -> vec3<f32> {
    let h = hash(id);
    return vec3(f32(h & 255u), f32((h >> 8u) & 255u), f32((h >> 16u) & 255u)) / 255.0;
}

// Black, blue, magenta, orange, white: brightness grows all the way.
fn ramp(x: f32) -> vec3<f32> {
    let t = clamp(x, 0.0, 1.0);
    return clamp(vec3(1.8 * t, 2.2 * t * t * t, 1.6 * t - 2.6 * t * t + 2.0 * t * t * t), vec3(0.0), vec3(1.0));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
#if VIEW <= 1
    return developed(v);
#endif
#if VIEW == 15
    return developed(v);
#endif
#if VIEW >= 17
    return developed(v);
#endif
#if VIEW == 2
    return linear_to_srgb(v);
#endif
#if VIEW == 3
    return select(0.5 * v + 0.5, vec3(0.0), dot(v, v) == 0.0);
#endif
#if VIEW == 4
    return vec3(v.x / (v.x + show.range));
#endif
#if VIEW == 5
    return color_of(u32(v.x) + 65536u * u32(v.y)) * v.z;
#endif
#if VIEW == 16
    return color_of(u32(v.x) + 65536u * u32(v.y));
#endif
#if VIEW == 14
    return vec3(0.5 + 0.5 * clamp(v.xy / show.range, vec2(-1.0), vec2(1.0)), 0.5);
#endif
#if VIEW == 6
    return vec3(0.5 + 0.5 * clamp(v.xy / show.range, vec2(-1.0), vec2(1.0)), 0.5);
#endif
#if VIEW >= 7
#if VIEW <= 9
    return ramp(v.x);
#endif
#endif
#if VIEW == 10
    return ramp(v.x / show.range);
#endif
#if VIEW == 11
    return ramp(0.25 * log2(1.0 + 255.0 * sqrt(max(v.x, 0.0)) * show.exposure) / 2.0);
#endif
#if VIEW == 12
    return vec3(v.x, 0.0, 0.0);
#endif
#if VIEW == 13
    return ramp(v.x / show.range);
#endif
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
#ifdef TARGET_PICTURE
    textureStore(target_out, pixel, vec4(picture(value(pixel)), 1.0));
#else
    textureStore(target_out, pixel, vec4(value(pixel), 1.0));
#endif
}
