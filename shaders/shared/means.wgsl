#define_import_path asvgf::means

// Means over samples i of one surface, of a stratum or of the strata around it: the evidence of change where there are no pairs.

#import asvgf::packing::{pack_rgb, unpack_rgb}

struct Means {
    // Mean of the new samples, s.
    now: vec3<f32>,
    // Mean of the reprojected histories, m.
    before: vec3<f32>,
    // Σw²(v + v/n)/(Σw)²: the variance of s − m as the histories know it, where v is the variance of a sample's luminance.
    variance: f32,
    // Σw²·l(s)², Σw²·l(s)·l(m), Σw²·l(m)², each over (Σw)²: the same variance as the samples show it, for any ratio of the two.
    now_square: f32,
    product: f32,
    before_square: f32,
}

// Packs the means into two texels.
fn pack_now(means: Means) -> vec4<u32> {
    return vec4(pack_rgb(means.now), bitcast<u32>(means.now_square), bitcast<u32>(means.variance));
}

fn pack_before(means: Means) -> vec4<u32> {
    return vec4(pack_rgb(means.before), bitcast<u32>(means.before_square), bitcast<u32>(means.product));
}

fn unpack_means(now: vec4<u32>, before: vec4<u32>) -> Means {
    return Means(
        unpack_rgb(now.xy),
        unpack_rgb(before.xy),
        bitcast<f32>(now.w),
        bitcast<f32>(now.z),
        bitcast<f32>(before.w),
        bitcast<f32>(before.z),
    );
}

// Divides weighted sums by the sum of weights; `scale` is its inverse.
fn scaled(sum: Means, scale: f32) -> Means {
    let square = scale * scale;
    return Means(
        sum.now * scale,
        sum.before * scale,
        sum.variance * square,
        sum.now_square * square,
        sum.product * square,
        sum.before_square * square,
    );
}
