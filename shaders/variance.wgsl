// What the spatial filter starts from: the history's colour and how uncertain it is. While a pixel's history is short its own
// variance means little: it is estimated from the neighbours instead (Schied et al. 2017, §4.2).

#import asvgf::frame::{frame, inside, scale_at}
#import asvgf::color::luminance
#import asvgf::history::{history_color, history_variance, history_length}
#import asvgf::packing::{unpack_normal, pack_tap}
#ifdef FEEDBACK
#import asvgf::packing::unpack_rgb
#endif
#import asvgf::edge_stop::{falloff, Plane, tangent_plane, plane_distance}

@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var history: texture_2d<u32>;
#ifdef FEEDBACK
@group(0) @binding(3) var feedback: texture_2d<u32>;
#endif
@group(0) @binding(4) var color_out: texture_storage_2d<rg32uint, write>;

// History length below which the variance is a spatial one.
const SHORT: f32 = 4.0;

// Falls off with the distance from the plane in 2 % of the depth, and with 64·(1 − n·n').
fn weight(plane: Plane, normal: vec3<f32>, offset: vec2<i32>, g: vec2<u32>) -> f32 {
    let depth = bitcast<f32>(g.y);
    if depth <= 0.0 {
        return 0.0;
    }
    let exponent = plane_distance(plane, vec2<f32>(offset), depth) / (0.02 * scale_at(frame.camera, plane.depth))
        + 64.0 * (1.0 - dot(normal, unpack_normal(g.x)));
    return falloff(exponent);
}

fn mean_luminance(h: vec2<u32>) -> f32 {
#ifdef FEEDBACK
    return history_color(h).x;
#else
    return luminance(history_color(h));
#endif
}

fn color_at(pixel: vec2<i32>, h: vec2<u32>) -> vec3<f32> {
#ifdef FEEDBACK
    return unpack_rgb(textureLoad(feedback, pixel, 0).xy);
#else
    return history_color(h);
#endif
}

#ifdef MISSING_SAMPLES
// Pixels on the surface that are enough to fill one from.
const ENOUGH: f32 = 6.0;

// A pixel that has neither a sample nor a history: the mean over 7×7 pixels on its surface, 1, 3 or 9 apart, as far as it takes to
// find enough. Black where there is none. The loops have no round elsewhere.
fn filled(pixel: vec2<i32>, plane: Plane, normal: vec3<f32>, missing: bool) -> vec2<u32> {
    var color = vec3(0.0);
    var square = 0.0;
    var weights = 0.0;
    let farthest = select(0, 9, missing);
    for (var spacing = 1; spacing <= farthest; spacing *= 3) {
        let taps = select(0, 49, weights < ENOUGH);
        for (var i = 0; i < taps; i++) {
            let row = (i * 37) >> 8u;
            let offset = spacing * (vec2(i - 7 * row, row) - 3);
            let tap = pixel + offset;
            let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
            let there = weight(plane, normal, offset, textureLoad(guide, clamped, 0).xy);
            let h = textureLoad(history, clamped, 0).xy;
            let w = select(0.0, there, inside(tap) && history_length(h) > 0.0);
            let c = color_at(clamped, h);
            color += w * c;
            square += w * luminance(c) * luminance(c);
            weights += w;
        }
    }
    let mean = color / max(weights, 1e-6);
    // Var(mean) of so many, as far as a few tell it.
    let variance = SHORT * max(square / max(weights, 1e-6) - luminance(mean) * luminance(mean), 0.0) / max(weights, 1.0);
    return select(vec2(0u), pack_tap(mean, sqrt(variance)), weights > 1e-3);
}
#endif

#ifdef REPEATED_NOISE
// Variance of a sample, over the mean's square, below which the history has seen no noise in time: less than the least that a
// history keeps.
const SILENT: f32 = 1e-6;

// What the least of four means over nine triples is of independent noise, over its variance: between 0.60 and 0.63 of uniform,
// exponential and rare noise.
const LEAST_OF_FOUR: f32 = 0.6;

// Triples of a direction that tell anything: two rows of three.
const FEWEST: f32 = 5.5;

// How much greater a mean may be than the fourth largest of what it is of.
const LONE: f32 = 20.0;

// A radiance on the centre's surface, as a difference to the centre's, and whether there is one.
struct Neighbour {
    difference: f32,
    weight: f32,
}

fn neighbour(pixel: vec2<i32>, offset: vec2<i32>, plane: Plane, normal: vec3<f32>, center: f32) -> Neighbour {
    let tap = pixel + offset;
    let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
    let h = textureLoad(history, clamped, 0).xy;
    let there = weight(plane, normal, offset, textureLoad(guide, clamped, 0).xy);
    return Neighbour(mean_luminance(h) - center, select(0.0, there, inside(tap) && history_length(h) > 0.0));
}

// The variance that three neighbours in a row show: independent numbers a, b, c have E[(b − (a + c)/2)²] = 1½·Var (compare
// Immerkær 1996, "Fast Noise Variance Estimation").
// With its weight, 0 where one of the three is elsewhere.
fn bend(pixel: vec2<i32>, at: vec2<i32>, step: vec2<i32>, plane: Plane, normal: vec3<f32>, center: f32) -> vec2<f32> {
    let a = neighbour(pixel, at - step, plane, normal, center);
    let b = neighbour(pixel, at, plane, normal, center);
    let c = neighbour(pixel, at + step, plane, normal, center);
    let difference = b.difference - 0.5 * (a.difference + c.difference);
    return a.weight * b.weight * c.weight * vec2(difference * difference / 1.5, 1.0);
}

// The variance of noise that is the same in every frame: the mean over 3×3 such triples. An edge does not vary along itself, so the
// least of four directions counts, of those with enough triples to tell. A lone bright pixel is in three of them: where there is
// nothing else, it is no noise.
fn repeated(pixel: vec2<i32>, plane: Plane, normal: vec3<f32>, center: f32, silent: bool) -> f32 {
    var first = vec4(0.0);
    var second = vec4(0.0);
    var third = vec4(0.0);
    var fourth = vec4(0.0);
    var sum = vec4(0.0);
    var weights = vec4(0.0);
    // At the image's border, those beside it: what lies along the border could not be told from noise else.
    let middle = clamp(pixel, vec2(2), max(vec2<i32>(frame.size) - 3, vec2(2))) - pixel;
    let places = select(0, 9, silent);
    for (var i = 0; i < places; i++) {
        let row = (i * 11) >> 5u;
        let at = middle + vec2(i - 3 * row, row) - 1;
        let across = bend(pixel, at, vec2(1, 0), plane, normal, center);
        let down = bend(pixel, at, vec2(0, 1), plane, normal, center);
        let falling = bend(pixel, at, vec2(1, 1), plane, normal, center);
        let rising = bend(pixel, at, vec2(1, -1), plane, normal, center);
        let next = vec4(across.x, down.x, falling.x, rising.x);
        fourth = max(fourth, min(third, next));
        third = max(third, min(second, next));
        second = max(second, min(first, next));
        first = max(first, next);
        sum += next;
        weights += vec4(across.y, down.y, falling.y, rising.y);
    }
    let each = select(vec4(1e30), min(sum / max(weights, vec4(1.0)), LONE * fourth), weights >= vec4(FEWEST));
    let least = min(min(each.x, each.y), min(each.z, each.w));
    return select(0.0, least / LEAST_OF_FOUR, least < 1e30);
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let h = textureLoad(history, pixel, 0).xy;
    // 0 where nothing was hit, and where no sample was seen yet.
    let length = history_length(h);
    let short = length > 0.0 && length < SHORT;
    let g = textureLoad(guide, pixel, 0).xy;
    let normal = unpack_normal(g.x);
    let plane = tangent_plane(vec2<f32>(pixel), normal, bitcast<f32>(g.y));
    let center = mean_luminance(h);
    // Moments over 7×7 about the centre's mean.
    var first = 0.0;
    var second = 0.0;
    var weights = 0.0;
    // One loop, which is not unrolled: a software adapter executes a branch either way, but a loop of no invocation once.
    let taps = select(0, 49, short);
    for (var i = 0; i < taps; i++) {
        // i / 7 for i < 49.
        let row = (i * 37) >> 8u;
        let offset = vec2(i - 7 * row, row) - 3;
        let tap = pixel + offset;
        let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
        let there = weight(plane, normal, offset, textureLoad(guide, clamped, 0).xy);
        let other = textureLoad(history, clamped, 0).xy;
#ifdef MISSING_SAMPLES
        let w = select(0.0, there, inside(tap) && history_length(other) > 0.0);
#else
        let w = select(0.0, there, inside(tap));
#endif
        let d = mean_luminance(other) - center;
        first += w * d;
        second += w * (history_variance(other) + d * d);
        weights += w;
    }
    let mean = first / max(weights, 1e-6);
    // The fewer frames there are, the less the neighbours know either.
    let spatial = max(second / max(weights, 1e-6) - mean * mean, 0.0) * max(1.0, SHORT / max(length, 1.0));
#ifdef VARIANCE_OF_MEAN
    // Bessel's correction while it matters, then the variance of a mean of n.
    let own = history_variance(h) * select(1.0, length / max(length - 1.0, 0.5), length < 8.0);
    var variance = mix(spatial, own, clamp((length - 1.0) / (SHORT - 1.0), 0.0, 1.0)) / max(length, 1.0);
#else
    var variance = select(history_variance(h), spatial, short);
#endif
#ifdef REPEATED_NOISE
    // A renderer that takes the same random numbers in each frame has noise that no history shows, and no average lessens: its
    // frames are worth one.
    let silent = length >= 2.0 && center > 0.0 && history_variance(h) <= SILENT * center * center;
    variance = max(variance, SHORT * repeated(pixel, plane, normal, center, silent));
#endif
    let color = color_at(pixel, h);
#ifdef MISSING_SAMPLES
    // What is infinite is shown, and so far from all else that it is not mixed with it.
    let infinite = any(h != vec2(0u));
    var other = filled(pixel, plane, normal, length <= 0.0 && g.y != 0u && !infinite);
    other = select(other, pack_tap(color, 0.0), infinite);
#else
    let other = vec2(0u);
#endif
    textureStore(color_out, pixel, vec4(select(other, pack_tap(color, sqrt(variance)), length > 0.0), 0u, 0u));
}
