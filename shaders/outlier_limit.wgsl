// How far above its level a sample may be in each stratum, by what 13×13 strata around have seen.
//
// If k strata have a candidate in one class of ratios or above, samples up to the end of the next class are light: k is 6, and 10 once
// there is a history. That fails where a burst of equal brightness hits a lit
// surface. So none is believed if the candidates imply more than 1.2 times the light that the others show, and are few beside these.

#import asvgf::frame::frame
#import asvgf::outliers::{Limit, WINDOW, pack_limit, unpack_candidate, window_start}

@group(0) @binding(1) var candidates: texture_2d<u32>;
@group(0) @binding(2) var candidate_counts: texture_2d<u32>;
@group(0) @binding(3) var sums: texture_2d<u32>;
@group(0) @binding(4) var limit_out: texture_storage_2d<rgba32uint, write>;

// Light that candidates may imply, in parts of what there is.
const IMPLIED: f32 = 1.2;

// Least part of the pixels that have to be lit by other samples, for these to say anything, and the most candidates beside each.
const LIT: f32 = 0.15;
const FEW: f32 = 0.2;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var count = vec4(0u);
    var sum = vec3(0.0);
    var pixels = 0u;
    let start = window_start(stratum.y, frame.strata.y);
    for (var y = start; y < min(start + WINDOW, i32(frame.strata.y)); y++) {
        let place = vec2(stratum.x, y);
        count += textureLoad(candidate_counts, place, 0);
        let s = textureLoad(sums, place, 0);
        sum += bitcast<vec3<f32>>(s.xyz);
        pixels += s.w;
    }
    let here = unpack_candidate(textureLoad(candidates, stratum, 0));
    let strata = f32(count.w >> 24u);
    let lit = f32(pixels & 0x7ffu);
    let seen = f32((pixels >> 11u) & 0x7ffu);
    let few = f32(pixels >> 22u);
    let doubtful = sum.x > IMPLIED * max(sum.y, sum.z) && lit > LIT * seen && few < FEW * lit;
    let asked = max(3.0, ceil((6.0 + 4.0 * min(here.length / 3.0, 1.0)) * sqrt(strata / f32(WINDOW * WINDOW))));
    var above = 0.0;
    let sightings = select(3u, 6u, doubtful);
    // Where nothing was seen, nothing speaks against a sample.
    var ratio = select(1.0, 3e38, strata == 0.0);
    // From the brightest class down.
    for (var k = 14; k >= 0; k--) {
        let word = count[k >> 2u];
        above += f32((word >> (8u * u32(k & 3))) & 0xffu);
        // ½·4^(k + 2), and everything from the last class but one on.
        let reach = select(bitcast<f32>(u32(127 + 3 + 2 * k) << 23u), 3e38, k >= 13);
        ratio = max(ratio, select(0.0, reach, above >= asked && !doubtful));
    }
    let limit = Limit(ratio, sum.y / max(seen, 1.0), sum.x / max(seen, 1.0), sum.z / max(seen, 1.0), sightings);
    textureStore(limit_out, stratum, pack_limit(limit));
}
