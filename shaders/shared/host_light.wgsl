#define_import_path asvgf::host_light

// A host's light, cleaned before it reaches history: what ingest_radiance.wgsl stores, or (HOST_LIGHT) what others read
// instead.

#import asvgf::color::{BRIGHTEST, is_finite, is_infinite, is_nan, sanitize}
#import asvgf::packing::{INFINITE_SAMPLE, NO_SAMPLE, pack_rgb}
#ifdef ALBEDO
#import asvgf::packing::round_to_f16
#ifdef MISSING_SAMPLES
#import asvgf::packing::is_missing
#import asvgf::frame::{frame, inside}
#endif
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

#ifdef MODULATED
#ifdef ALBEDO
#ifdef MISSING_SAMPLES
// Neighbours with an albedo that make one of 0 a hole. Beside an edge along rows, columns or diagonals there are three at most.
const AROUND_A_HOLE: u32 = 4u;

// Whether a pixel without light is black by chance. Failure: one pixel in five of a metal had neither albedo nor light in each frame, as its
// path saw nothing there; averaged as black and multiplied by such albedos, the metal was a fifth too dark. Ink darkened the paper
// around it likewise. Reason: without an albedo, no light says nothing of the light that falls on a surface. Rule: it is no sample where
// the surface around has an albedo. Black gloss, of which light is seen in few samples, has none around either.
fn is_hole(pixel: vec2<i32>, black: bool) -> bool {
    var reflecting = 0u;
    let taps = select(0, 9, black && all(textureLoad(albedo, pixel, 0).xyz == vec3(0.0)));
    for (var i = 0; i < taps; i++) {
        let row = (i * 11) >> 5u;
        let tap = pixel + vec2(i - 3 * row, row) - 1;
        let there = textureLoad(albedo, clamp(tap, vec2(0), vec2<i32>(frame.size) - 1), 0).xyz;
        reflecting += select(0u, 1u, inside(tap) && any(there > vec3(0.0)));
    }
    return reflecting >= AROUND_A_HOLE;
}

// What the filtered light of a pixel is multiplied with, whose sample this is: what light the surface around sends into a hole stays dark.
fn shown_albedo(pixel: vec2<i32>, hit: bool, arrived: vec2<u32>) -> vec3<f32> {
    return select(host_albedo(pixel, hit), vec3(0.0), is_hole(pixel, is_missing(arrived) && hit));
}
#endif
#endif
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
#ifdef MISSING_SAMPLES
    let hole = is_hole(pixel, all(r == vec3(0.0)));
#endif
    r /= divisor;
#endif
#endif
    var packed = pack_rgb(min(r, vec3(BRIGHTEST)));
    packed.y |= select(0u, INFINITE_SAMPLE, any(infinite));
    var missing = is_nan(given.x) | is_nan(given.y) | is_nan(given.z);
#ifdef MODULATED
#ifdef ALBEDO
#ifdef MISSING_SAMPLES
    missing |= hole;
#endif
#endif
#endif
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
