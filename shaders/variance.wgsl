// Prepares the spatial filter's input: the history's colour and the deviation of its luminance. A short history's own variance means
// little, so it is replaced by that of the neighbours on the same surface (Schied et al. 2017, §4.2).

#import asvgf::frame::{frame, inside, scale_at}
#import asvgf::color::luminance
#import asvgf::history::{history_color, history_variance, history_length, unbiased}
#import asvgf::packing::{unpack_normal, pack_tap}
#ifdef FEEDBACK
#import asvgf::packing::unpack_rgb
#endif
#ifdef SPECULAR_SIGNAL
#import asvgf::gloss::{roughness_code, specular_guide}
#endif
#import asvgf::edge_stop::{falloff, Plane, tangent_plane, plane_distance}

@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var history: texture_2d<u32>;
#ifdef FEEDBACK
@group(0) @binding(3) var feedback: texture_2d<u32>;
#endif
@group(0) @binding(4) var color_out: texture_storage_2d<rg32uint, write>;
#ifdef SPECULAR_SIGNAL
@group(0) @binding(5) var reflection: texture_2d<u32>;
// The guide of the spatial filter: the surface's, with the roughness.
@group(0) @binding(6) var guide_out: texture_storage_2d<rg32uint, write>;
#endif

// History length below which the variance is estimated from neighbours: four frames (Schied et al. 2017, §4.2).
const SHORT_HISTORY: f32 = 4.0;

// Weight of a neighbour: falloff(d/(0.02·z) + 64·(1 − n·n′)), where d is its distance from the tangent plane, z the depth and n, n′
// the normals. e^(−64·(1 − n·n′)) is about (n·n′)⁶⁴; SVGF's normal stop has the exponent 128 (Schied et al. 2017, §4.4).
const PLANE_TOLERANCE: f32 = 0.02;
const NORMAL_SHARPNESS: f32 = 64.0;

fn neighbour_weight(plane: Plane, normal: vec3<f32>, offset: vec2<i32>, g: vec2<u32>) -> f32 {
    let depth = bitcast<f32>(g.y);
    if depth <= 0.0 {
        return 0.0;
    }
    let exponent = plane_distance(plane, vec2<f32>(offset), depth) / (PLANE_TOLERANCE * scale_at(frame.camera, plane.depth))
        + NORMAL_SHARPNESS * (1.0 - dot(normal, unpack_normal(g.x)));
    return falloff(exponent);
}

#ifdef CLAMP
// Pixels of the window: 5×5, because reflections have borders of light that the weights do not see, and because the clamp reads them anyway.
const WINDOW: i32 = 25;

// Offset of pixel i of the window, row by row. (i·13) >> 6 is i / 5 for i < 25: a software adapter divides integers one by one.
fn window_offset(i: i32) -> vec2<i32> {
    let row = (i * 13) >> 6u;
    return vec2(i - 5 * row, row) - 2;
}
#else
// Pixels of the 7×7 window (Schied et al. 2017, §4.2).
const WINDOW: i32 = 49;

// Offset of pixel i of the window, row by row. (i·37) >> 8 is i / 7 for i < 49: a software adapter divides integers one by one.
fn window_offset(i: i32) -> vec2<i32> {
    let row = (i * 37) >> 8u;
    return vec2(i - 7 * row, row) - 3;
}
#endif

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
// Sum of weights from which on the window holds enough pixels of the surface to fill one from.
const ENOUGH: f32 = 6.0;

// Sum of weights up to which there is nothing to fill one from.
const LEAST_WEIGHT: f32 = 1e-3;

// Farthest spacing of the window's pixels: it grows from 1 by 3.
const FARTHEST_SPACING: i32 = 9;

// Fills a pixel that has neither a sample nor a history: the mean over the window's pixels on its surface. The window is spread to
// a spacing of 3, then 9, until enough pixels are on the surface. The result is black where there is none. A pixel that is not
// `missing` runs no round of the loops.
fn filled(pixel: vec2<i32>, plane: Plane, normal: vec3<f32>, missing: bool) -> vec2<u32> {
    var color = vec3(0.0);
    var square = 0.0;
    var weights = 0.0;
    let farthest = select(0, FARTHEST_SPACING, missing);
    for (var spacing = 1; spacing <= farthest; spacing *= 3) {
        let taps = select(0, WINDOW, weights < ENOUGH);
        for (var i = 0; i < taps; i++) {
            let offset = spacing * window_offset(i);
            let tap = pixel + offset;
            let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
            let on_surface = neighbour_weight(plane, normal, offset, textureLoad(guide, clamped, 0).xy);
            let h = textureLoad(history, clamped, 0).xy;
            let w = select(0.0, on_surface, inside(tap) && history_length(h) > 0.0);
            let c = color_at(clamped, h);
            color += w * c;
            square += w * luminance(c) * luminance(c);
            weights += w;
        }
    }
    let mean = color / max(weights, 1e-6);
    // Var(mean) = Var/Σw, times 4 because few pixels estimate it, as in the variance of a history of one sample below.
    let variance = SHORT_HISTORY * max(square / max(weights, 1e-6) - luminance(mean) * luminance(mean), 0.0) / max(weights, 1.0);
    return select(vec2(0u), pack_tap(mean, sqrt(variance)), weights > LEAST_WEIGHT);
}
#endif

#ifdef REPEATED_NOISE
// Variance of a sample over the square of the mean below which a history has seen no noise in time. It is less than the least
// variance that a history stores.
const SILENT: f32 = 1e-6;

// E[least of four means over nine triples] / Var for independent noise: between 0.60 and 0.63 for uniform, exponential and rare noise.
const LEAST_OF_FOUR: f32 = 0.6;

// Variance of a direction with too few triples.
const UNKNOWN: f32 = 1e30;

// Sum of weights of a direction's triples below which they tell nothing: just under the six of two rows of three.
const FEWEST_TRIPLES: f32 = 5.5;

// Greatest ratio of a direction's mean to its fourth largest triple: beyond it, a lone bright pixel carries the mean.
const LONE: f32 = 20.0;

// A pixel's mean luminance less the centre's, and its weight: 0 where it is not on the centre's surface.
struct Neighbour {
    difference: f32,
    weight: f32,
}

fn neighbour(pixel: vec2<i32>, offset: vec2<i32>, plane: Plane, normal: vec3<f32>, center: f32) -> Neighbour {
    let tap = pixel + offset;
    let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
    let h = textureLoad(history, clamped, 0).xy;
    let on_surface = neighbour_weight(plane, normal, offset, textureLoad(guide, clamped, 0).xy);
    return Neighbour(mean_luminance(h) - center, select(0.0, on_surface, inside(tap) && history_length(h) > 0.0));
}

// The variance that three neighbours in a row show, times their weight, and their weight: 0 where one of the three is on another
// surface. For independent a, b, c: E[(b − (a + c)/2)²] = 1½·Var (compare Immerkær 1996, "Fast Noise Variance Estimation").
fn triple_variance(pixel: vec2<i32>, at: vec2<i32>, step: vec2<i32>, plane: Plane, normal: vec3<f32>, center: f32) -> vec2<f32> {
    let a = neighbour(pixel, at - step, plane, normal, center);
    let b = neighbour(pixel, at, plane, normal, center);
    let c = neighbour(pixel, at + step, plane, normal, center);
    let difference = b.difference - 0.5 * (a.difference + c.difference);
    return a.weight * b.weight * c.weight * vec2(difference * difference / 1.5, 1.0);
}

// The variance of noise that is the same in every frame: the mean over 3×3 triples, in each of four directions.
//
// Failure: an edge looks like noise across itself, and a lone bright pixel like noise in the three triples that hold it. Reason:
// both differ from their neighbours. Rule: an edge does not vary along itself, so the least of the directions with enough triples
// counts; a mean is at most 20 times the direction's fourth largest triple, which is 0 beside a lone pixel.
fn repeated_noise(pixel: vec2<i32>, plane: Plane, normal: vec3<f32>, center: f32, silent: bool) -> f32 {
    // The four largest triples of each direction.
    var first = vec4(0.0);
    var second = vec4(0.0);
    var third = vec4(0.0);
    var fourth = vec4(0.0);
    var sum = vec4(0.0);
    var weights = vec4(0.0);
    // The 3×3 triples move inwards at the image's border: outside there is nothing to tell an edge along the border from noise.
    let middle = clamp(pixel, vec2(2), max(vec2<i32>(frame.size) - 3, vec2(2))) - pixel;
    let places = select(0, 9, silent);
    for (var i = 0; i < places; i++) {
        // (i·11) >> 5 is i / 3 for i < 9.
        let row = (i * 11) >> 5u;
        let at = middle + vec2(i - 3 * row, row) - 1;
        let across = triple_variance(pixel, at, vec2(1, 0), plane, normal, center);
        let down = triple_variance(pixel, at, vec2(0, 1), plane, normal, center);
        let falling = triple_variance(pixel, at, vec2(1, 1), plane, normal, center);
        let rising = triple_variance(pixel, at, vec2(1, -1), plane, normal, center);
        let next = vec4(across.x, down.x, falling.x, rising.x);
        fourth = max(fourth, min(third, next));
        third = max(third, min(second, next));
        second = max(second, min(first, next));
        first = max(first, next);
        sum += next;
        weights += vec4(across.y, down.y, falling.y, rising.y);
    }
    let each = select(vec4(UNKNOWN), min(sum / max(weights, vec4(1.0)), LONE * fourth), weights >= vec4(FEWEST_TRIPLES));
    let least = min(min(each.x, each.y), min(each.z, each.w));
    return select(0.0, least / LEAST_OF_FOUR, least < UNKNOWN);
}
#endif

#ifdef CLAMP
// Fewest pixels of the surface in the window that show what is usual.
const FEWEST: f32 = 6.0;

// Cosine of normals of one surface here: acos 0.8 is 37°.
const ONE_SURFACE: f32 = 0.8;

// Largest factor by which a pixel gives back the light that the clamp takes from its neighbourhood.
const MOST_GIVEN_BACK: f32 = 1.5;

// The luminances of the neighbours on the pixel's surface: the three largest ones, their sum and their number.
struct Usual {
    first: f32,
    second: f32,
    third: f32,
    sum: f32,
    count: f32,
}

fn add_neighbour(usual: ptr<function, Usual>, l: f32, there: bool) {
    let next = select(0.0, l, there);
    (*usual).third = max((*usual).third, min((*usual).second, next));
    (*usual).second = max((*usual).second, min((*usual).first, next));
    (*usual).first = max((*usual).first, next);
    (*usual).sum += next;
    (*usual).count += select(0.0, 1.0, there);
}

// Factor on a pixel's colour: it brings the luminance down to `gloss_clamp` times the third largest of the 24 around on its surface, about
// their 90th percentile, and gives the light that exceeds this bound back to the whole window:
//
//   min(1, b/l)·min(1.5, Σl/Σmin(l, b)),  b = gloss_clamp·third
//
// Failure: a highlight that one path had met glowed on for a dozen frames, as wide as the filter. Reason: the mean of a few samples is as
// far off as its largest one, and its neighbours know no better. Rule: the filter takes in what is usual around; the history keeps all of
// the light, and shows it once it is sure.
//
// Failure: the picture was 3 % too dark. Reason: the bound takes more from the light than it takes from its mean's error. Rule: neighbours
// share the excess, up to half of what they have; at most the first, the second and the pixel itself exceed the bound.
fn clamped(usual: Usual, center: f32) -> f32 {
    let bound = frame.gloss_clamp * usual.third;
    let excess = max(usual.first - bound, 0.0) + max(usual.second - bound, 0.0) + max(center - bound, 0.0);
    let given_back = clamp(1.0 + excess / max(usual.sum + center - excess, 1e-37), 1.0, MOST_GIVEN_BACK);
    return select(1.0, given_back * min(1.0, bound / max(center, 1e-37)), usual.count >= FEWEST);
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let h = textureLoad(history, pixel, 0).xy;
    // 0 where the pixel hit nothing, and where it has seen no sample yet.
    let length = history_length(h);
    let short = length > 0.0 && length < SHORT_HISTORY;
    let g = textureLoad(guide, pixel, 0).xy;
#ifdef SPECULAR_SIGNAL
    let own_guide = specular_guide(g, roughness_code(textureLoad(reflection, pixel, 0).xy));
    textureStore(guide_out, pixel, vec4(own_guide, 0u, 0u));
#endif
    let normal = unpack_normal(g.x);
    let plane = tangent_plane(vec2<f32>(pixel), normal, bitcast<f32>(g.y));
    let center = mean_luminance(h);
    // First and second moment over the window, about the centre's mean so that their squares do not cancel.
    var first = 0.0;
    var second = 0.0;
    var weights = 0.0;
    // A loop whose length may be 0, and not a branch: a software adapter executes a branch either way, but skips a loop that no
    // invocation enters. It is not unrolled. The clamp needs the window of long histories too.
#ifdef CLAMP
    var usual = Usual();
    let taps = select(0, WINDOW, length > 0.0);
#else
    let taps = select(0, WINDOW, short);
#endif
    for (var i = 0; i < taps; i++) {
        let offset = window_offset(i);
        let tap = pixel + offset;
        let near = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
        let there = textureLoad(guide, near, 0).xy;
        let on_surface = neighbour_weight(plane, normal, offset, there);
        let other = textureLoad(history, near, 0).xy;
#ifdef MISSING_SAMPLES
        let there_is_one = history_length(other) > 0.0;
#else
#ifdef SPECULAR_SIGNAL
        let there_is_one = history_length(other) > 0.0;
#else
        let there_is_one = true;
#endif
#endif
        let w = select(0.0, on_surface, inside(tap) && there_is_one);
        let l = mean_luminance(other);
        let d = l - center;
        first += w * d;
        second += w * (history_variance(other) + d * d);
        weights += w;
#ifdef CLAMP
        let similar = there.y != 0u && dot(normal, unpack_normal(there.x)) >= ONE_SURFACE;
        add_neighbour(&usual, l, similar && any(offset != vec2(0)) && inside(tap) && history_length(other) > 0.0);
#endif
    }
    let mean = first / max(weights, 1e-6);
    // Times 4/n: the neighbours of a history of n < 4 frames have seen as few frames as the pixel itself.
#ifdef SPECULAR_SIGNAL
    // Without the factor below: a mirror's own picture varies as much as its noise does.
    let few = 1.0;
#else
    let few = max(1.0, SHORT_HISTORY / max(length, 1.0));
#endif
    let spatial = max(second / max(weights, 1e-6) - mean * mean, 0.0) * few;
#ifdef VARIANCE_OF_MEAN
    // The variance of a mean of n samples: the unbiased variance of a sample over n.
    let own = unbiased(history_variance(h), length);
    var variance = mix(spatial, own, clamp((length - 1.0) / (SHORT_HISTORY - 1.0), 0.0, 1.0)) / max(length, 1.0);
#else
    var variance = select(history_variance(h), spatial, short);
#endif
#ifdef REPEATED_NOISE
    // Failure: a renderer that draws the same random numbers in each frame keeps its noise. Reason: the noise shows in no history,
    // and no average lessens it. Rule: its frames count as one, so the variance is that of a history of one sample.
    let silent = length >= 2.0 && center > 0.0 && history_variance(h) <= SILENT * center * center;
    variance = max(variance, SHORT_HISTORY * repeated_noise(pixel, plane, normal, center, silent));
#endif
#ifdef CLAMP
    let taken_in = clamped(usual, center);
    variance *= taken_in * taken_in;
    let color = taken_in * color_at(pixel, h);
#else
    let color = color_at(pixel, h);
#endif
#ifdef MISSING_SAMPLES
    // An infinite sample is shown, with a deviation of 0: it is so far from all others that the filter does not mix it with them.
    let infinite = any(h != vec2(0u));
#ifdef SPECULAR_SIGNAL
    let shown = own_guide.y != 0u;
#else
    let shown = g.y != 0u;
#endif
    var other = filled(pixel, plane, normal, length <= 0.0 && shown && !infinite);
    other = select(other, pack_tap(color, 0.0), infinite);
#else
    let other = vec2(0u);
#endif
    textureStore(color_out, pixel, vec4(select(other, pack_tap(color, sqrt(variance)), length > 0.0), 0u, 0u));
}
