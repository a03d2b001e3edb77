//! Wavefront OBJ with MTL materials.
//!
//! The `tobj` crate assembles the triangles. It is handed a cleaned text ([`text`]), because it misreads or panics on
//! some of what files in the wild contain, and because its errors do not tell lines.

mod material;
mod text;

use std::collections::HashMap;
use std::path::Path;

use tobj::LoadOptions;

use crate::scene::description::{Material, Mesh, Node, Scene, SceneError};
use crate::scene::load::Loaded;
use crate::scene::load::files::Files;
use crate::scene::load::folder::Folder;
use crate::scene::load::report::{Fault, Report};

/// Reads an OBJ file and the material libraries that it names.
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
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(Fault::new("file", "is empty"));
    }
    let geometry = text::clean_geometry(&String::from_utf8_lossy(&bytes), report)?;
    drop(bytes);

    let mut scene = Scene::default();
    let names = material::read_libraries(&geometry.libraries, &folder, report, &mut scene)?;
    for (name, line) in &geometry.used_materials {
        if !names.contains_key(name) {
            report.warn(format!("line {line}"), format!("there is no material \"{name}\"; it is drawn in grey"));
        }
    }

    let options = LoadOptions { single_index: true, triangulate: true, ..LoadOptions::default() };
    // tobj only has to know which name has which index.
    let (models, _) = tobj::load_obj_buf(&mut geometry.text.as_bytes(), &options, |_| Ok((Vec::new(), names.clone())))
        .map_err(|error| Fault::new("file", error.to_string()))?;
    drop(geometry);

    let mut meshes = Meshes::default();
    for model in models {
        meshes.add(model, &mut scene)?;
    }
    let meshes = (0..scene.meshes.len()).collect();
    scene.nodes.push(Node { meshes, ..Node::default() });
    Ok(scene)
}

/// Joins the pieces of one object that have the same material and the same kind of vertices: a file may switch
/// between materials for every face.
#[derive(Default)]
struct Meshes {
    places: HashMap<(String, Option<usize>, bool, bool), usize>,
    default_material: Option<usize>,
}

impl Meshes {
    fn add(&mut self, model: tobj::Model, scene: &mut Scene) -> Result<(), Fault> {
        let tobj::Model { mesh: piece, name } = model;
        if piece.indices.is_empty() {
            return Ok(());
        }
        let key = (name, piece.material_id, !piece.normals.is_empty(), !piece.texcoords.is_empty());
        let place = match self.places.get(&key) {
            Some(&place) => place,
            None => {
                let material = piece.material_id.unwrap_or_else(|| self.default_material(&mut scene.materials));
                scene.meshes.push(Mesh { name: key.0.clone(), material, ..Mesh::default() });
                let place = scene.meshes.len() - 1;
                self.places.insert(key, place);
                place
            }
        };
        let Some(mesh) = scene.meshes.get_mut(place) else { return Ok(()) };
        let too_many = |_| Fault::new(format!("object \"{}\"", mesh.name), "has more than 2³² vertices");
        let first = u32::try_from(mesh.positions.len()).map_err(too_many)?;
        u32::try_from(mesh.positions.len() + piece.positions.len() / 3).map_err(too_many)?;
        mesh.positions.extend_from_slice(piece.positions.as_chunks::<3>().0);
        mesh.normals.extend_from_slice(piece.normals.as_chunks::<3>().0);
        // In OBJ, v grows upwards.
        mesh.uvs[0].extend(piece.texcoords.as_chunks::<2>().0.iter().map(|&[u, v]| [u, 1.0 - v]));
        mesh.triangles.extend(piece.indices.as_chunks::<3>().0.iter().map(|corners| corners.map(|i| first + i)));
        Ok(())
    }

    /// The material of faces that have none.
    fn default_material(&mut self, materials: &mut Vec<Material>) -> usize {
        *self.default_material.get_or_insert_with(|| {
            materials.push(material::grey());
            materials.len() - 1
        })
    }
}
