//! Every setting of the denoiser as data: what the panel shows, and what a saved file holds.

use asvgf::{Blend, Gradient, Kernel, Sampling, Settings, Stops, Variance};
use serde_json::{Map, Value};
use std::ops::RangeInclusive;

/// One setting, named as its field.
pub struct Setting {
    pub name: &'static str,
    pub kind: Kind,
}

/// What a setting may be, and how it is read and written.
pub enum Kind {
    Number { range: RangeInclusive<f32>, logarithmic: bool, field: fn(&mut Settings) -> &mut f32 },
    Whole { range: RangeInclusive<u32>, field: fn(&mut Settings) -> &mut u32 },
    Switch { field: fn(&mut Settings) -> &mut bool },
    OneOf { names: &'static [&'static str], get: fn(&Settings) -> usize, set: fn(&mut Settings, usize) },
}

/// A field that holds a number; ranges are as wide as is useful to drag in, not as is allowed.
macro_rules! number {
    ($part:ident . $name:ident, $range:expr, $logarithmic:expr) => {
        Setting {
            name: stringify!($name),
            kind: Kind::Number { range: $range, logarithmic: $logarithmic, field: |s| &mut s.$part.$name },
        }
    };
}

macro_rules! whole {
    ($part:ident . $name:ident, $range:expr) => {
        Setting { name: stringify!($name), kind: Kind::Whole { range: $range, field: |s| &mut s.$part.$name } }
    };
}

macro_rules! switch {
    ($part:ident . $name:ident) => {
        Setting { name: stringify!($name), kind: Kind::Switch { field: |s| &mut s.$part.$name } }
    };
}

macro_rules! one_of {
    ($part:ident . $name:ident, $kind:ident: $($variant:ident),+) => {
        Setting {
            name: stringify!($name),
            kind: Kind::OneOf {
                names: &[$(stringify!($variant)),+],
                get: |s| [$($kind::$variant),+].iter().position(|v| *v == s.$part.$name).unwrap_or(0),
                set: |s, i| s.$part.$name = [$($kind::$variant),+][i],
            },
        }
    };
}

/// How the noise is filtered, in the order of the library's documentation.
pub const FILTER: &[Setting] = &[
    // `Pairs` and `Lambda` come from a host's renderer, and there is none here.
    one_of!(filter.gradient, Gradient: Automatic, Reshade, Statistics, BlinnPhong, Off),
    number!(filter.alpha, 0.0..=1.0, true),
    number!(filter.max_history, 1.0..=1024.0, true),
    number!(filter.history_power, 0.0..=16.0, false),
    switch!(filter.history_ratio),
    whole!(filter.ratio_iterations, 0..=7),
    number!(filter.gradient_gamma, 0.0..=1.0, false),
    whole!(filter.gradient_iterations, 0..=7),
    switch!(filter.gradient_across_surfaces),
    switch!(filter.gradient_signed),
    number!(filter.gradient_dead_zone, 0.0..=1.0, false),
    one_of!(filter.blend, Blend: HistoryLength, Lambda),
    switch!(filter.feedback),
    one_of!(filter.variance, Variance: OfMean, OfSample),
    one_of!(filter.stops, Stops: NoiseSubtracted, Classic),
    one_of!(filter.kernel, Kernel: Diamond, Full),
    switch!(filter.local_linear_fit),
    number!(filter.ridge, 1e-3..=100.0, true),
    number!(filter.ridge_noise, 0.0..=16.0, false),
    whole!(filter.iterations, 0..=8),
    switch!(filter.final_iteration),
    number!(filter.steadiness, 0.0..=1.0, false),
    number!(filter.outlier_limit, 0.0..=1e3, false),
    number!(filter.converged, 0.0..=1.0, false),
    number!(filter.sigma_luminance, 0.0..=32.0, false),
    number!(filter.sigma_depth, 1e-4..=10.0, true),
    number!(filter.sigma_normal, 0.0..=256.0, false),
    number!(filter.sigma_foreshortening, 0.0..=8.0, false),
];

/// How paths are traced.
pub const TRACER: &[Setting] = &[
    whole!(tracer.samples, 1..=16),
    whole!(tracer.bounces, 0..=16),
    whole!(tracer.roulette, 0..=16),
    one_of!(tracer.sampling, Sampling: Both, Lights, Scattered),
    whole!(tracer.seed, 0..=u32::MAX),
];

fn all() -> impl Iterator<Item = &'static Setting> {
    FILTER.iter().chain(TRACER)
}

/// The settings by name.
pub fn to_json(settings: &Settings) -> Value {
    let mut settings = settings.clone();
    let mut value = |setting: &Setting| match &setting.kind {
        Kind::Number { field, .. } => Value::from(*field(&mut settings)),
        Kind::Whole { field, .. } => Value::from(*field(&mut settings)),
        Kind::Switch { field } => Value::from(*field(&mut settings)),
        Kind::OneOf { names, get, .. } => Value::from(names[get(&settings)]),
    };
    Value::Object(all().map(|setting| (setting.name.to_owned(), value(setting))).collect::<Map<_, _>>())
}

/// The settings that a file holds; what it does not name is as by default. The error names what is wrong.
pub fn from_json(value: &Value) -> Result<Settings, String> {
    let object = value.as_object().ok_or("settings: must be names with values")?;
    let mut settings = Settings::adaptive();
    for (name, value) in object {
        let setting =
            all().find(|s| s.name == name).ok_or_else(|| format!("settings.{name}: there is no such setting"))?;
        set(setting, &mut settings, value).ok_or_else(|| format!("settings.{name}: {value} does not fit"))?;
    }
    settings.check().map_err(|error| error.to_string())?;
    Ok(settings)
}

fn set(setting: &Setting, settings: &mut Settings, value: &Value) -> Option<()> {
    match &setting.kind {
        Kind::Number { field, .. } => *field(settings) = value.as_f64()? as f32,
        Kind::Whole { field, .. } => *field(settings) = value.as_u64()?.try_into().ok()?,
        Kind::Switch { field } => *field(settings) = value.as_bool()?,
        Kind::OneOf { names, set, .. } => set(settings, names.iter().position(|n| Some(*n) == value.as_str())?),
    }
    Some(())
}

/// For serde's `with`.
pub mod stored {
    use asvgf::Settings;
    use serde::{Deserialize, Deserializer, Serialize, Serializer, de::Error};

    pub fn serialize<S: Serializer>(settings: &Settings, serializer: S) -> Result<S::Ok, S::Error> {
        super::to_json(settings).serialize(serializer)
    }

    pub fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Settings, D::Error> {
        super::from_json(&serde_json::Value::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::documentation;
    use asvgf::FilterSettings;

    /// Names of the fields of a struct, as `Debug` prints them.
    fn fields(debug: &str) -> Vec<&str> {
        let inner = debug.lines().filter(|line| line.starts_with("    ") && !line.starts_with("     "));
        inner.filter_map(|line| Some(line.trim().split_once(':')?.0)).collect()
    }

    #[test]
    fn every_field_of_the_library_is_in_the_table_and_documented() {
        let settings = Settings::adaptive();
        let filter = format!("{:#?}", settings.filter);
        let tracer = format!("{:#?}", settings.tracer);
        assert_eq!(FILTER.iter().map(|s| s.name).collect::<Vec<_>>(), fields(&filter));
        assert_eq!(TRACER.iter().map(|s| s.name).collect::<Vec<_>>(), fields(&tracer));
        for setting in all() {
            assert!(documentation::of_setting(setting.name).is_some_and(|t| t.len() > 10), "{}", setting.name);
        }
    }

    #[test]
    fn what_is_saved_is_loaded() {
        for settings in [Settings::adaptive(), Settings::classic()] {
            assert_eq!(from_json(&to_json(&settings)).unwrap(), settings);
        }
        let other = FilterSettings { alpha: 0.25, gradient: Gradient::Off, iterations: 2, ..FilterSettings::classic() };
        let settings = Settings { filter: other, ..Settings::adaptive() };
        assert_eq!(from_json(&to_json(&settings)).unwrap(), settings);
    }

    #[test]
    fn a_wrong_setting_is_refused_by_name() {
        let refused = |text: &str| from_json(&serde_json::from_str(text).unwrap()).unwrap_err();
        assert!(refused(r#"{"alpah": 0.1}"#).contains("alpah"));
        assert!(refused(r#"{"alpha": "much"}"#).contains("alpha"));
        assert!(refused(r#"{"alpha": 2}"#).contains("filter.alpha"));
        assert!(refused(r#"{"kernel": "Box"}"#).contains("kernel"));
        assert!(refused(r#"{"iterations": -1}"#).contains("iterations"));
    }
}
