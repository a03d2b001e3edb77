//! Cameras.

use std::f32::consts::PI;

use gltf::json::camera::Type;
use gltf::json::validation::Checked;

use super::source::Source;
use crate::scene::description::{Perspective, Scene};
use crate::scene::load::common::report::Report;

/// Reads the perspective cameras. Returns the index in the scene of each camera of the file.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene) -> Vec<Option<usize>> {
    let mut places = Vec::new();
    for (index, camera) in source.root.cameras.iter().enumerate() {
        let mut element = format!("cameras[{index}]");
        let fault = match (&camera.type_, &camera.perspective) {
            (Checked::Valid(Type::Perspective), Some(perspective))
                if (f32::MIN_POSITIVE..PI).contains(&perspective.yfov) =>
            {
                scene.cameras.push(Perspective { fov_y: perspective.yfov });
                places.push(Some(scene.cameras.len() - 1));
                continue;
            }
            (Checked::Valid(Type::Perspective), Some(perspective)) => {
                format!("yfov {} is not between 0 and π", perspective.yfov)
            }
            (Checked::Valid(Type::Perspective), None) => {
                element.push_str(".perspective");
                "is not there".into()
            }
            (Checked::Valid(Type::Orthographic), _) => "orthographic cameras are not read".into(),
            (Checked::Invalid, _) => "its type is neither perspective nor orthographic".into(),
        };
        report.warn(element, format!("{fault}; the camera is left out"));
        places.push(None);
    }
    places
}
