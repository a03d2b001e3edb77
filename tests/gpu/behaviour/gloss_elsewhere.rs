//! A glossy scene looks the same wherever it stands, in whichever unit its lengths are given, and however bright its lamps are.

use crate::common::stage::Stage;
use crate::common::statistics::{Rgb, mean};
use asvgf::scene::{Node, Scene, Transform, builtin};
use asvgf::{Camera, Settings, View};

const SIZE: [u32; 2] = [48, 36];

/// The first frame: in the frames that follow the lamp goes out, and everything moves.
const FIRST: u32 = 26;
const FRAMES: u32 = 8;

/// A world that is a scaled and moved copy of another, with brighter lamps.
#[derive(Clone, Copy, Debug)]
struct Copied {
    scale: f64,
    place: [f64; 3],
    brightness: f32,
}

const SAME: Copied = Copied { scale: 1.0, place: [0.0; 3], brightness: 1.0 };

impl Copied {
    fn scene(self, mut scene: Scene) -> Scene {
        for material in &mut scene.materials {
            material.emissive = material.emissive.map(|x| x * self.brightness);
        }
        let transform = Transform::Trs {
            translation: self.place.map(|x| x as f32),
            rotation: [0.0, 0.0, 0.0, 1.0],
            scale: [self.scale as f32; 3],
        };
        for node in &mut scene.nodes {
            node.parent = Some(node.parent.map_or(0, |parent| parent + 1));
        }
        scene.nodes.insert(0, Node { transform, ..Default::default() });
        for channel in scene.animations.iter_mut().flat_map(|a| &mut a.channels) {
            use asvgf::scene::Target::*;
            channel.target = match channel.target {
                Translation(node) => Translation(node + 1),
                Rotation(node) => Rotation(node + 1),
                Scale(node) => Scale(node + 1),
                other => other,
            };
        }
        scene
    }

    fn camera(self, camera: Camera) -> Camera {
        let at = |p: [f64; 3]| [0, 1, 2].map(|i| self.place[i] + self.scale * p[i]);
        Camera { eye: at(camera.eye), target: at(camera.target), ..camera }
    }
}

/// Frames of the altered scene: the image, and views of the reflections.
fn frames(scene: &Scene, copied: Copied) -> Vec<[Vec<Rgb>; 4]> {
    let original = Stage::new(scene.clone(), SIZE, Settings::adaptive());
    let mut stage = Stage::new(copied.scene(scene.clone()), SIZE, Settings::adaptive());
    stage.index = FIRST;
    (0..FRAMES)
        .map(|_| {
            let pose = original.pose_at(stage.index);
            stage.camera = Some(copied.camera(original.camera_in(&pose)));
            let image = stage.frame().image();
            let [motion, distance, length] =
                [View::ReflectionMotion, View::HitDistance, View::SpecularHistoryLength].map(|view| stage.view(view));
            // The motion's third number is a distance.
            [image, motion.iter().map(|m| [m[0], m[1], 0.0]).collect(), distance, length]
        })
        .collect()
}

/// Animations with moving reflections: all moves, or something that only mirrors show.
const ANIMATIONS: [&str; 2] = ["all", "move-reflected"];

/// Numbers that are powers of two times as large round alike, so all images are the same to the bit.
#[test]
fn in_another_place_or_unit_it_is_the_same_to_the_bit() {
    for animation in ANIMATIONS {
        let scene = builtin::scene("gloss", animation).unwrap();
        let near = frames(&scene, SAME);
        for copied in [
            Copied { place: [10_000.0, -10_000.0, 10_000.0], ..SAME },
            Copied { scale: 1024.0, ..SAME },
            Copied { scale: 1.0 / 1024.0, ..SAME },
        ] {
            for (frame, (found, near)) in frames(&scene, copied).iter().zip(&near).enumerate() {
                let what = format!("{animation}, {copied:?}, frame {frame}");
                for (k, name) in ["image", "motion", "", "length"].into_iter().enumerate() {
                    assert!(k == 2 || found[k] == near[k], "{what}: {name}");
                }
                let scale = copied.scale as f32;
                for (found, near) in found[2].iter().flatten().zip(near[2].iter().flatten()) {
                    // The sky is as far away in any unit, and a mean may hold some of it.
                    let same = (found - scale * near).abs() <= 2e-4 * found;
                    assert!(*near > 1e6 || same, "{what}: {found} is not {scale} times {near}");
                }
            }
        }
    }
}

#[test]
fn brighter_lamps_brighten_the_image_and_change_nothing_else() {
    for animation in ANIMATIONS {
        let scene = builtin::scene("gloss", animation).unwrap();
        let plain = frames(&scene, SAME);
        for brightness in [1024.0, 1.0 / 1024.0] {
            let altered = frames(&scene, Copied { brightness, ..SAME });
            for (frame, (found, plain)) in altered.iter().zip(&plain).enumerate() {
                let what = format!("{animation}, {brightness} times as bright, frame {frame}");
                assert!(found[1..] == plain[1..], "{what}: motion, distance or length");
                let level = mean(&plain[0]);
                let off = |(a, b): (&Rgb, &Rgb)| {
                    (0..3).map(|c| f64::from((a[c] / brightness - b[c]).abs())).fold(0.0, f64::max)
                };
                let worst = found[0].iter().zip(&plain[0]).map(off).fold(0.0, f64::max) / level;
                // Variances allow for rounding by constants, which are far below any light of this scene.
                assert!(worst < 5e-3, "{what}: {worst:.1e} of the mean");
            }
        }
    }
}
