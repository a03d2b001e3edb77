//! Placements of nodes.

use glam::{Affine3A, Mat4, Quat, Vec4};
use gltf::json::Node as NodeSource;

use crate::scene::description::Transform;
use crate::scene::load::common::report::{Fault, Report};

/// The placement of a node relative to its parent. The identity replaces a broken part.
pub(super) fn transform(node: &NodeSource, element: &str, report: &mut Report) -> Transform {
    let (transform, faults) = read(node);
    for (name, reason, instead) in faults {
        report.replace(Fault::new(format!("{element}.{name}"), reason), instead);
    }
    transform
}

/// A member of a node, its defect, and its replacement.
type Broken = (&'static str, String, &'static str);

fn read(node: &NodeSource) -> (Transform, Vec<Broken>) {
    let mut faults: Vec<Broken> = Vec::new();
    let mut finite = |numbers: &[f32], name: &'static str| {
        let finite = numbers.iter().all(|number| number.is_finite());
        if !finite {
            faults.push((name, format!("is not finite: {numbers:?}"), "the identity is used"));
        }
        finite
    };
    if let Some(matrix) = node.matrix.filter(|matrix| finite(matrix, "matrix")) {
        let columns = Mat4::from_cols_array(&matrix);
        let last_row = columns.row(3);
        // Exporters that multiply matrices leave rounding errors here.
        if !last_row.abs_diff_eq(Vec4::W, 1e-4) {
            let reason = format!("its last row is {last_row}, where 0, 0, 0, 1 belongs");
            faults.push(("matrix", reason, "the rest of it is used"));
        }
        let affine = Affine3A::from_mat4(columns);
        return (Transform::Matrix(Mat4::from(affine).to_cols_array_2d()), faults);
    }
    let translation = node.translation.filter(|translation| finite(translation, "translation"));
    let scale = node.scale.filter(|scale| finite(scale, "scale"));
    let rotation = node.rotation.map(|rotation| rotation.0).filter(|rotation| finite(rotation, "rotation"));
    let rotation = rotation.and_then(|rotation| {
        let unit = Vec4::from(rotation).try_normalize();
        if unit.is_none() {
            let reason = format!("{rotation:?} is not a rotation: its length is 0");
            faults.push(("rotation", reason, "the identity is used"));
        }
        unit
    });
    let transform = Transform::Trs {
        translation: translation.unwrap_or_default(),
        rotation: rotation.unwrap_or(Vec4::W).to_array(),
        scale: scale.unwrap_or([1.0; 3]),
    };
    (transform, faults)
}

/// Converts a transform to one that can be animated.
pub(super) fn separate(transform: Transform, element: &str, report: &mut Report) -> Transform {
    let Transform::Matrix(matrix) = transform else { return transform };
    let matrix = Mat4::from_cols_array_2d(&matrix);
    let (scale, rotation, translation) = matrix.to_scale_rotation_translation();
    report.warn(element, "is animated though it has a matrix; the matrix is split, and shear in it is lost");
    let rotation = if rotation.is_finite() { rotation } else { Quat::IDENTITY };
    Transform::Trs { translation: translation.into(), rotation: rotation.into(), scale: scale.into() }
}
