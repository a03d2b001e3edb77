//! Brightness of a colour.

/// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6).
pub(crate) fn luminance(c: [f32; 3]) -> f64 {
    0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2])
}
