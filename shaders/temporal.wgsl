// Reprojects the history and blends this frame into it: a running mean of weight 1/n, which the temporal gradient shortens.
//
// The history is a colour, the variance of a sample's luminance, and the history length n (history.wgsl). The mean luminance is
// that of the colour. With FEEDBACK the colour comes from the spatial filter instead, and the history holds the mean luminance in
// the colour's place, as a grey.
//
// n is the effective number of samples: Var(mean) = Var(sample)/n (Kish 1965). A new sample of weight α makes of it
//
//   1/n′ = (1 − α)²/n + α²
//
// That is n + 1 for α = 1/(n + 1), and it tends to (2 − α)/α for a constant α. If n counted frames instead, the spatial filter
// would take the noise of a constant α for gone.

#import asvgf::frame::{frame, inside}
#import asvgf::color::luminance
#import asvgf::history::{pack_history, rounding}
#import asvgf::history_taps::History
#import asvgf::packing::{unpack_rgb, unpack_normal}
#import asvgf::sample::sample_at
#ifdef MISSING_SAMPLES
#import asvgf::packing::{is_missing, is_sample}
#endif
#ifdef FEEDBACK
#import asvgf::packing::pack_rgb
#endif
#ifdef STEADY
#import asvgf::packing::pack_tap
#endif
#ifdef OUTLIERS
#import asvgf::outliers::{LEAST_LEVEL, bound, ratio_of, ratio_to, unpack_limit}
#ifdef DIAGNOSTICS
#import asvgf::counts::counts
#endif
#endif
#ifdef SPECULAR_SIGNAL
#import asvgf::history_taps::reflection_at
#endif
#ifdef STILL
#import asvgf::history_taps::own_history
#else
#import asvgf::history_taps::{LEAST_WEIGHT, TapSum, add_tap, bilinear_taps, corner_of, mean_of, motion_of, origin_at}
#import asvgf::reproject::Origin
#ifdef SPECULAR_SIGNAL
#import asvgf::reproject::in_mirror
#import asvgf::gloss::{Reflection, lobe_width}
#import asvgf::specular_history::{combined, evidence_around, weight_of}
#endif
#ifdef MIXED_GLOSS
#import asvgf::frame::{is_orthographic, project, ray_direction, sample_point, seen_position}
#import asvgf::gloss::unpack_gloss
#endif
#endif
#ifdef EXTERNAL_LAMBDA
#import asvgf::color::is_finite
#endif
#ifdef GRADIENT
#import asvgf::change::change_at
#endif
#ifdef IN_PLACE
#import asvgf::change::samples
#import asvgf::strata::is_sample_pixel
#endif
#ifdef OUTLIERS
#import asvgf::strata::{is_at, stratum_of}
#else
#ifdef IN_PLACE
#import asvgf::strata::stratum_of
#endif
#endif

@group(0) @binding(1) var guide: texture_2d<u32>;
#ifdef FEEDBACK
@group(0) @binding(9) var feedback_out: texture_storage_2d<rg32uint, write>;
#endif
#ifdef EXTERNAL_LAMBDA
@group(0) @binding(10) var external_lambda: texture_2d<f32>;
#endif
#ifdef MIXED_GLOSS
@group(0) @binding(12) var gloss: texture_2d<u32>;
#endif
@group(0) @binding(13) var history_out: texture_storage_2d<rg32uint, write>;
#ifdef STEADY
// The last output at the surface's former place, rescaled as the history is, and its weight in this frame's output, see steady.wgsl.
@group(0) @binding(16) var reprojected_out: texture_storage_2d<rg32uint, write>;
#endif
#ifdef OUTLIERS
@group(0) @binding(18) var limit: texture_2d<u32>;
#endif
#ifdef KEEP_WEIGHTS
// α and λ, for views.
@group(0) @binding(14) var weights_out: texture_storage_2d<rg32float, write>;
#endif

#ifdef STEADY
// The last output has no weight once the history ratio of the luminance is off 1 by 1/20.
const RATIO_SHARPNESS: f32 = 20.0;

// Weight b of the last output in this one:
//
//   b = min(steadiness, (1 − λ)²·max(0, 1 − 20·|ρ_l − 1|)·k/(k + 1))·max(0, 1 − 2·Σf·(1 − f)),  k = n − 1
//
// k/(k + 1) is the weight in a mean of all outputs; the limit `steadiness` bounds the lag. λ and the history ratio ρ say where the
// light has changed. f are the fractions of the motion in pixels: a bilinear tap between pixels blurs, in each frame anew, so the
// weight falls to 0 in the middle of four.
fn steadiness(lambda: f32, ratio: f32, length: f32, motion: vec2<f32>) -> f32 {
    let k = max(length - 1.0, 0.0);
    let unchanged = (1.0 - lambda) * (1.0 - lambda) * max(1.0 - RATIO_SHARPNESS * abs(ratio - 1.0), 0.0);
    let f = fract(motion);
    let between = 2.0 * dot(f, vec2(1.0) - f);
    return min(unchanged * k / (k + 1.0), frame.steadiness) * max(1.0 - between, 0.0);
}
#endif

#ifndef STILL
// Taps of the search around a point where no surface lies under the 2×2 taps: 4×4, one pixel farther on each side, with weights
// e^(−d²).
const SEARCH: i32 = 16;

// The history at the place where the pixel's surface, or its reflection, was: `moved` pixels away.
fn reproject(pixel: vec2<i32>, moved: vec2<f32>, origin: Origin, seen: bool) -> History {
    let point = vec2<f32>(pixel) + moved;
    var sum = bilinear_taps(origin, point);
    // The search is a loop of length 0 elsewhere, and not a branch, because a software adapter executes a branch either way.
#ifdef MISSING_SAMPLES
    // Taps on the surface that have no history do not start a search: a history borrowed from farther away would stay and move
    // farther in from frame to frame.
    let surface = sum.surface;
#else
    let surface = sum.weight;
#endif
    let searched = select(0, SEARCH, seen && surface <= LEAST_WEIGHT);
    if searched > 0 {
        sum = TapSum();
    }
    let base = corner_of(point);
    for (var i = 0; i < searched; i++) {
        let tap = base + vec2(i & 3, i >> 2u) - 1;
        let d = vec2<f32>(tap) - point;
        add_tap(&sum, origin, tap, exp(-dot(d, d)));
    }
    return mean_of(sum);
}
#endif

#ifdef SPECULAR_SIGNAL
#ifndef STILL
// The history of the specular light, see specular_history.wgsl.
fn reproject_gloss(pixel: vec2<i32>, m: vec3<f32>, origin: Origin, reflection: Reflection, depth: f32, seen: bool) -> History {
    let surface = reproject(pixel, m.xy, origin, seen);
    let reflected = reproject(pixel, reflection.motion, in_mirror(origin), seen);
    let width = lobe_width(reflection.roughness, reflection.hit_distance, depth);
    return combined(surface, reflected, weight_of(evidence_around(pixel, origin.normal)), reflection.motion, m.xy, width);
}
#endif
#endif

#ifdef MIXED_GLOSS
#ifndef STILL
// Distance of what a glossy surface reflects, in parts of the depth, where one radiance holds all light.
const REFLECTED: f32 = 0.5;

// Longest history of a surface whose light is partly specular (p: pixels between its motion and that of a reflection half the depth
// away; the flat mirror's image is as far behind the surface):
//
//   1/n = 1/n_max + gloss_parallax·part·(1 − r)²·p
fn longest_of_mixed(pixel: vec2<i32>, m: vec3<f32>, depth: f32) -> f32 {
    let gloss = unpack_gloss(textureLoad(gloss, pixel, 0).x);
    let point = sample_point(frame.camera, vec2<f32>(pixel));
    let here = seen_position(frame.camera, point, depth);
    let image = here + normalize(ray_direction(frame.camera, point)) * (REFLECTED * depth);
    let displaced = seen_position(frame.previous, point + m.xy, m.z) - here;
    let shift = project(frame.previous, image + displaced).xy - project(frame.camera, image).xy;
    let smoothness = 1.0 - gloss.roughness;
    let slid = select(0.0, min(distance(shift, m.xy), 1e6), gloss.exists);
    let rate = 1.0 / frame.max_history + frame.gloss_parallax * gloss.part * smoothness * smoothness * slid;
    // The new sample is one of the n.
    return max(1.0 / rate - 1.0, 0.0);
}
#endif
#endif

// The part of a history's length that is kept: (1 − λ)^k. Failure: pow(0, 0) may be anything, but a power of 0 shall shorten
// nothing. Rule: the base stays above 0.
fn kept_part(lambda: f32, pixel: vec2<i32>) -> f32 {
#ifdef SPECULAR_SIGNAL
    let power = frame.gloss_history_power;
#else
#ifdef MIXED_GLOSS
    let power = mix(frame.history_power, frame.gloss_history_power, unpack_gloss(textureLoad(gloss, pixel, 0).x).part);
#else
    let power = frame.history_power;
#endif
#endif
    return pow(max(1.0 - lambda, 1e-9), power);
}

#ifdef OUTLIERS
// The belief in a sample (outliers.wgsl).
struct Belief {
    // Weight of the sample, 0…1: (R·B/l)² if its luminance l is above the bound R·B. Brought down to R·B alone, outliers would
    // still brighten a surface; with this weight too, one far above does nothing, and one just above is light.
    weight: f32,
    // Factor that brings its luminance down to R·B.
    scale: f32,
    // True if it was seen in so many frames running that the history must be wrong.
    confirmed: bool,
    // Mean luminance of the samples around.
    around: f32,
}

fn belief_in(pixel: vec2<u32>, l: f32, level: f32, length: f32, lambda: f32) -> Belief {
    let stratum = stratum_of(pixel);
    let believed = unpack_limit(textureLoad(limit, stratum, 0).xy);
    let known = max(level, max(LEAST_LEVEL * believed.expected, lambda * believed.level));
    let base = select(known, believed.level, length <= 0.0);
    let ratio = ratio_to(bound(base, length), l);
    let most = ratio_of(believed.ratio_class);
    let over = ratio > most;
    // Outliers are rare, so light that stays is light: the same pixel in so many frames running, or any pixel of the same stratum.
    let confirmed = (is_at(believed.place, pixel) && believed.sightings == believed.asked) || (over && believed.running >= believed.asked);
    var scale = select(1.0, most / max(ratio, 1e-9), over && !confirmed);
#ifdef EXTERNAL_LAMBDA
    // The host's λ comes first: where it drops the history, this sample is all there is.
    scale = mix(scale, 1.0, lambda);
#endif
    return Belief(scale * scale, scale, confirmed, believed.level);
}
#endif

#ifdef EXTERNAL_LAMBDA
// The host's λ; 0 if it is not a finite number, because such a number tells nothing.
fn lambda_at(pixel: vec2<u32>) -> f32 {
    let value = textureLoad(external_lambda, pixel / frame.lambda_block, 0).x;
#ifdef CONFIDENCE
    let lambda = 1.0 - value;
#else
    let lambda = value;
#endif
    return select(0.0, clamp(lambda, 0.0, 1.0), is_finite(value));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let g = textureLoad(guide, pixel, 0).xy;
    let depth = bitcast<f32>(g.y);
    // A miss takes the same way as a surface, and its result is not stored.
#ifdef SPECULAR_SIGNAL
    let reflection = reflection_at(pixel);
    let seen = depth > 0.0 && reflection.exists;
#else
    let seen = depth > 0.0;
#endif
    let normal = unpack_normal(g.x);
    let arrived = sample_at(pixel, seen);
#ifdef OUTLIERS
    var sample = unpack_rgb(arrived);
    var l = luminance(sample);
#else
    let sample = unpack_rgb(arrived);
    let l = luminance(sample);
#endif
    var history = History();
#ifdef STEADY
    var last_output = vec3(0.0);
    var steady = 0.0;
    var moved = vec2(0.0);
#endif
    if frame.continued != 0u {
#ifdef STILL
        history = own_history(pixel);
#else
        let m = motion_of(pixel, depth);
        let origin = origin_at(pixel, m, normal);
#ifdef SPECULAR_SIGNAL
        history = reproject_gloss(pixel, m, origin, reflection, depth, seen);
#else
        history = reproject(pixel, m.xy, origin, seen);
#endif
#ifdef MIXED_GLOSS
        history.length = min(history.length, longest_of_mixed(pixel, m, depth));
#endif
#ifdef STEADY
#ifdef SPECULAR_SIGNAL
        moved = reflection.motion;
#else
        moved = m.xy;
#endif
#endif
#endif
    }
    var variance = 0.0;
    var length = 1.0;
    var alpha = 1.0;
    var lambda = 0.0;
#ifdef GRADIENT
    let change = change_at(pixel, normal, depth, seen);
    lambda = select(0.0, change.lambda, history.weight > 0.0);
#endif
#ifdef EXTERNAL_LAMBDA
    lambda = select(0.0, lambda_at(id.xy), history.weight > 0.0);
#endif
#ifdef OUTLIERS
    var level = luminance(history.color);
#ifdef STEADY
    level = max(level, luminance(history.output));
#endif
    let belief = belief_in(id.xy, l, level, history.length, lambda);
    // Without a history, the part of a sample that is not believed is replaced by the mean luminance around.
    let first = mix(min(belief.around, l) / max(l, 1e-37), belief.scale, belief.weight);
    var color = sample * first;
    var mean = l * first;
    sample *= belief.scale;
    l *= belief.scale;
#else
    var color = sample;
    var mean = l;
#endif
#ifdef MISSING_SAMPLES
    let sampled = is_sample(arrived);
    length = select(0.0, 1.0, sampled);
#endif
    if history.weight > 0.0 {
        var before = history.color;
        var mean_before = history.mean;
        var variance_before = history.variance;
        var ratio = vec4(1.0);
        // The history of an image that stood still may be longer than the settings allow in one that moves.
        var kept = min(history.length, frame.max_history);
#ifdef HISTORY_RATIO
        ratio = change.ratio;
        before *= ratio.xyz;
        mean_before *= ratio.w;
        variance_before *= ratio.w * ratio.w;
#endif
#ifdef GRADIENT
        kept *= kept_part(lambda, pixel);
#endif
#ifdef EXTERNAL_LAMBDA
        kept *= kept_part(lambda, pixel);
#endif
        length = min(kept + 1.0, frame.max_history);
#ifdef BLEND_BY_LAMBDA
        // α′ = (1 − λ)·α + λ (Schied et al. 2018; Basci 2025), and never below what the shortened history asks for.
        let base = max(1.0 / (history.length + 1.0), frame.alpha);
        alpha = max((1.0 - lambda) * base + lambda, 1.0 / (kept + 1.0));
#else
        alpha = max(1.0 / length, frame.alpha);
#endif
        let older = (1.0 - alpha) * (1.0 - alpha) / max(kept, 1e-9);
        length = select(length, min(1.0 / (older + alpha * alpha), frame.max_history), alpha * length > 1.0);
#ifdef OUTLIERS
        alpha = select(alpha * belief.weight, 1.0, belief.confirmed);
        length = select(mix(kept, length, belief.weight), 1.0, belief.confirmed);
#endif
#ifdef IN_PLACE
        // Failure: the noise was 1.11 times as large. Reason: the gradient's sample repeats a path that the history already holds,
        // so averaged in it counts twice. Rule: it has the weight λ, with which it replaces what λ drops.
        if is_sample_pixel(textureLoad(samples, stratum_of(id.xy), 0), id.xy) {
            alpha = lambda;
            length = max(kept, 1.0);
#ifdef OUTLIERS
            alpha *= belief.weight;
#endif
        }
#endif
#ifdef MISSING_SAMPLES
        // Without a sample the history goes on unchanged, unless λ has left nothing of it. A single infinite sample is a firefly;
        // each one halves the history's length, so that a sun is shown in the end.
        let trusted = kept * select(0.5, 1.0, is_missing(arrived));
        alpha = select(0.0, alpha, sampled);
        length = select(select(0.0, max(trusted, 1.0), trusted > 0.5), length, sampled);
#endif
        alpha = clamp(alpha, 0.0, 1.0);
        color = before + alpha * (sample - before);
        // Running mean and variance with weight α (West 1979). No term is subtracted from the second moment, so nothing cancels.
        let deviation = l - mean_before;
        mean = mean_before + alpha * deviation;
        variance = (1.0 - alpha) * (variance_before + alpha * deviation * deviation);
#ifdef STEADY
        last_output = history.output * ratio.xyz;
        steady = steadiness(lambda, ratio.w, length, moved);
#endif
    }
#ifdef MISSING_SAMPLES
    // An infinite sample without a history is stored as a colour of length 0, so that it is shown.
    let shown = length <= 0.0 && !is_missing(arrived);
    color = select(color, unpack_rgb(arrived), shown);
    mean = select(mean, luminance(unpack_rgb(arrived)), shown);
    variance = select(variance, 0.0, shown);
#endif
    color = max(color, vec3(0.0));
#ifdef FEEDBACK
    textureStore(feedback_out, pixel, vec4(select(vec2(0u), pack_rgb(color), seen), 0u, 0u));
    color = vec3(max(mean, 0.0));
#endif
    let packed = pack_history(color, variance, length, rounding(id.xy, frame.index));
#ifdef MISSING_SAMPLES
    let kept = seen && (length > 0.0 || shown);
#else
    let kept = seen;
#endif
    textureStore(history_out, pixel, vec4(select(vec2(0u), packed, kept), 0u, 0u));
#ifdef STEADY
    textureStore(reprojected_out, pixel, vec4(select(vec2(0u), pack_tap(last_output, steady), seen), 0u, 0u));
#endif
#ifdef OUTLIERS
#ifdef MISSING_SAMPLES
    let outlier = seen && sampled && belief.weight < 1.0;
#else
    let outlier = seen && belief.weight < 1.0;
#endif
#ifdef DIAGNOSTICS
    if outlier && inside(pixel) {
        atomicAdd(&counts.outliers, 1u);
    }
#endif
#endif
#ifdef KEEP_WEIGHTS
    var weights = vec2(alpha, lambda);
#ifdef OUTLIERS
    // A negative α marks an outlier for its view.
    weights.x = select(alpha, -max(alpha, 1e-30), outlier);
#endif
    textureStore(weights_out, pixel, vec4(select(vec2(0.0), weights, seen), 0.0, 0.0));
#endif
}
