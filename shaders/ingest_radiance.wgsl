// A host's radiance as the filter's own images: demodulated, r = max(radiance − emission, 0) / max(albedo, 10⁻³), so that no
// detail of textures is blurred, and cleaned before it reaches history.

#import asvgf::frame::inside
#import asvgf::color::{BRIGHTEST, is_finite, sanitize}
#import asvgf::packing::pack_rgb
#ifdef ALBEDO
#import asvgf::packing::round_to_f16
#endif
#ifdef DIAGNOSTICS
#import asvgf::counts::counts
#endif
#ifdef RESHADE
#import asvgf::strata::{is_sample_pixel, previous_pixel, stratum_of}
#endif

@group(0) @binding(1) var radiance: texture_2d<f32>;
@group(0) @binding(2) var radiance_out: texture_storage_2d<rg32uint, write>;
#ifdef ALBEDO
@group(0) @binding(3) var albedo: texture_2d<f32>;
@group(0) @binding(4) var albedo_out: texture_storage_2d<rgba16float, write>;
#ifdef MODULATED
@group(0) @binding(5) var guide: texture_2d<u32>;
#ifdef RESHADE
@group(0) @binding(6) var samples: texture_2d<u32>;
@group(0) @binding(7) var albedo_previous: texture_2d<f32>;
#endif
#endif
#endif
#ifdef DIRECT_EMISSION
@group(0) @binding(8) var emission: texture_2d<f32>;
@group(0) @binding(9) var emission_out: texture_storage_2d<rg32uint, write>;
#endif

#ifdef DIAGNOSTICS
var<private> not_finite: bool = false;
var<private> below_zero: bool = false;
#endif

fn clean(color: vec3<f32>) -> vec3<f32> {
#ifdef DIAGNOSTICS
    let finite = vec3(is_finite(color.x), is_finite(color.y), is_finite(color.z));
    not_finite |= !all(finite);
    below_zero |= any(finite & (color < vec3(0.0)));
#endif
    return sanitize(color);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    var r = clean(textureLoad(radiance, pixel, 0).xyz);
#ifdef DIRECT_EMISSION
    let e = clean(textureLoad(emission, pixel, 0).xyz);
    textureStore(emission_out, pixel, vec4(pack_rgb(e), 0u, 0u));
#ifdef MODULATED
    // Where colour and emission disagree by a pixel, as at a light's edge, light must not become negative.
    r = max(r - e, vec3(0.0));
#endif
#endif
#ifdef ALBEDO
    // Below the limit of f16.
    var a = min(clean(textureLoad(albedo, pixel, 0).xyz), vec3(65472.0));
#ifdef MODULATED
    let hit = textureLoad(guide, pixel, 0).y != 0u;
    a = round_to_f16(select(vec3(1.0), max(a, vec3(1e-3)), hit));
    var divisor = a;
#ifdef RESHADE
    // What was shaded here is the surface that another pixel saw in the last frame: its albedo is the one to divide by.
    let record = textureLoad(samples, vec2<i32>(stratum_of(id.xy)), 0);
    if is_sample_pixel(record, id.xy) {
        divisor = max(textureLoad(albedo_previous, previous_pixel(record), 0).xyz, vec3(1e-3));
    }
#endif
    r /= divisor;
#endif
    textureStore(albedo_out, pixel, vec4(a, 0.0));
#endif
    textureStore(radiance_out, pixel, vec4(pack_rgb(min(r, vec3(BRIGHTEST))), 0u, 0u));
#ifdef DIAGNOSTICS
    if not_finite {
        atomicAdd(&counts.non_finite, 1u);
    }
    if below_zero {
        atomicAdd(&counts.negative, 1u);
    }
#endif
}
