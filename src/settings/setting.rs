//! A setting as data.

use super::{FilterSettings, Settings};
use crate::Error;
use std::ops::RangeInclusive;

/// A field of [`FilterSettings`] or `TracerSettings` as data, for sliders, files and command lines.
///
/// ```
/// use asvgf::{Setting, SettingKind, Settings};
///
/// let mut settings = Settings::default();
/// let iterations = Setting::named("filter.iterations").unwrap();
/// if let SettingKind::Whole { range, field, .. } = &iterations.kind {
///     *(field.get_mut)(&mut settings) = *range.end();
/// }
/// assert_eq!(settings.filter.iterations, 8);
/// ```
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Setting {
    /// The place in [`Settings`]: `filter.alpha`.
    pub name: &'static str,
    /// The field's documentation, in Markdown.
    pub documentation: &'static str,
    /// The accepted values, with the field that holds one.
    pub kind: SettingKind,
    /// The changes after which shaders have to be compiled.
    pub compiles: Compiles,
}

/// The values that a [`Setting`] accepts, with the field that holds its own.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub enum SettingKind {
    /// A real number.
    Number {
        /// The numbers that are accepted.
        range: RangeInclusive<f32>,
        /// The range in words, with the unit, as in errors.
        accepted: &'static str,
        /// The part of the range that is worth a slider.
        useful: RangeInclusive<f32>,
        /// True if numbers compare by their ratio, so that a slider should be logarithmic.
        logarithmic: bool,
        /// The field that holds the value.
        field: Field<f32>,
    },
    /// A whole number.
    Whole {
        /// The numbers that are accepted.
        range: RangeInclusive<u32>,
        /// The range in words, with the unit, as in errors.
        accepted: &'static str,
        /// The part of the range that is worth a slider.
        useful: RangeInclusive<u32>,
        /// The field that holds the value.
        field: Field<u32>,
    },
    /// On or off.
    Switch {
        /// The field that holds the value.
        field: Field<bool>,
    },
    /// One of several variants.
    Choice {
        /// All variants, in order.
        choices: fn() -> Vec<Choice>,
        /// Returns the name of the field's variant.
        get: fn(&Settings) -> &'static str,
        /// Sets the field to the variant of that name. Returns false if there is none.
        set: fn(&mut Settings, &str) -> bool,
    },
}

/// A field of [`Settings`].
#[derive(Clone, Copy, Debug)]
#[non_exhaustive]
pub struct Field<T> {
    /// Reads the field.
    pub get: fn(&Settings) -> &T,
    /// Writes the field.
    pub get_mut: fn(&mut Settings) -> &mut T,
}

/// A variant of a setting that is an enum.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Choice {
    /// The name of the variant: `blinn-phong`.
    pub name: &'static str,
    /// The documentation of the variant, in Markdown.
    pub documentation: &'static str,
}

/// The changes of a [`Setting`] after which shaders have to be compiled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Compiles {
    /// No change.
    Never,
    /// The changes that the documentation names.
    Sometimes,
    /// Every change.
    Always,
}

impl Setting {
    /// Every setting but [`Settings::mode`], in the order of the documentation.
    pub fn all() -> impl Iterator<Item = &'static Self> {
        #[cfg(feature = "path-tracer")]
        let tracer = super::TracerSettings::FIELDS;
        #[cfg(not(feature = "path-tracer"))]
        let tracer: &[Self] = &[];
        FilterSettings::FIELDS.iter().chain(tracer)
    }

    /// The setting of that [`name`](Self::name).
    pub fn named(name: &str) -> Option<&'static Self> {
        Self::all().find(|setting| setting.name == name)
    }

    /// The name of the field alone: `alpha`.
    pub fn field_name(&self) -> &'static str {
        self.name.rsplit('.').next().unwrap_or(self.name)
    }

    /// Checks the range.
    ///
    /// # Errors
    /// [`Error::Setting`] if the value is outside its range or is not a number.
    pub fn check(&self, settings: &Settings) -> Result<(), Error> {
        let (within, value, accepted) = match &self.kind {
            SettingKind::Number { range, accepted, field, .. } => {
                let value = *(field.get)(settings);
                (range.contains(&value), f64::from(value), accepted)
            }
            SettingKind::Whole { range, accepted, field, .. } => {
                let value = *(field.get)(settings);
                (range.contains(&value), f64::from(value), accepted)
            }
            SettingKind::Switch { .. } | SettingKind::Choice { .. } => return Ok(()),
        };
        if within { Ok(()) } else { Err(Error::Setting { setting: self.name, value, accepted }) }
    }
}
