// Finds how far above its level a sample may be in each stratum, from the 13×13 strata around.
//
// Light is seen by several strata: if k of them have a candidate in one class of ratios or above, samples up to the end of the next
// class are light, with
//
//   k = max(3, ⌈(6 + 4·min(n/3, 1))·√(N/169)⌉)       N strata of the window have a sample, n is the history length
//
// Failure: a burst of outliers of equal brightness passes that rule. Reason: it is in several strata too. Rule: no candidate is
// believed if they imply more than 1.2 times the light that the others show and are few beside the lit pixels.

#import asvgf::frame::frame
#import asvgf::outliers::{ALL, Limit, Memory, WINDOW, pack_limit, pack_memory, unpack_candidate, window_start}

@group(0) @binding(1) var candidates: texture_2d<u32>;
@group(0) @binding(2) var candidate_counts: texture_2d<u32>;
@group(0) @binding(3) var sums: texture_2d<u32>;
@group(0) @binding(4) var limit_out: texture_storage_2d<rg32uint, write>;
@group(0) @binding(5) var memory_out: texture_storage_2d<rgba32uint, write>;

// Most light that candidates may imply, in parts of the light that the others show. With 4 instead, one outlier in 100 samples has a
// relMSE of 47 (docs/filter.md).
const IMPLIED: f32 = 1.2;

// Least part of the pixels that other samples have to light for that rule to hold, and the most candidates per such pixel.
const LIT: f32 = 0.15;
const FEW: f32 = 0.2;

// Strata k that have to agree in a window of 13×13: without a history, how many more with one, the history length from which on
// those count in full, and the least number in a window with few samples.
const AGREEING: f32 = 6.0;
const MORE_WITH_HISTORY: f32 = 4.0;
const KNOWN_LENGTH: f32 = 3.0;
const LEAST_AGREEING: f32 = 3.0;

// Sightings running after which a sample is believed, and the same in doubt.
const SIGHTINGS: u32 = 3u;
const SIGHTINGS_IN_DOUBT: u32 = 6u;

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
    let wanted = (AGREEING + MORE_WITH_HISTORY * min(here.length / KNOWN_LENGTH, 1.0)) * sqrt(strata / f32(WINDOW * WINDOW));
    let asked = max(LEAST_AGREEING, ceil(wanted));
    var above = 0.0;
    let sightings = select(SIGHTINGS, SIGHTINGS_IN_DOUBT, doubtful);
    // All is believed where no sample was seen, because nothing speaks against one.
    var ratio_class = select(0u, ALL, strata == 0.0);
    // From the brightest class down.
    for (var k = 14; k >= 0; k--) {
        let word = count[k >> 2u];
        above += f32((word >> (8u * u32(k & 3))) & 0xffu);
        // The end of the next class is ½·4^(k + 2). From the last class but one on, all is believed.
        ratio_class = max(ratio_class, select(0u, min(u32(k + 1), ALL), above >= asked && !doubtful));
    }
    let around = sum / max(seen, 1.0);
    let limit = Limit(ratio_class, around.y, around.z, sightings, here.place, here.sightings, here.running);
    textureStore(limit_out, stratum, vec4(pack_limit(limit), 0u, 0u));
    let memory = Memory(here.brightest, here.implied, around.x, around.z, here.place, here.sightings, here.running);
    textureStore(memory_out, stratum, pack_memory(memory));
}
