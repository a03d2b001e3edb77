//! What is measured: sequences, methods, and how well.

use crate::methods::{self, Method};
use crate::options::Source;
use asvgf::scene::builtin;

/// The built-in scenes' lamps and paths turn in this frame: blinking ones go out, moving ones go back.
pub const TURN: u32 = 30;

pub struct Suite {
    pub name: &'static str,
    pub size: [u32; 2],
    /// Frames of each sequence, half of them before the turn.
    pub frames: u32,
    /// Paths per pixel of a reference.
    pub paths: u32,
    /// How often times are taken.
    pub repeats: u32,
    pub sequences: Vec<Sequence>,
    pub methods: Vec<Method>,
}

/// Frames of one scene with one animation.
#[derive(Clone, Debug)]
pub struct Sequence {
    /// Also the name of its files.
    pub name: String,
    pub source: Source,
    pub animation: Option<String>,
}

impl Suite {
    /// For a look, and for software adapters: minutes.
    pub fn quick() -> Self {
        Self {
            name: "quick",
            size: [96, 54],
            frames: 16,
            paths: 256,
            repeats: 3,
            sequences: ["static", "blink", "move-light"].map(|animation| built_in("cornell", animation)).to_vec(),
            methods: methods::quick(),
        }
    }

    /// For the record.
    pub fn full() -> Self {
        let sequences = builtin::NAMES.iter().flat_map(|scene| builtin::ANIMATIONS.map(|a| built_in(scene, a)));
        Self {
            name: "full",
            size: [640, 360],
            frames: 32,
            paths: 8192,
            repeats: 5,
            sequences: sequences.collect(),
            methods: methods::all(),
        }
    }

    /// Keeps the sequences of one scene; of a file there is one.
    pub fn only(&mut self, scene: &str) {
        let animations: &[&str] =
            if self.name == "quick" { &["static", "blink", "move-light"] } else { &builtin::ANIMATIONS };
        self.sequences = if builtin::NAMES.contains(&scene) {
            animations.iter().map(|animation| built_in(scene, animation)).collect()
        } else {
            let stem = std::path::Path::new(scene).file_stem().unwrap_or_default();
            vec![Sequence { name: stem.to_string_lossy().into(), source: Source::File(scene.into()), animation: None }]
        };
    }

    /// Number of the first frame.
    pub fn first(&self) -> u32 {
        TURN - self.frames / 2
    }
}

fn built_in(scene: &str, animation: &str) -> Sequence {
    Sequence {
        name: format!("{scene}-{animation}"),
        source: Source::BuiltIn(scene.into()),
        animation: Some(animation.into()),
    }
}
