#define_import_path asvgf::means_taps

// One à-trous iteration over the grid of strata, on both means with the same weights. Variances and squares take the squares of the
// weights.

#import asvgf::means::{Means, scaled, unpack_means}
#import asvgf::strata_filter::site
#import asvgf::strata_taps::tap_at

@group(0) @binding(4) var before: texture_2d<u32>;

// `before` is no storage texture: a device is only sure to have four, see `Feature::StorageReads`.
#ifdef STORAGE_READS
@group(0) @binding(3) var now: texture_storage_2d<rgba32uint, read>;

fn means_of(stratum: vec2<i32>) -> Means {
    return unpack_means(textureLoad(now, stratum), textureLoad(before, stratum, 0));
}
#else
@group(0) @binding(3) var now: texture_2d<u32>;

fn means_of(stratum: vec2<i32>) -> Means {
    return unpack_means(textureLoad(now, stratum, 0), textureLoad(before, stratum, 0));
}
#endif

// The means of a stratum with this record, on the next coarser level.
fn coarser_means(stratum: vec2<i32>, record: vec4<u32>) -> Means {
    var sum = Means();
    var weights = 0.0;
    if record.x != 0u {
        let center = site(record, stratum);
        for (var y = -1; y <= 1; y++) {
            for (var x = -1; x <= 1; x++) {
                let offset = vec2(x, y);
                let tap = tap_at(center, stratum, offset);
                let w = tap.weight;
                let means = means_of(tap.stratum);
                sum.now += w * means.now;
                sum.before += w * means.before;
                sum.variance += w * w * means.variance;
                sum.now_square += w * w * means.now_square;
                sum.product += w * w * means.product;
                sum.before_square += w * w * means.before_square;
                weights += w;
            }
        }
    }
    // The tent weighs 4 at the centre, so the sum of weights is at least 4 wherever there is a record.
    return scaled(sum, 1.0 / max(weights, 1.0));
}
