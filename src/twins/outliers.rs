//! Outliers: candidates, the limit from the surrounding strata, and the belief in a sample.

use super::bench::{Bench, SIZES, Texel};
use super::codec::{assert_close, depth, float, luminance, unpack_rgb, word};
use super::last_frame::Given;
use super::random::Random;
use crate::Settings;
use crate::passes::{Step, outlier_candidates, outlier_counts, outlier_limit};
use crate::plan::{Feature, Features};

const MOST_RATIO: f64 = 1e9;
const LEAST_LEVEL: f64 = 0.25;

/// A stratum's record.
#[derive(Clone, Copy, Debug, Default)]
struct Candidate {
    brightest: f64,
    implied: f64,
    ordinary: f64,
    expected: f64,
    place: u32,
    sightings: u32,
    running: u32,
    seen: u32,
    lit: u32,
    candidates: u32,
    length: f64,
}

impl Candidate {
    fn pack(self) -> Texel {
        let counts = self.place
            | self.sightings << 4
            | self.seen << 7
            | self.lit << 11
            | self.candidates << 15
            | self.running << 19;
        let length =
            if self.length > 0.0 { ((word(self.length.clamp(1.0, 32768.0)) - 0x3f80_0000) >> 18) + 1 } else { 0 };
        let brief = |x: f64| (word(x) + 0x7fff) >> 16;
        [
            word(self.brightest),
            word(self.implied),
            counts | length << 22,
            brief(self.ordinary) | brief(self.expected) << 16,
        ]
    }

    fn unpack(t: Texel) -> Self {
        let field = |shift: u32, bits: u32| t[2] >> shift & ((1 << bits) - 1);
        Self {
            brightest: float(t[0]),
            implied: float(t[1]),
            ordinary: float(t[3] << 16),
            expected: float(t[3] & 0xffff_0000),
            place: field(0, 4),
            sightings: field(4, 3),
            seen: field(7, 4),
            lit: field(11, 4),
            candidates: field(15, 4),
            running: field(19, 3),
            length: match t[2] >> 22 {
                0 => 0.0,
                code => float(((code - 1) << 18) + 0x3f80_0000),
            },
        }
    }
}

/// The limit of a stratum.
#[derive(Clone, Copy, Debug, Default)]
struct Limit {
    ratio: f64,
    level: f64,
    expected: f64,
    asked: u32,
    place: u32,
    sightings: u32,
    running: u32,
}

impl Limit {
    /// `ratio` is 1, 8·4^k for k = 0…12, or 3·10³⁸.
    fn pack(self) -> Texel {
        let class = match self.ratio {
            1.0 => 0,
            3e38 => 14,
            power => (power.log2() as u32 - 1) / 2,
        };
        let counts = self.place | self.sightings << 4 | self.running << 7 | self.asked << 10 | class << 13;
        [word(self.level), counts | (word(self.expected) >> 16) << 17, 0, 0]
    }

    fn unpack(t: Texel) -> Self {
        let field = |shift: u32, bits: u32| t[1] >> shift & ((1 << bits) - 1);
        Self {
            ratio: match field(13, 4) {
                0 => 1.0,
                14 => 3e38,
                class => 2_f64.powi(2 * class as i32 + 1),
            },
            level: float(t[0]),
            expected: float(t[1] >> 17 << 16),
            asked: field(10, 3),
            place: field(0, 4),
            sightings: field(4, 3),
            running: field(7, 3),
        }
    }
}

/// The facts on a stratum that the next frame needs.
#[derive(Clone, Copy, Debug, Default)]
struct Memory {
    brightest: f64,
    implied: f64,
    around: f64,
    expected: f64,
    place: u32,
    sightings: u32,
    running: u32,
}

impl Memory {
    fn pack(self) -> Texel {
        let counts = self.place | self.sightings << 4 | self.running << 7;
        [word(self.brightest), word(self.implied), word(self.around), counts | word(self.expected) & 0xffff_0000]
    }

    fn unpack(t: Texel) -> Self {
        Self {
            brightest: float(t[0]),
            implied: float(t[1]),
            around: float(t[2]),
            expected: float(t[3] & 0xffff_0000),
            place: t[3] & 0xf,
            sightings: t[3] >> 4 & 7,
            running: t[3] >> 7 & 7,
        }
    }
}

/// The bound B = limit·level·max(1, min(n, longest history)/64).
pub(super) fn bound(settings: &Settings, level: f64, length: f64) -> f64 {
    let length = length.min(settings.filter.max_history.into());
    f64::from(settings.filter.outlier_limit) * level * (length / 64.0).max(1.0)
}

/// The ratio l/B.
pub(super) fn ratio_to(bound: f64, l: f64) -> f64 {
    if l > 0.0 { (l / bound.max(l / MOST_RATIO)).min(MOST_RATIO) } else { 0.0 }
}

/// True if a stratum beside a history believes light of this luminance, for pairs and means: `leeway` times as much as a sample.
/// The second is true if rounding decides.
pub(super) fn believed(settings: &Settings, limit: Texel, history: [f64; 2], l: f64, leeway: f64) -> (bool, bool) {
    let limit = Limit::unpack(limit);
    let [level, length] = history;
    let most = leeway * bound(settings, level.max(limit.expected).max(limit.level), length);
    let ratio = ratio_to(most, l);
    (ratio <= limit.ratio, (ratio / limit.ratio - 1.0).abs() < 1e-2)
}

/// The belief in a sample: its weight, the factor on its luminance, and true if it was seen so often that the history must be
/// wrong.
#[derive(Clone, Copy, Debug)]
pub(super) struct Belief {
    pub(super) weight: f64,
    pub(super) scale: f64,
    pub(super) confirmed: bool,
    pub(super) around: f64,
}

impl Given {
    /// The belief in a sample. `level` and `length` are those of the history, 0 if there is none. Notes that a threshold is near.
    pub(super) fn belief(
        &self,
        [x, y]: [i32; 2],
        l: f64,
        [level, length, lambda]: [f64; 3],
        unsure: &mut bool,
    ) -> Belief {
        let stratum = self.bench.stratum(x / 3, y / 3).unwrap();
        let limit = Limit::unpack(self.limit[stratum]);
        let known = level.max(LEAST_LEVEL * limit.expected).max(lambda * limit.level);
        let base = if length > 0.0 { known } else { limit.level };
        let ratio = ratio_to(bound(&self.bench.settings, base, length), l);
        *unsure |= (ratio / limit.ratio - 1.0).abs() < 1e-2;
        let over = ratio > limit.ratio;
        let here = limit.place as i32 == y % 3 * 3 + x % 3 + 1;
        let confirmed = here && limit.sightings == limit.asked || over && limit.running >= limit.asked;
        let mut scale = if over && !confirmed { limit.ratio / ratio } else { 1.0 };
        if self.has(Feature::ExternalLambda) {
            // The host's λ comes first.
            scale += (1.0 - scale) * lambda;
        }
        Belief { weight: scale * scale, scale, confirmed, around: limit.level }
    }
}

/// Records that a frame may make.
fn candidates(bench: &Bench, random: &mut Random) -> Vec<Texel> {
    let [across, down] = bench.size.map(|s| s.div_ceil(3));
    (0..across * down)
        .map(|_| {
            let mut below = |n: u32| random.below(n as usize) as u32;
            let (seen, place) = (below(10), below(10));
            let record = Candidate {
                place,
                sightings: if place == 0 { 0 } else { 1 + below(7) },
                seen,
                lit: below(seen + 1),
                candidates: below(seen + 1),
                running: if below(4) == 0 { below(8) } else { 0 },
                length: f64::from(below(200)),
                ..Default::default()
            };
            let mut some = |none: usize| match random.below(none) {
                0 => 0.0,
                _ => 10_f64.powf(random.between(-3.0, 3.0)),
            };
            let record =
                Candidate { brightest: some(3), implied: some(8), ordinary: some(8), expected: some(8), ..record };
            Candidate::unpack(record.pack()).pack()
        })
        .collect()
}

/// Limits that a frame may make.
pub(super) fn limits(bench: &Bench, random: &mut Random) -> Vec<Texel> {
    let of = |candidate| {
        let Candidate { place, sightings, running, .. } = Candidate::unpack(candidate);
        let ratio = [1.0, 1.0, 8.0, 3e38][random.below(4)];
        let level = [0.0, 1e-3, 0.02][random.below(3)];
        let asked = if random.below(2) == 0 { 3 } else { 6 };
        Limit { ratio, level, expected: 0.01 * random.unit(), asked, place, sightings, running }.pack()
    };
    candidates(bench, &mut Random(3)).into_iter().map(of).collect()
}

/// What a frame may leave.
fn memories(bench: &Bench, random: &mut Random) -> Vec<Texel> {
    let of = |(candidate, limit)| {
        let Candidate { brightest, implied, place, sightings, running, .. } = Candidate::unpack(candidate);
        let Limit { expected, .. } = Limit::unpack(limit);
        Memory { brightest, implied, around: random.unit(), expected, place, sightings, running }.pack()
    };
    let candidates = candidates(bench, &mut Random(7));
    candidates.into_iter().zip(limits(bench, &mut Random(8))).map(of).collect()
}

/// A stratum's record by the formulas; the second is true if a threshold was near.
fn twin(given: &Given, [sx, sy]: [i32; 2], before: &[Texel]) -> (Candidate, bool) {
    let bench = &given.bench;
    let mut unsure = false;
    let mut now = Candidate::default();
    let mut last_stratum = None;
    let mut farthest = 0.0;
    let mut implied = 0.0;
    let mut length = 0.0;
    let mut carried = (0, 0);
    // These samples have no history.
    let mut fresh: Vec<(f64, u32, u32)> = Vec::new();
    for at in [4, 5, 6, 7, 8, 0, 1, 2, 3] {
        let (x, y) = (sx * 3 + at % 3, sy * 3 + at / 3);
        let Some(i) = bench.at(x, y).filter(|&i| depth(given.guide[i]) > 0.0) else { continue };
        let own = given.samples[bench.stratum(sx, sy).unwrap()][0] as i32 == at + 1;
        let sample = given.sample(i);
        let m = if given.has(Feature::Still) { [0.0; 3] } else { given.motion[i] };
        let was = [f64::from(x) + 0.5 + m[0], f64::from(y) + 0.5 + m[1]];
        unsure |= was.iter().any(|p| (p - p.round()).abs() < 1e-4);
        let tap = was.map(|p| p.floor() as i32);
        let q = bench.continued.then(|| bench.at(tap[0], tap[1])).flatten();
        let n = q.map_or(0.0, |q| given.history[q].length);
        let there = q.map(|_| bench.stratum(tap[0] / 3, tap[1] / 3).unwrap());
        let last_one = there.map(|there| Memory::unpack(before[there]));
        let was_one = last_one.filter(|last| last.place as i32 == tap[1] % 3 * 3 + tap[0] % 3 + 1);
        let Some(sample) = sample.filter(|_| !(given.has(Feature::InPlace) && own)) else {
            carried = was_one.map_or(carried, |last| (at as u32 + 1, last.sightings));
            continue;
        };
        let l = luminance(sample);
        now.seen += 1;
        if let (None, Some(there)) = (last_stratum, there) {
            last_stratum = Some(there);
            length = n;
        }
        let sightings = was_one.map_or(0, |last| {
            unsure |= (2.0 * l / last.brightest - 1.0).abs() < 1e-3;
            if 2.0 * l >= last.brightest { last.sightings } else { 0 }
        });
        let place = at as u32 + 1;
        let Some(q) = q.filter(|_| n > 0.0) else {
            fresh.push((l, place, sightings));
            continue;
        };
        let mut level = luminance(given.history[q].color);
        if given.has(Feature::Steady) {
            level = level.max(luminance(unpack_rgb([given.output[q][0], given.output[q][1]])));
        }
        let least = level.max(LEAST_LEVEL * last_one.unwrap().expected);
        let ratio = ratio_to(bound(&bench.settings, least, n), l);
        unsure |= (ratio - 0.5).abs() < 1e-3 || (ratio / farthest - 1.0_f64).abs() < 1e-3;
        let candidate = ratio > 0.5 || (1..7).contains(&sightings) && l > 0.0;
        now.expected += level;
        if candidate {
            now.candidates += 1;
            implied += l.min(MOST_RATIO * least);
            if ratio > farthest {
                farthest = ratio;
                (now.brightest, now.place, now.sightings) = (l, place, (sightings + 1).min(7));
            }
        } else {
            now.ordinary += l;
            now.lit += u32::from(l > 0.0);
        }
    }
    let sum: f64 = fresh.iter().map(|f| f.0).sum();
    let largest = fresh.iter().fold((0.0, 0, 0), |a, &b| if b.0 > a.0 { b } else { a });
    let others = (sum - largest.0) / (fresh.len() as f64 - 1.0).max(1.0);
    let ratio = ratio_to(bound(&bench.settings, others, 1.0), largest.0);
    let candidate = fresh.len() > 1 && ratio > 0.5;
    // Sums of f32 cancel, so rounding may decide.
    unsure |= !fresh.is_empty() && ((ratio - 0.5).abs() < 1e-3 || others < 1e-5 * sum && others > 0.0);
    unsure |= fresh.len() > 1 && (ratio / farthest - 1.0).abs() < 1e-3;
    let rest = sum - if candidate { largest.0 } else { 0.0 };
    if candidate {
        now.candidates += 1;
        implied += largest.0.min(MOST_RATIO * others);
        if ratio > farthest {
            (now.brightest, now.place, now.sightings) = (largest.0, largest.1, (largest.2 + 1).min(7));
        }
    }
    now.ordinary += rest;
    now.expected += rest;
    if others > 0.0 {
        now.lit += fresh.len() as u32 - u32::from(candidate);
    }
    let found = now.place != 0;
    if now.place == 0 {
        (now.place, now.sightings) = carried;
    }
    now.implied = implied;
    now.length = length;
    if let Some(there) = last_stratum {
        let last = Memory::unpack(before[there]);
        now.brightest = now.brightest.max(0.6 * last.brightest);
        now.running = last.running;
        now.implied = last.implied + (implied - last.implied) / (length + 1.0_f64).min(16.0);
        let dark = 1e-10 * last.around * f64::from(now.seen);
        unsure |= (now.ordinary / dark - 1.0).abs() < 1e-2;
        if now.ordinary <= dark {
            now.lit = 0;
        }
    }
    now.running = match found {
        true => (now.running + 1).min(7),
        // This frame added no knowledge.
        false if carried.0 != 0 => now.running,
        false => 0,
    };
    (now, unsure)
}

#[test]
fn candidates_are_what_is_far_above_its_level() {
    use Feature::*;
    let kinds: [&[Feature]; 5] =
        [&[], &[Steady], &[Still, Steady, MissingSamples], &[Gradient, InPlace, Steady], &[MissingSamples, Steady]];
    let (mut compared, mut found, mut unsure) = (0, 0, 0);
    for (size, features) in SIZES.into_iter().flat_map(|s| kinds.map(|k| (s, k))) {
        for (moving, continued) in [(false, true), (true, true), (true, false)] {
            let mut given = Given::new(size, features, Settings::adaptive(), moving);
            given.bench.continued = continued;
            let before = memories(&given.bench, &mut Random(9));
            let step = Step::new(&outlier_candidates::PASS, given.features);
            let mut inputs = given.inputs(&step);
            inputs.push(("memory_previous", before.clone()));
            let written = &given.bench.run(&step, &inputs)["candidates_out"];
            let [across, down] = size.map(|s| s.div_ceil(3) as i32);
            for (sx, sy) in (0..down).flat_map(|sy| (0..across).map(move |sx| (sx, sy))) {
                let (expected, near) = twin(&given, [sx, sy], &before);
                compared += 1;
                if near {
                    unsure += 1;
                    continue;
                }
                found += usize::from(expected.place > 0);
                let actual = Candidate::unpack(written[given.bench.stratum(sx, sy).unwrap()]);
                let what = format!("{size:?} ({sx}, {sy}) {features:?}, moving {moving}, continued {continued}");
                let counts = |c: Candidate| [c.place, c.sightings, c.running, c.seen, c.lit, c.candidates];
                assert_close(actual.length, expected.length, expected.length / 31.0, || what.clone());
                assert_eq!(counts(actual), counts(expected), "{what}: {expected:?}");
                let sums = |c: Candidate| [c.brightest, c.implied, c.ordinary, c.expected];
                for (a, e) in sums(actual).into_iter().zip(sums(expected)) {
                    assert_close(a, e, 6e-3 * e + 1e-2 * 1e-5, || format!("{what}: {expected:?}"));
                }
            }
        }
    }
    assert!(found * 8 > compared && unsure * 5 < compared, "{found} of {compared}, {unsure} unsure: no grip");
}

/// The limit of a stratum and its memory, from all records of its window at once; the last is true if a threshold was near.
fn limit(bench: &Bench, records: &[Texel], [sx, sy]: [i32; 2]) -> (Limit, Memory, bool) {
    let extent = bench.size.map(|s| s.div_ceil(3) as i32);
    let range = |at: i32, extent: i32| {
        let start = (at - 6).clamp(0, (extent - 13).max(0));
        start..(start + 13).min(extent)
    };
    let (columns, rows) = (range(sx, extent[0]), range(sy, extent[1]));
    let mut classes = Vec::new();
    let (mut sums, mut strata, mut lit, mut few, mut all_seen) = ([0.0; 3], 0.0, 0.0, 0.0, 0.0_f64);
    for y in rows {
        let row: Vec<_> = columns.clone().map(|x| Candidate::unpack(records[bench.stratum(x, y).unwrap()])).collect();
        let seen: u32 = row.iter().map(|c| c.seen).sum();
        all_seen += f64::from(seen);
        few += f64::from(row.iter().map(|c| c.candidates).sum::<u32>().min(78));
        let least = LEAST_LEVEL * row.iter().map(|c| c.expected).sum::<f64>() / f64::from(seen.max(1));
        for c in row {
            let level = (c.expected / f64::from(c.seen.max(1))).max(least);
            let ratio = ratio_to(bound(&bench.settings, level, c.length), c.brightest);
            if ratio >= 0.5 {
                classes.push(((2.0 * ratio).log2() / 2.0).min(14.99));
            }
            strata += f64::from(u32::from(c.seen > 0));
            for (sum, x) in sums.iter_mut().zip([c.implied, c.ordinary, c.expected]) {
                *sum += x;
            }
            lit += f64::from(c.lit);
        }
    }
    let here = Candidate::unpack(records[bench.stratum(sx, sy).unwrap()]);
    let most = 1.2 * sums[1].max(sums[2]);
    let doubtful = sums[0] > most && lit > 0.15 * all_seen && few < 0.2 * lit;
    let asked = ((6.0 + 4.0 * (here.length / 3.0).min(1.0)) * (strata / 169.0_f64).sqrt()).ceil().max(3.0);
    let mut unsure = (sums[0] / most - 1.0).abs() < 1e-3 || (lit / (0.15 * all_seen) - 1.0).abs() < 1e-6;
    unsure |= (few / (0.2 * lit) - 1.0).abs() < 1e-6;
    // A ratio on the border of two classes may be in either.
    unsure |= classes.iter().any(|c| (c - c.round()).abs() < 1e-4);
    let believed = (0..15).rev().find(|&k| classes.iter().filter(|c| **c >= f64::from(k)).count() as f64 >= asked);
    let sightings_asked = if doubtful { 6 } else { 3 };
    let ratio = match believed.filter(|_| !doubtful) {
        // Without any sample, everything is believed.
        _ if strata == 0.0 => 3e38,
        None => 1.0,
        Some(13 | 14) => 3e38,
        Some(k) => 8.0 * 4_f64.powi(k),
    };
    let pixels = all_seen.max(1.0);
    let [around, level, expected] = sums.map(|s| s / pixels);
    let Candidate { brightest, implied, place, sightings, running, .. } = here;
    let limit = Limit { ratio, level, expected, asked: sightings_asked, place, sightings, running };
    (limit, Memory { brightest, implied, around, expected, place, sightings, running }, unsure)
}

#[test]
fn a_limit_is_what_the_window_has_seen() {
    let (mut believed, mut doubted, mut compared, mut unsure) = (0, 0, 0, 0);
    for (size, seed) in [[1, 1], [7, 5], [33, 17], [60, 44], [130, 9]].into_iter().flat_map(|s| [(s, 1), (s, 2)]) {
        let bench = Bench::new(size, Settings::adaptive());
        let records: Vec<Texel> = candidates(&bench, &mut Random(seed))
            .into_iter()
            .map(|texel| {
                // There are hardly any candidates, or many.
                let mut c = Candidate::unpack(texel);
                if seed == 1 {
                    (c.candidates, c.lit) = (0, c.seen);
                    c.implied *= 100.0;
                } else {
                    c.brightest *= 100.0;
                }
                c.pack()
            })
            .collect();
        let input = || ("candidates", records.clone());
        let mut written = bench.run(&Step::new(&outlier_counts::PASS, Features::default()), &[input()]);
        let inputs = [
            input(),
            ("candidate_counts", written.remove("counts_out").unwrap()),
            ("sums", written.remove("sums_out").unwrap()),
        ];
        let written = &bench.run(&Step::new(&outlier_limit::PASS, Features::default()), &inputs);
        let [across, down] = size.map(|s| s.div_ceil(3) as i32);
        for (sx, sy) in (0..down).flat_map(|sy| (0..across).map(move |sx| (sx, sy))) {
            let (expected, kept, near) = limit(&bench, &records, [sx, sy]);
            compared += 1;
            if near {
                unsure += 1;
                continue;
            }
            let stratum = bench.stratum(sx, sy).unwrap();
            let actual = Limit::unpack(written["limit_out"][stratum]);
            let memory = Memory::unpack(written["memory_out"][stratum]);
            let what = || format!("{size:?} ({sx}, {sy}), seed {seed}: {expected:?}");
            let counts = |l: Limit| [l.asked, l.place, l.sightings, l.running];
            assert_eq!(counts(actual), counts(expected), "{}", what());
            let counts = |m: Memory| [m.place, m.sightings, m.running];
            assert_eq!(counts(memory), counts(kept), "{}", what());
            assert_close(actual.ratio, expected.ratio, 1e-6 * expected.ratio, what);
            believed += usize::from(expected.ratio > 1.0);
            doubted += usize::from(expected.asked == 6);
            let sums = |l: Limit, m: Memory| [l.level, l.expected, m.brightest, m.implied, m.around, m.expected];
            for (a, e) in sums(actual, memory).into_iter().zip(sums(expected, kept)) {
                assert_close(a, e, 6e-3 * e, what);
            }
        }
    }
    assert!(believed > 50 && doubted > 50 && unsure * 5 < compared, "{believed} {doubted} {unsure} of {compared}");
}
