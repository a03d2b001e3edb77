#define_import_path asvgf::outliers

// The bound on a sample's luminance, from the light that its surroundings have shown.
//
// Failure: twelve pixels of 6·10⁴ in each of eight frames made a room of 0.15 brighter by a factor of 128 on average. Reason: a
// mean has no bound on what one sample can do to it. Rule: a sample of luminance l is believed as far as
//
//   l ≤ R·B,  B = limit·level·max(1, min(n, longest history)/64)
//
// The level is the greatest of four: the luminance of the history, that of the last output, a quarter of the mean level around, and
// λ times the mean luminance around in this frame. B grows with the history length n, so that the most that one sample can do to a
// mean stays the same, and a still image still converges. R is 1, unless several strata around have seen samples as far above their
// levels: light that few paths find is light all the same. docs/filter.md has the measurements.

#import asvgf::frame::frame

// A stratum's brightest candidate and the sums over its pixels, see outlier_candidates.wgsl.
struct Candidate {
    // Luminance of the candidate, which fades from frame to frame; 0 for none.
    brightest: f32,
    // Slow mean over frames of the sum of the candidates' luminances.
    implied: f32,
    // Sum of the luminances of all other samples.
    ordinary: f32,
    // Sum of the levels.
    expected: f32,
    // Pixel of the candidate in the stratum, 1…9 row by row; 0 if this frame has none.
    place: u32,
    // Frames running in which that pixel's surface was a candidate.
    sightings: u32,
    // Frames running in which the stratum had a candidate, whichever.
    running: u32,
    // Number of pixels with a sample.
    seen: u32,
    // Number of those that are lit and no candidates.
    lit: u32,
    // Number of candidates.
    candidates: u32,
    // History length, to 1/32 of it.
    length: f32,
}

// Packs a non-negative f32 into its upper 16 bits, rounded: 8 bits of mantissa are left.
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

// The limit on samples of a stratum, see outlier_limit.wgsl. It takes 64 bits.
struct Limit {
    // Class of R in the rule above, see `ratio_of`.
    ratio_class: u32,
    // Mean luminance of the samples around that are no candidates. It is the level where there is no history.
    level: f32,
    // Mean level around.
    expected: f32,
    // Sightings running after which a sample is believed, however bright.
    asked: u32,
    // Place, sightings and running sightings of the stratum's candidate, see `Candidate`.
    place: u32,
    sightings: u32,
    running: u32,
}

// The last class of R.
const ALL: u32 = 14u;

// R of a class: 1 for 0, 8·4^(k − 1) for k, and everything is believed in the last one.
fn ratio_of(ratio_class: u32) -> f32 {
    let power = bitcast<f32>((128u + 2u * ratio_class) << 23u);
    return select(select(power, 1.0, ratio_class == 0u), 3e38, ratio_class == ALL);
}

fn pack_limit(limit: Limit) -> vec2<u32> {
    let counts = limit.place | (limit.sightings << 4u) | (limit.running << 7u) | (limit.asked << 10u) | (limit.ratio_class << 13u);
    return vec2(bitcast<u32>(limit.level), counts | (pack_brief(limit.expected) << 17u));
}

fn unpack_limit(bits: vec2<u32>) -> Limit {
    return Limit(
        (bits.y >> 13u) & 0xfu,
        bitcast<f32>(bits.x),
        bitcast<f32>((bits.y >> 17u) << 16u),
        (bits.y >> 10u) & 0x7u,
        bits.y & 0xfu,
        (bits.y >> 4u) & 0x7u,
        (bits.y >> 7u) & 0x7u,
    );
}

// The facts on a stratum that the next frame's candidates depend on. They take 128 bits.
struct Memory {
    // Luminance of the candidate, and the light that candidates imply, see `Candidate`.
    brightest: f32,
    implied: f32,
    // Slow mean of the light that the candidates around imply, per pixel.
    around: f32,
    // Mean level around.
    expected: f32,
    // Place, sightings and running sightings of the candidate.
    place: u32,
    sightings: u32,
    running: u32,
}

fn pack_memory(memory: Memory) -> vec4<u32> {
    let counts = memory.place | (memory.sightings << 4u) | (memory.running << 7u);
    return vec4(
        bitcast<u32>(memory.brightest),
        bitcast<u32>(memory.implied),
        bitcast<u32>(memory.around),
        counts | (pack_brief(memory.expected) << 16u),
    );
}

fn unpack_memory(bits: vec4<u32>) -> Memory {
    return Memory(
        bitcast<f32>(bits.x),
        bitcast<f32>(bits.y),
        bitcast<f32>(bits.z),
        bitcast<f32>(bits.w & 0xffff0000u),
        bits.w & 0xfu,
        (bits.w >> 4u) & 0x7u,
        (bits.w >> 7u) & 0x7u,
    );
}

// Width of the window of strata around one that is asked, in strata.
const WINDOW: i32 = 13;

// First stratum of the window around one. At the image's border the window moves inwards.
fn window_start(stratum: i32, strata: u32) -> i32 {
    return clamp(stratum - WINDOW / 2, 0, max(i32(strata) - WINDOW, 0));
}

// Greatest ratio l/B that is told from others.
const MOST_RATIO: f32 = 1e9;

// Least ratio l/B of a candidate.
const LEAST_RATIO: f32 = 0.5;

// Least level, in parts of the mean level around: where few paths find light, a pixel's own level is often far too low.
const LEAST_LEVEL: f32 = 0.25;

// History length from which on B grows with it: α is below 1/64 there, and n/64 keeps the most that a sample adds, α·B, the same.
const GROWS_FROM: f32 = 64.0;

#ifdef GLOSS
// Factor on the limit where diffuse and specular light are signals of their own. Failure: a room with metal and plastic was 4 % too dark.
// Reason: fewer paths find the light of one lobe, so its samples are farther apart. Rule: a limit of 100 instead of 40.
const SPLIT: f32 = 2.5;
#else
const SPLIT: f32 = 1.0;
#endif

// The bound B = limit·level·max(1, n/64).
fn bound(level: f32, length: f32) -> f32 {
    return SPLIT * frame.outlier_limit * level * max(1.0, min(length, frame.max_history) / GROWS_FROM);
}

// l/B, at most `MOST_RATIO`; 0 for a black sample.
fn ratio_to(bound: f32, l: f32) -> f32 {
    return select(0.0, min(l / max(max(bound, l / MOST_RATIO), 1e-37), MOST_RATIO), l > 0.0);
}
