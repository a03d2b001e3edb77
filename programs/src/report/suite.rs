//! Suites: sequences, methods, and quality of the measurement.

use crate::render::options::Source;
use crate::report::methods::{self, Method};
use asvgf::scene::builtin::{ANIMATIONS, GLOSS_ANIMATIONS};
use asvgf_fallbacks::shipped;
use std::path::Path;

/// Frame of the turn of the built-in scenes' lamps and paths: blinking lamps go out, moving ones go back.
pub const TURN: u32 = 30;

/// Scenes and their animations, the most informative first.
const SCENES: [(&str, &[&str]); 5] = [
    ("cornell", &ANIMATIONS),
    ("pillars", &ANIMATIONS),
    ("gloss", &GLOSS_ANIMATIONS),
    ("textured", &["static", "move-camera"]),
    ("still-life", &["sway", "blink", "move-camera", "all"]),
];

/// Number of a scene's animations in the quick suite.
const QUICK: usize = 3;

pub struct Suite {
    pub name: &'static str,
    pub size: [u32; 2],
    /// Frames of each sequence, half of them before the turn.
    pub frames: u32,
    /// Paths per pixel of a reference.
    pub paths: u32,
    /// Number of repeats for the times.
    pub repeats: u32,
    pub sequences: Vec<Sequence>,
    pub methods: Vec<Method>,
}

/// Frames of one scene with one animation.
#[derive(Clone, Debug)]
pub struct Sequence {
    /// Name, also of its files.
    pub name: String,
    pub source: Source,
    pub animation: Option<String>,
}

impl Suite {
    /// Returns the suite for a first look, and for software adapters: takes minutes.
    pub fn quick() -> Self {
        Self {
            name: "quick",
            size: [96, 54],
            frames: 16,
            paths: 256,
            repeats: 3,
            sequences: sequences("cornell", &ANIMATIONS[..QUICK]),
            methods: methods::quick(),
        }
    }

    /// Returns the suite for the record.
    pub fn full() -> Self {
        Self {
            name: "full",
            size: [640, 360],
            frames: 32,
            paths: 8192,
            repeats: 5,
            sequences: SCENES.iter().flat_map(|(scene, animations)| sequences(scene, animations)).collect(),
            methods: methods::all(),
        }
    }

    /// Keeps the sequences of one scene; a file has one sequence.
    pub fn only(&mut self, scene: &str) {
        let known = SCENES.iter().find(|(name, _)| *name == scene);
        self.sequences = match known {
            Some((_, animations)) if self.name == "quick" => {
                sequences(scene, &animations[..QUICK.min(animations.len())])
            }
            Some((_, animations)) => sequences(scene, animations),
            None => {
                let stem = Path::new(scene).file_stem().unwrap_or_default();
                vec![Sequence {
                    name: stem.to_string_lossy().into(),
                    source: Source::File(scene.into()),
                    animation: None,
                }]
            }
        };
    }

    /// Returns the number of the first frame.
    pub fn first(&self) -> u32 {
        TURN - self.frames / 2
    }
}

/// Returns the sequences of a scene, one for each animation.
fn sequences(scene: &str, animations: &[&str]) -> Vec<Sequence> {
    let source = match scene {
        _ if shipped::NAMES.contains(&scene) => Source::Shipped(scene.into()),
        _ => Source::BuiltIn(scene.into()),
    };
    let sequence = |animation: &&str| Sequence {
        name: format!("{scene}-{animation}"),
        source: source.clone(),
        animation: Some(animation.to_string()),
    };
    animations.iter().map(sequence).collect()
}
