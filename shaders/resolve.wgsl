// Puts the picture together: filtered radiance times albedo, plus the emission of the surface or the sky towards the camera.

#import asvgf::frame::{frame, inside}
#import asvgf::packing::unpack_rgb
#ifdef ACCUMULATE
#import asvgf::packing::is_sample
#endif
#ifndef UNFILTERED
#import asvgf::history::filtered_color
#endif
#import asvgf::sample::sample_at
#ifdef HOST_LIGHT
#ifdef GLOSS
#ifdef UNFILTERED
#import asvgf::host_light::clean
#endif
#ifdef REFLECTANCE
#import asvgf::host_light::cleaned_albedo
#endif
#endif
#ifdef ALBEDO
#import asvgf::host_light::host_albedo
#ifdef MODULATED
#ifdef MISSING_SAMPLES
#import asvgf::host_light::shown_albedo
#endif
#endif
#endif
#ifdef DIRECT_EMISSION
#import asvgf::host_light::host_emission
#endif
#endif

#ifndef UNFILTERED
@group(0) @binding(1) var color: texture_2d<u32>;
#endif
#ifdef GLOSS
#ifdef UNFILTERED
#ifdef HOST_LIGHT
@group(0) @binding(9) var specular_radiance: texture_2d<f32>;
#else
@group(0) @binding(9) var specular_radiance: texture_2d<u32>;
#endif
#else
@group(0) @binding(9) var specular_color: texture_2d<u32>;
#endif
#ifdef REFLECTANCE
@group(0) @binding(10) var specular_albedo: texture_2d<f32>;
#endif
#endif
@group(0) @binding(8) var guide: texture_2d<u32>;

// True if the pixel sees a surface. Only a host's frames ask for it.
fn hit_at(pixel: vec2<i32>) -> bool {
#ifdef HOST_LIGHT
    return textureLoad(guide, pixel, 0).y != 0u;
#else
#ifdef BACKGROUND
    return textureLoad(guide, pixel, 0).y != 0u;
#else
    return true;
#endif
#endif
}

#ifdef HOST_LIGHT
#ifdef ALBEDO
fn albedo_at(pixel: vec2<i32>, hit: bool) -> vec3<f32> {
#ifdef MODULATED
#ifdef MISSING_SAMPLES
    return shown_albedo(pixel, hit, sample_at(pixel, hit));
#else
    return host_albedo(pixel, hit);
#endif
#else
    return host_albedo(pixel, hit);
#endif
}
#endif
#ifdef DIRECT_EMISSION
fn emission_at(pixel: vec2<i32>) -> vec3<f32> {
    return unpack_rgb(host_emission(pixel));
}
#endif
#else
@group(0) @binding(2) var albedo: texture_2d<f32>;
@group(0) @binding(3) var emission: texture_2d<u32>;

fn albedo_at(pixel: vec2<i32>, hit: bool) -> vec3<f32> {
    return textureLoad(albedo, pixel, 0).xyz;
}

fn emission_at(pixel: vec2<i32>) -> vec3<f32> {
    return unpack_rgb(textureLoad(emission, pixel, 0).xy);
}
#endif

#ifdef ACCUMULATE
// Sum over the samples so far, and their number.
@group(0) @binding(4) var sum_previous: texture_2d<f32>;
@group(0) @binding(5) var sum_out: texture_storage_2d<rgba32float, write>;
#endif
#ifdef TARGET_F16
@group(0) @binding(6) var target_out: texture_storage_2d<rgba16float, write>;
// Largest number that the target holds.
const LIMIT: f32 = 65504.0;
#else
@group(0) @binding(6) var target_out: texture_storage_2d<rgba32float, write>;
const LIMIT: f32 = 3.4e38;
#endif

#ifdef GLOSS
// The specular light, with its reflectance.
fn specular_at(pixel: vec2<i32>, hit: bool) -> vec3<f32> {
#ifdef UNFILTERED
#ifdef HOST_LIGHT
    var light = clean(textureLoad(specular_radiance, pixel, 0).xyz);
#ifdef MODULATED
    return light;
#endif
#else
    var light = unpack_rgb(textureLoad(specular_radiance, pixel, 0).xy);
#endif
#else
    var light = filtered_color(textureLoad(specular_color, pixel, 0).xy);
#endif
#ifdef REFLECTANCE
#ifdef HOST_LIGHT
    light *= cleaned_albedo(textureLoad(specular_albedo, pixel, 0).xyz, hit);
#else
    light *= textureLoad(specular_albedo, pixel, 0).xyz;
#endif
#endif
    return light;
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let hit = hit_at(pixel);
#ifdef UNFILTERED
    let arrived = sample_at(pixel, hit);
    var result = unpack_rgb(arrived);
#else
    var result = filtered_color(textureLoad(color, pixel, 0).xy);
#ifdef BACKGROUND
    // A pixel that hits nothing is not filtered. It shows the host's sky.
    if !hit {
        result = unpack_rgb(sample_at(pixel, hit));
    }
#endif
#endif
#ifdef ALBEDO
    result *= albedo_at(pixel, hit);
#endif
#ifdef GLOSS
    result += specular_at(pixel, hit);
#endif
#ifdef DIRECT_EMISSION
    result += emission_at(pixel);
#endif
#ifdef ACCUMULATE
    // A missing sample is no part of the mean.
    var sum = select(vec4(0.0), vec4(result, 1.0), is_sample(arrived));
    if frame.continued != 0u {
        sum += textureLoad(sum_previous, pixel, 0);
    }
    textureStore(sum_out, pixel, sum);
    // Without any sample so far, the pixel shows what is left of its own: the emission, or an infinite radiance.
    result = select(result, sum.xyz / max(sum.w, 1.0), sum.w > 0.0);
#endif
    textureStore(target_out, pixel, vec4(min(result, vec3(LIMIT)), 1.0));
}
