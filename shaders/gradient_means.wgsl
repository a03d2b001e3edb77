// The evidence of change in each stratum where no path was repeated: the mean of its new samples beside the mean of their
// reprojected histories, and how far the two may differ by noise alone.
//
// Failure: a renderer that hands in an image and a G-buffer has no pairs, and a constant α lags behind its light. Reason: a single
// sample tells nothing about change, because its noise is larger. Rule: compare means of many samples on one surface, with the
// variances of both.
//
//   s = mean of the new samples, m = mean of the histories, over the N pixels of the stratum that see the surface of its reference
//   V = Σ(v + v/n)/N²: variance of s − m in luminance, where v is that of a sample, from its history, and n the history length
//
// The reference is the first pixel with a history, from the centre on. A history of one sample knows nothing of v: until n is 5, a
// deviation of twice the mean is mixed in.

#import asvgf::frame::{frame, inside, sample_point, seen_position, scale_at}
#import asvgf::color::luminance
#import asvgf::history::unbiased
#import asvgf::history_taps::{History, bilinear_taps, mean_of, motion_of, origin_at}
#import asvgf::means::{Means, pack_before, pack_now, scaled}
#import asvgf::packing::{unpack_normal, unpack_rgb}
#import asvgf::reproject::SAME_NORMAL
#import asvgf::sample::sample_at
#import asvgf::strata::{pixel_at, place_from_center}
#import asvgf::strata_filter::PLANE
#ifdef MISSING_SAMPLES
#import asvgf::packing::is_sample
#endif
#ifdef OUTLIERS
#import asvgf::outliers::{bound, ratio_of, ratio_to, unpack_limit}
#endif
#ifdef SPECULAR_SIGNAL
#import asvgf::gloss::lobe_width
#import asvgf::history_taps::reflection_at
#import asvgf::reproject::in_mirror
#import asvgf::specular_history::{combined, evidence_at, weight_of}
#endif

@group(0) @binding(1) var guide: texture_2d<u32>;
#ifdef OUTLIERS
@group(0) @binding(6) var limit: texture_2d<u32>;
#endif
@group(0) @binding(9) var samples_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(10) var now_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(11) var before_out: texture_storage_2d<rgba32uint, write>;

// Deviation of a sample of which nothing is known, in parts of its mean.
const PRIOR_DEVIATION: f32 = 2.0;

// History length at which the history's own variance is believed.
const KNOWN: f32 = 5.0;

// Variance of one sample's luminance: unbiased, and mixed with the prior's while the history is short.
fn sample_variance(history: History, n: f32) -> f32 {
    let prior = PRIOR_DEVIATION * history.mean;
    let own = unbiased(history.variance, n);
    return mix(prior * prior, own, min((n - 1.0) / (KNOWN - 1.0), 1.0));
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var record = vec4(0u);
    var place = vec3(0.0);
    var normal = vec3(0.0);
    var reach = 0.0;
    var sum = Means();
    var count = 0.0;
#ifdef OUTLIERS
    let believed = unpack_limit(textureLoad(limit, stratum, 0).xy);
    let most = ratio_of(believed.ratio_class);
#endif
    let first = select(0u, 9u, frame.continued == 0u);
    for (var k = first; k < 9u; k++) {
        let at = place_from_center(k);
        let pixel = pixel_at(at, stratum);
        if !inside(pixel) {
            continue;
        }
        let g = textureLoad(guide, pixel, 0).xy;
        let depth = bitcast<f32>(g.y);
        if depth <= 0.0 {
            continue;
        }
#ifdef SPECULAR_SIGNAL
        let reflection = reflection_at(pixel);
        if !reflection.exists {
            continue;
        }
#endif
        let point = seen_position(frame.camera, sample_point(frame.camera, vec2<f32>(pixel)), depth);
        let n = unpack_normal(g.x);
        if record.x != 0u && (abs(dot(normal, point - place)) > reach || dot(normal, n) < SAME_NORMAL) {
            continue;
        }
        let arrived = sample_at(pixel, true);
#ifdef MISSING_SAMPLES
        if !is_sample(arrived) {
            continue;
        }
#endif
        let moved = motion_of(pixel, depth);
        let origin = origin_at(pixel, moved, n);
        var history = mean_of(bilinear_taps(origin, vec2<f32>(pixel) + moved.xy));
#ifdef SPECULAR_SIGNAL
        let reflected = mean_of(bilinear_taps(in_mirror(origin), vec2<f32>(pixel) + reflection.motion));
        let width = lobe_width(reflection.roughness, reflection.hit_distance, depth);
        history = combined(history, reflected, weight_of(evidence_at(stratum).sums), reflection.motion, moved.xy, width);
#endif
        if history.weight <= 0.0 {
            continue;
        }
        let sample = unpack_rgb(arrived);
        let l = luminance(sample);
        let l_before = luminance(history.color);
#ifdef OUTLIERS
        // A sample that temporal.wgsl does not believe is no sign of change either.
        if ratio_to(bound(max(l_before, max(believed.expected, believed.level)), history.length), l) > most {
            continue;
        }
#endif
        if record.x == 0u {
            record = vec4(at, 0u, g);
            place = point;
            normal = n;
            reach = PLANE * scale_at(frame.camera, depth);
        }
        let length = clamp(history.length, 1.0, frame.max_history);
        let v = sample_variance(history, length);
        sum.now += sample;
        sum.before += history.color;
        sum.variance += v + v / length;
        sum.now_square += l * l;
        sum.product += l * l_before;
        sum.before_square += l_before * l_before;
        count += 1.0;
    }
    let means = scaled(sum, 1.0 / max(count, 1.0));
    textureStore(samples_out, stratum, record);
    textureStore(now_out, stratum, pack_now(means));
    textureStore(before_out, stratum, pack_before(means));
}
