// Makes the next coarser level of the means, see means_taps.wgsl.

#import asvgf::means::{pack_before, pack_now}
#import asvgf::means_taps::coarser_means
#import asvgf::strata_taps::record_of

@group(0) @binding(5) var now_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(6) var before_out: texture_storage_2d<rgba32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let means = coarser_means(stratum, record_of(stratum));
    textureStore(now_out, stratum, pack_now(means));
    textureStore(before_out, stratum, pack_before(means));
}
