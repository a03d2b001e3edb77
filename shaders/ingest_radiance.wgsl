// Turns a host's radiance into the filter's own images. It is demodulated, so that no detail of textures is blurred, and cleaned
// before it reaches the history:
//
//   r = max(radiance − emission, 0) / clamp(albedo, 0.02, 1)

#import asvgf::frame::inside
#ifdef RESHADE
#import asvgf::frame::frame
#import asvgf::packing::NO_SAMPLE
#endif
#import asvgf::host_light::host_radiance
#ifdef ALBEDO
#import asvgf::host_light::{LEAST_ALBEDO, host_albedo}
#ifdef MODULATED
#ifdef MISSING_SAMPLES
#import asvgf::host_light::shown_albedo
#endif
#endif
#endif
#ifdef DIRECT_EMISSION
#import asvgf::host_light::host_emission
#endif
#ifdef DIAGNOSTICS
#import asvgf::counts::counts
#import asvgf::host_light::{below_zero, not_finite}
#endif
#ifdef RESHADE
#import asvgf::strata::{is_sample_pixel, previous_pixel, stratum_of}
#endif

#ifdef SPECULAR_SIGNAL
@group(0) @binding(1) var radiance_out: texture_storage_2d<rgba32uint, write>;
#else
@group(0) @binding(1) var radiance_out: texture_storage_2d<rg32uint, write>;
#endif
#ifdef RESHADE
@group(0) @binding(4) var samples: texture_2d<u32>;
#endif
#ifdef ALBEDO
@group(0) @binding(2) var albedo_out: texture_storage_2d<rgba16float, write>;
#ifdef MODULATED
@group(0) @binding(3) var guide: texture_2d<u32>;
#ifdef RESHADE
@group(0) @binding(5) var albedo_previous: texture_2d<f32>;
#endif
#endif
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(6) var emission_out: texture_storage_2d<rg32uint, write>;
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    var divisor = vec3(1.0);
#ifdef RESHADE
    // A pixel that repeats a path shows the surface that another pixel saw in the last frame. If this frame's light is demodulated
    // in another way than the last one's, there is nothing to compare it with.
    let record = textureLoad(samples, vec2<i32>(stratum_of(id.xy)), 0);
    let repeats = is_sample_pixel(record, id.xy);
    let comparable = !repeats || frame.continued != 0u;
#endif
#ifdef ALBEDO
#ifdef MODULATED
    let a = host_albedo(pixel, textureLoad(guide, pixel, 0).y != 0u);
    divisor = a;
#ifdef RESHADE
    // The albedo of that surface is the one to divide by.
    if repeats {
        divisor = max(textureLoad(albedo_previous, previous_pixel(record), 0).xyz, vec3(LEAST_ALBEDO));
    }
#endif
#else
    let a = host_albedo(pixel, true);
#endif
#endif
#ifdef DIRECT_EMISSION
    textureStore(emission_out, pixel, vec4(host_emission(pixel), 0u, 0u));
#endif
    let light = host_radiance(pixel, divisor);
#ifdef ALBEDO
#ifdef MODULATED
#ifdef MISSING_SAMPLES
    let shown = shown_albedo(pixel, textureLoad(guide, pixel, 0).y != 0u, light);
#else
    let shown = a;
#endif
#else
    let shown = a;
#endif
    textureStore(albedo_out, pixel, vec4(shown, 0.0));
#endif
#ifdef RESHADE
    textureStore(radiance_out, pixel, vec4(select(NO_SAMPLE, light, comparable), 0u, 0u));
#else
    textureStore(radiance_out, pixel, vec4(light, 0u, 0u));
#endif
#ifdef DIAGNOSTICS
    if not_finite {
        atomicAdd(&counts.non_finite, 1u);
    }
    if below_zero {
        atomicAdd(&counts.negative, 1u);
    }
#endif
}
