//! The promises of the settings' documentation.

use super::*;
use crate::plan::{Changes, Features, HostInputs, PairInputs, Plan};
use std::collections::BTreeSet;
use wgpu::TextureFormat;

#[test]
fn a_constant_alpha_may_be_anything_from_0_to_1() {
    for alpha in [0.0, 1e-30, 1e-6, 1.0 / 32768.0, 0.05, 0.5, 1.0] {
        let settings = Settings::adaptive().constant(alpha);
        settings.check().unwrap_or_else(|e| panic!("{alpha}: {e}"));
        // The history must be as long as such an average is worth, (2 − α)/α samples, up to the longest history.
        let worth = (2.0 / alpha - 1.0).min(LONGEST_HISTORY);
        assert!(alpha == 0.0 || settings.filter.max_history >= worth, "{alpha}");
    }
    for alpha in [-0.1, 1.1, f32::NAN] {
        let error = Settings::adaptive().constant(alpha).check().unwrap_err().to_string();
        assert!(error.contains("filter.alpha"), "{alpha}: {error}");
    }
}

#[test]
fn presets_are_within_their_ranges() {
    Settings::adaptive().check().unwrap();
    Settings::classic().check().unwrap();
    assert_ne!(Settings::adaptive(), Settings::classic());
}

#[test]
fn a_setting_is_found_by_its_name_and_has_words() {
    for setting in Setting::all() {
        let found = Setting::named(setting.name).map(|found| found.name);
        assert_eq!(found, Some(setting.name), "two have one name");
        assert!(setting.documentation.len() > 10, "{}", setting.name);
    }
    assert!(Setting::named("filter.nothing").is_none());
}

/// The same settings with another value for one of them.
fn with(base: &Settings, change: impl FnOnce(&mut Settings)) -> Settings {
    let mut settings = base.clone();
    change(&mut settings);
    settings
}

#[test]
fn numbers_are_accepted_to_the_ends_of_their_range_and_no_farther() {
    let base = Settings::adaptive();
    let accepts = |name: &str, change: &dyn Fn(&mut Settings)| match with(&base, change).check() {
        Ok(()) => true,
        Err(Error::Setting { setting, .. }) if setting == name => false,
        Err(error) => panic!("{name}: {error}"),
    };
    for setting in Setting::all() {
        match &setting.kind {
            SettingKind::Number { range, useful, field, .. } => {
                let accepts = |value| accepts(setting.name, &|s| *(field.get_mut)(s) = value);
                assert!(accepts(*range.start()) && accepts(*range.end()), "{}", setting.name);
                for outside in [range.start().next_down(), range.end().next_up(), f32::NAN] {
                    assert!(!accepts(outside), "{}: {outside}", setting.name);
                }
                assert!(range.contains(useful.start()) && range.contains(useful.end()), "{}", setting.name);
            }
            SettingKind::Whole { range, useful, field, .. } => {
                let accepts = |value| accepts(setting.name, &|s| *(field.get_mut)(s) = value);
                assert!(accepts(*range.start()) && accepts(*range.end()), "{}", setting.name);
                let outside = [range.start().checked_sub(1), range.end().checked_add(1)];
                assert!(!outside.into_iter().flatten().any(accepts), "{}", setting.name);
                assert!(range.contains(useful.start()) && range.contains(useful.end()), "{}", setting.name);
            }
            SettingKind::Switch { .. } => {}
            SettingKind::Choice { choices, get, set } => {
                for choice in choices() {
                    let chosen = with(&base, |s| assert!(set(s, choice.name), "{}", choice.name));
                    assert_eq!(get(&chosen), choice.name);
                }
                assert!(!set(&mut base.clone(), "nothing"));
            }
        }
    }
}

/// The base with several values of one setting.
fn varied(base: &Settings, setting: &Setting) -> Vec<Settings> {
    match &setting.kind {
        SettingKind::Number { useful, field, .. } => [0.0, 0.4, 0.8, 1.0]
            .map(|t| with(base, |s| *(field.get_mut)(s) = useful.start() + t * (useful.end() - useful.start())))
            .into(),
        SettingKind::Whole { useful, field, .. } => {
            let values = *useful.start()..=(*useful.end()).min(16);
            values.map(|value| with(base, |s| *(field.get_mut)(s) = value)).collect()
        }
        SettingKind::Switch { field } => [false, true].map(|on| with(base, |s| *(field.get_mut)(s) = on)).into(),
        SettingKind::Choice { choices, set, .. } => {
            choices().iter().map(|choice| with(base, |s| _ = set(s, choice.name))).collect()
        }
    }
}

/// The shaders that several kinds of frames run: each pass with its features.
fn shaders(settings: &Settings) -> Vec<BTreeSet<(&'static str, Features)>> {
    let target = TextureFormat::Rgba16Float;
    let inputs = [[false, false], [true, false], [false, true]].map(|[pairs, lambda]| HostInputs {
        pairs: pairs.then(PairInputs::default),
        lambda,
        specular: pairs,
        ..Default::default()
    });
    #[allow(unused_mut, reason = "without the path tracer these are all")]
    let mut plans: Vec<Plan> =
        inputs.iter().map(|inputs| Plan::hosted(inputs, settings, Changes::ANY, target)).collect();
    #[cfg(feature = "path-tracer")]
    {
        let contents = crate::plan::SceneContents { emitters: true, specular: true, levels: 20, ..Default::default() };
        plans.push(Plan::path_traced(&contents, settings, Changes::ANY, target));
    }
    plans.iter().map(|plan| plan.steps.iter().map(|step| (step.pass.name(), step.features)).collect()).collect()
}

#[test]
fn settings_say_whether_a_change_compiles() {
    let reshade = FilterSettings { gradient: Gradient::Reshade, ..Default::default() };
    #[allow(unused_mut, reason = "without the path tracer these are all")]
    let mut bases =
        vec![Settings::adaptive(), Settings::classic(), Settings { filter: reshade, ..Settings::adaptive() }];
    // One path is never divided, and roulette shortens long paths alone.
    #[cfg(feature = "path-tracer")]
    bases.extend([(8, 3), (2, 40)].map(|(samples, bounces)| {
        let tracer = TracerSettings { samples, bounces, ..Default::default() };
        Settings { tracer, ..Settings::adaptive() }
    }));
    for setting in Setting::all() {
        // Compare each pair of values: does any frame of any base compile something?
        let shaders: Vec<Vec<_>> =
            bases.iter().map(|base| varied(base, setting).iter().map(shaders).collect()).collect();
        let values = 0..shaders[0].len();
        let pairs = values.clone().flat_map(|a| (0..a).map(move |b| (a, b)));
        let differ: Vec<bool> = pairs.map(|(a, b)| shaders.iter().any(|of| of[a] != of[b])).collect();
        let found = match (differ.contains(&true), differ.contains(&false)) {
            (false, _) => Compiles::Never,
            (true, true) => Compiles::Sometimes,
            (true, false) => Compiles::Always,
        };
        assert_eq!(setting.compiles, found, "{}", setting.name);
        let said = setting.documentation.contains("compiles");
        assert_eq!(said, found == Compiles::Sometimes, "{}: its words", setting.name);
    }
}
