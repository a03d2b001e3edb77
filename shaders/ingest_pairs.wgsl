// Turns the pairs of radiances that a host made, one path each, now and in the previous frame, into records and demodulated
// radiances of the strata. gradient.wgsl goes on with them.

#import asvgf::frame::{frame, inside}
#import asvgf::color::{BRIGHTEST, is_finite, luminance}
#import asvgf::packing::pack_rgb
#ifdef DIAGNOSTICS
#import asvgf::counts::counts
#endif
#ifdef ALBEDO
#ifdef HOST_LIGHT
#import asvgf::host_light::host_albedo
#else
#import asvgf::host_light::LEAST_ALBEDO
#endif
#endif

@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var current: texture_2d<f32>;
@group(0) @binding(3) var previous: texture_2d<f32>;
#ifdef MODULATED
#ifdef ALBEDO
#ifndef HOST_LIGHT
@group(0) @binding(4) var albedo: texture_2d<f32>;
#endif
#endif
#endif
@group(0) @binding(5) var samples_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(6) var pair_now_out: texture_storage_2d<rg32uint, write>;
@group(0) @binding(7) var pair_before_out: texture_storage_2d<rg32uint, write>;

fn value(texel: vec4<f32>) -> vec3<f32> {
#ifdef LUMINANCE_PAIRS
    return texel.xxx;
#else
    return texel.xyz;
#endif
}

// Divisor that makes the pair comparable with demodulated radiance.
fn divisor_at(pixel: vec2<i32>) -> vec3<f32> {
    var divisor = vec3(1.0);
#ifdef MODULATED
#ifdef ALBEDO
#ifdef HOST_LIGHT
    // Only called where there is a surface.
    divisor = host_albedo(pixel, true);
#else
    // A hole has an albedo of 0, see `is_hole` in host_light.wgsl.
    divisor = max(textureLoad(albedo, pixel, 0).xyz, vec3(LEAST_ALBEDO));
#endif
#ifdef LUMINANCE_PAIRS
    divisor = vec3(luminance(divisor));
#endif
#endif
#endif
    return divisor;
}

fn finite(v: vec3<f32>) -> bool {
    return is_finite(v.x) && is_finite(v.y) && is_finite(v.z);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.strata) {
        return;
    }
    let stratum = vec2<i32>(id.xy);
    var record = vec4(0u);
    var now = vec3(0.0);
    var before = vec3(0.0);
    var broken = false;
#ifdef STRATUM_PAIRS
    // The pair stands for the stratum's centre or, at the image's edge, for the pixel nearest to it.
    let center = min(stratum * 3 + 1, vec2<i32>(frame.size) - 1);
    let first = u32(center.y - stratum.y * 3) * 3u + u32(center.x - stratum.x * 3);
    let last = first + 1u;
#else
    let first = 0u;
    let last = 9u;
#endif
    for (var place = first; place < last; place++) {
        let pixel = stratum * 3 + vec2<i32>(vec2(place % 3u, place / 3u));
        if record.x != 0u || !inside(pixel) {
            continue;
        }
#ifdef STRATUM_PAIRS
        let at = stratum;
#else
        let at = pixel;
#endif
        let c = value(textureLoad(current, at, 0));
        let p = value(textureLoad(previous, at, 0));
        broken |= !(finite(c) && finite(p));
        let g = textureLoad(guide, pixel, 0).xy;
        // −1 says that there is no pair.
        if !finite(c) || !finite(p) || any(min(c, p) < vec3(0.0)) || g.y == 0u {
            continue;
        }
        record = vec4(place + 1u, 0u, g);
        let divisor = divisor_at(pixel);
        now = c / divisor;
        before = p / divisor;
    }
    textureStore(samples_out, stratum, record);
    textureStore(pair_now_out, stratum, vec4(pack_rgb(min(now, vec3(BRIGHTEST))), 0u, 0u));
    textureStore(pair_before_out, stratum, vec4(pack_rgb(min(before, vec3(BRIGHTEST))), 0u, 0u));
#ifdef DIAGNOSTICS
    if broken {
        atomicAdd(&counts.pairs, 1u);
    }
#endif
}
