#define_import_path asvgf::color

// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6, item 3.2).
fn luminance(color: vec3<f32>) -> f32 {
    return dot(color, vec3(0.2126, 0.7152, 0.0722));
}

// WGSL lets a compiler assume that NaN and infinity do not exist, so `x != x` and `max(x, 0)` prove nothing:
// the exponent bits do.
fn is_finite(x: f32) -> bool {
    return (bitcast<u32>(x) & 0x7f800000u) != 0x7f800000u;
}

// A radiance that may enter history: not finite or negative becomes 0, channel by channel.
fn sanitize(color: vec3<f32>) -> vec3<f32> {
    let ok = vec3(is_finite(color.x), is_finite(color.y), is_finite(color.z)) & (color > vec3(0.0));
    return select(vec3(0.0), color, ok);
}
