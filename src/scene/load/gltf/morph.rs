//! Morph targets.

use gltf::json::accessor::Type;
use gltf::json::{Accessor, Index};

use super::accessor::{Elements, REAL};
use super::attributes::Vertices;
use crate::scene::description::{Mesh, MorphTarget};
use crate::scene::load::common::report::Report;

/// The morph targets of a primitive, for the vertices in use of `mesh`. A target that cannot be read moves nothing.
pub(super) fn targets(vertices: &Vertices<'_>, mesh: &Mesh, report: &mut Report) -> Vec<MorphTarget> {
    let mut broken = 0;
    let sources = vertices.primitive.targets.as_deref().unwrap_or_default();
    let mut read = |(number, source): (usize, &gltf::json::mesh::MorphTarget)| {
        let element = format!("{}.targets[{number}]", vertices.element);
        let mut open = |name: &str, accessor: Option<Index<Accessor>>, is_used: bool| {
            let accessor = accessor.filter(|_| is_used)?;
            let opened = vertices.open(accessor, Type::Vec3, REAL, &format!("{element}.{name}"));
            opened.map_err(|fault| report.replace(fault, "it is left out")).ok()
        };
        let attributes = [
            open("POSITION", source.positions, true),
            open("NORMAL", source.normals, !mesh.normals.is_empty()),
            open("TANGENT", source.tangents, !mesh.tangents.is_empty()),
        ];
        sparse(&attributes, vertices.kept, &mut broken)
    };
    let targets = sources.iter().enumerate().map(&mut read).collect();
    if broken > 0 {
        let reason = format!("{broken} offsets are not finite; 0 is used");
        report.warn(format!("{}.targets", vertices.element), reason);
    }
    targets
}

/// The offsets of those vertices that have any. Faces have dozens of targets, each of which moves a few vertices.
fn sparse(attributes: &[Option<Elements<'_>>; 3], kept: &[u32], broken: &mut usize) -> MorphTarget {
    let mut target = MorphTarget::default();
    for (number, &vertex) in (0..).zip(kept) {
        let offsets = attributes.each_ref().map(|elements| {
            let offset = elements.as_ref().map_or([0.0; 3], |elements| elements.vector::<3>(vertex as usize));
            let is_finite = offset.iter().all(|number| number.is_finite());
            *broken += usize::from(!is_finite);
            if is_finite { offset } else { [0.0; 3] }
        });
        if offsets == [[0.0; 3]; 3] {
            continue;
        }
        target.vertices.push(number);
        let lists = [&mut target.positions, &mut target.normals, &mut target.tangents];
        for ((list, offset), elements) in lists.into_iter().zip(offsets).zip(attributes) {
            if elements.is_some() {
                list.push(offset);
            }
        }
    }
    target
}
