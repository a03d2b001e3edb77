//! Reprojection and blending.

use super::bench::{SIZES, Texel};
use super::codec::{
    VARIANCE_UNIT, assert_close, depth, float, float_code, history_exponent, luminance, rounding, unpack_history,
    unpack_normal, unpack_rgb, unpack_tap, variance_code,
};
use super::last_frame::{Before, Given, INFINITE, NO_SAMPLE, Notes};
use super::plane::{V, add, scale};
use super::strata::{Site, exponent, falloff};
use crate::passes::{Nth, Step, temporal};
use crate::plan::{Feature, Image};
use crate::{FilterSettings, Settings};

/// A pixel's result by the formulas.
#[derive(Debug, Default)]
pub(super) struct Blended {
    pub(super) color: V,
    pub(super) mean: f64,
    pub(super) variance: f64,
    pub(super) length: f64,
    pub(super) lambda: f64,
    /// Weight of the sample.
    alpha: f64,
    /// The last output, reprojected and rescaled, and its weight in this one.
    last_output: V,
    steadiness: f64,
    /// True if the sample is not wholly believed.
    outlier: bool,
    /// True if a threshold was so near that rounding may decide differently.
    unsure: bool,
    /// The largest numbers that went in; errors are relative to these.
    largest: f64,
}

impl Given {
    fn run(&self) -> std::collections::BTreeMap<&'static str, Vec<Texel>> {
        let step = Step::nth(&temporal::PASS, self.features, Nth::of(Some(Image::Gradient(0))));
        self.bench.run(&step, &self.inputs(&step))
    }

    /// Ratio and λ of the strata around a pixel on its surface: from 2×2 of them, or else from 4×4.
    fn change(&self, i: usize, x: i32, y: i32, unsure: &mut bool) -> ([f64; 4], f64) {
        let z = depth(self.guide[i]);
        let here = Site { position: self.bench.position(x, y, z), normal: unpack_normal(self.guide[i][0]), depth: z };
        let grid = [x, y].map(|p| (f64::from(p) + 0.5) / 3.0 - 0.5);
        let base = grid.map(|g| g.floor() as i32);
        let mut found = ([1.0; 4], 0.0);
        for ring in [0, 1] {
            let (mut weights, mut ratio) = (0.0, [0.0; 4]);
            let (mut gradient, mut around) = ([0.0; 2], [0.0; 2]);
            for (sx, sy) in
                (-ring..=1 + ring).flat_map(|dy| (-ring..=1 + ring).map(move |dx| (base[0] + dx, base[1] + dy)))
            {
                let Some(s) = self.bench.stratum(sx, sy).filter(|&s| self.samples[s][0] != 0) else { continue };
                let exponent = exponent(&here, &self.bench.site(self.samples[s], sx, sy), here.depth);
                let tent = [(sx, grid[0]), (sy, grid[1])].map(|(s, g)| (1.0 - (g - f64::from(s)).abs()).max(0.05));
                let w = tent[0] * tent[1] * falloff(exponent);
                for c in [0, 1] {
                    gradient[c] += w * float(self.gradient[s][c]);
                    around[c] += tent[0] * tent[1] * float(self.gradient[s][c + 2]);
                }
                for (sum, &r) in ratio.iter_mut().zip(&self.ratio[s]) {
                    *sum += w * float(r);
                }
                weights += w;
            }
            *unsure |= (weights / 1e-4 - 1.0).abs() < 0.1;
            // The strata on any surface count too, so that thin surfaces do not miss a change.
            let part = |[numerator, denominator]: [f64; 2]| {
                if denominator > 0.0 { numerator.abs() / denominator } else { 0.0 }
            };
            let dead_zone = f64::from(self.bench.settings.filter.gradient_dead_zone);
            let across = if self.has(Feature::AcrossSurfaces) { part(around) } else { 0.0 };
            let across = across + across.powi(3);
            let lambda = (part(gradient).max(across) - dead_zone).clamp(0.0, 1.0);
            found = (if weights > 0.0 { ratio.map(|r| r / weights) } else { [1.0; 4] }, lambda);
            if weights > 1e-4 {
                break;
            }
        }
        found
    }

    /// The level that a sample is compared with.
    fn level(&self, before: &Before) -> f64 {
        let output = if self.has(Feature::Steady) { luminance(before.output) } else { 0.0 };
        luminance(before.color).max(output)
    }

    /// The host's λ, if it is a number.
    fn external_lambda(&self, x: i32, y: i32) -> f64 {
        let block = self.bench.lambda_block as i32;
        let across = self.bench.size[0].div_ceil(self.bench.lambda_block) as i32;
        let value = float(self.external[(y / block * across + x / block) as usize][0]);
        let lambda = if self.has(Feature::Confidence) { 1.0 - value } else { value };
        if value.is_finite() { lambda.clamp(0.0, 1.0) } else { 0.0 }
    }

    pub(super) fn twin(&self, x: i32, y: i32) -> Blended {
        let i = self.bench.at(x, y).unwrap();
        let f = &self.bench.settings.filter;
        let mut sample = unpack_rgb([self.radiance[i][0], self.radiance[i][1] & !INFINITE]);
        let mut l = luminance(sample);
        let sampled = self.radiance[i] != NO_SAMPLE && self.radiance[i][1] & INFINITE == 0;
        let length = if sampled { 1.0 } else { 0.0 };
        let mut out = Blended { color: sample, mean: l, length, alpha: 1.0, ..Default::default() };
        let mut notes = Notes { largest: sample.into_iter().fold(l, f64::max), ..Default::default() };
        let before = self.bench.continued.then(|| self.before(i, x, y, &mut notes)).flatten();
        (out.unsure, out.largest) = (notes.unsure, notes.largest);
        let level = before.as_ref().map_or([0.0; 2], |b| [self.level(b), b.length]);
        if before.is_some() && self.has(Feature::Gradient) {
            out.lambda = self.change(i, x, y, &mut out.unsure).1;
        }
        if before.is_some() && self.has(Feature::ExternalLambda) {
            out.lambda = self.external_lambda(x, y);
        }
        let belief = self
            .has(Feature::Outliers)
            .then(|| self.belief([x, y], l, [level[0], level[1], out.lambda], &mut out.unsure));
        if let Some(belief) = belief {
            // Without a history, the result is the sample as far as it is believed; the rest is as bright as the pixels around.
            let doubted = belief.around.min(l) / l.max(1e-37);
            let first = belief.weight * belief.scale + (1.0 - belief.weight) * doubted;
            out.color = scale(sample, first);
            out.mean = l * first;
            out.outlier = sampled && belief.weight < 1.0;
            sample = scale(sample, belief.scale);
            l *= belief.scale;
        }
        let Some(mut before) = before else { return out };
        // The history of a still image may be longer than other histories.
        let mut kept = before.length.min(f.max_history.into());
        let mut rescaled = 1.0;
        out.last_output = before.output;
        if self.has(Feature::Gradient) {
            let (ratio, lambda) = self.change(i, x, y, &mut out.unsure);
            if self.has(Feature::HistoryRatio) {
                before.color = [0, 1, 2].map(|c| before.color[c] * ratio[c]);
                before.mean *= ratio[3];
                rescaled = ratio[3];
                out.last_output = [0, 1, 2].map(|c| before.output[c] * ratio[c]);
                before.variance *= ratio[3].powi(2);
                out.largest *= 4.0;
            }
            kept *= (1.0 - lambda).powf(f.history_power.into());
        }
        if self.has(Feature::ExternalLambda) {
            kept *= (1.0 - out.lambda).powf(f.history_power.into());
        }
        let least = f64::from(f.alpha);
        out.length = (kept + 1.0).min(f.max_history.into());
        let mut alpha = if self.has(Feature::BlendByLambda) {
            let base = least.max(1.0 / (before.length + 1.0));
            ((1.0 - out.lambda) * base + out.lambda).max(1.0 / (kept + 1.0))
        } else {
            least.max(1.0 / out.length)
        };
        if alpha > 1.0 / out.length {
            // The effective number of samples is 1/Σw², for weights that add up to 1.
            let worth = 1.0 / ((1.0 - alpha).powi(2) / kept.max(1e-9) + alpha.powi(2));
            out.length = worth.min(f.max_history.into());
        }
        if let Some(belief) = belief {
            (alpha, out.length) = if belief.confirmed {
                (1.0, 1.0)
            } else {
                (alpha * belief.weight, kept + belief.weight * (out.length - kept))
            };
        }
        let stratum = self.bench.stratum(x / 3, y / 3).unwrap();
        if self.has(Feature::InPlace) && self.samples[stratum][0] as i32 == y % 3 * 3 + x % 3 + 1 {
            // A repeated path is no new sample: it only replaces what λ drops.
            alpha = out.lambda * belief.map_or(1.0, |b| b.weight);
            out.length = kept.max(1.0);
        }
        if !sampled {
            alpha = 0.0;
            let trusted = if self.radiance[i] == NO_SAMPLE { kept } else { 0.5 * kept };
            out.unsure |= (trusted - 0.5).abs() < 1e-3;
            out.length = if trusted > 0.5 { trusted.max(1.0) } else { 0.0 };
        }
        out.alpha = alpha;
        // The weight depends on the k frames before this one; it is 0 where the light changes, and smaller between pixels.
        let k = (out.length - 1.0).max(0.0);
        let f = if self.has(Feature::Still) { [0.0; 2] } else { [0, 1].map(|a| self.motion[i][a].rem_euclid(1.0)) };
        let between = 2.0 * f.iter().map(|f| f * (1.0 - f)).sum::<f64>();
        let unchanged = (1.0 - out.lambda).powi(2) * (1.0 - 20.0 * (rescaled - 1.0).abs()).max(0.0);
        let most = f64::from(self.bench.settings.filter.steadiness);
        out.steadiness = (unchanged * k / (k + 1.0)).min(most) * (1.0 - between).max(0.0);
        let deviation = l - before.mean;
        out.color = add(scale(before.color, 1.0 - alpha), scale(sample, alpha));
        out.mean = before.mean + alpha * deviation;
        out.variance = (1.0 - alpha) * (before.variance + alpha * deviation * deviation);
        out
    }
}

fn check(features: &[Feature], settings: &Settings) {
    let (mut compared, mut unsure, mut followed, mut outliers) = (0, 0, 0, 0);
    for (size, moving, continued) in
        SIZES.into_iter().flat_map(|s| [(s, false, true), (s, true, true), (s, true, false)])
    {
        let mut given = Given::new(size, features, settings.clone(), moving);
        given.bench.continued = continued;
        let written = given.run();
        for (x, y) in given.bench.pixels() {
            let i = given.bench.at(x, y).unwrap();
            let history = written["history_out"][i];
            let what = || format!("{size:?} ({x}, {y}), moving {moving}, continued {continued}, {:?}", given.features);
            let weights = written.get("weights_out").map(|w| [w[i][0], w[i][1]].map(float));
            if depth(given.guide[i]) == 0.0 {
                assert_eq!(history, [0; 4], "{}: a miss", what());
                assert_eq!(weights.unwrap_or_default(), [0.0; 2], "{}: a miss", what());
                continue;
            }
            let expected = given.twin(x, y);
            compared += 1;
            if expected.unsure {
                unsure += 1;
                continue;
            }
            outliers += usize::from(expected.outlier);
            if let (Some([alpha, _]), true) = (weights, given.has(Feature::Outliers)) {
                assert_eq!(alpha < 0.0, expected.outlier, "{}: an outlier", what());
            }
            let weights = weights.map(|[alpha, lambda]| [alpha.abs(), lambda]);
            for (found, expected) in weights.into_iter().flatten().zip([expected.alpha, expected.lambda]) {
                assert_close(found, expected, 2e-3, || format!("{}: α, λ", what()));
            }
            if let Some(reprojected) = written.get("reprojected_out") {
                let (output, weight) = unpack_tap(reprojected[i]);
                assert_close(weight, expected.steadiness, 0.04, || format!("{}: steadiness", what()));
                let largest = expected.last_output.into_iter().fold(0.0, f64::max);
                for (found, expected) in output.into_iter().zip(expected.last_output) {
                    assert_close(found, expected, 5e-3 * largest + 1e-9, || format!("{}: last output", what()));
                }
            }
            if expected.length == 0.0 {
                if given.radiance[i][1] & INFINITE != 0 {
                    // Without a history, its colour is kept to be shown.
                    let sample = unpack_rgb([given.radiance[i][0], given.radiance[i][1] & !INFINITE]);
                    let kept = unpack_history([history[0], history[1]]);
                    let error = luminance(kept.color) - luminance(sample);
                    let largest = sample.into_iter().fold(0.0, f64::max);
                    assert!(kept.length == 0.0 && error.abs() <= 1e-3 * largest, "{}: infinite", what());
                } else {
                    assert_eq!(history, [0; 4], "{}: neither a sample nor a history", what());
                }
                continue;
            }
            followed += usize::from(expected.length > 1.0);
            // Weights between strata are precise to 1e-4, and so is λ; a power of up to ten multiplies that error.
            let tolerance = 2e-3 * expected.largest + 1e-30;
            let mut color = expected.color;
            if given.has(Feature::Feedback) {
                let fed = written["feedback_out"][i];
                for (found, expected) in unpack_rgb([fed[0], fed[1]]).into_iter().zip(color) {
                    assert_close(found, expected, tolerance, || format!("{}: colour", what()));
                }
                color = [expected.mean; 3];
            }
            assert_kept(
                [history[0], history[1]],
                &expected,
                color,
                tolerance,
                rounding([x as u32, y as u32], 5),
                &what,
            );
        }
    }
    println!(
        "{features:?}: {compared} pixels, {followed} with a history, {outliers} outliers, {unsure} at a threshold"
    );
    let outliers_are_there = !features.contains(&Feature::Outliers) || outliers * 50 >= compared;
    assert!(outliers_are_there, "{features:?}: {outliers} outliers");
    assert!(unsure * 10 <= compared && followed * 4 >= compared, "{features:?}: the test has lost its grip");
}

/// Asserts that a number was rounded correctly, given the expected number and its tolerance.
fn assert_kept(words: [u32; 2], expected: &Blended, color: V, tolerance: f64, random: V, what: &dyn Fn() -> String) {
    let bits = u64::from(words[0]) | u64::from(words[1]) << 32;
    let field = |shift: u32, width: u32| (bits >> shift & ((1 << width) - 1)) as f64;
    let between = |found: f64, [low, high]: [f64; 2], random: f64, name: &str| {
        // The shader rounds with fewer bits.
        let [low, high] = [(low + random - 1e-3).floor(), (high + random + 1e-3).floor()];
        assert!(low <= found && found <= high, "{}: {name} {found}, not {low}…{high}", what());
    };
    let exponent = field(39, 8) - 127.0;
    let squared = 4e-3 * expected.largest.powi(2) + 1e-30;
    let around = |x: f64, error: f64| [x - error, x + error].map(|x| x.max(0.0));
    let [low, high] = [0, 1].map(|end| {
        f64::from(history_exponent(color.map(|c| around(c, tolerance)[end]), around(expected.variance, squared)[end]))
    });
    assert!(low <= exponent && exponent <= high, "{}: exponent {exponent}, not {low}…{high}", what());
    let scale = exponent.exp2();
    for (shift, c) in [0, 13, 26].into_iter().zip(color) {
        between(field(shift, 13), around(c, tolerance).map(|c| c / scale * 8192.0), random[0], "colour");
    }
    // The code of 2⁻²⁰ is 0, which stands for no variance.
    let variance = |v: f64| variance_code((v / (scale * scale)).max(VARIANCE_UNIT));
    let [low, high] = around(expected.variance, squared).map(variance);
    between(field(47, 9), [if low < 16.0 { -1.0 } else { low }, high.max(16.0)], random[1], "variance");
    let length = [1.0 - 2e-3, 1.0 + 2e-3].map(|part| float_code((expected.length * part).max(1.0), 16.0) + 1.0);
    between(field(56, 8), length, random[2], "length");
}

#[test]
fn every_reachable_kind_of_blending() {
    use Feature::*;
    let power = |history_power| Settings {
        filter: FilterSettings { history_power, max_history: 12.0, alpha: 0.1, ..Default::default() },
        ..Settings::adaptive()
    };
    check(&[], &power(3.5));
    check(&[Objects], &power(3.5));
    check(&[Feedback], &power(3.5));
    check(&[Still], &power(3.5));
    check(&[Still, Objects, Feedback], &power(3.5));
    check(&[Gradient, BlinnPhong], &power(3.5));
    check(&[Gradient, InPlace, Objects], &power(1.0));
    check(&[Gradient, AcrossSurfaces, InPlace, HistoryRatio], &power(3.5));
    check(&[Gradient, InPlace, HistoryRatio], &power(3.5));
    check(&[Gradient, InPlace, BlendByLambda, Feedback], &power(2.0));
    check(&[Gradient, InPlace, HistoryRatio, BlendByLambda, Feedback, Objects], &power(0.0));
    // Steadiness by the last output.
    check(&[Steady, Objects], &power(3.5));
    check(&[Steady, Still], &power(3.5));
    check(&[Steady, Gradient, InPlace, AcrossSurfaces, HistoryRatio], &power(3.5));
    check(&[Steady, MissingSamples, ExternalLambda], &power(3.5));
    // Samples that are not believed.
    check(&[Outliers, KeepWeights], &power(3.5));
    check(&[Outliers, Steady, Still, MissingSamples], &power(3.5));
    check(&[Outliers, Steady, Gradient, InPlace, AcrossSurfaces, HistoryRatio, KeepWeights], &power(3.5));
    check(&[Outliers, ExternalLambda, MissingSamples, KeepWeights], &power(3.5));
    // Weights that are kept for views.
    check(&[Gradient, InPlace, AcrossSurfaces, HistoryRatio, KeepWeights], &power(3.5));
    check(&[Gradient, InPlace, BlendByLambda, Feedback, KeepWeights], &power(2.0));
    check(&[Still, BlendByLambda, Feedback, KeepWeights], &power(2.0));
    // A host's frames.
    check(&[MissingSamples, Objects], &power(3.5));
    check(&[MissingSamples, Still, Feedback], &power(3.5));
    check(&[MissingSamples, Gradient, InPlace, HistoryRatio, KeepWeights], &power(3.5));
    check(&[MissingSamples, ExternalLambda, BlendByLambda, KeepWeights], &power(2.0));
    check(&[ExternalLambda], &power(3.5));
    check(&[ExternalLambda, Confidence, BlendByLambda, Objects], &power(2.0));
    let mut signed = power(3.5);
    (signed.filter.gradient_signed, signed.filter.gradient_dead_zone) = (true, 0.1);
    check(&[Gradient], &signed);
    check(&[Gradient, AcrossSurfaces], &signed);
}
