#define_import_path asvgf::host_light

// A host's light, cleaned before it reaches the history. ingest_radiance.wgsl stores it or, with HOST_LIGHT, other passes read it
// from here.

#import asvgf::color::{BRIGHTEST, is_finite, is_infinite, is_nan, sanitize}
#import asvgf::packing::{INFINITE_SAMPLE, NO_SAMPLE, pack_rgb, round_to_f16}
#ifdef ALBEDO
#ifdef MISSING_SAMPLES
#import asvgf::packing::is_missing
#import asvgf::frame::{frame, inside}
#endif
#endif

@group(0) @binding(25) var radiance: texture_2d<f32>;
#ifdef ALBEDO
@group(0) @binding(26) var albedo: texture_2d<f32>;
#endif
#ifdef SUMMED_ALBEDO
@group(0) @binding(32) var reflectance: texture_2d<f32>;
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(27) var emission: texture_2d<f32>;
#endif

#ifdef DIAGNOSTICS
// Faults found in this pixel.
var<private> not_finite: bool = false;
var<private> below_zero: bool = false;
#endif

// Stands for an infinite channel: the largest finite number of the 16-bit floats in which most renderers write.
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

// Limits of an albedo that divides. Failure: radiance over Cycles' albedo of a metal was a firefly of 1000 times the light, and the
// image of a room was twice as bright. Reason: that albedo is what a single path saw in the metal, with zeros and values above 10,
// so it is a random number itself. Rule: no surface reflects more than it receives, and hardly one, soot aside, less than 2 %. A
// darker one has its texture blurred by the filter, together with its light.
const LEAST_ALBEDO: f32 = 0.02;
const MOST_ALBEDO: f32 = 1.0;

// Largest albedo that is stored, below the limit of f16.
const MOST_STORED: f32 = 65472.0;

// The albedo that the filtered radiance is multiplied by, from the one that the host gives; `hit` is true where there is a surface. An
// albedo that is no number is unknown and divides by nothing.
fn cleaned_albedo(given: vec3<f32>, hit: bool) -> vec3<f32> {
    let finite = are_finite(given);
#ifdef DIAGNOSTICS
    count(given, finite);
#endif
    var a = select(vec3(1.0), min(sanitize(given), vec3(MOST_STORED)), finite);
#ifdef MODULATED
    a = select(vec3(1.0), clamp(a, vec3(LEAST_ALBEDO), vec3(MOST_ALBEDO)), hit);
#endif
    return round_to_f16(a);
}

#ifdef ALBEDO
fn host_albedo(pixel: vec2<i32>, hit: bool) -> vec3<f32> {
#ifdef SUMMED_ALBEDO
    return cleaned_albedo(textureLoad(albedo, pixel, 0).xyz + textureLoad(reflectance, pixel, 0).xyz, hit);
#else
    return cleaned_albedo(textureLoad(albedo, pixel, 0).xyz, hit);
#endif
}
#endif

#ifdef MODULATED
#ifdef ALBEDO
#ifdef MISSING_SAMPLES
// Neighbours with an albedo that make a pixel with an albedo of 0 a hole. Beside an edge along rows, columns or diagonals there are
// at most three.
const AROUND_A_HOLE: u32 = 4u;

// True if a pixel without light is black by chance. Failure: one pixel in five of a metal had neither albedo nor light in each
// frame, because its path saw nothing there. Averaged as black and multiplied by such albedos, the metal was a fifth too dark; ink
// darkened the paper around it likewise. Reason: without an albedo, the lack of light tells nothing of the light that falls on a
// surface. Rule: it is no sample if the surface around has an albedo. Black gloss, whose light is seen in few samples, has none
// around either.
fn is_hole(pixel: vec2<i32>, black: bool) -> bool {
    var reflecting = 0u;
    let taps = select(0, 9, black && all(textureLoad(albedo, pixel, 0).xyz == vec3(0.0)));
    for (var i = 0; i < taps; i++) {
        // (i·11) >> 5 is i / 3 for i < 9.
        let row = (i * 11) >> 5u;
        let tap = pixel + vec2(i - 3 * row, row) - 1;
        let there = textureLoad(albedo, clamp(tap, vec2(0), vec2<i32>(frame.size) - 1), 0).xyz;
        reflecting += select(0u, 1u, inside(tap) && any(there > vec3(0.0)));
    }
    return reflecting >= AROUND_A_HOLE;
}

// The albedo that the filtered light of a pixel with this sample is multiplied by: 0 for a hole, which the light of the surface
// around leaves dark.
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

// The light alone, r = max(radiance − emission, 0) / divisor, where the divisor is the albedo if the radiance holds it. A radiance
// that is no number is no sample. One that is infinite, and not by emission, is marked: it is shown if there is nothing else, and
// enters no mean.
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

// `host_radiance`, divided by the pixel's own albedo.
fn host_sample(pixel: vec2<i32>, hit: bool) -> vec2<u32> {
#ifdef MODULATED
#ifdef ALBEDO
    return host_radiance(pixel, host_albedo(pixel, hit));
#endif
#endif
    return host_radiance(pixel, vec3(1.0));
}
