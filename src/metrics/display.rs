//! Colours as a display shows them, for the metrics that model an eye.

/// Returns linear colours as a display shows them: times an exposure, cut off at 0 and 1, and encoded as sRGB (IEC
/// 61966-2-1). They are not tone-mapped, so that a metric does not depend on the taste of a tone mapper.
pub fn encode(linear: &[[f32; 3]], exposure: f32) -> Vec<[f32; 3]> {
    linear.iter().map(|color| color.map(|x| srgb((x * exposure).clamp(0.0, 1.0)))).collect()
}

fn srgb(x: f32) -> f32 {
    if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 }
}
