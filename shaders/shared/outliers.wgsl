#define_import_path asvgf::outliers

// How bright a sample may be beside what its surroundings have shown, in two texels per stratum.
//
// Failure: twelve pixels of 6·10⁴ in each of eight frames made a room of 0.15 brighter by a factor of 128 on average. Reason: a mean has no bound on what one sample can do to it. Rule: a sample of luminance l is believed as far as
//
//   l ≤ R·B,  B = limit·level·max(1, min(n, longest history)/64)
//
// where the level is the greatest of the history's luminance, of the last output's, of a quarter of the mean level around, and of λ times the
// mean around in this frame. B grows with the history length n, so that
// the most that one sample can do to a mean stays the same, and a still image still converges. R is 1 but where several strata around
// have seen samples as far above their levels: light that few paths find is light all the same.

#import asvgf::frame::frame

// The stratum's brightest candidate and what its pixels are made of, see outlier_candidates.wgsl.
struct Candidate {
    // Its luminance, fading from frame to frame; 0 for none.
    brightest: f32,
    // Slow mean of the candidates' sum of luminances.
    implied: f32,
    // Sum of luminances of all other samples, and of the levels.
    ordinary: f32,
    expected: f32,
    // Its pixel in the stratum, 1…9 row by row, 0 where this frame has none, and the frames running that its surface was one.
    place: u32,
    sightings: u32,
    // The frames running in which the stratum had one, whichever.
    running: u32,
    // Pixels with a sample, those of them that are lit and no candidates, and candidates.
    seen: u32,
    lit: u32,
    candidates: u32,
    // History length, to a 32nd.
    length: f32,
}

// A f32 with 8 bits of mantissa in 16 bits.
fn pack_brief(x: f32) -> u32 {
    return (bitcast<u32>(min(x, 3e38)) + 0x7fffu) >> 16u;
}

fn pack_candidate(c: Candidate) -> vec4<u32> {
    let counts = c.place | (c.sightings << 4u) | (c.seen << 7u) | (c.lit << 11u) | (c.candidates << 15u) | (c.running << 19u);
    let length = select(0u, ((bitcast<u32>(clamp(c.length, 1.0, 32768.0)) - 0x3f800000u) >> 18u) + 1u, c.length > 0.0);
    return vec4(
        bitcast<u32>(c.brightest),
        bitcast<u32>(c.implied),
        counts | (length << 22u),
        pack_brief(c.ordinary) | (pack_brief(c.expected) << 16u),
    );
}

fn unpack_candidate(bits: vec4<u32>) -> Candidate {
    return Candidate(
        bitcast<f32>(bits.x),
        bitcast<f32>(bits.y),
        bitcast<f32>(bits.w << 16u),
        bitcast<f32>(bits.w & 0xffff0000u),
        bits.z & 0xfu,
        (bits.z >> 4u) & 0x7u,
        (bits.z >> 19u) & 0x7u,
        (bits.z >> 7u) & 0xfu,
        (bits.z >> 11u) & 0xfu,
        (bits.z >> 15u) & 0xfu,
        select(0.0, bitcast<f32>((((bits.z >> 22u) - 1u) << 18u) + 0x3f800000u), (bits.z >> 22u) > 0u),
    );
}

// What is believed in a stratum, see outlier_limit.wgsl.
struct Limit {
    // R.
    ratio: f32,
    // Mean luminance of the samples around that are no candidates: the level where there is no history.
    level: f32,
    // Slow mean of what the candidates around would add to that.
    implied: f32,
    // Mean of the levels around.
    expected: f32,
    // Sightings in a row after which a sample is believed whatever it is.
    sightings: u32,
}

fn pack_limit(limit: Limit) -> vec4<u32> {
    return vec4(
        bitcast<u32>(limit.ratio),
        bitcast<u32>(limit.level),
        bitcast<u32>(limit.implied),
        pack_brief(limit.expected) | (limit.sightings << 16u),
    );
}

fn unpack_limit(bits: vec4<u32>) -> Limit {
    return Limit(
        bitcast<f32>(bits.x),
        bitcast<f32>(bits.y),
        bitcast<f32>(bits.z),
        bitcast<f32>(bits.w << 16u),
        bits.w >> 16u,
    );
}

// Strata of a window in each direction.
const WINDOW: i32 = 13;

// The first stratum of the window around one, which does not reach over the image's border.
fn window_start(stratum: i32, strata: u32) -> i32 {
    return clamp(stratum - WINDOW / 2, 0, max(i32(strata) - WINDOW, 0));
}

// Greatest ratio that is told from others.
const MOST_RATIO: f32 = 1e9;

// Part of the mean level around that a level is not below: where few paths find light, a pixel's own is as often far too low.
const LEAST_LEVEL: f32 = 0.25;

// B.
fn bound(level: f32, length: f32) -> f32 {
    return frame.outlier_limit * level * max(1.0, min(length, frame.max_history) / 64.0);
}

// l/B.
fn ratio_to(bound: f32, l: f32) -> f32 {
    return select(0.0, min(l / max(max(bound, l / MOST_RATIO), 1e-37), MOST_RATIO), l > 0.0);
}
