#define_import_path asvgf::pair_taps

// The two radiances of a stratum's path, now and in the last frame.

#import asvgf::packing::{is_sample, unpack_rgb}
#import asvgf::strata::{place_now, place_before}
#ifdef OUTLIERS
#import asvgf::color::luminance
#import asvgf::frame::frame
#import asvgf::history::{history_color, history_length}
#import asvgf::outliers::{bound, ratio_of, ratio_to, unpack_limit}
#ifdef PAIRS
#import asvgf::strata::sample_pixel
#endif
#endif

@group(0) @binding(2) var radiance: texture_2d<u32>;
@group(0) @binding(3) var radiance_previous: texture_2d<u32>;
#ifdef OUTLIERS
@group(0) @binding(10) var limit: texture_2d<u32>;
@group(0) @binding(11) var history_previous: texture_2d<u32>;

// Bound of a pair in bounds of a sample. Pairs may be brighter: one alone changes neither ratio nor λ by much, and the evidence of
// a change may be bright.
const LEEWAY: f32 = 1.6;

// True if neither radiance is brighter than light is believed to be there (outliers.wgsl).
fn is_believed(record: vec4<u32>, stratum: vec2<i32>, now: vec3<f32>, before: vec3<f32>) -> bool {
    let believed = unpack_limit(textureLoad(limit, stratum, 0).xy);
#ifdef PAIRS
    let pixel = min(sample_pixel(record, stratum), vec2<i32>(frame.size) - 1);
#else
    let pixel = place_before(record, stratum);
#endif
    let h = textureLoad(history_previous, pixel, 0).xy;
    let known = frame.continued != 0u;
    let level = select(0.0, luminance(history_color(h)), known);
    let most = LEEWAY * bound(max(level, max(believed.expected, believed.level)), select(0.0, history_length(h), known));
    return ratio_to(most, max(luminance(now), luminance(before))) <= ratio_of(believed.ratio_class);
}
#endif

struct Radiances {
    now: vec3<f32>,
    before: vec3<f32>,
}

// The radiances of a stratum with a record. If one of the two is missing there is nothing to compare: two zeros add nothing to any
// sum.
fn radiances_of(record: vec4<u32>, stratum: vec2<i32>) -> Radiances {
    let path_now = textureLoad(radiance, place_now(record, stratum), 0).xy;
    let path_before = textureLoad(radiance_previous, place_before(record, stratum), 0).xy;
    let now = unpack_rgb(path_now);
    let before = unpack_rgb(path_before);
    var comparable = is_sample(path_now) & is_sample(path_before);
#ifdef OUTLIERS
    comparable &= is_believed(record, stratum, now, before);
#endif
    return Radiances(select(vec3(0.0), now, comparable), select(vec3(0.0), before, comparable));
}
