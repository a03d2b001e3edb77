#define_import_path asvgf::history_ratio

// Limits of the history ratio ρ, by which the history is multiplied before it is blended (docs/filter.md, "Temporal gradient"). They
// are the prototype's; no setting changes them.

// ¼ ≤ ρ ≤ 4.
const RATIO_LIMIT: f32 = 4.0;

// The ratio of a colour's channel stays within 1½ of the luminance's.
const CHROMA_LIMIT: f32 = 1.5;

// Prior of ρ towards 1: e = 0.05·l′ is added to numerator and denominator, where l′ is the light that there was.
const PRIOR: f32 = 0.05;

// Light that there was, in parts of the light that there is, below which there is no ratio: the quotient's square may be infinite.
const FROM_DARK: f32 = 1e-6;

// The ratio within its limits.
fn limited(ratio: vec4<f32>) -> vec4<f32> {
    return clamp(ratio, vec4(1.0 / RATIO_LIMIT), vec4(RATIO_LIMIT));
}

// The ratio of a colour, within its limits about that of the luminance.
fn limited_color(color: vec3<f32>, luminance_ratio: f32) -> vec3<f32> {
    return clamp(color, vec3(luminance_ratio / CHROMA_LIMIT), vec3(luminance_ratio * CHROMA_LIMIT));
}

// How far the luminance's ratio is outside of its limits: 0 within them, 1 below ⅛ and above 8. A history that would have to be scaled
// by more than the limit is worth nothing: λ = 1.
fn beyond_limit(ratio: f32) -> f32 {
    return clamp(max(2.0 - 2.0 * RATIO_LIMIT * ratio, ratio / RATIO_LIMIT - 1.0), 0.0, 1.0);
}
