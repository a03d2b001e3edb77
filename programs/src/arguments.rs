//! Parts that all command lines share: values as text, and errors of usage.

use asvgf::{Setting, SettingKind, Settings};
use std::fmt;
use std::ops::RangeInclusive;

/// An error of usage: says which argument is wrong, and why.
#[derive(Debug)]
pub struct Usage(pub String);

impl fmt::Display for Usage {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

impl std::error::Error for Usage {}

impl From<lexopt::Error> for Usage {
    fn from(error: lexopt::Error) -> Self {
        Self(error.to_string())
    }
}

/// File formats of images.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Format {
    Png,
    Exr,
}

/// An option with its value.
pub struct Value {
    pub option: String,
    pub text: String,
}

impl Value {
    pub fn wrong(&self, reason: impl fmt::Display) -> Usage {
        Usage(format!("--{} {}: {reason}", self.option, self.text))
    }

    pub fn whole(&self, range: RangeInclusive<u32>) -> Result<u32, Usage> {
        let value = self.text.parse().ok().filter(|value| range.contains(value));
        value.ok_or_else(|| self.wrong(format!("must be a whole number from {} to {}", range.start(), range.end())))
    }

    pub fn number(&self, range: RangeInclusive<f32>) -> Result<f32, Usage> {
        let value = self.text.parse().ok().filter(|value| range.contains(value));
        value.ok_or_else(|| self.wrong(format!("must be a number from {} to {}", range.start(), range.end())))
    }

    /// Sets a setting of the denoiser to this value, a number within the setting's range.
    pub fn set(&self, setting: &str, settings: &mut Settings) -> Result<(), Usage> {
        match Setting::named(setting).map(|setting| &setting.kind) {
            Some(SettingKind::Number { range, field, .. }) => {
                *(field.get_mut)(settings) = self.number(range.clone())?
            }
            Some(SettingKind::Whole { range, field, .. }) => *(field.get_mut)(settings) = self.whole(range.clone())?,
            _ => return Err(self.wrong(format!("the denoiser has no number {setting}"))),
        }
        Ok(())
    }

    /// Returns the constant, or `None` for an adaptive α.
    pub fn alpha(&self) -> Result<Option<f32>, Usage> {
        match (self.text.as_str(), self.text.strip_prefix("constant:")) {
            ("adaptive", _) => Ok(None),
            ("constant", _) => Ok(Some(0.2)),
            (_, Some(alpha)) => {
                let alpha = alpha.parse().ok().filter(|alpha| (0.0..=1.0).contains(alpha));
                alpha.map(Some).ok_or_else(|| self.wrong("the constant must be a number from 0 to 1"))
            }
            _ => Err(self.wrong("must be adaptive, or constant:A as in constant:0.2")),
        }
    }

    pub fn one_of<T: Copy>(&self, known: &[(&str, T)]) -> Result<T, Usage> {
        let found = known.iter().find(|(name, _)| *name == self.text).map(|(_, value)| *value);
        let names: Vec<&str> = known.iter().map(|(name, _)| *name).collect();
        found.ok_or_else(|| self.wrong(format!("must be one of {}", names.join(", "))))
    }

    /// Returns the items between commas, each once.
    pub fn list<T: PartialEq>(&self, item: impl Fn(&Self) -> Result<T, Usage>) -> Result<Vec<T>, Usage> {
        let mut items = Vec::new();
        for text in self.text.split(',') {
            let value = item(&Self { option: self.option.clone(), text: text.trim().into() })?;
            if !items.contains(&value) {
                items.push(value);
            }
        }
        Ok(items)
    }
}
