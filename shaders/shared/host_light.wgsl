#define_import_path asvgf::host_light

// A host's light, cleaned before it reaches history: what ingest_radiance.wgsl stores, or (HOST_LIGHT) what others read
// instead.

#import asvgf::color::{BRIGHTEST, is_finite, is_infinite, is_nan, sanitize}
#import asvgf::packing::{INFINITE_SAMPLE, NO_SAMPLE, pack_rgb}
#ifdef ALBEDO
#import asvgf::packing::round_to_f16
#endif

@group(0) @binding(25) var radiance: texture_2d<f32>;
#ifdef ALBEDO
@group(0) @binding(26) var albedo: texture_2d<f32>;
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(27) var emission: texture_2d<f32>;
#endif

#ifdef DIAGNOSTICS
// What was found in this pixel.
var<private> not_finite: bool = false;
var<private> below_zero: bool = false;
#endif

// What an infinite channel becomes: the largest finite number of the 16-bit floats in which most renderers write.
const INFINITE: f32 = 65504.0;

#ifdef DIAGNOSTICS
fn count(color: vec3<f32>, finite: vec3<bool>) {
    not_finite |= !all(finite);
    below_zero |= any(finite & (color < vec3(0.0)));
}
#endif

fn are_finite(color: vec3<f32>) -> vec3<bool> {
    return vec3(is_finite(color.x), is_finite(color.y), is_finite(color.z));
}

fn are_infinite(color: vec3<f32>) -> vec3<bool> {
    return vec3(is_infinite(color.x), is_infinite(color.y), is_infinite(color.z));
}

fn clean(color: vec3<f32>) -> vec3<f32> {
#ifdef DIAGNOSTICS
    count(color, are_finite(color));
#endif
    return sanitize(select(color, vec3(INFINITE), are_infinite(color)));
}

#ifdef ALBEDO
// An albedo that divides is kept between these. Failure: Cycles' albedo of a metal is that of what a single path saw in it, with zeros and
// values above 10; radiance over that was a firefly of 1000 times the light, and an image of a room twice as bright. Reason: such an albedo
// is a random number itself. Rule: no surface reflects more than it receives, and hardly one, soot aside, less than 2 %. The filter blurs
// the texture of what is darker with its light.
const LEAST_ALBEDO: f32 = 0.02;
const MOST_ALBEDO: f32 = 1.0;

// What the filtered radiance is multiplied with; `hit` where there is a surface. An albedo that is no number is unknown, and
// divides by nothing.
fn host_albedo(pixel: vec2<i32>, hit: bool) -> vec3<f32> {
    let given = textureLoad(albedo, pixel, 0).xyz;
    let finite = are_finite(given);
#ifdef DIAGNOSTICS
    count(given, finite);
#endif
    // Below the limit of f16.
    var a = select(vec3(1.0), min(sanitize(given), vec3(65472.0)), finite);
#ifdef MODULATED
    a = select(vec3(1.0), clamp(a, vec3(LEAST_ALBEDO), vec3(MOST_ALBEDO)), hit);
#endif
    return round_to_f16(a);
}
#endif

#ifdef DIRECT_EMISSION
fn host_emission(pixel: vec2<i32>) -> vec2<u32> {
    return pack_rgb(clean(textureLoad(emission, pixel, 0).xyz));
}
#endif

// The light alone, r = max(radiance − emission, 0) / divisor, the divisor being the albedo, if that is in it. What is no number
// is no sample. What is infinite, and not by emission, is marked: shown where there is nothing else, it enters no average.
fn host_radiance(pixel: vec2<i32>, divisor: vec3<f32>) -> vec2<u32> {
    let given = textureLoad(radiance, pixel, 0).xyz;
    var r = clean(given);
    var infinite = are_infinite(given);
#ifdef MODULATED
#ifdef DIRECT_EMISSION
    // Where colour and emission disagree by a pixel, as at a light's edge, light must not become negative.
    let emitted = textureLoad(emission, pixel, 0).xyz;
    r = max(r - clean(emitted), vec3(0.0));
    infinite &= !are_infinite(emitted);
#endif
#ifdef ALBEDO
    r /= divisor;
#endif
#endif
    var packed = pack_rgb(min(r, vec3(BRIGHTEST)));
    packed.y |= select(0u, INFINITE_SAMPLE, any(infinite));
    let missing = is_nan(given.x) | is_nan(given.y) | is_nan(given.z);
    return select(packed, NO_SAMPLE, missing);
}

// As `host_radiance`, by the pixel's own albedo.
fn host_sample(pixel: vec2<i32>, hit: bool) -> vec2<u32> {
#ifdef MODULATED
#ifdef ALBEDO
    return host_radiance(pixel, host_albedo(pixel, hit));
#endif
#endif
    return host_radiance(pixel, vec3(1.0));
}
