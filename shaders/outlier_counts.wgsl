// Counts the strata of a row that have a candidate, by the candidate's ratio, and sums up their pixels. The row is the 13 strata
// around each stratum; outlier_limit.wgsl adds up 13 rows.
//
// A count is a byte, because 13×13 strata are fewer than 256. The candidates' ratios, from ½ on, fall into 15 classes by powers of
// 4; the last byte counts the strata that have a sample.

#import asvgf::frame::frame
#import asvgf::outliers::{LEAST_LEVEL, LEAST_RATIO, WINDOW, bound, ratio_to, unpack_candidate, window_start}

@group(0) @binding(1) var candidates: texture_2d<u32>;
@group(0) @binding(2) var counts_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(3) var sums_out: texture_storage_2d<rgba32uint, write>;

// Most candidates of a row that are counted: 13 rows of them fit into the ten bits that the numbers of lit and of seen pixels (11
// each) leave. More are never few, see outlier_limit.wgsl.
const MOST_OF_A_ROW: u32 = 78u;

// The last of the 15 classes.
const LAST_CLASS: u32 = 14u;

// Class of a ratio r ≥ ½: ⌊½·log₂(2r)⌋, from the exponent's bits.
fn class_of(ratio: f32) -> u32 {
    return min(((bitcast<u32>(ratio) >> 23u) - 126u) >> 1u, LAST_CLASS);
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var counts = vec4(0u);
    var sums = vec3(0.0);
    var pixels = 0u;
    var candidates_seen = 0u;
    let start = window_start(stratum.x, frame.strata.x);
    let end = min(start + WINDOW, i32(frame.strata.x));
    var expected = 0.0;
    var seen = 0.0;
    for (var x = start; x < end; x++) {
        let c = unpack_candidate(textureLoad(candidates, vec2(x, stratum.y), 0));
        expected += c.expected;
        seen += f32(c.seen);
    }
    let least = LEAST_LEVEL * expected / max(seen, 1.0);
    for (var x = start; x < end; x++) {
        let place = vec2(x, stratum.y);
        let c = unpack_candidate(textureLoad(candidates, place, 0));
        let ratio = ratio_to(bound(max(c.expected / f32(max(c.seen, 1u)), least), c.length), c.brightest);
        let class_number = class_of(ratio);
        let one = select(0u, 1u << (8u * (class_number & 3u)), ratio >= LEAST_RATIO);
        counts += select(vec4(0u), vec4(one), vec4(class_number >> 2u) == vec4(0u, 1u, 2u, 3u));
        counts.w += select(0u, 1u << 24u, c.seen > 0u);
        sums += vec3(c.implied, c.ordinary, c.expected);
        pixels += c.lit | (c.seen << 11u);
        candidates_seen += c.candidates;
    }
    textureStore(counts_out, stratum, counts);
    pixels |= min(candidates_seen, MOST_OF_A_ROW) << 22u;
    textureStore(sums_out, stratum, vec4(bitcast<vec3<u32>>(sums), pixels));
}
