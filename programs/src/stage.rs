//! The scene to render: loaded, lit, animated and seen by a camera.

use crate::arguments::Usage;
use crate::render::options::{Options, Source, Viewpoint};
use asvgf::Camera;
use asvgf::scene::{self, Environment, Loaded, Pose, Scene, Warning, builtin};
use asvgf_fallbacks::framing::{bounds, framing};
use asvgf_fallbacks::shipped;
use asvgf_fallbacks::sky::{is_dark, sky};
use glam::DVec3;
use std::error::Error;
use std::path::Path;

/// Frames per second of the animations.
const RATE: f64 = 30.0;

/// Number of importer warnings to print one by one.
const WARNINGS: usize = 20;

/// A scene with the one animation to play, and its camera.
pub struct Stage {
    pub scene: Scene,
    viewpoint: Viewpoint,
    jitter: bool,
    /// Box around everything during the whole animation.
    bounds: [DVec3; 2],
    aspect: f32,
}

impl Stage {
    /// Loads the scene of the options. Reports on standard error the parts that the importer could not honour, and all
    /// additions.
    pub fn load(options: &Options) -> Result<Self, Box<dyn Error>> {
        let Loaded { mut scene, warnings, .. } = read(options)?;
        tell(&warnings);
        if !matches!(options.source, Source::BuiltIn(_)) {
            scene = choose_animation(scene, options.animation.as_deref())?;
        }
        if options.environment.as_deref() == Some(Path::new("sky")) {
            scene.environment = Some(sky());
        } else if let Some(file) = &options.environment {
            let (environment, warnings) = Environment::load(file)?;
            tell(&warnings);
            scene.environment = Some(environment);
        } else if is_dark(&scene) {
            eprintln!("note: the scene has no light; a soft sky was added (--environment sets another)");
            scene.environment = Some(sky());
        }
        let bounds = bounds(&scene).unwrap_or_else(|| {
            eprintln!("warning: the scene has no triangles");
            [DVec3::NEG_ONE, DVec3::ONE]
        });
        let aspect = options.size[0] as f32 / options.size[1] as f32;
        Ok(Self { scene, viewpoint: options.viewpoint, jitter: options.jitter, bounds, aspect })
    }

    /// Returns the pose of everything in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.scene.pose(Some(0), (f64::from(frame) / RATE) as f32)
    }

    /// Returns the camera of a frame: from the options first, then the scene's own, then one that frames the scene.
    pub fn camera(&self, pose: &Pose, frame: u32) -> Camera {
        let own = self.scene.camera_node().and_then(|node| self.scene.camera_view(pose, node));
        let base = own.unwrap_or_else(|| framing(self.bounds, self.aspect, self.viewpoint.fov_y.unwrap_or(0.7)));
        let v = &self.viewpoint;
        let centre = (0.5 * (self.bounds[0] + self.bounds[1])).to_array();
        let moved = v.eye.is_some() || v.target.is_some();
        Camera {
            eye: v.eye.unwrap_or(base.eye),
            target: v.target.unwrap_or(if v.eye.is_some() { centre } else { base.target }),
            up: v.up.unwrap_or(if moved { [0.0, 1.0, 0.0] } else { base.up }),
            fov_y: v.fov_y.unwrap_or(base.fov_y),
            jitter: if self.jitter { [halton(frame, 2) - 0.5, halton(frame, 3) - 0.5] } else { [0.0; 2] },
        }
    }
}

/// Reads the scene as it is, with all its animations.
pub fn read(options: &Options) -> Result<Loaded, Box<dyn Error>> {
    let mut loaded = match &options.source {
        Source::BuiltIn(name) => {
            let animation = options.animation.as_deref().unwrap_or("all");
            let scene = builtin::scene(name, animation);
            let scene = scene.ok_or_else(|| Usage(format!("{name}: no such built-in scene")))?;
            Loaded::from(scene)
        }
        Source::Shipped(name) => {
            shipped::load(name).ok_or_else(|| Usage(format!("{name}: no such shipped scene")))??
        }
        Source::File(path) => scene::load(path)?,
    };
    if options.cull {
        loaded.scene.cull_back_faces();
    }
    Ok(loaded)
}

/// Prints the parts that an importer could not honour.
fn tell(warnings: &[Warning]) {
    for warning in warnings.iter().take(WARNINGS) {
        eprintln!("warning: {}: {}", warning.element, warning.reason);
    }
    if warnings.len() > WARNINGS {
        eprintln!("warning: and {} more", warnings.len() - WARNINGS);
    }
}

/// Keeps one animation of a file. Nodes that only other animations move become static geometry, which is faster.
fn choose_animation(mut scene: Scene, name: Option<&str>) -> Result<Scene, Usage> {
    let chosen = match name {
        None => (!scene.animations.is_empty()).then_some(0),
        Some(name) => match scene.find_animation(name) {
            // A file's own animation with that name takes precedence over the word.
            Some(index) => Some(index),
            None if name == "static" => None,
            None => {
                let number = name.parse().ok().filter(|&number: &usize| number < scene.animations.len());
                Some(number.ok_or_else(|| Usage(format!("--animation {name}: {}", known(&scene))))?)
            }
        },
    };
    scene.animations = chosen.map(|index| scene.animations.swap_remove(index)).into_iter().collect();
    Ok(scene)
}

/// Lists the animations of a file, in words.
fn known(scene: &Scene) -> String {
    if scene.animations.is_empty() {
        return "the file has no animations; leave the option out, or say static".into();
    }
    let names = scene.animations.iter().enumerate().map(|(i, a)| format!("{i} \"{}\"", a.name));
    format!("the file has {}; or say static", names.collect::<Vec<_>>().join(", "))
}

/// Returns the radical inverse: 0…1, evenly spread over any number of successive indices.
fn halton(index: u32, base: u32) -> f32 {
    let (mut value, mut digit, mut rest) = (0.0, 1.0, index);
    while rest > 0 {
        digit /= base as f32;
        value += digit * (rest % base) as f32;
        rest /= base;
    }
    value
}
