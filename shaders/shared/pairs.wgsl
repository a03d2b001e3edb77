#define_import_path asvgf::pairs

#import asvgf::packing::{pack_rgb, unpack_rgb}

// The radiances f and f′ of a gradient's path or, once filtered, their means, with the squares of their luminances l² and l′², and
// l·l′. The three products are f32, because the variance of a ratio is a difference of them of which little may be left.
struct Pair {
    now: vec4<f32>,
    before: vec4<f32>,
    product: f32,
}

// Packs a pair into two texels: f (62 bits), l², l·l′; f′, l′².
fn pack_now(pair: Pair) -> vec4<u32> {
    return vec4(pack_rgb(pair.now.xyz), bitcast<u32>(pair.now.w), bitcast<u32>(pair.product));
}

fn pack_before(pair: Pair) -> vec4<u32> {
    return vec4(pack_rgb(pair.before.xyz), bitcast<u32>(pair.before.w), 0u);
}

fn unpack_pair(now: vec4<u32>, before: vec4<u32>) -> Pair {
    return Pair(
        vec4(unpack_rgb(now.xy), bitcast<f32>(now.z)),
        vec4(unpack_rgb(before.xy), bitcast<f32>(before.z)),
        bitcast<f32>(now.w),
    );
}
