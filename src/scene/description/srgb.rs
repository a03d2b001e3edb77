//! The transfer function of sRGB.

/// The transfer function of sRGB, from 0…1 to 0…1.
pub(crate) fn linear_from_srgb(encoded: f32) -> f32 {
    if encoded <= 0.040_45 { encoded / 12.92 } else { ((encoded + 0.055) / 1.055).powf(2.4) }
}
