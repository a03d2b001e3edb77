//! The guards recognise numbers that are not finite, although a compiler may assume that all are.

use super::compute::compute;
use super::random::Random;
use crate::passes::resolve;
use crate::plan::Features;

/// `BRIGHTEST` of color.wgsl: the greatest number that passes.
const BRIGHTEST: f32 = 1e15;

/// Bits of numbers, and of NaN and infinities: quiet and signalling NaN of either sign with the least, the greatest and other
/// payloads, infinities, both zeros, denormals, and the largest numbers.
const BITS: [u32; 20] = [
    0x7fc0_0000,
    0xffc0_0000,
    0x7f80_0001,
    0xff80_0001,
    0x7fbf_ffff,
    0x7fff_ffff,
    0xffff_ffff,
    0x7fc1_2345,
    0x7f80_0000,
    0xff80_0000,
    0x0000_0000,
    0x8000_0000,
    0x0000_0001,
    0x007f_ffff,
    0x8000_0001,
    0x0080_0000,
    0x7f7f_ffff,
    0xff7f_ffff,
    0x3f80_0000,
    0xbf80_0000,
];

/// Every triple of those, and random bits.
fn colors() -> Vec<[f32; 4]> {
    let mut random = Random(7);
    let mut any = || f32::from_bits((random.unit() * 4294967296.0) as u32);
    let random: Vec<[f32; 4]> = (0..10_000).map(|_| [any(), any(), any(), 0.0]).collect();
    let triples = BITS.iter().flat_map(|&r| BITS.iter().flat_map(move |&g| BITS.iter().map(move |&b| [r, g, b])));
    triples.map(|[r, g, b]| [r, g, b, 0].map(f32::from_bits)).chain(random).collect()
}

#[test]
fn what_is_not_a_number_is_seen_and_stopped() {
    let colors = colors();
    let results = compute(include_str!("guards.wgsl"), &resolve::PASS, Features::default(), &colors, colors.len());
    for (color, found) in colors.iter().zip(results) {
        let what = || format!("{:08x?}", color.map(f32::to_bits));
        let finite: f32 = (0..3).map(|c| if color[c].is_finite() { [1.0, 2.0, 4.0][c] } else { 0.0 }).sum();
        assert_eq!(found[3], finite, "{}: which channels are finite", what());
        for channel in 0..3 {
            let given = color[channel];
            let passed = if given.is_finite() && given > 0.0 { given.min(BRIGHTEST) } else { 0.0 };
            // A device may flush denormals to 0 (WGSL, 15.7.2).
            let flushed = given.is_subnormal() && found[channel] == 0.0;
            assert!(found[channel] == passed || flushed, "{}: {} for {passed}", what(), found[channel]);
        }
    }
}
