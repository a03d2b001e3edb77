//! Materials with special light: unlit, coloured by vertices, coated, transparent.

use super::{SIZE, channel, floor_points, from_above, images, tracer};
use crate::common::scenes::{floor, lambert, quad, scene, shine};
use asvgf::scene::{Alpha, Environment, Image, LightKind, Material, Node, Scene, Texture, Transform};
use asvgf::{Camera, Sampling};

#[test]
fn an_unlit_surface_shows_its_colour_and_lights_nothing() {
    let floor = floor(0);
    // Half of the camera's view lies under an unlit sign. It faces down, and turns its back up to the camera.
    let sign = quad([0.3, 0.5, -9.0], [9.0, 0.0, 0.0], [0.0, 0.0, 18.0], 1);
    let unlit = Material { unlit: true, ..lambert([0.25, 0.5, 0.75]) };
    let scene = scene(vec![lambert([0.9; 3]), unlit], vec![floor, sign]);
    let image = images(scene, from_above(), tracer(Sampling::Both, 3), 1).remove(0);
    for (i, color) in image.iter().enumerate() {
        let x = i as u32 % SIZE[0];
        // The camera is above x = 0.3, and its right is +x.
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
        // Radiance is stored with 18 bits of the largest channel.
        assert!((0..3).all(|i| (c[i] - radiance[i]).abs() <= 7.0 * 4e-6), "{c:?}");
    }
}

#[test]
fn nothing_at_all_is_black() {
    let image = images(Scene::default(), from_above(), tracer(Sampling::Both, 3), 1).remove(0);
    assert!(image.iter().all(|c| *c == [0.0; 3]));
}

/// A floor under a white sky: each pixel shows the fraction of light from everywhere that the surface reflects.
fn under_the_sky(material: Material) -> Scene {
    let floor = floor(0);
    Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene(vec![material], vec![floor]) }
}

#[test]
fn colours_of_vertices_multiply_the_albedo_and_are_interpolated() {
    let mut scene = under_the_sky(lambert([0.8, 0.5, 1.0]));
    // Red grows with x, green with −z, from corner to corner; blue is the same everywhere.
    scene.meshes[0].colors =
        vec![[0.0, 0.0, 0.25, 1.0], [1.0, 0.0, 0.25, 1.0], [1.0, 1.0, 0.25, 1.0], [0.0, 1.0, 0.25, 1.0]];
    // A mesh without colours beside it is white.
    scene.meshes.push(quad([0.3, 0.01, 9.0], [9.0, 0.0, 0.0], [0.0, 0.0, -18.0], 0));
    scene.nodes.push(Node { meshes: vec![1], ..Default::default() });
    let found = images(scene, from_above(), tracer(Sampling::Scattered, 0), 1).remove(0);
    for (pixel, (color, place)) in found.iter().zip(floor_points()).enumerate() {
        let expected = if place[0] > 0.3 {
            [0.8, 0.5, 1.0]
        } else {
            [0.8 * (place[0] + 9.0) / 18.0, 0.5 * (9.0 - place[2]) / 18.0, 0.25]
        };
        for (found, expected) in color.iter().zip(expected) {
            let error = (f64::from(*found) - expected).abs();
            assert!(error < 5e-4, "pixel {pixel} at {place:?}: {color:?}, not {expected}");
        }
    }
}

#[test]
fn opacity_of_vertices_makes_holes() {
    let mut scene = under_the_sky(Material { alpha: Alpha::Mask(0.5), ..lambert([0.5; 3]) });
    // Opacity grows with x, so the floor begins at x = 0.
    scene.meshes[0].colors = [0.0, 1.0, 1.0, 0.0].map(|opacity| [1.0, 1.0, 1.0, opacity]).to_vec();
    let found = images(scene, from_above(), tracer(Sampling::Scattered, 0), 1).remove(0);
    for (color, place) in found.iter().zip(floor_points()) {
        // The sky is visible through the holes.
        let expected = if place[0] > 0.0 { 0.5 } else { 1.0 };
        assert!((color[0] - expected).abs() < 1e-3, "{color:?} at {place:?}");
    }
}

/// Light from everywhere that a coated Lambertian surface of GGX width 1 reflects, seen from straight above: the integral of
/// (1 − F)·albedo·cos/π + F·D·G₂/(4·cos) with Schlick's F between `normal` and `edge`, by the midpoint rule.
fn coated(albedo: f64, normal: f64, edge: f64) -> f64 {
    use std::f64::consts::PI;
    let steps = 2000;
    let mut sum = 0.0;
    for i in 0..steps {
        let cos = (f64::from(i) + 0.5) / f64::from(steps);
        // With α = 1, D = 1/π, Λ(c) = (1/c − 1)/2, and Λ is 0 towards the viewer. The half vector is halfway up.
        let half = ((1.0 + cos) / 2.0).sqrt();
        let fresnel = normal + (edge - normal) * (1.0 - half).powi(5);
        let lambda = 0.5 * (1.0 / cos - 1.0);
        sum += (1.0 - fresnel) * albedo * cos / PI + fresnel / (4.0 * PI * (1.0 + lambda));
    }
    sum * 2.0 * PI / f64::from(steps)
}

#[test]
fn a_coat_reflects_by_its_colour_its_edge_and_its_textures() {
    let coat = |material: Material| {
        let mut scene = under_the_sky(material);
        // Alpha is ⅘. The colour is in sRGB: 255 is 1, 188 is 0.5029.
        scene.images.push(Image { width: 1, height: 1, texels: vec![[255, 188, 0, 204]], ..Default::default() });
        let camera = Camera { fov_y: 0.01, ..from_above() };
        let found = images(scene, camera, tracer(Sampling::Both, 0), 64);
        [0, 1, 2].map(|index| channel(&found, index))
    };
    let base = Material { roughness: 1.0, specular: [0.04, 0.2, 0.5], specular_edge: 0.5, ..lambert([0.5; 3]) };
    let texture = Some(Texture::new(0));
    for (material, name, scale, edge) in [
        (base.clone(), "coloured", [1.0, 1.0, 1.0], 0.5),
        (Material { specular_edge: 0.0, specular: [0.0; 3], ..base.clone() }, "without", [0.0; 3], 0.0),
        (Material { specular_texture: texture, ..base.clone() }, "weighted", [0.8; 3], 0.4),
        (Material { specular_color_texture: texture, ..base.clone() }, "tinted", [1.0, 0.5029, 0.0], 0.5),
    ] {
        for (index, found) in coat(material).into_iter().enumerate() {
            let expected = coated(0.5, [0.04, 0.2, 0.5][index] * scale[index], edge);
            found.assert_is(expected, 1e-3, &format!("{name}, channel {index}"));
        }
    }
}

#[test]
fn back_faces_of_a_culled_material_are_not_there() {
    // A sheet between the camera and the floor hides the sky. Its back or its front looks up.
    let sheet = |culled: bool, up: bool, mirrored: bool, moves: bool| {
        let mut scene = under_the_sky(lambert([0.5; 3]));
        let [u, v] = [[18.0, 0.0, 0.0], [0.0, 0.0, -18.0]];
        let [u, v] = if up { [u, v] } else { [v, u] };
        scene.meshes.push(quad([-9.0, 0.5, 9.0], u, v, 1));
        scene.materials.push(Material { culled, unlit: true, ..lambert([0.125; 3]) });
        let scale = if mirrored { [-1.0, 1.0, 1.0] } else { [1.0; 3] };
        let transform = Transform::Trs { translation: [0.0; 3], rotation: [0.0, 0.0, 0.0, 1.0], scale };
        scene.nodes.push(Node { meshes: vec![1], transform, movable: moves, ..Default::default() });
        images(scene, from_above(), tracer(Sampling::Both, 2), 1).remove(0)[0][0]
    };
    for moves in [false, true] {
        for mirrored in [false, true] {
            assert!((sheet(false, false, mirrored, moves) - 0.125).abs() < 1e-4, "both sides are seen");
            assert!((sheet(true, true, mirrored, moves) - 0.125).abs() < 1e-4, "the front is seen");
            // Light reaches the floor through the sheet's back. The floor sees its front, which keeps the sky out.
            let through = sheet(true, false, mirrored, moves);
            assert!((through - 0.125).abs() > 1e-3, "the back is seen");
        }
    }
}

/// A camera above a sheet of this opacity above a floor, under a white sky.
fn behind_a_sheet(sheet: Material, floor: Material, moves: bool) -> Scene {
    let mut scene = under_the_sky(floor);
    scene.materials.push(sheet);
    scene.meshes.push(quad([-9.0, 0.5, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], 1));
    scene.nodes.push(Node { meshes: vec![1], movable: moves, ..Default::default() });
    scene
}

#[test]
fn a_blended_surface_covers_as_much_as_its_opacity() {
    let sheet =
        |opacity: f32| Material { alpha: Alpha::Blend, base_color: [0.8, 0.0, 0.0, opacity], ..lambert([0.0; 3]) };
    for moves in [false, true] {
        for opacity in [0.0, 0.3, 0.7, 1.0] {
            let [red, blue] =
                [Material { unlit: true, ..sheet(opacity) }, Material { unlit: true, ..lambert([0.0, 0.0, 0.5]) }];
            let found = images(behind_a_sheet(red, blue, moves), from_above(), tracer(Sampling::Both, 0), 64);
            let what = format!("opacity {opacity}, moves: {moves}");
            channel(&found, 0).assert_is(0.8 * f64::from(opacity), 1e-4, &what);
            channel(&found, 2).assert_is(0.5 * f64::from(1.0 - opacity), 1e-4, &what);
        }
    }
}

#[test]
fn light_goes_through_a_blended_surface() {
    // A black sheet absorbs its opacity's share of the light on the way down, and again on the way up. It reflects nothing itself.
    let sheet = Material { alpha: Alpha::Blend, base_color: [0.0, 0.0, 0.0, 0.4], ..lambert([0.0; 3]) };
    for sampling in super::SAMPLINGS {
        let scene = behind_a_sheet(sheet.clone(), lambert([0.5; 3]), false);
        let found = images(scene, from_above(), tracer(sampling, 0), 256);
        channel(&found, 1).assert_is(0.5 * 0.6 * 0.6, 1e-3, &format!("{sampling:?}"));
    }
}

#[test]
fn the_shadow_of_a_blended_surface_is_as_dark_as_its_opacity() {
    // The sheet is above the camera, which sees its shadow alone.
    let sheet = Material { alpha: Alpha::Blend, base_color: [0.8, 0.8, 0.8, 0.3], ..lambert([0.0; 3]) };
    for moves in [false, true] {
        let mut scene = behind_a_sheet(sheet.clone(), lambert([0.5; 3]), moves);
        scene.environment = None;
        scene.meshes[1].positions.iter_mut().for_each(|position| position[1] = 4.0);
        shine(&mut scene, LightKind::Directional, [1.0; 3], f32::INFINITY, [0.0; 3]);
        let found = images(scene, from_above(), tracer(Sampling::Both, 0), 64);
        let expected = 0.5 / std::f64::consts::PI * (1.0 - 0.3);
        channel(&found, 1).assert_is(expected, 1e-3, &format!("moves: {moves}"));
    }
}

#[test]
fn repeated_paths_meet_the_same_blended_surfaces() {
    use crate::common::stage::Stage;
    use asvgf::{FilterSettings, Gradient, Settings, View};
    let sheet = Material { alpha: Alpha::Blend, base_color: [0.8, 0.0, 0.0, 0.3], ..lambert([0.0; 3]) };
    let filter = FilterSettings { gradient: Gradient::Reshade, ..Default::default() };
    let scene = behind_a_sheet(sheet, lambert([0.5; 3]), true);
    let mut stage = Stage::new(scene, SIZE, Settings { filter, ..Settings::adaptive() }).leaving_nothing_out();
    stage.camera = Some(from_above());
    for frame in 0..12 {
        assert_eq!(stage.frame().largest(View::Lambda), 0.0, "frame {frame}");
    }
}

#[test]
fn two_instances_of_one_mesh_are_met_independently() {
    // Both sheets are the same triangles, so a random number that depends on the triangle alone would let all or nothing through.
    let sheet = Material { alpha: Alpha::Blend, unlit: true, base_color: [0.0, 0.0, 0.0, 0.5], ..lambert([0.0; 3]) };
    let mut scene = behind_a_sheet(sheet, Material { unlit: true, ..lambert([1.0; 3]) }, true);
    let transform = Transform::Trs { translation: [0.0, 0.25, 0.0], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
    scene.nodes.push(Node { meshes: vec![1], transform, movable: true, ..Default::default() });
    let found = images(scene, from_above(), tracer(Sampling::Both, 0), 64);
    channel(&found, 1).assert_is(0.25, 1e-4, "two sheets of ½");
}

#[test]
fn what_is_seen_through_a_blended_surface_comes_to_rest() {
    use crate::common::stage::Stage;
    use asvgf::Settings;
    let red = Material { alpha: Alpha::Blend, unlit: true, base_color: [0.8, 0.0, 0.0, 0.3], ..lambert([0.0; 3]) };
    let blue = Material { unlit: true, ..lambert([0.0, 0.0, 0.5]) };
    let mut stage = Stage::new(behind_a_sheet(red, blue, false), SIZE, Settings::adaptive());
    stage.camera = Some(from_above());
    let image = stage.frames(64).image();
    for color in &image {
        // 64 samples of a coin with a probability of 0.3, filtered in space: 0.8 · 0.46 / 8 is one standard deviation of one pixel.
        assert!((color[0] - 0.24).abs() < 0.08 && (color[2] - 0.35).abs() < 0.05, "{color:?}");
    }
    let next = stage.frame().image();
    let change = image.iter().zip(&next).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f32::max);
    assert!(change < 0.03, "a pixel changes by {change} from frame to frame");
}

#[test]
fn the_edge_between_two_triangles_of_a_blended_quad_covers_once() {
    // The triangles' common diagonal goes through the centres of pixels.
    let sheet = Material { alpha: Alpha::Blend, unlit: true, base_color: [0.8, 0.0, 0.0, 0.3], ..lambert([0.0; 3]) };
    let black = Material { unlit: true, ..lambert([0.0; 3]) };
    for moves in [false, true] {
        let camera = Camera { eye: [0.0, 3.0, 0.0], target: [0.0; 3], ..from_above() };
        let found = images(behind_a_sheet(sheet.clone(), black.clone(), moves), camera, tracer(Sampling::Both, 0), 400);
        let diagonal = (0..SIZE[1]).map(|row| (row * SIZE[0] + (SIZE[0] - SIZE[1]) / 2 + SIZE[1] - 1 - row) as usize);
        let mean = |image: &Vec<[f32; 3]>| diagonal.clone().map(|pixel| f64::from(image[pixel][0])).sum::<f64>() / 16.0;
        let mean = found.iter().map(mean).sum::<f64>() / found.len() as f64;
        // 6400 samples of a coin with a probability of 0.3: one standard deviation is 0.8 · 0.46 / 80.
        assert!((mean - 0.24).abs() < 0.02, "{mean}");
    }
}

#[test]
fn the_albedo_behind_a_blended_surface_is_that_of_all_that_is_seen() {
    use crate::common::stage::Stage;
    use asvgf::{Settings, View};
    // The reflectance at normal incidence is part of the albedo.
    let red =
        Material { alpha: Alpha::Blend, base_color: [0.8, 0.0, 0.0, 0.3], specular: [0.04; 3], ..lambert([0.0; 3]) };
    let blue = Material { specular: [0.04; 3], ..lambert([0.0, 0.0, 0.8]) };
    for moves in [false, true] {
        let mut stage = Stage::new(behind_a_sheet(red.clone(), blue.clone(), moves), SIZE, Settings::adaptive());
        stage.camera = Some(from_above());
        for _ in 0..3 {
            for color in stage.frame().view(View::Albedo) {
                let expected = [0.3 * 0.84 + 0.7 * 0.04, 0.04, 0.3 * 0.04 + 0.7 * 0.84];
                assert!(std::iter::zip(color, expected).all(|(a, b)| (a - b).abs() < 2e-3), "{color:?}");
            }
        }
    }
}
