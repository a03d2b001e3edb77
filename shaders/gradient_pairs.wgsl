// The two radiances of each stratum's path, now (f) and in the previous frame (f′), and the products of luminances from which the
// variance of the history ratio follows.

#import asvgf::frame::frame
#import asvgf::color::luminance
#import asvgf::pair_taps::radiances_of
#import asvgf::pairs::{Pair, pack_now, pack_before}

@group(0) @binding(1) var samples: texture_2d<u32>;
@group(0) @binding(4) var now_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(5) var before_out: texture_storage_2d<rgba32uint, write>;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    let record = textureLoad(samples, stratum, 0);
    var now = vec3(0.0);
    var before = vec3(0.0);
    if record.x != 0u {
        let radiances = radiances_of(record, stratum);
        now = radiances.now;
        before = radiances.before;
    }
    let l = luminance(now);
    let l_before = luminance(before);
    let pair = Pair(vec4(now, l * l), vec4(before, l_before * l_before), l * l_before);
    textureStore(now_out, stratum, pack_now(pair));
    textureStore(before_out, stratum, pack_before(pair));
}
