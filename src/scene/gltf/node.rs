//! The node hierarchy of the default scene, with its lights and cameras.

use std::collections::{HashMap, HashSet};
use std::f32::consts::{FRAC_PI_2, PI};

use glam::{Affine3A, Mat4, Quat, Vec4};
use gltf::json::extensions::scene::khr_lights_punctual as punctual;
use gltf::json::validation::Checked;
use gltf::json::{Index, Node as NodeSource, camera};

use super::mesh::Meshes;
use super::source::{Source, lookup};
use crate::scene::description::{Light, LightKind, Node, Perspective, Scene, Transform};
use crate::scene::load::report::{Fault, Report};

/// Where each node of the file that is in the scene came to lie in [`Scene::nodes`].
pub(super) type Places = HashMap<usize, usize>;

/// A node and its parent, if it has one.
type Link = (Index<NodeSource>, Option<Index<NodeSource>>);

/// Reads the nodes of the default scene, and the meshes, lights and cameras that they place.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene) -> Result<Places, Fault> {
    let lights = source.root.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
    let lights = lights.map_or(&[][..], |extension| &extension.lights);
    for (index, light) in lights.iter().enumerate() {
        scene.lights.push(read_light(light, &format!("KHR_lights_punctual.lights[{index}]"), report)?);
    }
    let cameras = read_cameras(source, report, scene)?;
    let animated = animated(source);
    let mut meshes = Meshes::new(source);
    let mut places = Places::new();

    for (index, parent) in ordered(source, report)? {
        let element = format!("nodes[{index}]");
        let node = source.get(index, &element)?;
        let light = node.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
        if let Some(light) = light {
            lookup(lights, light.light, &format!("{element}.light"))?;
        }
        if let Some(camera) = node.camera {
            source.get(camera, &format!("{element}.camera"))?;
        }
        if node.skin.is_some() {
            report.warn_once(&element, "skins are not read; the rest shape is drawn");
        }
        let transform = transform(node, &element)?;
        places.insert(index.value(), scene.nodes.len());
        let placed = match node.mesh {
            Some(mesh) => meshes.get(mesh, &format!("{element}.mesh"), report, scene)?,
            None => Vec::new(),
        };
        scene.nodes.push(Node {
            name: node.name.clone().unwrap_or_default(),
            parent: parent.and_then(|parent| places.get(&parent.value())).copied(),
            transform: if animated.contains(&index.value()) {
                separate(transform, &element, report)
            } else {
                transform
            },
            meshes: placed,
            light: light.map(|light| light.light.value()),
            camera: node.camera.and_then(|camera| cameras.get(camera.value()).copied().flatten()),
            movable: false,
        });
    }
    Ok(places)
}

/// The nodes of the default scene, each with its parent, parents first.
fn ordered(source: &Source<'_>, report: &mut Report) -> Result<Vec<Link>, Fault> {
    let roots = roots(source, report)?;
    let children = |node: Index<NodeSource>| -> Result<&[Index<NodeSource>], Fault> {
        let description = source.get(node, &format!("nodes[{node}]"))?;
        Ok(description.children.as_deref().unwrap_or_default())
    };

    // A scene may list a node that is also the child of another one. It is drawn once, below its parent.
    let mut reachable = HashSet::new();
    let mut below = HashSet::new();
    let mut open = Vec::new();
    for (position, &root) in roots.iter().enumerate() {
        source.get(root, &format!("scene.nodes[{position}]"))?;
        open.push(root);
    }
    while let Some(node) = open.pop() {
        if !reachable.insert(node.value()) {
            continue;
        }
        for (position, &child) in children(node)?.iter().enumerate() {
            source.get(child, &format!("nodes[{node}].children[{position}]"))?;
            below.insert(child.value());
            open.push(child);
        }
    }

    let mut order = Vec::with_capacity(reachable.len());
    let mut seen = HashSet::new();
    let mut open: Vec<_> =
        roots.iter().rev().filter(|root| !below.contains(&root.value())).map(|&root| (root, None)).collect();
    while let Some((node, parent)) = open.pop() {
        if !seen.insert(node.value()) {
            if parent.is_none() {
                continue; // a root that is listed twice
            }
            return Err(Fault::new(format!("nodes[{node}]"), "is the child of more than one node"));
        }
        order.push((node, parent));
        open.extend(children(node)?.iter().rev().map(|&child| (child, Some(node))));
    }
    match reachable.iter().filter(|node| !seen.contains(node)).min() {
        Some(node) => Err(Fault::new(format!("nodes[{node}]"), "is its own ancestor, or below such a node")),
        None => Ok(order),
    }
}

/// The roots of the default scene: the one that the file names, else its first, else every node without a parent.
fn roots(source: &Source<'_>, report: &mut Report) -> Result<Vec<Index<NodeSource>>, Fault> {
    let root = &source.root;
    if let Some(scene) = root.scene {
        return Ok(source.get(scene, "scene")?.nodes.clone());
    }
    if let Some(first) = root.scenes.first() {
        return Ok(first.nodes.clone());
    }
    if !root.nodes.is_empty() {
        report.warn("scenes", "the file has no scene; all its nodes are drawn");
    }
    let children: HashSet<usize> =
        root.nodes.iter().flat_map(|node| node.children.iter().flatten()).map(Index::value).collect();
    let orphans = (0..root.nodes.len()).filter(|node| !children.contains(node));
    Ok(orphans.filter_map(|node| u32::try_from(node).ok()).map(Index::new).collect())
}

fn transform(node: &NodeSource, element: &str) -> Result<Transform, Fault> {
    let finite = |numbers: &[f32], name: &str| match numbers.iter().all(|number| number.is_finite()) {
        true => Ok(()),
        false => Err(Fault::new(format!("{element}.{name}"), format!("is not finite: {numbers:?}"))),
    };
    if let Some(matrix) = &node.matrix {
        finite(matrix, "matrix")?;
        let columns = Mat4::from_cols_array(matrix);
        let last_row = columns.row(3);
        // Exporters that multiply matrices leave rounding errors here.
        if !last_row.abs_diff_eq(Vec4::W, 1e-4) {
            let reason = format!("its last row is {last_row}, where 0, 0, 0, 1 belongs");
            return Err(Fault::new(format!("{element}.matrix"), reason));
        }
        let affine = Affine3A::from_mat4(columns);
        return Ok(Transform::Matrix(Mat4::from(affine).to_cols_array_2d()));
    }
    let translation = node.translation.unwrap_or_default();
    let rotation = node.rotation.unwrap_or_default().0;
    let scale = node.scale.unwrap_or([1.0; 3]);
    finite(&translation, "translation")?;
    finite(&rotation, "rotation")?;
    finite(&scale, "scale")?;
    let rotation = Vec4::from(rotation).try_normalize().ok_or_else(|| {
        Fault::new(format!("{element}.rotation"), format!("{rotation:?} is not a rotation: its length is 0"))
    })?;
    Ok(Transform::Trs { translation, rotation: rotation.to_array(), scale })
}

/// Makes a transform one that can be animated.
fn separate(transform: Transform, element: &str, report: &mut Report) -> Transform {
    let Transform::Matrix(matrix) = transform else { return transform };
    let matrix = Mat4::from_cols_array_2d(&matrix);
    let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
    report.warn(element, "is animated though it has a matrix; the matrix is split, and shear in it is lost");
    let rotation = if rotation.is_finite() { rotation } else { Quat::IDENTITY };
    Transform::Trs { translation: translation.into(), rotation: rotation.into(), scale: scale.into() }
}

/// The nodes that some animation moves.
fn animated(source: &Source<'_>) -> HashSet<usize> {
    let channels = source.root.animations.iter().flat_map(|animation| &animation.channels);
    channels.map(|channel| channel.target.node.value()).collect()
}

fn read_light(light: &punctual::Light, element: &str, report: &mut Report) -> Result<Light, Fault> {
    let kind = match light.type_ {
        Checked::Valid(punctual::Type::Directional) => LightKind::Directional,
        Checked::Valid(punctual::Type::Point) => LightKind::Point,
        Checked::Valid(punctual::Type::Spot) => {
            let cone =
                light.spot.as_ref().map_or((0.0, PI / 4.0), |spot| (spot.inner_cone_angle, spot.outer_cone_angle));
            read_cone(cone, element, report)
        }
        Checked::Invalid => {
            return Err(Fault::new(format!("{element}.type"), "is none of directional, point and spot"));
        }
    };
    report.warn_once(element, "photometric units are taken to be radiometric: lux as W/m², candela as W/sr");
    let intensity = light.color.map(|channel| channel * light.intensity);
    let range = light.range.unwrap_or(f32::INFINITY);
    if range.is_nan() || range <= 0.0 {
        report.warn(format!("{element}.range"), format!("{range} is not above 0; the light has no end"));
    }
    Ok(Light {
        kind,
        intensity: report.clamp_radiance(intensity, || format!("{element}.intensity")),
        range: if range > 0.0 { range } else { f32::INFINITY },
    })
}

fn read_cone((inner, outer): (f32, f32), element: &str, report: &mut Report) -> LightKind {
    let wide = if outer > 0.0 { outer.min(FRAC_PI_2) } else { PI / 4.0 };
    // The fade between the two divides by their difference.
    let narrow = inner.clamp(0.0, wide * 0.999);
    if (narrow, wide) != (inner, outer) {
        let reason = format!(
            "cone angles {inner} and {outer} do not keep 0 ≤ inner < outer ≤ π/2; {narrow} and {wide} are used"
        );
        report.warn(format!("{element}.spot"), reason);
    }
    LightKind::Spot { inner: narrow, outer: wide }
}

/// Reads the perspective cameras; the result tells for each camera of the file which one of the scene it became.
fn read_cameras(source: &Source<'_>, report: &mut Report, scene: &mut Scene) -> Result<Vec<Option<usize>>, Fault> {
    let mut places = Vec::new();
    for (index, camera) in source.root.cameras.iter().enumerate() {
        let element = format!("cameras[{index}]");
        places.push(match (&camera.type_, &camera.perspective) {
            (Checked::Valid(camera::Type::Perspective), Some(perspective)) => {
                let fov_y = perspective.yfov;
                if fov_y > 0.0 && fov_y < PI {
                    scene.cameras.push(Perspective { fov_y });
                    Some(scene.cameras.len() - 1)
                } else {
                    report.warn(element, format!("yfov {fov_y} is not between 0 and π; the camera is left out"));
                    None
                }
            }
            (Checked::Valid(camera::Type::Perspective), None) => {
                return Err(Fault::new(element, "has no perspective"));
            }
            (Checked::Valid(camera::Type::Orthographic), _) => {
                report.warn(element, "orthographic cameras are not read; it is left out");
                None
            }
            (Checked::Invalid, _) => {
                return Err(Fault::new(format!("{element}.type"), "is neither perspective nor orthographic"));
            }
        });
    }
    Ok(places)
}
