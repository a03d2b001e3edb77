#define_import_path asvgf::specular_history

// The history of a glossy pixel's specular light: at the former place of the reflection (V), at that of the surface (S), or between.
//
//   w = 1 / (1 + exp(−(1.5·z + 4)))      weight of V
//   z = t/√s,  t = Σ (V − S)·(E − (V + S)/2)/σ²,  s = Σ (V − S)²/σ²
//
// where E are new samples and σ² their variances, over the strata around (agreement.wgsl). z is the logarithm of a likelihood ratio,
// in its own deviations: it says which of the two histories predicts the new samples. The prior of 4 prefers V.
//
// Failure: where something new enters a mirror at its edge, ghosts of the old reflection stayed. Reason: V is not there yet, and S shows
// what has moved on. Rule: a history that is not wholly V's is at most as long as the lobe hides the motion,
//
//   n ≤ 1 + ¼·width / (p·(1 − w))          p: pixels between the places of V and S; width: of the reflection (gloss.wgsl)

#import asvgf::frame::frame
#import asvgf::history_taps::History
#import asvgf::evidence::{Evidence, unpack_evidence}
#import asvgf::packing::unpack_normal
#import asvgf::strata::stratum_of

@group(0) @binding(31) var agreement: texture_2d<u32>;

// Bound of the exponent, so that its power stays finite.
const MOST_EVIDENCE: f32 = 20.0;
const SHARPNESS: f32 = 1.5;
const PRIOR: f32 = 4.0;

// Weight of V from which on the history counts as wholly V's.
const TRUSTED: f32 = 0.999;

// Part of a reflection's width by which it may slide unnoticed over a whole history.
const HIDDEN: f32 = 0.25;

// Cosine of normals of strata whose evidence counts for a pixel.
const ONE_SURFACE: f32 = 0.9;

// Weight of V from the evidence t and s.
fn weight_of(evidence: vec2<f32>) -> f32 {
    let z = SHARPNESS * evidence.x * inverseSqrt(evidence.y + 1e-6) + PRIOR;
    return 1.0 / (1.0 + exp(-clamp(z, -MOST_EVIDENCE, MOST_EVIDENCE)));
}

fn evidence_at(stratum: vec2<i32>) -> Evidence {
    return unpack_evidence(textureLoad(agreement, stratum, 0).xy);
}

// Evidence of the 3×3 strata around a pixel, on surfaces of its direction.
fn evidence_around(pixel: vec2<i32>, normal: vec3<f32>) -> vec2<f32> {
    let own = vec2<i32>(stratum_of(vec2<u32>(pixel)));
    var sums = vec2(0.0);
    for (var i = 0; i < 9; i++) {
        let stratum = clamp(own + vec2(i % 3, i / 3) - 1, vec2(0), vec2<i32>(frame.strata) - 1);
        let evidence = evidence_at(stratum);
        let counts = evidence.exists && dot(unpack_normal(evidence.normal), normal) >= ONE_SURFACE;
        sums += select(vec2(0.0), evidence.sums, counts);
    }
    return sums;
}

fn mixed(s: History, v: History, w: f32) -> History {
    var h = History();
    h.color = mix(s.color, v.color, w);
    h.mean = mix(s.mean, v.mean, w);
    h.variance = mix(s.variance, v.variance, w);
    h.length = mix(s.length, v.length, w);
    h.weight = max(s.weight, v.weight);
#ifdef STEADY
    h.output = mix(s.output, v.output, w);
#endif
    return h;
}

// The history of a pixel whose surface moved by `moved` and whose reflection moved by `shift`, both in pixels, for the weight w of V.
// `width` is the reflection's, in pixels.
fn combined(s: History, v: History, w: f32, shift: vec2<f32>, moved: vec2<f32>, width: f32) -> History {
    let both = v.weight > 0.0 && s.weight > 0.0;
    let weight = select(select(0.0, 1.0, v.weight > 0.0), w, both);
    var h = mixed(s, v, weight);
    let slid = distance(shift, moved) * (1.0 - weight);
    let longest = 1.0 + HIDDEN * width / max(slid, 1e-3);
    h.length = select(min(h.length, longest), h.length, weight >= TRUSTED);
    return h;
}
