// The temporal gradient of each stratum, as numerator and denominator of
//
//   λ = A[Δ^(γ−1)·|δ|] / A[Δ^γ],  δ = f − ρ·f′,  Δ = max(f, ρ·f′)       (luminances)
//
// where A is the filter that follows, and f and f′ are the radiances of one path now and in the last frame. γ = 1 is Schied et al.
// 2018 (filter, then divide), where a dim change beside a bright steady light drowns; γ = 0 divides first.
//
// With HISTORY_RATIO, ρ = A[f]/A[f′]: the history is multiplied by it before it is blended, so only the residual is left for λ to
// drop. Without, ρ = 1.

#import asvgf::frame::frame
#import asvgf::color::luminance
#ifdef HISTORY_RATIO
#import asvgf::history_ratio::{FROM_DARK, PRIOR, beyond_limit, limited, limited_color}
#import asvgf::pairs::unpack_pair
#endif
#ifdef BLINN_PHONG
#import asvgf::blinn_phong::shade_pair
#import asvgf::strata::previous_pixel
#else
#import asvgf::pair_taps::radiances_of
#endif

@group(0) @binding(1) var samples: texture_2d<u32>;
#ifdef BLINN_PHONG
@group(0) @binding(2) var visibility_previous: texture_2d<u32>;
#endif
#ifdef HISTORY_RATIO
@group(0) @binding(4) var now_filtered: texture_2d<u32>;
@group(0) @binding(5) var before_filtered: texture_2d<u32>;
// ρ for red, green, blue and luminance.
@group(0) @binding(7) var ratio_out: texture_storage_2d<rgba32uint, write>;
#endif
// Numerator and denominator for the filter on one surface, and again for the filter across surfaces. Both images hold bits of f32,
// so that they can share memory with pairs.
@group(0) @binding(8) var gradient_out: texture_storage_2d<rgba32uint, write>;

// Demodulated luminances below which there is nothing to compare: 2⁻¹⁰⁰ keeps every later product a normal number.
const DARK: f32 = 7.9e-31;

#ifdef HISTORY_RATIO
// a/b, and exactly 1 for a = b. A GPU's division may be off by an ulp, but a static scene must keep its history exactly.
fn quotient(a: f32, b: f32) -> f32 {
    return select(a / b, 1.0, a == b);
}

struct HistoryRatio {
    ratio: vec4<f32>,
    // Excess of the ratio over its limits, see `beyond_limit`.
    beyond: f32,
    // The brighter of the filtered luminances.
    larger: f32,
}

fn history_ratio(stratum: vec2<i32>) -> HistoryRatio {
    let pair = unpack_pair(textureLoad(now_filtered, stratum, 0), textureLoad(before_filtered, stratum, 0));
    let now = pair.now;
    let before = pair.before;
    let l = luminance(now.xyz);
    let l_before = luminance(before.xyz);
    // A prior towards 1, in proportion to the light that there was. In full darkness there is nothing to scale; neither is there
    // where the last frame was as good as dark, because a quotient whose square is infinite tells nothing.
    let e = PRIOR * l_before;
    if max(l, l_before) <= DARK || l_before <= FROM_DARK * l {
        return HistoryRatio(vec4(1.0), 0.0, max(l, l_before));
    }
    let luminance_ratio = quotient(l + e, l_before + e);
    let color_ratio = vec3(
        quotient(now.x + e, before.x + e),
        quotient(now.y + e, before.y + e),
        quotient(now.z + e, before.z + e),
    );
    var ratio = vec4(limited_color(color_ratio, luminance_ratio), luminance_ratio);
    // Shrinks ρ towards 1 by its own variance V (the delta method for a quotient of means of correlated pairs):
    // ρ ← 1 + (ρ − 1)·max(0, 1 − V/(ρ_l − 1)²),  V = (A[l²] − 2·ρ_l·A[l·l′] + ρ_l²·A[l′²]) / (pairs·A[l′]²).
    let r = luminance_ratio;
    let variance = max(now.w - 2.0 * r * pair.product + r * r * before.w, 0.0)
        / (frame.effective_pairs * max(l_before * l_before, DARK));
    let excess = (r - 1.0) * (r - 1.0);
    let kept = select(max(0.0, 1.0 - variance / max(excess, 1e-9)), 0.0, excess == 0.0 && variance > 0.0);
    ratio = 1.0 + (ratio - 1.0) * kept;
    return HistoryRatio(limited(ratio), beyond_limit(ratio.w), max(l, l_before));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let record = textureLoad(samples, stratum, 0);
    var gradient = vec2(0.0);
#ifdef HISTORY_RATIO
    var ratio = vec4(1.0);
#endif
    if record.x != 0u {
#ifdef BLINN_PHONG
        let pair = shade_pair(textureLoad(visibility_previous, previous_pixel(record), 0).x, previous_pixel(record));
        let now = pair.x;
        var before = pair.y;
#else
        let radiances = radiances_of(record, stratum);
        let now = luminance(radiances.now);
        var before = luminance(radiances.before);
#endif
#ifdef HISTORY_RATIO
        let rescaled = history_ratio(stratum);
        ratio = rescaled.ratio;
        before *= ratio.w;
#endif
        let larger = max(now, before);
        if larger > DARK {
#ifdef SIGNED_GRADIENT
            let difference = now - before;
#else
            let difference = abs(now - before);
#endif
            gradient = vec2(
                difference * pow(larger, frame.gradient_gamma - 1.0),
                pow(larger, frame.gradient_gamma),
            );
        }
#ifdef HISTORY_RATIO
        // Failure: a lamp that went out left light behind that was as bright, for a whole history, as the light that remained.
        // Reason: its history would have to be scaled by more than the limit. Rule: such a history is worth nothing, λ = 1,
        // whatever this one path saw.
        gradient = mix(gradient, vec2(pow(max(rescaled.larger, DARK), frame.gradient_gamma)), rescaled.beyond);
#endif
    }
    textureStore(gradient_out, stratum, bitcast<vec4<u32>>(gradient.xyxy));
#ifdef HISTORY_RATIO
    textureStore(ratio_out, stratum, bitcast<vec4<u32>>(ratio));
#endif
}
