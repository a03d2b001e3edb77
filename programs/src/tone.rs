//! Conversion from linear radiance to a pixel for images on the CPU; shaders/view.wgsl does the same on the GPU.

/// Returns a pixel of a picture, encoded as sRGB.
pub fn pixel(radiance: [f32; 3], exposure: f32) -> [u8; 4] {
    let [r, g, b] = neutral(radiance.map(|x| (x * exposure).clamp(0.0, 1e6))).map(encode);
    [r, g, b, 255]
}

/// Khronos PBR Neutral tone mapper (2024).
fn neutral(color: [f32; 3]) -> [f32; 3] {
    let start = 0.76;
    let low = color[0].min(color[1]).min(color[2]);
    let offset = if low < 0.08 { low - 6.25 * low * low } else { 0.04 };
    let color = color.map(|x| x - offset);
    let peak = color[0].max(color[1]).max(color[2]);
    if peak < start {
        return color;
    }
    let room = 1.0 - start;
    let mapped = 1.0 - room * room / (peak + room - start);
    let white = 1.0 - 1.0 / (0.15 * (peak - mapped) + 1.0);
    color.map(|x| x * mapped / peak * (1.0 - white) + mapped * white)
}

/// The transfer function of IEC 61966-2-1, in 8 bits.
fn encode(linear: f32) -> u8 {
    let encoded = if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * linear.powf(1.0 / 2.4) - 0.055 };
    (encoded.clamp(0.0, 1.0) * 255.0).round() as u8
}
