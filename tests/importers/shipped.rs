//! The scene files of this repository.

use asvgf::scene::{self, Loaded, Scene};
use std::path::Path;

fn shipped(file: &str) -> Loaded {
    scene::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("assets").join(file)).unwrap()
}

fn still_life() -> Scene {
    shipped("still_life/still_life.glb").scene
}

#[test]
fn every_shipped_scene_is_read_in_full() {
    for file in ["textured/room.glb", "still_life/still_life.glb"] {
        let loaded = shipped(file);
        assert!(loaded.details.is_empty(), "{file}: {:?}", loaded.details);
        assert!(loaded.scene.validate().is_ok(), "{file}");
    }
}

#[test]
fn the_still_life_has_glass_gloss_metal_relief_a_mask_a_skin_and_a_morph_target() {
    let scene = still_life();
    let some = |has: fn(&scene::Material) -> bool| scene.materials.iter().any(has);
    assert!(some(|m| m.transmission > 0.0 && m.interior.absorption.is_some_and(|a| a[0] > 0.0)));
    assert!(some(|m| m.metallic == 0.0 && m.roughness < 0.2 && m.specular != [0.0; 3] && m.transmission == 0.0));
    assert!(some(|m| m.metallic == 1.0 && m.normal_texture.is_some()));
    assert!(some(|m| matches!(m.alpha, scene::Alpha::Mask(_))));
    assert!(!scene.skins.is_empty());
    assert!(scene.meshes.iter().any(|mesh| !mesh.targets.is_empty()));
}

#[test]
fn the_still_life_sways_and_is_the_same_after_its_period() {
    let scene = still_life();
    let sway = scene.find_animation("sway").unwrap();
    let period = scene.duration(Some(sway));
    assert_eq!(period, 4.0);
    // The keys of the start and of the end are one pose, and times beyond the end are those of the next period.
    let [start, end, later, again] = [0.0, period, 1.5, 1.5 + period].map(|time| scene.pose(Some(sway), time));
    assert_eq!((&start.world, &start.weights), (&end.world, &end.weights));
    assert_eq!((&later.world, &later.weights), (&again.world, &again.weights));
    for (node, (a, b)) in scene.nodes.iter().zip(start.world.iter().zip(&later.world)) {
        assert_eq!(a != b, node.name.contains("joint"), "{}", node.name);
    }
    assert_ne!(start.weights, later.weights);
}

#[test]
fn the_lamp_of_the_still_life_goes_out_and_comes_back() {
    let scene = still_life();
    let blink = scene.find_animation("blink").unwrap();
    let lamp = scene.nodes.iter().position(|node| node.name == "lamp").unwrap();
    let area = |time| {
        let [x, y, ..] = scene.pose(Some(blink), time).world[lamp];
        let length = |v: [f64; 4]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
        length(x) * length(y)
    };
    for (time, expected) in [(0.5, 1.0), (1.5, 1e-6), (2.5, 1.0), (3.5, 1e-6)] {
        assert!((area(time) - expected).abs() < 1e-6 * expected.max(0.1), "{time}: {}", area(time));
    }
}
