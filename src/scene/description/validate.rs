//! The rules that a [`Scene`] must keep to be drawn.

use std::collections::HashSet;
use std::f32::consts::{FRAC_PI_2, PI};

use crate::scene::description::{
    Alpha, Animation, Channel, Environment, Image, Influence, Interior, Interpolation, Light, LightKind, Material,
    Matrix, Mesh, Node, Scene, SceneError, Skin, Target, Texture, Transform,
};

/// The first broken rule: element and reason.
type Broken = (String, String);

impl Scene {
    /// Checks the whole scene: indices are in range, arrays that belong together have the same length, parents come before their
    /// children, and numbers are finite and within their documented ranges.
    ///
    /// # Errors
    ///
    /// Names the element that breaks the first rule (`meshes[2].triangles[7]`) and the reason, with `scene` as the file.
    pub fn validate(&self) -> Result<(), SceneError> {
        self.check().map_err(|(element, reason)| SceneError { file: "scene".into(), element, reason })
    }

    fn check(&self) -> Result<(), Broken> {
        each(&self.meshes, "meshes", |mesh, element| self.check_mesh(mesh, element))?;
        each(&self.skins, "skins", |skin, element| self.check_skin(skin, element))?;
        each(&self.materials, "materials", |material, element| self.check_material(material, element))?;
        each(&self.images, "images", check_image)?;
        for (index, node) in self.nodes.iter().enumerate() {
            self.check_node(index, node)?;
        }
        each(&self.lights, "lights", check_light)?;
        each(&self.cameras, "cameras", |camera, element| {
            let open = camera.fov_y > 0.0 && camera.fov_y < PI;
            rule(open, || format!("{element}.fov_y"), || format!("{} is not between 0 and π", camera.fov_y))
        })?;
        self.environment.as_ref().map_or(Ok(()), check_environment)?;
        each(&self.animations, "animations", |animation, element| self.check_animation(animation, element))?;
        each(&self.resting_factors, "resting_factors", |&(target, value), element| {
            self.check_target(target, element)?;
            let is_factor = !matches!(target, Target::Weight { .. }) && target.node().is_none();
            rule(is_factor, || element.into(), || format!("{target:?} has no factor"))?;
            non_negative(&value, || element.into())
        })
    }

    fn check_mesh(&self, mesh: &Mesh, element: &str) -> Result<(), Broken> {
        index(mesh.material, self.materials.len(), || format!("{element}.material"))?;
        let vertices = mesh.positions.len();
        let optional = [
            ("normals", mesh.normals.len()),
            ("tangents", mesh.tangents.len()),
            ("uvs[0]", mesh.uvs[0].len()),
            ("uvs[1]", mesh.uvs[1].len()),
            ("colors", mesh.colors.len()),
        ];
        for (name, length) in optional {
            rule(
                length == 0 || length == vertices,
                || format!("{element}.{name}"),
                || format!("{length} entries for {vertices} vertices (as many, or none)"),
            )?;
        }
        all_finite(&mesh.positions, || format!("{element}.positions"))?;
        all_finite(&mesh.normals, || format!("{element}.normals"))?;
        all_finite(&mesh.tangents, || format!("{element}.tangents"))?;
        all_finite(&mesh.uvs[0], || format!("{element}.uvs[0]"))?;
        all_finite(&mesh.uvs[1], || format!("{element}.uvs[1]"))?;
        for (vertex, color) in mesh.colors.iter().enumerate() {
            color.iter().try_for_each(|&channel| unit(channel, || format!("{element}.colors[{vertex}]")))?;
        }
        for (triangle, corners) in mesh.triangles.iter().enumerate() {
            for &corner in corners {
                index(corner as usize, vertices, || format!("{element}.triangles[{triangle}]"))?;
            }
        }
        self.check_deformation(mesh, element)
    }

    fn check_deformation(&self, mesh: &Mesh, element: &str) -> Result<(), Broken> {
        let vertices = mesh.positions.len();
        let influences = mesh.influences.len();
        rule(
            influences == 0 || vertices > 0 && influences.is_multiple_of(vertices),
            || format!("{element}.influences"),
            || format!("{influences} entries for {vertices} vertices (as many for each)"),
        )?;
        let weights = |influence: &Influence| [influence.weight];
        all_finite(&mesh.influences.iter().map(weights).collect::<Vec<_>>(), || format!("{element}.influences"))?;
        each(&mesh.targets, &format!("{element}.targets"), |target, element| {
            let moved = target.vertices.len();
            let lists =
                [("positions", &target.positions), ("normals", &target.normals), ("tangents", &target.tangents)];
            for (name, list) in lists {
                rule(
                    list.is_empty() || list.len() == moved,
                    || format!("{element}.{name}"),
                    || format!("{} entries for {moved} vertices (as many, or none)", list.len()),
                )?;
                all_finite(list, || format!("{element}.{name}"))?;
            }
            let mut vertex = target.vertices.iter().enumerate();
            vertex.try_for_each(|(at, &v)| index(v as usize, vertices, || format!("{element}.vertices[{at}]")))
        })
    }

    fn check_skin(&self, skin: &Skin, element: &str) -> Result<(), Broken> {
        let (joints, inverses) = (skin.joints.len(), skin.inverse_bind.len());
        rule(
            joints == inverses && joints > 0,
            || format!("{element}.inverse_bind"),
            || format!("{inverses} matrices for {joints} joints (as many, and at least one)"),
        )?;
        for (joint, (&node, matrix)) in skin.joints.iter().zip(&skin.inverse_bind).enumerate() {
            index(node, self.nodes.len(), || format!("{element}.joints[{joint}]"))?;
            check_affine(matrix, || format!("{element}.inverse_bind[{joint}]"))?;
        }
        Ok(())
    }

    fn check_material(&self, material: &Material, element: &str) -> Result<(), Broken> {
        for channel in material.base_color {
            unit(channel, || format!("{element}.base_color"))?;
        }
        unit(material.metallic, || format!("{element}.metallic"))?;
        unit(material.roughness, || format!("{element}.roughness"))?;
        for channel in material.specular {
            unit(channel, || format!("{element}.specular"))?;
        }
        unit(material.specular_edge, || format!("{element}.specular_edge"))?;
        unit(material.clearcoat.weight, || format!("{element}.clearcoat.weight"))?;
        unit(material.clearcoat.roughness, || format!("{element}.clearcoat.roughness"))?;
        for (name, scale) in
            [("normal_scale", material.normal_scale), ("clearcoat.normal_scale", material.clearcoat.normal_scale)]
        {
            rule(scale.is_finite(), || format!("{element}.{name}"), || format!("{scale} is not finite"))?;
        }
        unit(material.transmission, || format!("{element}.transmission"))?;
        let Interior { index, absorption } = material.interior;
        rule(
            (1.0..=Interior::MOST_INDEX).contains(&index),
            || format!("{element}.interior.index"),
            || format!("{index} is not within 1…{}", Interior::MOST_INDEX),
        )?;
        non_negative(&absorption.unwrap_or_default(), || format!("{element}.interior.absorption"))?;
        non_negative(&material.emissive, || format!("{element}.emissive"))?;
        if let Alpha::Mask(cutoff) = material.alpha {
            non_negative(&[cutoff], || format!("{element}.alpha"))?;
        }
        for (name, texture) in material.textures() {
            self.check_texture(&texture, &format!("{element}.{name}"))?;
        }
        Ok(())
    }

    fn check_texture(&self, texture: &Texture, element: &str) -> Result<(), Broken> {
        index(texture.image, self.images.len(), || format!("{element}.image"))?;
        index(texture.uv_set, 2, || format!("{element}.uv_set"))?;
        all_finite(&texture.transform, || format!("{element}.transform"))
    }

    fn check_node(&self, own: usize, node: &Node) -> Result<(), Broken> {
        let element = format!("nodes[{own}]");
        if let Some(parent) = node.parent {
            rule(
                parent < own,
                || format!("{element}.parent"),
                || format!("{parent} is not smaller than the node's own index"),
            )?;
        }
        match &node.transform {
            Transform::Trs { translation, rotation, scale } => {
                all_finite(&[*translation, *scale], || format!("{element}.transform"))?;
                check_quaternion(rotation, || format!("{element}.transform"))?;
            }
            Transform::Matrix(matrix) => check_affine(matrix, || format!("{element}.transform"))?,
        }
        for &mesh in &node.meshes {
            index(mesh, self.meshes.len(), || format!("{element}.meshes"))?;
        }
        all_finite(&[&node.weights], || format!("{element}.weights"))?;
        if let Some(skin) = node.skin {
            index(skin, self.skins.len(), || format!("{element}.skin"))?;
            let joints = self.skins[skin].joints.len();
            for &mesh in &node.meshes {
                let influences = self.meshes[mesh].influences.iter().enumerate();
                for (at, influence) in influences {
                    index(influence.joint as usize, joints, || format!("meshes[{mesh}].influences[{at}].joint"))?;
                }
            }
        }
        if let Some(light) = node.light {
            index(light, self.lights.len(), || format!("{element}.light"))?;
        }
        node.camera.map_or(Ok(()), |camera| index(camera, self.cameras.len(), || format!("{element}.camera")))
    }

    fn check_animation(&self, animation: &Animation, element: &str) -> Result<(), Broken> {
        let mut targets = HashSet::new();
        each(&animation.channels, &format!("{element}.channels"), |channel, element| {
            self.check_target(channel.target, element)?;
            rule(
                targets.insert(channel.target),
                || format!("{element}.target"),
                || format!("{:?} is the target of an earlier channel as well", channel.target),
            )?;
            check_channel(channel, element)
        })
    }

    fn check_target(&self, target: Target, element: &str) -> Result<(), Broken> {
        let element = || format!("{element}.target");
        match target {
            Target::Emission(material) | Target::EmissionColor(material) => {
                index(material, self.materials.len(), element)
            }
            Target::Intensity(light) | Target::IntensityColor(light) => index(light, self.lights.len(), element),
            Target::Weight { node, target } => {
                index(node, self.nodes.len(), element)?;
                index(target, self.target_count(&self.nodes[node]), element)
            }
            Target::Translation(node) | Target::Rotation(node) | Target::Scale(node) => {
                index(node, self.nodes.len(), element)?;
                let moves = self.nodes.get(node).is_some_and(|node| matches!(node.transform, Transform::Trs { .. }));
                rule(moves, element, || format!("node {node} has a matrix, which cannot be animated"))
            }
        }
    }
}

fn check_image(image: &Image, element: &str) -> Result<(), Broken> {
    check_size(image.width, image.height, image.texels.len(), element)
}

fn check_environment(environment: &Environment) -> Result<(), Broken> {
    check_size(environment.width, environment.height, environment.radiance.len(), "environment")?;
    environment.radiance.iter().try_for_each(|radiance| non_negative(radiance, || "environment.radiance".into()))
}

fn check_size(width: u32, height: u32, texels: usize, element: &str) -> Result<(), Broken> {
    let sound = width > 0 && height > 0 && u64::from(width) * u64::from(height) == texels as u64;
    rule(sound, || element.into(), || format!("{width} × {height} does not match {texels} texels"))
}

fn check_light(light: &Light, element: &str) -> Result<(), Broken> {
    non_negative(&light.intensity, || format!("{element}.intensity"))?;
    // Infinity is a range; NaN is not greater than zero.
    rule(light.range > 0.0, || format!("{element}.range"), || format!("{} is not above 0", light.range))?;
    match light.kind {
        LightKind::Directional | LightKind::Point => Ok(()),
        LightKind::Spot { inner, outer } => rule(
            0.0 <= inner && inner < outer && outer <= FRAC_PI_2,
            || format!("{element}.kind"),
            || format!("half angles {inner} and {outer} do not keep 0 ≤ inner < outer ≤ π/2"),
        ),
    }
}

fn check_channel(channel: &Channel, element: &str) -> Result<(), Broken> {
    let keys = channel.times.len();
    rule(keys > 0, || format!("{element}.times"), || "no key".into())?;
    all_finite(&[channel.times.as_slice()], || format!("{element}.times"))?;
    let increasing = channel.times.is_sorted_by(|earlier, later| earlier < later);
    rule(increasing, || format!("{element}.times"), || "key times do not increase".into())?;
    let expected = match channel.interpolation {
        Interpolation::CubicSpline => keys.saturating_mul(3),
        Interpolation::Step | Interpolation::Linear => keys,
    };
    let values = channel.values.len();
    rule(
        values == expected,
        || format!("{element}.values"),
        || format!("{values} values for {keys} keys, where {expected} belong"),
    )?;
    all_finite(&channel.values, || format!("{element}.values"))
}

fn check_affine(matrix: &Matrix, element: impl Fn() -> String) -> Result<(), Broken> {
    all_finite(matrix, &element)?;
    let affine = matrix.map(|column| column[3]) == [0.0, 0.0, 0.0, 1.0];
    rule(affine, element, || "the last row is not 0, 0, 0, 1".into())
}

fn check_quaternion(rotation: &[f32; 4], element: impl FnOnce() -> String) -> Result<(), Broken> {
    let length = rotation.iter().map(|x| x * x).sum::<f32>().sqrt();
    rule((length - 1.0).abs() < 1e-2, element, || format!("rotation {rotation:?} is not a unit quaternion"))
}

fn each<T>(items: &[T], name: &str, mut check: impl FnMut(&T, &str) -> Result<(), Broken>) -> Result<(), Broken> {
    items.iter().enumerate().try_for_each(|(index, item)| check(item, &format!("{name}[{index}]")))
}

fn rule(holds: bool, element: impl FnOnce() -> String, reason: impl FnOnce() -> String) -> Result<(), Broken> {
    if holds { Ok(()) } else { Err((element(), reason())) }
}

fn index(index: usize, count: usize, element: impl FnOnce() -> String) -> Result<(), Broken> {
    rule(index < count, element, || format!("index {index} is out of range: there are {count}"))
}

fn unit(value: f32, element: impl FnOnce() -> String) -> Result<(), Broken> {
    rule((0.0..=1.0).contains(&value), element, || format!("{value} is not within 0…1"))
}

fn non_negative(values: &[f32], element: impl FnOnce() -> String) -> Result<(), Broken> {
    let holds = values.iter().all(|&value| value >= 0.0 && value.is_finite());
    rule(holds, element, || format!("{values:?} is not finite and ≥ 0"))
}

fn all_finite<T: AsRef<[f32]>>(items: &[T], element: impl FnOnce() -> String) -> Result<(), Broken> {
    match items.iter().position(|item| item.as_ref().iter().any(|x| !x.is_finite())) {
        None => Ok(()),
        Some(position) => Err((format!("{}[{position}]", element()), "not finite".into())),
    }
}
