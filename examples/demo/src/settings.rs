//! The denoiser's settings in the format of a saved file.

use asvgf::{Setting, SettingKind, Settings};
use serde_json::{Map, Value};

/// The settings by name.
pub fn to_json(settings: &Settings) -> Value {
    let value = |setting: &Setting| match &setting.kind {
        SettingKind::Number { field, .. } => Value::from(*(field.get)(settings)),
        SettingKind::Whole { field, .. } => Value::from(*(field.get)(settings)),
        SettingKind::Switch { field } => Value::from(*(field.get)(settings)),
        SettingKind::Choice { get, .. } => Value::from(get(settings)),
        _ => Value::Null,
    };
    Value::Object(
        Setting::all().map(|setting| (setting.field_name().to_owned(), value(setting))).collect::<Map<_, _>>(),
    )
}

/// Reads settings. Those that the file does not name have their defaults. The error names the wrong entry.
pub fn from_json(value: &Value) -> Result<Settings, String> {
    let object = value.as_object().ok_or("settings: must be names with values")?;
    let mut settings = Settings::adaptive();
    for (name, value) in object {
        let setting = Setting::all()
            .find(|setting| setting.field_name() == name)
            .ok_or_else(|| format!("settings.{name}: there is no such setting"))?;
        set(setting, &mut settings, value).ok_or_else(|| format!("settings.{name}: {value} does not fit"))?;
    }
    settings.check().map_err(|error| error.to_string())?;
    Ok(settings)
}

fn set(setting: &Setting, settings: &mut Settings, value: &Value) -> Option<()> {
    match &setting.kind {
        SettingKind::Number { field, .. } => *(field.get_mut)(settings) = value.as_f64()? as f32,
        SettingKind::Whole { field, .. } => *(field.get_mut)(settings) = value.as_u64()?.try_into().ok()?,
        SettingKind::Switch { field } => *(field.get_mut)(settings) = value.as_bool()?,
        SettingKind::Choice { set, .. } => return set(settings, value.as_str()?).then_some(()),
        _ => return None,
    }
    Some(())
}

/// Functions for serde's `with`.
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
    use asvgf::{FilterSettings, Gradient};

    #[test]
    fn every_setting_is_stored() {
        let Value::Object(stored) = to_json(&Settings::adaptive()) else { panic!("not an object") };
        assert_eq!(stored.len(), Setting::all().count(), "two settings share a name");
        assert!(!stored.values().any(Value::is_null), "{stored:?}");
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
