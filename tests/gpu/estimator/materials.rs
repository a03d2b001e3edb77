//! Materials that are not simply lit.

use super::{SIZE, from_above, images, tracer};
use crate::common::scenes::{lambert, quad, scene};
use asvgf::Sampling;
use asvgf::scene::{Environment, Material, Scene};

#[test]
fn an_unlit_surface_shows_its_colour_and_lights_nothing() {
    let floor = quad([-9.0, 0.0, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 0);
    // Half of what the camera sees lies under an unlit sign that faces down, and up at the camera with its back.
    let sign = quad([0.3, 0.5, -9.0], [9.0, 0.0, 0.0], [0.0, 0.0, 18.0], 1);
    let unlit = Material { unlit: true, ..lambert([0.25, 0.5, 0.75]) };
    let scene = scene(vec![lambert([0.9; 3]), unlit], vec![floor, sign]);
    let image = images(scene, from_above(), tracer(Sampling::Both, 3), 1).remove(0);
    for (i, color) in image.iter().enumerate() {
        let x = i as u32 % SIZE[0];
        // The camera is above x = 0.3, its right is +x.
        let expected = if x >= SIZE[0] / 2 { [0.25, 0.5, 0.75] } else { [0.0; 3] };
        for (c, e) in color.iter().zip(expected) {
            assert!((c - e).abs() <= 1e-5, "pixel {i}: {color:?}, not {expected:?}");
        }
    }
}

#[test]
fn an_environment_is_seen_where_nothing_is() {
    let radiance = [0.3, 0.2, 7.0];
    let scene = Scene { environment: Some(Environment::uniform(radiance)), ..Default::default() };
    let image = images(scene, from_above(), tracer(Sampling::Both, 3), 1).remove(0);
    for c in image {
        // 18 bits of the largest channel.
        assert!((0..3).all(|i| (c[i] - radiance[i]).abs() <= 7.0 * 4e-6), "{c:?}");
    }
}

#[test]
fn nothing_at_all_is_black() {
    let image = images(Scene::default(), from_above(), tracer(Sampling::Both, 3), 1).remove(0);
    assert!(image.iter().all(|c| *c == [0.0; 3]));
}
