// One à-trous iteration over the grid of strata, on all channels of the pairs with the same weights.

#import asvgf::pairs::{Pair, pack_now, pack_before, unpack_pair}
#import asvgf::strata_filter::site
#import asvgf::strata_taps::{record_of, tap_at}

@group(0) @binding(4) var before: texture_2d<u32>;
@group(0) @binding(5) var now_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(6) var before_out: texture_storage_2d<rgba32uint, write>;

// `before` is no storage texture: a device is only sure to have four, see `Feature::StorageReads`.
#ifdef STORAGE_READS
@group(0) @binding(3) var now: texture_storage_2d<rgba32uint, read>;

fn pair_of(stratum: vec2<i32>) -> Pair {
    return unpack_pair(textureLoad(now, stratum), textureLoad(before, stratum, 0));
}
#else
@group(0) @binding(3) var now: texture_2d<u32>;

fn pair_of(stratum: vec2<i32>) -> Pair {
    return unpack_pair(textureLoad(now, stratum, 0), textureLoad(before, stratum, 0));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let record = record_of(stratum);
    var sum = Pair(vec4(0.0), vec4(0.0), 0.0);
    var weights = 0.0;
    if record.x != 0u {
        let center = site(record, stratum);
        for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let offset = vec2(x, y);
                let tap = tap_at(center, stratum, offset);
                let w = tap.weight;
                let pair = pair_of(tap.stratum);
                sum.now += w * pair.now;
                sum.before += w * pair.before;
                sum.product += w * pair.product;
                weights += w;
            }
        }
    }
    // The tent weighs 4 at the centre, so the sum of weights is at least 4 wherever there is a sample.
    let scale = 1.0 / max(weights, 1.0);
    let mean = Pair(sum.now * scale, sum.before * scale, sum.product * scale);
    textureStore(now_out, stratum, pack_now(mean));
    textureStore(before_out, stratum, pack_before(mean));
}
