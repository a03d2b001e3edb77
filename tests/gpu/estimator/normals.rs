//! Normal maps: the cosine of the mapped normal, its frame, and the energy that is left.

use super::{SIZE, channel, from_above, images, tracer};
use crate::common::plane::{V, add, dot, scale, sub, unit};
use crate::common::scenes::{lambert, textured_floor};
use crate::common::stage::Stage;
use asvgf::scene::{Environment, Light, LightKind, Material, Node, Scene, Texture, Transform};
use asvgf::{Camera, Sampling, Settings, View};
use std::f64::consts::PI;

const ALBEDO: f64 = 0.6;

/// Direction to the sun.
const SUN: V = [0.4, 0.8, 0.2];

/// The floor with an image of this texel for its normals, without light.
fn mapped(texel: [u8; 3], normal_scale: f32, material: Material) -> Scene {
    let material = Material { normal_texture: Some(Texture::new(0)), normal_scale, ..material };
    textured_floor(texel, material)
}

/// Adds a sun of this direction and radiance 1.
fn shine(scene: &mut Scene, sun: V) {
    let [x, y, z] = unit(sun);
    // The turn from −Z to −sun: (−Z × −sun, 1 + Z·sun), made a unit quaternion.
    let turn = [-y, x, 0.0, 1.0 + z];
    let length = turn.iter().map(|c| c * c).sum::<f64>().sqrt();
    let rotation = turn.map(|c| (c / length) as f32);
    let transform = Transform::Trs { translation: [0.0; 3], rotation, scale: [1.0; 3] };
    scene.lights.push(Light { kind: LightKind::Directional, intensity: [1.0; 3], range: f32::INFINITY });
    scene.nodes.push(Node { light: Some(scene.lights.len() - 1), transform, ..Default::default() });
}

/// The normal of a texel, in the space of the image.
fn normal(texel: [u8; 3], slope: f64) -> V {
    let [x, y, z] = texel.map(|byte| f64::from(byte) / 127.5 - 1.0);
    unit([x * slope, y * slope, z])
}

/// Asserts that each pixel of the sunlit scene shows the cosine of the angle between this normal and the sun.
#[track_caller]
fn assert_shows(mut scene: Scene, camera: Camera, sun: V, expected: V, what: &str) {
    shine(&mut scene, sun);
    let cosine = dot(unit(expected), unit(sun)).max(0.0);
    for sampling in [Sampling::Both, Sampling::Lights] {
        let image = images(scene.clone(), camera, tracer(sampling, 0), 1).remove(0);
        for color in image {
            let difference = (f64::from(color[0]) - ALBEDO / PI * cosine).abs();
            assert!(difference < 1e-4, "{what}: {color:?}, not {}", ALBEDO / PI * cosine);
        }
    }
}

fn matte() -> Material {
    lambert([ALBEDO as f32; 3])
}

const TEXELS: [[u8; 3]; 5] = [[128, 128, 255], [200, 128, 230], [128, 40, 220], [60, 190, 210], [255, 128, 128]];

#[test]
fn a_tilted_map_under_a_sun_shows_the_cosine_of_the_tilted_normal() {
    for texel in TEXELS {
        for slope in [1.0, 0.5, 2.0, -1.0, 0.0_f32] {
            let [x, y, z] = normal(texel, f64::from(slope));
            let what = format!("{texel:?} × {slope}");
            assert_shows(mapped(texel, slope, matte()), from_above(), SUN, [x, z, y], &what);
        }
    }
}

#[test]
fn mirrored_coordinates_and_the_second_set_turn_the_map() {
    let texel = [200, 60, 220];
    let [x, y, z] = normal(texel, 1.0);
    let with = |uv: fn([f32; 2]) -> [f32; 2], set: usize| {
        let mut scene = mapped(texel, 1.0, matte());
        let uvs = scene.meshes[0].uvs[0].iter().map(|&at| uv(at)).collect();
        scene.meshes[0].uvs[set] = uvs;
        scene.materials[0].normal_texture = Some(Texture { uv_set: set, ..Texture::new(0) });
        scene
    };
    for set in [0, 1] {
        let shows = |uv, expected, what| assert_shows(with(uv, set), from_above(), SUN, expected, what);
        shows(|at| at, [x, z, y], "as it is");
        shows(|[u, v]| [1.0 - u, v], [-x, z, y], "mirrored in u");
        shows(|[u, v]| [u, 1.0 - v], [x, z, -y], "mirrored in v");
        shows(|[u, v]| [v, u], [-y, z, -x], "its axes exchanged");
        shows(|[u, v]| [3.0 * u, 5.0 * v], [x, z, y], "stretched");
    }
}

#[test]
fn tangents_of_the_mesh_have_a_handedness() {
    let texel = [200, 60, 220];
    let [x, y, z] = normal(texel, 1.0);
    for (tangent, expected) in [
        ([1.0, 0.0, 0.0, -1.0], [x, z, y]),
        ([1.0, 0.0, 0.0, 1.0], [x, z, -y]),
        ([0.0, 0.0, 1.0, 1.0], [y, z, x]),
        ([0.0, 0.0, 1.0, -1.0], [-y, z, x]),
    ] {
        let mut scene = mapped(texel, 1.0, matte());
        scene.meshes[0].normals = vec![[0.0, 1.0, 0.0]; 4];
        scene.meshes[0].tangents = vec![tangent; 4];
        assert_shows(scene, from_above(), SUN, expected, &format!("{tangent:?}"));
    }
}

#[test]
fn placements_turn_and_mirror_the_relief() {
    let texel = [200, 60, 220];
    let [x, y, z] = normal(texel, 1.0);
    let half = std::f32::consts::FRAC_1_SQRT_2;
    for movable in [false, true] {
        for (rotation, scale, expected) in [
            ([0.0, 0.0, 0.0, 1.0], [-1.0, 1.0, 1.0], [-x, z, y]),
            ([0.0, 0.0, 0.0, 1.0], [1.0, 1.0, -1.0], [x, z, -y]),
            ([0.0, 0.0, 0.0, 1.0], [-3.0, 2.0, -2.0], [-x, z, -y]),
            // A quarter turn about Y brings X to −Z and Z to X.
            ([0.0, half, 0.0, half], [1.0, 1.0, 1.0], [y, z, -x]),
            ([0.0, half, 0.0, half], [-1.0, 1.0, 1.0], [y, z, x]),
        ] {
            let mut scene = mapped(texel, 1.0, matte());
            scene.nodes[0].transform = Transform::Trs { translation: [0.0; 3], rotation, scale };
            scene.nodes[0].movable = movable;
            let what = format!("{rotation:?} {scale:?}, movable: {movable}");
            assert_shows(scene, from_above(), SUN, expected, &what);
        }
    }
}

#[test]
fn the_back_shows_the_relief_turned_over() {
    let texel = [200, 60, 220];
    let [x, y, z] = normal(texel, 1.0);
    let below = Camera { eye: [0.3, -3.0, 0.2], ..from_above() };
    let sun = [SUN[0], -SUN[1], SUN[2]];
    assert_shows(mapped(texel, 1.0, matte()), below, sun, [-x, -z, -y], "the back");
}

#[test]
fn light_of_the_mapped_normal_never_comes_through_the_surface() {
    // The relief faces a sun that is below the floor.
    let mut scene = mapped([255, 128, 140], 1.0, matte());
    shine(&mut scene, [1.0, -0.05, 0.0]);
    for sampling in [Sampling::Both, Sampling::Lights] {
        let image = images(scene.clone(), from_above(), tracer(sampling, 2), 1).remove(0);
        assert!(image.iter().all(|color| *color == [0.0; 3]), "{sampling:?}");
    }
}

#[test]
fn the_denoiser_sees_the_normal_without_the_relief() {
    let mut scene = mapped([200, 60, 220], 1.0, matte());
    shine(&mut scene, SUN);
    let mut stage = Stage::new(scene, SIZE, Settings::adaptive());
    stage.camera = Some(from_above());
    for found in stage.frame().view(View::Normal) {
        let difference = [0.0, 1.0, 0.0].iter().zip(found).map(|(a, b)| f32::abs(a - b)).fold(0.0, f32::max);
        assert!(difference < 2e-3, "{found:?} is not the floor's");
    }
}

/// Mean of the light that the mapped floor reflects under a white sky.
fn under_the_sky(scene: Scene, camera: Camera, paths: u32) -> crate::common::statistics::Estimate {
    let scene = Scene { environment: Some(Environment::uniform([1.0; 3])), ..scene };
    channel(&images(scene, camera, tracer(Sampling::Both, 0), paths), 0)
}

#[test]
fn a_matte_relief_loses_the_light_from_below_the_surface() {
    for texel in TEXELS {
        // The part of a cosine lobe about the tilted normal that lies above the surface.
        let cosine = normal(texel, 1.0)[2];
        let found = under_the_sky(mapped(texel, 1.0, matte()), from_above(), 64);
        found.assert_is(ALBEDO * (1.0 + cosine) / 2.0, 5e-4, &format!("{texel:?}"));
    }
}

/// The part of the light from everywhere that GGX metal of this width about the normal n reflects to `view` above the surface z = 0, by the
/// midpoint rule; n is bent as in Keller et al. 2017, appendix A.3.
fn metal(alpha: f64, n: V, view: V) -> f64 {
    let mirrored = sub(scale(n, 2.0 * dot(n, view)), view);
    let n = if mirrored[2] < 0.0 {
        let lifted = unit(sub(mirrored, scale(n, mirrored[2] / n[2])));
        unit(add(view, lifted))
    } else {
        n
    };
    let lambda = |c: f64| 0.5 * ((1.0 + alpha * alpha * (1.0 - c * c) / (c * c)).sqrt() - 1.0);
    let facing = dot(n, view);
    let steps = 500;
    let mut sum = 0.0;
    for i in 0..steps {
        let z = (f64::from(i) + 0.5) / f64::from(steps);
        for j in 0..2 * steps {
            let azimuth = (f64::from(j) + 0.5) / f64::from(steps) * PI;
            let r = (1.0 - z * z).sqrt();
            let light = [r * azimuth.cos(), r * azimuth.sin(), z];
            let cosine = dot(n, light);
            if cosine <= 0.0 {
                continue;
            }
            let h = dot(n, unit(add(view, light)));
            let d = alpha * alpha / (PI * (h * h * (alpha * alpha - 1.0) + 1.0).powi(2));
            sum += d / (4.0 * facing * (1.0 + lambda(facing) + lambda(cosine)));
        }
    }
    sum * 2.0 * PI / f64::from(2 * steps * steps)
}

#[test]
fn a_metal_relief_reflects_what_its_bent_normal_leaves() {
    for texel in [[128, 128, 255], [170, 128, 245], [210, 128, 220]] {
        for eye in [[0.0, 3.0, 0.0], [2.4, 1.8, 0.0], [-3.0, 0.8, 0.0]] {
            let camera = Camera { eye, target: [0.0; 3], up: [0.0, 0.5, -1.0], fov_y: 0.01, ..Default::default() };
            let [x, y, z] = normal(texel, 1.0);
            let [a, b, c] = unit(eye);
            // The axes of the image, with its height last.
            let expected = metal(0.25, [x, y, z], [a, c, b]);
            let metal = Material { metallic: 1.0, roughness: 0.5, ..lambert([1.0; 3]) };
            let found = under_the_sky(mapped(texel, 1.0, metal), camera, 96);
            println!("{texel:?} from {eye:?}: {:.4}, expected {expected:.4}", found.mean);
            found.assert_is(expected, 1e-3, &format!("{texel:?} from {eye:?}"));
            assert!(expected > 0.3, "nothing is black");
        }
    }
}
