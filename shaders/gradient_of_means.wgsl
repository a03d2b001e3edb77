// History ratio ρ and λ of each stratum from the means of this frame's samples, s, and of the history, m, on three levels of a
// pyramid. The coarsest comes first: it knows a change of the whole room with little noise. Each finer one adds what differs from
// that. The coarsest is made here and not stored, because nothing else reads it.
//
//   d = s − ρ·m                                                            (luminances)
//   V′ = max(ρ²·V, Σ(s_i − ρ·m_i)²/N²)                                     as the histories, and as the samples know it
//   λ ← max(λ, √max(0, d² − 6·V′) / max(s, ρ·m))                           not explained even by the coarser ratio
//   ρ ← ρ + (ρ_level − ρ)·max(0, 1 − 6·V′/d²),  ρ_level = (s + e·ρ)/(m + e),  e = 0.05·m, per channel
//
// Noise is subtracted because d has the variance V′ where nothing has changed. By the samples, d²/V′ is (Σr)²/Σr² of the residuals
// r, the number of samples that agree (Kish 1965), so no single bright path counts as a change.
//
// Failure: by the histories alone, a still room that one path in twenty lights became brighter by 12 %. Reason: only rises
// exceeded the noise that the histories knew. Rule: both variances. Levels finer than these three know their mean too badly: one of
// nine samples is off by a quarter.

#import asvgf::frame::frame
#import asvgf::color::luminance
#import asvgf::means::{Means, pack_before, pack_now, unpack_means}
#import asvgf::means_taps::{coarser_means, means_of}
#import asvgf::strata_taps::record_of
#ifdef HISTORY_RATIO
#import asvgf::history_ratio::{FROM_DARK, PRIOR, beyond_limit, limited, limited_color}
#endif

@group(0) @binding(6) var now_fine: texture_2d<u32>;
@group(0) @binding(7) var before_fine: texture_2d<u32>;
@group(0) @binding(8) var gradient_out: texture_storage_2d<rgba32uint, write>;
#ifdef HISTORY_RATIO
@group(0) @binding(9) var ratio_out: texture_storage_2d<rgba32uint, write>;
#endif

// Luminances below which there is nothing to compare: the squares that make the noise are still normal numbers.
const DARK: f32 = 1e-17;

// Variances V′ that are taken for noise. docs/filter.md compares 2, 4, 6 and 9: with 6, still images come nearest to a constant α.
const NOISE: f32 = 6.0;

struct Found {
    // ρ for red, green, blue and luminance.
    ratio: vec4<f32>,
    lambda: f32,
}

fn refine(found: Found, means: Means) -> Found {
    let s = luminance(means.now);
    let m = luminance(means.before);
    let ratio = found.ratio;
    let expected = ratio.w * m;
    let larger = max(s, expected);
    if larger <= DARK {
        return found;
    }
    let difference = (s - expected) / larger;
    let square = difference * difference;
    let scale = ratio.w / larger;
    let seen = (means.now_square / larger - 2.0 * scale * means.product) / larger + scale * (scale * means.before_square);
    let noise = max(scale * (scale * means.variance), seen);
    let lambda = max(found.lambda, sqrt(max(square - NOISE * noise, 0.0)));
#ifdef HISTORY_RATIO
    // Light that comes out of the dark has no ratio, because its quotient may be infinite.
    if m <= FROM_DARK * s {
        return Found(ratio, lambda);
    }
    let e = PRIOR * m;
    let level = (s + e * ratio.w) / max(m + e, DARK);
    let color = limited_color((means.now + e * ratio.xyz) / max(means.before + e, vec3(DARK)), level);
    let believed = max(0.0, 1.0 - NOISE * noise / max(square, 1e-12));
    return Found(ratio + (vec4(color, level) - ratio) * believed, lambda);
#else
    return Found(ratio, lambda);
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var found = Found(vec4(1.0), 0.0);
    let record = record_of(stratum);
    if record.x != 0u {
        let coarsest = coarser_means(stratum, record);
        // Rounded as the others are.
        found = refine(found, unpack_means(pack_now(coarsest), pack_before(coarsest)));
        found = refine(found, means_of(stratum));
        found = refine(found, unpack_means(textureLoad(now_fine, stratum, 0), textureLoad(before_fine, stratum, 0)));
    }
    var lambda = found.lambda;
#ifdef HISTORY_RATIO
    // A history that would have to be scaled by more than the limit is worth nothing, as in gradient.wgsl.
    lambda = max(lambda, beyond_limit(found.ratio.w));
    textureStore(ratio_out, stratum, bitcast<vec4<u32>>(limited(found.ratio)));
#endif
    // λ as the quotient of sums over strata that the other gradients are.
    textureStore(gradient_out, stratum, bitcast<vec4<u32>>(vec4(lambda, 1.0, lambda, 1.0)));
}
