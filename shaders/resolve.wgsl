// Puts the picture together again: filtered radiance times albedo, plus what the surface or the sky emits towards the camera.

#import asvgf::frame::{frame, inside}
#import asvgf::packing::unpack_rgb
#ifndef UNFILTERED
#import asvgf::history::filtered_color
#endif

#ifdef UNFILTERED
@group(0) @binding(1) var radiance: texture_2d<u32>;
#else
@group(0) @binding(1) var color: texture_2d<u32>;
#ifdef BACKGROUND
@group(0) @binding(7) var radiance: texture_2d<u32>;
@group(0) @binding(8) var guide: texture_2d<u32>;
#endif
#endif
#ifdef ALBEDO
@group(0) @binding(2) var albedo: texture_2d<f32>;
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(3) var emission: texture_2d<u32>;
#endif
#ifdef ACCUMULATE
// Sum over the samples so far, and their count.
@group(0) @binding(4) var sum_previous: texture_2d<f32>;
@group(0) @binding(5) var sum_out: texture_storage_2d<rgba32float, write>;
#endif
#ifdef TARGET_F16
@group(0) @binding(6) var target_out: texture_storage_2d<rgba16float, write>;
// The largest number that the target holds.
const LIMIT: f32 = 65504.0;
#else
@group(0) @binding(6) var target_out: texture_storage_2d<rgba32float, write>;
const LIMIT: f32 = 3.4e38;
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
#ifdef UNFILTERED
    let reflected = unpack_rgb(textureLoad(radiance, pixel, 0).xy);
#else
    var reflected = filtered_color(textureLoad(color, pixel, 0).xy);
#ifdef BACKGROUND
    // Nothing was hit, so nothing was filtered: the host's sky.
    if textureLoad(guide, pixel, 0).y == 0u {
        reflected = unpack_rgb(textureLoad(radiance, pixel, 0).xy);
    }
#endif
#endif
    var result = reflected;
#ifdef ALBEDO
    result *= textureLoad(albedo, pixel, 0).xyz;
#endif
#ifdef DIRECT_EMISSION
    result += unpack_rgb(textureLoad(emission, pixel, 0).xy);
#endif
#ifdef ACCUMULATE
    var sum = vec4(result, 1.0);
    if frame.continued != 0u {
        sum += textureLoad(sum_previous, pixel, 0);
    }
    textureStore(sum_out, pixel, sum);
    result = sum.xyz / sum.w;
#endif
    textureStore(target_out, pixel, vec4(min(result, vec3(LIMIT)), 1.0));
}
