// One à-trous iteration over the strata grid, on the gradient's numerator and denominator: x and y on the stratum's own surface,
// z and w on any (ACROSS_SURFACES).

#import asvgf::frame::frame
#import asvgf::strata_filter::{site, tap_weight, tent, in_grid}

@group(0) @binding(1) var<uniform> stride: i32;
@group(0) @binding(4) var gradient_out: texture_storage_2d<rgba32uint, write>;

#ifdef STORAGE_READS
@group(0) @binding(2) var samples: texture_storage_2d<rgba32uint, read>;
@group(0) @binding(3) var gradient: texture_storage_2d<rgba32uint, read>;

fn record_of(stratum: vec2<i32>) -> vec4<u32> {
    return textureLoad(samples, stratum);
}

fn gradient_of(stratum: vec2<i32>) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(gradient, stratum));
}
#else
@group(0) @binding(2) var samples: texture_2d<u32>;
@group(0) @binding(3) var gradient: texture_2d<u32>;

fn record_of(stratum: vec2<i32>) -> vec4<u32> {
    return textureLoad(samples, stratum, 0);
}

fn gradient_of(stratum: vec2<i32>) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(gradient, stratum, 0));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let record = record_of(stratum);
    var sum = vec4(0.0);
    // On the own surface, on any.
    var weights = vec2(0.0);
    if record.x != 0u {
        let center = site(record, stratum);
        for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let offset = vec2(x, y);
                let tap = stratum + offset * stride;
                let clamped = clamp(tap, vec2(0), vec2<i32>(frame.strata) - 1);
                let other = record_of(clamped);
#ifdef ACROSS_SURFACES
                let there = vec2(tap_weight(center, site(other, clamped), offset, stride), tent(offset));
#else
                let there = vec2(tap_weight(center, site(other, clamped), offset, stride), 0.0);
#endif
                let w = select(vec2(0.0), there, in_grid(tap) && other.x != 0u);
                sum += w.xxyy * gradient_of(clamped);
                weights += w;
            }
        }
    }
    textureStore(gradient_out, stratum, bitcast<vec4<u32>>(sum / max(weights, vec2(1.0)).xxyy));
}
