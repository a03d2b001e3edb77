// One à-trous iteration over the grid of strata, on the gradient's numerator and denominator: x and y on the stratum's own surface,
// z and w on any surface (ACROSS_SURFACES).

#import asvgf::strata_filter::site
#import asvgf::strata_taps::{record_of, tap_at}
#ifdef ACROSS_SURFACES
#import asvgf::strata_filter::tent
#endif

@group(0) @binding(4) var gradient_out: texture_storage_2d<rgba32uint, write>;

#ifdef STORAGE_READS
@group(0) @binding(3) var gradient: texture_storage_2d<rgba32uint, read>;

fn gradient_of(stratum: vec2<i32>) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(gradient, stratum));
}
#else
@group(0) @binding(3) var gradient: texture_2d<u32>;

fn gradient_of(stratum: vec2<i32>) -> vec4<f32> {
    return bitcast<vec4<f32>>(textureLoad(gradient, stratum, 0));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let record = record_of(stratum);
    var sum = vec4(0.0);
    // Sums of weights on the own surface, and on any.
    var weights = vec2(0.0);
    if record.x != 0u {
        let center = site(record, stratum);
        for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let offset = vec2(x, y);
                let tap = tap_at(center, stratum, offset);
#ifdef ACROSS_SURFACES
                let w = vec2(tap.weight, select(0.0, tent(offset), tap.exists));
#else
                let w = vec2(tap.weight, 0.0);
#endif
                sum += w.xxyy * gradient_of(tap.stratum);
                weights += w;
            }
        }
    }
    textureStore(gradient_out, stratum, bitcast<vec4<u32>>(sum / max(weights, vec2(1.0)).xxyy));
}
