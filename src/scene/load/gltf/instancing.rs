//! Nodes that place their mesh many times (EXT_mesh_gpu_instancing).

use glam::Vec4;
use gltf::json::accessor::{ComponentType, Type};
use gltf::json::{Index, Node as NodeSource};
use serde_json::Value;

use super::accessor::{Elements, REAL};
use super::source::Source;
use crate::scene::description::Transform;
use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of instances of one file. The size of the file does not bound them: attributes without data cost nothing, and nodes
/// may share attributes.
const MOST: usize = 1 << 20;

/// The placements of the instances of a node, relative to it. `None` for a node that is placed once.
pub(super) fn instances(
    source: &Source<'_>,
    node: &NodeSource,
    element: &str,
    placed: &mut usize,
    report: &mut Report,
) -> Option<Vec<Transform>> {
    let extension = node.extensions.as_ref()?.others.get("EXT_mesh_gpu_instancing")?;
    match read(source, extension, &format!("{element}.EXT_mesh_gpu_instancing"), MOST - *placed) {
        Ok((transforms, broken)) => {
            *placed += transforms.len();
            if broken > 0 {
                let reason = format!("{broken} instances are not finite; they are not drawn");
                report.warn(format!("{element}.EXT_mesh_gpu_instancing"), reason);
            }
            Some(transforms)
        }
        Err(fault) => {
            report.replace(fault, "the mesh is drawn once");
            None
        }
    }
}

fn read(source: &Source<'_>, extension: &Value, element: &str, most: usize) -> Result<(Vec<Transform>, usize), Fault> {
    let attribute = |name: &str, shape: Type, components: &[ComponentType]| {
        let user = format!("{element}.attributes.{name}");
        let Some(accessor) = extension.pointer(&format!("/attributes/{name}")) else { return Ok(None) };
        let index = accessor.as_u64().and_then(|index| u32::try_from(index).ok());
        let index = index.ok_or_else(|| Fault::new(&user, format!("{accessor} is not an index")))?;
        Elements::open(source, Index::new(index), shape, components, &user).map(Some)
    };
    let translations = attribute("TRANSLATION", Type::Vec3, &[ComponentType::F32])?;
    let rotations = attribute("ROTATION", Type::Vec4, REAL)?;
    let scales = attribute("SCALE", Type::Vec3, &[ComponentType::F32])?;
    let lengths: Vec<usize> = [&translations, &rotations, &scales].into_iter().flatten().map(Elements::len).collect();
    let Some(&count) = lengths.first() else {
        return Err(Fault::new(format!("{element}.attributes"), "has none of TRANSLATION, ROTATION and SCALE"));
    };
    if lengths.iter().any(|&length| length != count) || count > most {
        let reason = format!("the attributes have {lengths:?} elements: as many each, and {MOST} in a file, are read");
        return Err(Fault::new(format!("{element}.attributes"), reason));
    }
    let mut broken = 0;
    let transform = |instance: usize| {
        let translation = translations.as_ref().map_or([0.0; 3], |elements| elements.vector(instance));
        let scale = scales.as_ref().map_or([1.0; 3], |elements| elements.vector(instance));
        let rotation = rotations.as_ref().map_or(Vec4::W, |elements| elements.normalized(instance).into());
        let finite = translation.iter().chain(&scale).all(|number| number.is_finite());
        let rotation = rotation.try_normalize().filter(|_| finite);
        broken += usize::from(rotation.is_none());
        Some(Transform::Trs { translation, rotation: rotation?.to_array(), scale })
    };
    let transforms = (0..count).filter_map(transform).collect();
    Ok((transforms, broken))
}
