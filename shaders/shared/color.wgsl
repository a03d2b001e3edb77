#define_import_path asvgf::color

// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6, item 3.2).
fn luminance(color: vec3<f32>) -> f32 {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// WGSL lets a compiler assume that NaN and infinity do not exist, so `x != x` and `max(x, 0)` prove nothing. The exponent's bits do.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

fn is_nan(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7fffffffu) > 0x7f800000u;
}

// True for +∞, and not for −∞.
fn is_infinite(x: f32) -> bool {
    return bitcast<u32>(x) == 0x7f800000u;
}

// Brightest radiance that enters the filter. Its square, weighted and summed over strata and rescaled by ratios, is far below f32's
// 3·10³⁸. An infinite variance would become 0·∞, which is NaN and stays in the history.
const BRIGHTEST: f32 = 1e15;

// Makes a radiance fit to enter the history: a channel that is negative or not finite becomes 0.
fn sanitize(color: vec3<f32>) -> vec3<f32> {
    let ok = vec3(is_finite(color.x), is_finite(color.y), is_finite(color.z)) & (color > vec3(0.0));
    return select(vec3(0.0), min(color, vec3(BRIGHTEST)), ok);
}
