//! Checks and measures of scenes that are made in code.

use asvgf::scene::{
    Alpha, Animation, Channel, Environment, Image, Influence, Interpolation, Light, LightKind, Material, Mesh,
    MorphTarget, Node, Perspective, Scene, Skin, Target, Texture, Transform,
};

use crate::common::assert_close;

/// A scene in which everything occurs once.
fn whole() -> Scene {
    let channel = Channel {
        target: Target::Translation(1),
        interpolation: Interpolation::Linear,
        times: vec![0.0, 1.0],
        values: vec![[0.0; 4]; 2],
    };
    let texture = Some(Texture::new(0));
    Scene {
        meshes: vec![Mesh {
            positions: vec![[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]],
            normals: vec![[0.0, 0.0, 1.0]; 3],
            uvs: [vec![[0.0; 2]; 3], vec![]],
            targets: vec![MorphTarget { vertices: vec![2], positions: vec![[1.0, 0.0, 0.0]], ..Default::default() }],
            influences: vec![Influence { joint: 0, weight: 1.0 }; 6],
            triangles: vec![[0, 1, 2]],
            ..Mesh::default()
        }],
        materials: vec![Material { base_color_texture: texture, alpha: Alpha::Mask(0.5), ..Material::default() }],
        images: vec![Image { width: 2, height: 1, texels: vec![[0; 4]; 2], ..Image::default() }],
        nodes: vec![
            Node { meshes: vec![0], light: Some(0), camera: Some(0), ..Node::default() },
            Node { parent: Some(0), meshes: vec![0], skin: Some(0), weights: vec![0.5], ..Node::default() },
            Node { transform: Transform::Matrix(asvgf::scene::IDENTITY), ..Node::default() },
        ],
        skins: vec![Skin { joints: vec![2], inverse_bind: vec![asvgf::scene::IDENTITY] }],
        lights: vec![Light {
            kind: LightKind::Spot { inner: 0.1, outer: 0.2 },
            intensity: [1.0; 3],
            range: f32::INFINITY,
        }],
        cameras: vec![Perspective { fov_y: 1.0 }],
        environment: Some(Environment::uniform([1.0; 3])),
        animations: vec![Animation { name: String::new(), channels: vec![channel] }],
        resting_factors: vec![(Target::Emission(0), [0.5; 3])],
    }
}

#[track_caller]
fn broken(change: impl FnOnce(&mut Scene), element: &str, reason: &str) {
    let mut scene = whole();
    scene.validate().unwrap();
    change(&mut scene);
    let error = scene.validate().expect_err(element);
    assert_eq!(error.file, "scene");
    assert!(error.element.contains(element) && error.reason.contains(reason), "{error}");
    // Measuring and posing do not panic, whatever is wrong.
    let pose = scene.pose(Some(0), 0.5);
    scene.bounds(&pose);
    scene.surface_area(&pose);
    scene.triangle_count();
    scene.animated_nodes();
    scene.shape(&pose, 1, 0);
    scene.camera_view(&pose, 0);
}

#[test]
fn every_rule_is_checked() {
    broken(|scene| scene.meshes[0].material = 1, "meshes[0].material", "index 1 is out of range");
    broken(|scene| scene.meshes[0].triangles[0][1] = 3, "meshes[0].triangles[0]", "index 3");
    broken(|scene| scene.meshes[0].normals.truncate(2), "meshes[0].normals", "2 entries for 3 vertices");
    broken(|scene| scene.meshes[0].uvs[1].push([0.0; 2]), "meshes[0].uvs[1]", "1 entries");
    broken(|scene| scene.meshes[0].positions[2][1] = f32::NAN, "meshes[0].positions[2]", "not finite");
    broken(|scene| scene.meshes[0].normals[0][0] = f32::INFINITY, "meshes[0].normals[0]", "not finite");
    broken(|scene| scene.meshes[0].uvs[0][1][0] = f32::NAN, "meshes[0].uvs[0][1]", "not finite");
    broken(|scene| scene.materials[0].base_color[3] = 1.5, "materials[0].base_color", "1.5");
    broken(|scene| scene.materials[0].metallic = -0.5, "materials[0].metallic", "0…1");
    broken(|scene| scene.materials[0].roughness = f32::NAN, "materials[0].roughness", "NaN");
    broken(|scene| scene.materials[0].specular[1] = 2.0, "materials[0].specular", "2");
    broken(|scene| scene.materials[0].emissive[0] = -1.0, "materials[0].emissive", "-1");
    broken(|scene| scene.materials[0].emissive[0] = f32::INFINITY, "materials[0].emissive", "inf");
    broken(|scene| scene.materials[0].alpha = Alpha::Mask(f32::NAN), "materials[0].alpha", "NaN");
    broken(|scene| scene.materials[0].emissive_texture = Some(Texture::new(1)), "emissive_texture.image", "index 1");
    let texture = |change: fn(&mut Texture)| {
        move |scene: &mut Scene| change(scene.materials[0].base_color_texture.as_mut().unwrap())
    };
    broken(texture(|texture| texture.uv_set = 2), "base_color_texture.uv_set", "index 2");
    broken(texture(|texture| texture.transform[1][2] = f32::NAN), "base_color_texture.transform[1]", "not finite");
    broken(|scene| scene.images[0].height = 2, "images[0]", "2 × 2 does not match 2 texels");
    broken(|scene| scene.images[0] = Image::default(), "images[0]", "0 × 0");
    broken(|scene| scene.nodes[1].parent = Some(1), "nodes[1].parent", "not smaller");
    broken(|scene| scene.nodes[0].meshes.push(4), "nodes[0].meshes", "index 4");
    broken(|scene| scene.nodes[0].light = Some(4), "nodes[0].light", "index 4");
    broken(|scene| scene.nodes[0].camera = Some(4), "nodes[0].camera", "index 4");
    let rotated = |rotation| Transform::Trs { translation: [0.0; 3], rotation, scale: [1.0; 3] };
    broken(|scene| scene.nodes[0].transform = rotated([0.0; 4]), "nodes[0].transform", "unit quaternion");
    broken(|scene| scene.nodes[0].transform = rotated([f32::NAN; 4]), "nodes[0].transform", "unit quaternion");
    broken(|scene| scene.nodes[2].transform = Transform::Matrix([[1.0; 4]; 4]), "nodes[2].transform", "last row");
    broken(|scene| scene.nodes[1].skin = Some(1), "nodes[1].skin", "index 1");
    broken(|scene| scene.nodes[1].weights[0] = f32::NAN, "nodes[1].weights", "not finite");
    broken(|scene| scene.meshes[0].influences[5].joint = 1, "meshes[0].influences[5].joint", "index 1");
    broken(|scene| scene.meshes[0].influences[5].weight = f32::NAN, "meshes[0].influences[5]", "not finite");
    broken(|scene| scene.meshes[0].influences.truncate(5), "meshes[0].influences", "5 entries for 3 vertices");
    broken(|scene| scene.meshes[0].targets[0].vertices[0] = 3, "meshes[0].targets[0].vertices[0]", "index 3");
    broken(|scene| scene.meshes[0].targets[0].normals = vec![[0.0; 3]; 2], "targets[0].normals", "2 entries for 1");
    broken(|scene| scene.meshes[0].targets[0].positions[0][1] = f32::NAN, "targets[0].positions[0]", "not finite");
    broken(|scene| scene.skins[0].joints[0] = 3, "skins[0].joints[0]", "index 3");
    broken(|scene| scene.skins[0].joints.clear(), "skins[0].inverse_bind", "1 matrices for 0 joints");
    broken(|scene| scene.skins[0].inverse_bind[0][3][3] = 0.5, "skins[0].inverse_bind[0]", "last row");
    broken(|scene| scene.lights[0].intensity[1] = f32::NAN, "lights[0].intensity", "NaN");
    broken(|scene| scene.lights[0].range = 0.0, "lights[0].range", "above 0");
    let cone = |inner, outer| move |scene: &mut Scene| scene.lights[0].kind = LightKind::Spot { inner, outer };
    broken(cone(0.5, 0.5), "lights[0].kind", "0.5 and 0.5");
    broken(cone(0.5, 2.0), "lights[0].kind", "π/2");
    broken(|scene| scene.cameras[0].fov_y = 4.0, "cameras[0].fov_y", "between 0 and π");
    broken(|scene| scene.environment.as_mut().unwrap().radiance[0][0] = -1.0, "environment.radiance", "-1");
    broken(|scene| scene.environment.as_mut().unwrap().width = 3, "environment", "3 × 1");
    let channel = |change: fn(&mut Channel)| move |scene: &mut Scene| change(&mut scene.animations[0].channels[0]);
    let element = "animations[0].channels[0]";
    broken(channel(|channel| channel.target = Target::Scale(9)), element, "index 9");
    broken(channel(|channel| channel.target = Target::Scale(2)), element, "matrix");
    broken(channel(|channel| channel.target = Target::Emission(1)), element, "index 1");
    broken(channel(|channel| channel.target = Target::Weight { node: 1, target: 1 }), element, "index 1");
    broken(channel(|channel| channel.target = Target::Intensity(1)), element, "index 1");
    broken(channel(|channel| channel.target = Target::EmissionColor(1)), element, "index 1");
    broken(channel(|channel| channel.target = Target::IntensityColor(1)), element, "index 1");
    broken(|scene| scene.resting_factors[0].0 = Target::Emission(1), "resting_factors[0]", "index 1");
    broken(|scene| scene.resting_factors[0].0 = Target::Scale(0), "resting_factors[0]", "no factor");
    broken(|scene| scene.resting_factors[0].1[2] = f32::NAN, "resting_factors[0]", "NaN");
    broken(channel(|channel| channel.times.clear()), element, "no key");
    broken(channel(|channel| channel.times[1] = 0.0), element, "do not increase");
    broken(channel(|channel| channel.times[1] = f32::NAN), element, "not finite");
    broken(channel(|channel| channel.values[1][0] = f32::NAN), element, "not finite");
    broken(channel(|channel| channel.interpolation = Interpolation::CubicSpline), element, "where 6 belong");
    broken(
        |scene| {
            let copy = scene.animations[0].channels[0].clone();
            scene.animations[0].channels.push(copy);
        },
        "animations[0].channels[1].target",
        "earlier channel",
    );
}

#[test]
fn measures_are_those_of_the_placed_triangles() {
    let mut scene = whole();
    scene.nodes[0].transform =
        Transform::Trs { translation: [0.0, 0.0, 1.0], rotation: [0.0, 0.0, 0.0, 1.0], scale: [2.0; 3] };
    scene.nodes[1].transform =
        Transform::Trs { translation: [0.0, 0.0, 1.0], rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0, -1.0, 1.0] };
    scene.nodes[1].weights.clear();
    scene.nodes[1].skin = None;
    let pose = scene.pose(None, 0.0);
    assert_eq!(scene.triangle_count(), 2);
    assert!((scene.surface_area(&pose) - 4.0).abs() < 1e-9);
    assert_eq!(scene.bounds(&pose), Some([[0.0, -2.0, 1.0], [2.0, 2.0, 3.0]]));
    assert_eq!(Scene::default().bounds(&Scene::default().pose(None, 0.0)), None);
}

#[test]
fn a_camera_keeps_its_up_vector_upright_under_shear() {
    let mut scene = whole();
    let matrix = [[1.0, 0.0, 0.0, 0.0], [0.0, 3.0, 3.0, 0.0], [0.0, 0.0, 2.0, 0.0], [1.0, 2.0, 3.0, 1.0]];
    scene.nodes[0].transform = Transform::Matrix(matrix);
    let view = scene.camera_view(&scene.pose(None, 0.0), 0).unwrap();
    assert_eq!(view.eye, [1.0, 2.0, 3.0]);
    assert_close(&view.target, &[1.0, 2.0, 2.0], 1e-6);
    assert_close(&view.up, &[0.0, 1.0, 0.0], 1e-6);
    scene.nodes[0].transform = Transform::Matrix([[0.0; 4], [0.0; 4], [0.0; 4], [0.0, 0.0, 0.0, 1.0]]);
    assert_eq!(scene.camera_view(&scene.pose(None, 0.0), 0), None);
}
