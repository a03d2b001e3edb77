// Shows one intermediate image: as numbers in a float target, as a picture in an rgba8unorm one.
//
// Each block shows a view, or several of different images. It declares the images that it reads, `value`, which returns the numbers, and
// `picture`, which turns these into colours.

#import asvgf::frame::{frame, inside, project, sample_point, seen_position}
#import asvgf::color::{is_finite, luminance}
#import asvgf::packing::{unpack_rgb, unpack_motion, unpack_normal}
#import asvgf::random::hash

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
    // The value that is shown as white: depth, pixels of motion, frames of history.
    range: f32,
}

@group(0) @binding(11) var<uniform> show: Show;

#ifdef VIEW_DENOISED
#import asvgf::history::filtered_color

@group(0) @binding(1) var color: texture_2d<u32>;
#ifdef BACKGROUND
@group(0) @binding(2) var radiance: texture_2d<u32>;
@group(0) @binding(5) var guide: texture_2d<u32>;
#endif
#ifdef ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(4) var emission: texture_2d<u32>;
#endif

#ifdef GLOSS
@group(0) @binding(12) var specular_color: texture_2d<u32>;
#ifdef REFLECTANCE
@group(0) @binding(13) var specular_albedo: texture_2d<f32>;
#endif

fn specular_at(pixel: vec2<i32>) -> vec3<f32> {
    let light = filtered_color(textureLoad(specular_color, pixel, 0).xy);
#ifdef REFLECTANCE
    return light * textureLoad(specular_albedo, pixel, 0).xyz;
#else
    return light;
#endif
}
#endif

fn value(pixel: vec2<i32>) -> vec3<f32> {
    var c = filtered_color(textureLoad(color, pixel, 0).xy);
#ifdef BACKGROUND
    if textureLoad(guide, pixel, 0).y == 0u {
        c = unpack_rgb(textureLoad(radiance, pixel, 0).xy);
    }
#endif
#ifdef ALBEDO
    c *= textureLoad(albedo, pixel, 0).xyz;
#endif
#ifdef GLOSS
    c += specular_at(pixel);
#endif
#ifdef DIRECT_EMISSION
    c += unpack_rgb(textureLoad(emission, pixel, 0).xy);
#endif
    return c;
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_NOISY
@group(0) @binding(2) var radiance: texture_2d<u32>;
#ifdef ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(4) var emission: texture_2d<u32>;
#endif

#ifdef GLOSS
@group(0) @binding(12) var specular_radiance: texture_2d<u32>;
#ifdef REFLECTANCE
@group(0) @binding(13) var specular_albedo: texture_2d<f32>;
#endif

fn specular_at(pixel: vec2<i32>) -> vec3<f32> {
    let light = unpack_rgb(textureLoad(specular_radiance, pixel, 0).xy);
#ifdef REFLECTANCE
    return light * textureLoad(specular_albedo, pixel, 0).xyz;
#else
    return light;
#endif
}
#endif

fn value(pixel: vec2<i32>) -> vec3<f32> {
    var c = unpack_rgb(textureLoad(radiance, pixel, 0).xy);
#ifdef ALBEDO
    c *= textureLoad(albedo, pixel, 0).xyz;
#endif
#ifdef GLOSS
    c += specular_at(pixel);
#endif
#ifdef DIRECT_EMISSION
    c += unpack_rgb(textureLoad(emission, pixel, 0).xy);
#endif
    return c;
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return textureLoad(albedo, pixel, 0).xyz;
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return linear_to_srgb(v);
}
#endif

#ifdef VIEW_NORMAL
@group(0) @binding(5) var guide: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let g = textureLoad(guide, pixel, 0).xy;
    return unpack_normal(g.x);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return select(0.5 * v + 0.5, vec3(0.0), dot(v, v) == 0.0);
}
#endif

#ifdef VIEW_DEPTH
@group(0) @binding(5) var guide: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return vec3(bitcast<f32>(textureLoad(guide, pixel, 0).y));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return vec3(v.x / (v.x + show.range));
}
#endif

#ifdef VIEW_TRIANGLE_ID
@group(0) @binding(6) var visibility: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    // A float holds 24 bits exactly: the low 16 and the rest.
    let id = textureLoad(visibility, pixel, 0).x;
    return vec3(f32(id & 0xffffu), f32(id >> 16u), select(1.0, 0.0, id == 0xffffffffu));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return color_of(u32(v.x) + 65536u * u32(v.y)) * v.z;
}
#endif

#ifdef VIEW_OBJECT
@group(0) @binding(6) var object: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let id = textureLoad(object, pixel, 0).x;
    return vec3(f32(id & 0xffffu), f32(id >> 16u), 1.0);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return color_of(u32(v.x) + 65536u * u32(v.y));
}
#endif

#ifdef VIEW_MOTION
@group(0) @binding(7) var motion: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return unpack_motion(textureLoad(motion, pixel, 0).xy);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return centred(v);
}
#endif

#ifdef VIEW_MOTION_ERROR
@group(0) @binding(5) var guide: texture_2d<u32>;
@group(0) @binding(7) var motion: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let depth = bitcast<f32>(textureLoad(guide, pixel, 0).y);
    let point = sample_point(frame.camera, vec2<f32>(pixel));
    let rest = project(frame.previous, seen_position(frame.camera, point, depth));
    let implied = vec3(rest.xy - point, rest.z);
    return select(vec3(0.0), unpack_motion(textureLoad(motion, pixel, 0).xy) - implied, depth > 0.0 && rest.z > 0.0);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return centred(v);
}
#endif

#ifdef VIEW_GRADIENT
#ifdef UNCHANGED
fn value(pixel: vec2<i32>) -> vec3<f32> {
    return vec3(0.0);
}
#else
@group(0) @binding(8) var gradient: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let g = bitcast<vec2<f32>>(textureLoad(gradient, pixel / 3, 0).xy);
    return vec3(clamp(abs(g.x) / max(g.y, 1e-30) - frame.dead_zone, 0.0, 1.0));
}
#endif

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x);
}
#endif

#ifdef VIEW_LAMBDA
@group(0) @binding(8) var weights: texture_2d<f32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return vec3(textureLoad(weights, pixel, 0).y);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x);
}
#endif

#ifdef VIEW_ALPHA
@group(0) @binding(8) var weights: texture_2d<f32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    // The weight of an outlier is stored below zero.
    return vec3(abs(textureLoad(weights, pixel, 0).x));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x);
}
#endif

#ifdef VIEW_OUTLIERS
@group(0) @binding(8) var weights: texture_2d<f32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    // The weight of an outlier is stored below zero.
    return vec3(select(0.0, 1.0, textureLoad(weights, pixel, 0).x < 0.0));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_HISTORY_LENGTH
#import asvgf::history::history_length

@group(0) @binding(9) var history: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return vec3(history_length(textureLoad(history, pixel, 0).xy));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x / show.range);
}
#endif

#ifdef VIEW_VARIANCE
#import asvgf::history::history_variance

@group(0) @binding(9) var history: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return vec3(history_variance(textureLoad(history, pixel, 0).xy));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(0.25 * log2(1.0 + 255.0 * sqrt(max(v.x, 0.0)) * show.exposure) / 2.0);
}
#endif

#ifdef VIEW_NON_FINITE
#import asvgf::history::filtered_color

@group(0) @binding(1) var color: texture_2d<u32>;
#ifdef GLOSS
@group(0) @binding(12) var specular_color: texture_2d<u32>;
#endif

fn value(pixel: vec2<i32>) -> vec3<f32> {
    var c = filtered_color(textureLoad(color, pixel, 0).xy);
#ifdef GLOSS
    c += filtered_color(textureLoad(specular_color, pixel, 0).xy);
#endif
    let ok = is_finite(c.x) && is_finite(c.y) && is_finite(c.z);
    return vec3(select(1.0, 0.0, ok));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return vec3(v.x, 0.0, 0.0);
}
#endif

#ifdef VIEW_RAYS
@group(0) @binding(3) var albedo: texture_2d<f32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return vec3(textureLoad(albedo, pixel, 0).w);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x / show.range);
}
#endif

#ifdef VIEW_EMISSION
@group(0) @binding(4) var emission: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    return unpack_rgb(textureLoad(emission, pixel, 0).xy);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_PAIR_NOW
#import asvgf::strata::{is_sample_pixel, place_now, stratum_of}

@group(0) @binding(1) var samples: texture_2d<u32>;
@group(0) @binding(2) var radiance: texture_2d<u32>;
#ifdef ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let stratum = vec2<i32>(stratum_of(vec2<u32>(pixel)));
    let record = textureLoad(samples, stratum, 0);
    if !is_sample_pixel(record, vec2<u32>(pixel)) {
        return vec3(-1.0);
    }
    var r = unpack_rgb(textureLoad(radiance, place_now(record, stratum), 0).xy);
#ifdef ALBEDO
    r *= textureLoad(albedo, pixel, 0).xyz;
#endif
    return r;
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_PAIR_BEFORE
#import asvgf::strata::{is_sample_pixel, place_before, stratum_of}

@group(0) @binding(1) var samples: texture_2d<u32>;
@group(0) @binding(2) var radiance: texture_2d<u32>;
#ifdef ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;
#endif

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let stratum = vec2<i32>(stratum_of(vec2<u32>(pixel)));
    let record = textureLoad(samples, stratum, 0);
    if !is_sample_pixel(record, vec2<u32>(pixel)) {
        return vec3(-1.0);
    }
    var r = unpack_rgb(textureLoad(radiance, place_before(record, stratum), 0).xy);
#ifdef ALBEDO
    r *= textureLoad(albedo, pixel, 0).xyz;
#endif
    return r;
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_MEAN
// Sum over the samples so far, and their count.
@group(0) @binding(1) var sum: texture_2d<f32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let s = textureLoad(sum, pixel, 0);
    return s.xyz / max(s.w, 1.0);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return developed(v);
}
#endif

#ifdef VIEW_ROUGHNESS
#import asvgf::gloss::unpack_gloss

@group(0) @binding(8) var gloss: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let gloss = unpack_gloss(textureLoad(gloss, pixel, 0).x);
    return vec3(select(1.0, gloss.roughness, gloss.exists));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x);
}
#endif

#ifdef VIEW_HIT_DISTANCE
#import asvgf::gloss::{unpack_gloss, unpack_reflection}

@group(0) @binding(8) var gloss: texture_2d<u32>;
@group(0) @binding(7) var reflection: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let smoothed = unpack_reflection(textureLoad(reflection, pixel, 0).xy).hit_distance;
    return vec3(smoothed, unpack_gloss(textureLoad(gloss, pixel, 0).x).hit_distance, 0.0);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return vec3(v.x / (v.x + show.range));
}
#endif

#ifdef VIEW_REFLECTION_MOTION
#import asvgf::gloss::unpack_reflection

@group(0) @binding(7) var reflection: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let reflection = unpack_reflection(textureLoad(reflection, pixel, 0).xy);
    return vec3(reflection.motion, reflection.hit_distance);
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return centred(v);
}
#endif

#ifdef VIEW_AGREEMENT
#import asvgf::gloss::unpack_reflection
#import asvgf::specular_history::{evidence_around, weight_of}

@group(0) @binding(5) var guide: texture_2d<u32>;
@group(0) @binding(7) var reflection: texture_2d<u32>;

fn value(pixel: vec2<i32>) -> vec3<f32> {
    let weight = weight_of(evidence_around(pixel, unpack_normal(textureLoad(guide, pixel, 0).x)));
    return vec3(select(0.0, weight, unpack_reflection(textureLoad(reflection, pixel, 0).xy).exists));
}

fn picture(v: vec3<f32>) -> vec3<f32> {
    return ramp(v.x);
}
#endif

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

// Signed components in red and green, grey at zero.
fn centred(v: vec3<f32>) -> vec3<f32> {
    return vec3(0.5 + 0.5 * clamp(v.xy / show.range, vec2(-1.0), vec2(1.0)), 0.5);
}

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
