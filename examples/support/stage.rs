//! The scene that is rendered: loaded, lit, animated and seen by a camera.

use crate::arguments::Usage;
use crate::options::{Options, Source, Viewpoint};
use asvgf::Camera;
use asvgf::scene::{self, Environment, Pose, Scene, Warning, builtin};
use glam::Vec3;
use std::error::Error;
use std::path::Path;

/// Frames per second of the animations.
const RATE: f64 = 30.0;

/// Importer warnings that are printed one by one.
const WARNINGS: usize = 20;

/// A scene with the one animation that is played, and its camera.
pub struct Stage {
    pub scene: Scene,
    viewpoint: Viewpoint,
    jitter: bool,
    /// Box around everything during the whole animation.
    bounds: [Vec3; 2],
    aspect: f32,
}

impl Stage {
    /// Loads what the options ask for. What could not be honoured, and what was added, is told on standard error.
    pub fn load(options: &Options) -> Result<Self, Box<dyn Error>> {
        let mut scene = read(options)?;
        if let Source::File(_) = &options.source {
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
            [Vec3::NEG_ONE, Vec3::ONE]
        });
        let aspect = options.size[0] as f32 / options.size[1] as f32;
        Ok(Self { scene, viewpoint: options.viewpoint, jitter: options.jitter, bounds, aspect })
    }

    /// Where everything is in a frame.
    pub fn pose(&self, frame: u32) -> Pose {
        self.scene.pose(Some(0), (f64::from(frame) / RATE) as f32)
    }

    /// From where a frame is seen: the options first, then the scene's own camera, then one that frames the scene.
    pub fn camera(&self, pose: &Pose, frame: u32) -> Camera {
        let own = self.scene.camera_node().and_then(|node| self.scene.camera_view(pose, node));
        let base = match own {
            Some(v) => Camera { eye: v.eye, target: v.target, up: v.up, fov_y: v.fov_y, jitter: [0.0; 2] },
            None => framing(self.bounds, self.aspect, self.viewpoint.fov_y.unwrap_or(0.7)),
        };
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

/// The scene as it is, with all its animations.
pub fn read(options: &Options) -> Result<Scene, Box<dyn Error>> {
    match &options.source {
        Source::BuiltIn(name) => {
            let animation = options.animation.as_deref().unwrap_or("all");
            Ok(builtin::scene(name, animation).ok_or_else(|| Usage(format!("{name}: no such built-in scene")))?)
        }
        Source::File(path) => {
            let loaded = scene::load(path)?;
            tell(&loaded.warnings);
            Ok(loaded.scene)
        }
    }
}

/// Prints what an importer could not honour.
fn tell(warnings: &[Warning]) {
    for warning in warnings.iter().take(WARNINGS) {
        eprintln!("warning: {}: {}", warning.element, warning.reason);
    }
    if warnings.len() > WARNINGS {
        eprintln!("warning: and {} more", warnings.len() - WARNINGS);
    }
}

/// Keeps one animation of a file: nodes that only others move are static geometry, which is faster.
fn choose_animation(mut scene: Scene, name: Option<&str>) -> Result<Scene, Usage> {
    let chosen = match name {
        None => (!scene.animations.is_empty()).then_some(0),
        Some(name) => match scene.find_animation(name) {
            // A file's own animation of that name comes before the word.
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

/// The animations of a file, in words.
fn known(scene: &Scene) -> String {
    if scene.animations.is_empty() {
        return "the file has no animations; leave the option out, or say static".into();
    }
    let names = scene.animations.iter().enumerate().map(|(i, a)| format!("{i} \"{}\"", a.name));
    format!("the file has {}; or say static", names.collect::<Vec<_>>().join(", "))
}

/// Whether nothing would be seen but black.
fn is_dark(scene: &Scene) -> bool {
    let placed = |mesh: usize| scene.nodes.iter().any(|node| node.meshes.contains(&mesh));
    let emits = |material: usize| scene.materials.get(material).is_some_and(|m| m.emissive.iter().any(|&x| x > 0.0));
    let emitter = scene.meshes.iter().enumerate().any(|(i, mesh)| emits(mesh.material) && placed(i));
    let lamp = scene.nodes.iter().filter_map(|node| scene.lights.get(node.light?)).any(|l| l.intensity != [0.0; 3]);
    scene.environment.is_none() && !emitter && !lamp
}

/// A cloudy sky: bright above, brightest on one side so that shapes show, and a darker ground.
fn sky() -> Environment {
    let (width, height) = (512_u32, 256_u32);
    let brightest = Vec3::new(0.5, 0.7, 0.5).normalize();
    let texel = |i: u32| {
        let azimuth = ((i % width) as f32 + 0.5) / width as f32 * std::f32::consts::TAU - std::f32::consts::PI;
        let polar = ((i / width) as f32 + 0.5) / height as f32 * std::f32::consts::PI;
        let direction = Vec3::new(polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin());
        let (ground, horizon, zenith) = (Vec3::splat(0.2), Vec3::new(0.5, 0.53, 0.58), Vec3::new(0.7, 0.85, 1.1));
        let above = 1.0 - (1.0 - direction.y.clamp(0.0, 1.0)).powi(2);
        let below = (-direction.y * 4.0).clamp(0.0, 1.0);
        let glow = direction.dot(brightest).max(0.0).powi(8);
        (horizon.lerp(zenith, above).lerp(ground, below) + glow * Vec3::new(2.4, 2.2, 1.9)).to_array()
    };
    Environment { width, height, radiance: (0..width * height).map(texel).collect() }
}

/// The box around everything, at rest and at some moments of the animation.
fn bounds(scene: &Scene) -> Option<[Vec3; 2]> {
    let moments = 12;
    let duration = scene.duration(Some(0));
    let times = (0..moments).map(|i| duration * i as f32 / moments as f32);
    let boxes = times.filter_map(|time| scene.bounds(&scene.pose(Some(0), time)));
    boxes.map(|b| b.map(Vec3::from)).reduce(|[low, high], [l, h]| [low.min(l), high.max(h)])
}

/// A camera in front, to the right and slightly above, so far away that the box just fits.
fn framing([low, high]: [Vec3; 2], aspect: f32, fov_y: f32) -> Camera {
    let towards = Vec3::new(0.55, 0.35, 1.0).normalize();
    let right = Vec3::Y.cross(towards).normalize();
    let up = towards.cross(right);
    let centre = 0.5 * (low + high);
    let slope = (fov_y / 2.0).tan();
    // A corner at (x, y, z) in the camera's directions is in the picture from a distance of z + |y| / slope on.
    let distance = (0..8_u32).fold(0.0_f32, |distance, i| {
        let corner = Vec3::select(glam::BVec3::new(i & 1 > 0, i & 2 > 0, i & 4 > 0), high, low) - centre;
        let sideways = (corner.dot(right).abs() / aspect).max(corner.dot(up).abs());
        distance.max(corner.dot(towards) + 1.05 * sideways / slope)
    });
    // A scene may be one point.
    let eye = centre + towards * distance.max(1e-3);
    Camera { eye: eye.to_array(), target: centre.to_array(), up: [0.0, 1.0, 0.0], fov_y, jitter: [0.0; 2] }
}

/// The radical inverse: 0…1, evenly spread over any number of successive indices.
fn halton(index: u32, base: u32) -> f32 {
    let (mut value, mut digit, mut rest) = (0.0, 1.0, index);
    while rest > 0 {
        digit /= base as f32;
        value += digit * (rest % base) as f32;
        rest /= base;
    }
    value
}
