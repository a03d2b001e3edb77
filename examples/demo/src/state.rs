//! The state: all choices of the user, which a frame is made from and a saved file holds.

use crate::settings;
use asvgf::{Gradient, Mode, Settings, View};
use serde::{Deserialize, Serialize};

/// The source of the pixels of a half.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Serialize, Deserialize)]
pub enum Source {
    /// The denoiser with an adaptive α.
    Adaptive,
    /// The denoiser with a constant α.
    Constant,
    /// The denoiser with an adaptive α and all light in one signal: specular light is not kept apart.
    OneSignal,
    /// The traced samples, unfiltered.
    Noisy,
    /// The mean of all samples since the last change of anything.
    Reference,
    /// Another such mean, from other random numbers. It serves only the measurement: see means.rs.
    Witness,
}

impl Source {
    /// The sources that can be shown.
    pub const SHOWN: [Self; 5] = [Self::Adaptive, Self::Constant, Self::OneSignal, Self::Noisy, Self::Reference];

    /// The name in the window.
    pub fn name(self) -> &'static str {
        match self {
            Self::Adaptive => "adaptive α",
            Self::Constant => "constant α",
            Self::OneSignal => "one signal",
            Self::Noisy => "1 spp",
            Self::Reference => "reference",
            Self::Witness => "second reference",
        }
    }

    /// The view that the source's denoiser has to show if `view` is asked for: each has a picture of its own kind.
    pub fn view(self, view: View) -> View {
        match (self, view) {
            (Self::Noisy, View::Denoised) => View::Noisy,
            (Self::Reference | Self::Witness, View::Denoised) => View::Mean,
            _ => view,
        }
    }
}

/// Everything that moves, besides the camera.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Motion {
    /// Names of the scene's animations that play.
    pub playing: Vec<String>,
    /// True if the lamps are on.
    pub lit: bool,
    /// True if the lamps go on and off, a second each.
    pub blink: bool,
    /// Factor on the light of the lamps.
    pub brightness: f32,
    /// Factor on each colour channel of that light, 0…1.
    pub tint: [f32; 3],
    /// Offset of the lamps from their place in the scene, in metres.
    pub lamp: [f32; 3],
    /// Offset of the object that the user can move, in metres.
    pub object: [f32; 3],
    /// True if the camera trembles.
    pub shake: bool,
}

impl Default for Motion {
    fn default() -> Self {
        Self {
            playing: Vec::new(),
            lit: true,
            blink: true,
            brightness: 1.0,
            tint: [1.0; 3],
            lamp: [0.0; 3],
            object: [0.0; 3],
            shake: false,
        }
    }
}

/// All choices of the user.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct State {
    /// The source of the picture, or of its left half.
    pub left: Source,
    /// The source of the right half.
    pub right: Source,
    /// True if both halves are shown.
    pub split: bool,
    /// Place at which the halves meet, 0…1.
    pub divider: f32,
    /// α of [`Source::Constant`].
    pub alpha: f32,
    /// Name of the shown [`View`].
    pub view: String,
    /// Factor on radiance.
    pub exposure: f32,
    /// Pixels of the image per pixel of the window, along each axis. With `None`, the adapter decides.
    pub scale: Option<f32>,
    /// True while time stands still.
    pub paused: bool,
    /// True if a drag turns the head instead of going around.
    pub fly: bool,
    /// The scene: the name of a built-in one, or a file.
    pub scene: String,
    pub motion: Motion,
    /// True if errors and means are measured and plotted.
    pub plots: bool,
    #[serde(with = "settings::stored")]
    pub settings: Settings,
}

impl Default for State {
    fn default() -> Self {
        Self {
            left: Source::Adaptive,
            right: Source::Constant,
            split: false,
            divider: 0.5,
            // The default of the `render` example and of the papers.
            alpha: 0.2,
            view: View::Denoised.name().into(),
            exposure: 1.0,
            scale: None,
            paused: false,
            fly: false,
            scene: "cornell".into(),
            motion: Motion::default(),
            plots: false,
            settings: Settings::adaptive(),
        }
    }
}

impl State {
    /// The shown view. If a saved file names an unknown view, the denoised picture.
    pub fn view(&self) -> View {
        View::named(&self.view).unwrap_or(View::Denoised)
    }

    /// Switches the left half between the adaptive and the constant α. A right half that shows the other one switches too.
    pub fn toggle(&mut self) {
        let other = if self.left == Source::Adaptive { Source::Constant } else { Source::Adaptive };
        if self.split && self.right == other {
            self.right = self.left;
        }
        self.left = other;
    }

    /// The sources that have to be rendered, those of the picture first.
    pub fn sources(&self) -> Vec<Source> {
        let mut sources = vec![self.left];
        let measured = [Source::Adaptive, Source::Constant, Source::Reference, Source::Witness];
        let right = self.split.then_some(self.right);
        for source in right.into_iter().chain(measured.into_iter().filter(|_| self.plots)) {
            if !sources.contains(&source) {
                sources.push(source);
            }
        }
        sources
    }

    /// The settings for the denoiser of a source.
    pub fn settings(&self, source: Source) -> Settings {
        let mut settings = self.settings.clone();
        match source {
            Source::Adaptive | Source::OneSignal => {
                if settings.filter.gradient == Gradient::Off {
                    settings.filter.gradient = Gradient::Automatic;
                }
                settings.filter.gloss &= source == Source::Adaptive;
            }
            Source::Constant => settings = settings.constant(self.alpha),
            Source::Noisy => settings.mode = Mode::Noisy,
            Source::Reference | Source::Witness => {
                settings.mode = Mode::Reference;
                // The noise of a reference must be independent of the noise that is measured against it.
                settings.tracer.seed ^= if source == Source::Reference { 0x5eed_0000 } else { 0x5eed_1111 };
            }
        }
        settings
    }

    /// Returns to the initial state, but keeps the scene and the scale.
    pub fn restore(&mut self) {
        *self = Self { scene: std::mem::take(&mut self.scene), scale: self.scale, ..Self::default() };
    }

    /// The text of a saved file.
    pub fn save(&self) -> String {
        serde_json::to_string_pretty(self).unwrap_or_default()
    }

    /// Reads the text of a saved file. The error says where the text is wrong.
    pub fn load(text: &str) -> Result<Self, String> {
        let state: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        let fits = |value: f32, range: std::ops::RangeInclusive<f32>| range.contains(&value);
        let within = fits(state.divider, 0.0..=1.0)
            && fits(state.alpha, 0.0..=1.0)
            && state.scale.is_none_or(|scale| fits(scale, 0.05..=1.0))
            && fits(state.exposure, 1e-3..=1e3)
            && fits(state.motion.brightness, 0.0..=100.0)
            && state.motion.tint.iter().all(|&t| fits(t, 0.0..=1.0));
        if within { Ok(state) } else { Err("a number is outside its range".into()) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_saved_is_loaded() {
        let state = State { split: true, divider: 0.25, settings: Settings::classic(), ..State::default() };
        assert_eq!(State::load(&state.save()).unwrap(), state);
        // A file may hold only the values that differ from the defaults.
        let partial = State::load(r#"{"alpha": 0.5, "settings": {"iterations": 2}}"#).unwrap();
        assert_eq!((partial.alpha, partial.settings.filter.iterations), (0.5, 2));
    }

    #[test]
    fn a_broken_file_is_refused() {
        for text in ["", "{", r#"{"alpha": 7}"#, r#"{"settings": {"nonsense": 1}}"#, r#"{"left": "Sideways"}"#] {
            assert!(State::load(text).is_err(), "{text}");
        }
    }

    #[test]
    fn the_toggle_swaps_halves_that_would_be_alike() {
        let mut state = State { split: true, ..State::default() };
        state.toggle();
        assert_eq!((state.left, state.right), (Source::Constant, Source::Adaptive));
        state.split = false;
        state.toggle();
        assert_eq!(state.left, Source::Adaptive);
    }

    #[test]
    fn both_halves_share_their_noise_and_references_do_not() {
        let state = State::default();
        let seed = |source| state.settings(source).tracer.seed;
        assert_eq!(seed(Source::Adaptive), seed(Source::Constant));
        assert_eq!(seed(Source::Adaptive), seed(Source::Noisy));
        assert_ne!(seed(Source::Adaptive), seed(Source::Reference));
        assert_ne!(seed(Source::Witness), seed(Source::Reference));
    }

    #[test]
    fn only_what_is_looked_at_is_rendered() {
        let mut state = State::default();
        assert_eq!(state.sources(), [Source::Adaptive]);
        state.split = true;
        assert_eq!(state.sources(), [Source::Adaptive, Source::Constant]);
        state.right = Source::Adaptive;
        assert_eq!(state.sources(), [Source::Adaptive]);
        state.plots = true;
        assert_eq!(state.sources().len(), 4);
    }

    #[test]
    fn constant_is_constant_and_adaptive_is_not_whatever_the_panel_says() {
        let mut state = State { alpha: 0.1, ..State::default() };
        state.settings.filter.gradient = Gradient::Off;
        assert_eq!(state.settings(Source::Adaptive).filter.gradient, Gradient::Automatic);
        let constant = state.settings(Source::Constant).filter;
        assert_eq!((constant.gradient, constant.alpha), (Gradient::Off, 0.1));
    }

    #[test]
    fn one_signal_differs_from_adaptive_by_nothing_else() {
        let mut state = State::default();
        state.settings.filter.gradient = Gradient::Off;
        let [mut two, one] = [Source::Adaptive, Source::OneSignal].map(|source| state.settings(source));
        assert!(two.filter.gloss && !one.filter.gloss);
        two.filter.gloss = false;
        assert_eq!(two, one);
    }
}
