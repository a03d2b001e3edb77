//! glTF 2.0: `.gltf` with external or embedded data, and `.glb`.
//!
//! The `gltf` crate reads the JSON. Its own validation refuses files that are common and harmless (a root of the scene that is another
//! node's child, quantised attributes). Everything is therefore checked here, as it is read.

mod accessor;
mod animation;
mod attributes;
mod buffer;
mod camera;
mod clearcoat;
mod container;
mod glossiness;
mod image;
mod instancing;
mod light;
mod light_animation;
mod material;
mod mend;
mod mesh;
mod morph;
mod node;
mod normal_map;
mod normals;
mod pointer;
mod skin;
mod source;
mod text;
mod transform;
mod transmission;

use std::path::Path;

use crate::scene::description::{Scene, SceneError};
use crate::scene::load::common::files::Files;
use crate::scene::load::common::folder::Folder;
use crate::scene::load::common::report::Loaded;
use crate::scene::load::common::report::{Fault, Report};
use source::Source;

/// Reads a glTF file.
pub(crate) fn load(files: Files<'_>, path: &Path) -> Result<Loaded, SceneError> {
    let mut report = Report::new(path);
    match read(files, path, &mut report) {
        Ok(scene) => report.finish(scene),
        Err(fault) => Err(report.error(fault)),
    }
}

fn read(files: Files<'_>, path: &Path, report: &mut Report) -> Result<Scene, Fault> {
    let unreadable = |reason: String| Fault::new("file", reason);
    let folder = Folder::of(files, path).map_err(unreadable)?;
    let bytes = files.read(path).map_err(unreadable)?;
    let container = container::open(&bytes, report)?;
    let buffers = buffer::read_all(&container.root, container.binary, &folder, report);
    let source = Source { root: container.root, pointers: container.pointers, buffers, folder };

    let mut scene = Scene::default();
    material::read_all(&source, report, &mut scene);
    let (places, lights) = node::read_all(&source, report, &mut scene);
    animation::read_all(&source, report, &mut scene, &places);
    light_animation::read_all(&source, report, &mut scene, &lights);
    Ok(scene)
}
