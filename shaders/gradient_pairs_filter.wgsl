// One à-trous iteration over the strata grid, on all channels of the pairs with the same weights.

#import asvgf::frame::frame
#import asvgf::strata_filter::{site, tap_weight, in_grid}

@group(0) @binding(1) var<uniform> stride: i32;
@group(0) @binding(3) var now: texture_2d<f32>;
@group(0) @binding(4) var before: texture_2d<f32>;
@group(0) @binding(5) var product: texture_2d<f32>;
@group(0) @binding(6) var now_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(7) var before_out: texture_storage_2d<rgba32float, write>;
@group(0) @binding(8) var product_out: texture_storage_2d<r32float, write>;

#ifdef STORAGE_READS
@group(0) @binding(2) var samples: texture_storage_2d<rgba32uint, read>;

fn record_of(stratum: vec2<i32>) -> vec4<u32> {
    return textureLoad(samples, stratum);
}
#else
@group(0) @binding(2) var samples: texture_2d<u32>;

fn record_of(stratum: vec2<i32>) -> vec4<u32> {
    return textureLoad(samples, stratum, 0);
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let record = record_of(stratum);
    var sum_now = vec4(0.0);
    var sum_before = vec4(0.0);
    var sum_product = 0.0;
    var weights = 0.0;
    if record.x != 0u {
        let center = site(record, stratum);
        for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let offset = vec2(x, y);
                let tap = stratum + offset * stride;
                let clamped = clamp(tap, vec2(0), vec2<i32>(frame.strata) - 1);
                let other = record_of(clamped);
                let there = tap_weight(center, site(other, clamped), offset, stride);
                let w = select(0.0, there, in_grid(tap) && other.x != 0u);
                sum_now += w * textureLoad(now, clamped, 0);
                sum_before += w * textureLoad(before, clamped, 0);
                sum_product += w * textureLoad(product, clamped, 0).x;
                weights += w;
            }
        }
    }
    // The centre weighs 4 wherever there is a sample.
    let scale = 1.0 / max(weights, 1.0);
    textureStore(now_out, stratum, sum_now * scale);
    textureStore(before_out, stratum, sum_before * scale);
    textureStore(product_out, stratum, vec4(sum_product * scale));
}
