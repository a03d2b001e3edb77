//! Glass against closed forms: furnaces, Snell, Fresnel, Beer–Lambert, and light that goes straight through it.

use super::{ROUNDING, SAMPLINGS, SIZE, channel, from_above, images, tracer};
use crate::common::scenes::{block, emitter, floor, glass, lambert, quad, scene, shine};
use asvgf::scene::{Alpha, Environment, LightKind, Material, Node, Scene};
use asvgf::{Camera, Sampling};

/// A plate of glass of this thickness below y = 0.
fn plate(material: Material, thickness: f32) -> Scene {
    scene(vec![material], block([-9.0, -thickness, -9.0], [9.0, 0.0, 9.0], 0))
}

/// Fresnel's reflectance between air and glass, at a cosine on the side of the air.
fn fresnel(index: f64, cosine: f64) -> f64 {
    let refracted = (1.0 - (1.0 - cosine * cosine) / (index * index)).sqrt();
    let s = (cosine - index * refracted) / (cosine + index * refracted);
    let p = (index * cosine - refracted) / (index * cosine + refracted);
    0.5 * (s * s + p * p)
}

/// A camera that sees very little, so that all its rays have one angle.
fn narrow(eye: [f64; 3], target: [f64; 3]) -> Camera {
    Camera { eye, target, up: [0.0, 0.5, -1.0], fov_y: 0.002, ..Default::default() }
}

#[test]
fn a_plate_of_glass_in_a_white_furnace_is_white() {
    let outside = narrow([0.2, 3.0, 0.1], [0.2, 0.0, 0.1]);
    let grazing = narrow([0.2, 0.3, 3.0], [0.2, 0.0, 0.0]);
    let inside = narrow([0.2, -0.4, 0.1], [0.9, 0.0, -0.2]);
    for index in [1.0, 1.0005, 1.33, 1.5, 3.0] {
        for roughness in [0.0, 0.3, 0.7, 1.0] {
            for (camera, place) in [(outside, "above"), (grazing, "at 5.7°"), (inside, "inside")] {
                let mut plate = plate(glass(index, roughness, Some([0.0; 3])), 1.0);
                plate.environment = Some(Environment::uniform([1.0; 3]));
                for sampling in SAMPLINGS {
                    let found = channel(&images(plate.clone(), camera, tracer(sampling, 0), 24), 0);
                    found.assert_is(1.0, 1e-3, &format!("index {index}, roughness {roughness}, {place}, {sampling:?}"));
                }
            }
        }
    }
}

#[test]
fn a_pane_in_a_white_furnace_is_white_and_a_coloured_one_tints_once() {
    for roughness in [0.0, 0.5] {
        for (color, cosine) in [([1.0; 3], 1.0), ([0.25, 0.5, 0.75], 1.0), ([0.25, 0.5, 0.75], 0.5_f32)] {
            let material = Material { base_color: [color[0], color[1], color[2], 1.0], ..glass(1.5, roughness, None) };
            let pane = floor(0);
            let sky = Some(Environment::uniform([1.0; 3]));
            let under = Scene { environment: sky, ..scene(vec![material], vec![pane]) };
            let z = f64::from((1.0 - cosine * cosine).sqrt()) * 3.0;
            let camera = narrow([0.2, f64::from(cosine) * 3.0, z + 0.1], [0.2, 0.0, 0.1]);
            let mirrored = fresnel(1.5, cosine.into());
            for sampling in SAMPLINGS {
                let found = images(under.clone(), camera, tracer(sampling, 0), 24);
                for (i, &tint) in color.iter().enumerate() {
                    // A rough pane mirrors another part, because its facets are seen at other angles.
                    let expected = mirrored + (1.0 - mirrored) * f64::from(tint);
                    let allowed = if roughness > 0.0 { 0.02 } else { 1e-3 };
                    channel(&found, i).assert_is(expected, allowed, &format!("{roughness}, {cosine}, {sampling:?}"));
                }
            }
        }
    }
}

#[test]
fn a_metre_of_tinted_glass_absorbs_as_beer_and_lambert_say() {
    let absorption = [0.0, 0.7, 2.5_f32];
    for (index, thickness) in [(1.5, 1.0), (2.5, 0.5_f32)] {
        let mut scene = plate(glass(index, 0.0, Some(absorption)), thickness);
        scene.materials.push(emitter([1.0; 3]));
        scene.meshes.push(quad([-9.0, -4.0, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 1));
        scene.nodes.push(Node { meshes: vec![6], ..Default::default() });
        let camera = narrow([0.2, 3.0, 0.1], [0.2, 0.0, 0.1]);
        let r = fresnel(index.into(), 1.0);
        for sampling in SAMPLINGS {
            let found = images(scene.clone(), camera, tracer(sampling, 0), 24);
            for (i, &sigma) in absorption.iter().enumerate() {
                let a = (-f64::from(sigma * thickness)).exp();
                // The geometric series of the reflections inside.
                let expected = (1.0 - r) * (1.0 - r) * a / (1.0 - r * r * a * a);
                channel(&found, i).assert_is(expected, 2e-3, &format!("{sigma}, index {index}, {sampling:?}"));
            }
        }
    }
}

#[test]
fn a_camera_inside_glass_sees_what_the_glass_leaves() {
    let mut scene = plate(glass(1.5, 0.0, Some([0.5, 1.0, 2.0])), 1.0);
    scene.environment = Some(Environment::uniform([1.0; 3]));
    // From the middle of the plate straight up: half a metre, then further ways of the parts that are mirrored.
    let camera = narrow([0.2, -0.5, 0.1], [0.2, 0.0, 0.1]);
    let found = images(scene, camera, tracer(Sampling::Both, 0), 24);
    let r = fresnel(1.5, 1.0);
    for (i, sigma) in [0.5, 1.0, 2.0_f64].into_iter().enumerate() {
        let expected = (1.0 - r) * (-0.5 * sigma).exp() / (1.0 - r * (-sigma).exp());
        channel(&found, i).assert_is(expected, 2e-3, &format!("{sigma}"));
    }
}

#[test]
fn a_body_is_whole_whatever_its_opacity_is() {
    let image = |alpha: Alpha, opacity: f32| {
        let skin = Material { alpha, base_color: [1.0, 1.0, 1.0, opacity], ..glass(1.5, 0.0, Some([0.5, 1.0, 2.0])) };
        let scene = Scene { environment: Some(Environment::uniform([1.0; 3])), ..plate(skin, 1.0) };
        images(scene, narrow([0.2, 3.0, 0.1], [0.2, 0.0, 0.1]), tracer(Sampling::Both, 0), 1)
    };
    // A ray through a hole would be inside without having entered: it was darker than without any hole.
    assert_eq!(image(Alpha::Blend, 0.5), image(Alpha::Opaque, 1.0));
}

#[test]
fn a_beam_is_refracted_as_snell_says() {
    // At 45° through a metre of glass, to a floor just below it that glows on one side of the point that Snell's law gives.
    for index in [1.2, 1.5, 2.4_f64] {
        let sine = 0.5_f64.sqrt() / index;
        let x = sine / (1.0 - sine * sine).sqrt();
        for step in [-0.01, 0.01] {
            let mut scene = plate(glass(index as f32, 0.0, Some([0.0; 3])), 1.0);
            scene.materials.push(emitter([1.0; 3]));
            let edge = (x - step) as f32;
            // The side away from the camera glows.
            scene.meshes.push(quad([edge, -1.0001, 9.0], [9.0, 0.0, 0.0], [0.0, 0.0, -18.0], 1));
            scene.nodes.push(Node { meshes: vec![6], ..Default::default() });
            let camera = Camera { up: [0.0, 0.0, -1.0], ..narrow([-2.0, 2.0, 0.0], [0.0, 0.0, 0.0]) };
            let found = channel(&images(scene, camera, tracer(Sampling::Scattered, 0), 8), 0).mean;
            let expected = (1.0 - fresnel(index, 0.5_f64.sqrt())).powi(2);
            if step < 0.0 {
                assert!(found < 0.2 * expected, "index {index}: {found} beside the light");
            } else {
                assert!(found > 0.9 * expected, "index {index}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn beyond_the_critical_angle_everything_is_mirrored() {
    // The sky glows above the plate alone; a black floor lies in the glass.
    let mut scene = plate(glass(1.5, 0.0, Some([0.0; 3])), 1.0);
    scene.materials.push(lambert([0.0; 3]));
    scene.meshes.push(quad([-9.0, -0.9, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 1));
    scene.nodes.push(Node { meshes: vec![6], ..Default::default() });
    scene.environment = Some(Environment::uniform([1.0; 3]));
    // The critical angle is 41.8° from the normal.
    for (tangent, outside) in [(0.8, true), (1.0, false)] {
        let camera = narrow([0.2, -0.5, 0.1], [0.2 + 0.5 * tangent, 0.0, 0.1]);
        let found = channel(&images(scene.clone(), camera, tracer(Sampling::Both, 0), 16), 0).mean;
        assert!(if outside { found > 0.5 } else { found < 1e-3 }, "tangent {tangent}: {found}");
    }
}

#[test]
fn light_goes_through_panes_and_plates_to_a_floor() {
    let color = [0.25, 0.5, 1.0_f32];
    let ground = || quad([-9.0, -2.0, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 1);
    // A camera below the glass, beside the light's beam.
    let camera = narrow([0.4, -0.5, 0.0], [0.0, -2.0, 0.0]);
    for absorption in [None, Some([0.3; 3])] {
        let material = Material { base_color: [color[0], color[1], color[2], 1.0], ..glass(1.5, 0.0, absorption) };
        let panes = match absorption {
            None => vec![floor(0)],
            Some(_) => block([-9.0, -0.25, -9.0], [9.0, 0.0, 9.0], 0),
        };
        let mut scene = scene(vec![material, lambert([0.5; 3])], [panes, vec![ground()]].concat());
        shine(&mut scene, LightKind::Directional, [3.0; 3], f32::INFINITY, [0.0; 3]);
        for sampling in [Sampling::Both, Sampling::Lights] {
            let found = images(scene.clone(), camera, tracer(sampling, 0), 4);
            for (i, &tint) in color.iter().enumerate() {
                let boundary = (1.0 - fresnel(1.5, 1.0)) * f64::from(tint);
                let through = match absorption {
                    None => boundary,
                    Some(_) => boundary * boundary * (-0.3 * 0.25_f64).exp(),
                };
                let expected = 3.0 * through * 0.5 / std::f64::consts::PI;
                channel(&found, i).assert_is(expected, 2e-3, &format!("{absorption:?}, {sampling:?}"));
            }
        }
    }
}

#[test]
fn all_estimators_agree_on_light_behind_a_clear_pane() {
    // Through a pane light goes straight, so all estimators have the same mean.
    let lamp = || quad([-0.5, 1.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0], 2);
    let pane = || quad([-9.0, 0.5, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 0);
    let tinted = Material { base_color: [0.5, 0.8, 1.0, 1.0], ..glass(1.5, 0.0, None) };
    let shiny = Material { specular: [0.04; 3], roughness: 0.4, ..lambert([0.5; 3]) };
    let scene = scene(vec![tinted, shiny, emitter([4.0; 3])], vec![pane(), floor(1), lamp()]);
    let camera = Camera { eye: [0.0, 0.3, 1.5], target: [0.0, 0.0, 0.0], fov_y: 0.3, ..Default::default() };
    let found = SAMPLINGS.map(|sampling| images(scene.clone(), camera, tracer(sampling, 0), 96));
    for i in 0..3 {
        let [both, lights, scattered] = [0, 1, 2].map(|s| channel(&found[s], i));
        both.assert_agrees(lights, ROUNDING, "both and light samples");
        both.assert_agrees(scattered, ROUNDING, "both and scattered rays");
    }
}

#[test]
fn a_thousand_panes_one_behind_the_other_end() {
    let panes = (0..1000).map(|i| quad([-9.0, -(i as f32) * 0.01, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 0));
    let clear = glass(1.0, 0.0, None);
    let mut many = scene(vec![clear], panes.collect());
    many.environment = Some(Environment::uniform([1.0; 3]));
    let image = images(many, from_above(), tracer(Sampling::Both, 3), 1).remove(0);
    assert_eq!(image.len(), (SIZE[0] * SIZE[1]) as usize);
    assert!(image.iter().flatten().all(|x| x.is_finite() && (0.0..=1.01).contains(x)));
}
