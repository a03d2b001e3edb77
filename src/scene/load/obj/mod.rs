//! Wavefront OBJ with MTL materials.
//!
//! A file is refused only if none of its faces can be drawn. Any other broken element is lost alone. One warning for each kind of defect
//! ([`tally`]) names the first line and counts the others.
//!
//! | broken | lost |
//! |---|---|
//! | a position that cannot be read, the index of a position that does not exist | the faces that use it |
//! | a normal that cannot be read, has no direction or does not exist | the normal: the corner gets the one that it would have without normals ([`smoothing`]) |
//! | texture coordinates that cannot be read or do not exist | the coordinates: 0 replaces them |
//!
//! Faces may use vectors of later lines. Keywords may be in any case, numbers may have a decimal comma, and lines may end with CR.

mod assemble;
mod body;
mod color;
mod faces;
mod geometry;
mod library;
mod map;
mod material;
mod part;
mod polygon;
mod ring;
mod skin;
mod smoothing;
mod source;
mod tally;
mod text;
mod textures;
mod vectors;

use std::collections::HashMap;
use std::path::Path;

use crate::scene::description::{Alpha, Material, Mesh, Node, Scene, SceneError, Transform};
use crate::scene::load::common::encoding;
use crate::scene::load::common::files::Files;
use crate::scene::load::common::folder::Folder;
use crate::scene::load::common::recognise::{foreign, is_binary};
use crate::scene::load::common::report::Loaded;
use crate::scene::load::common::report::{Fault, Report};
use geometry::Geometry;
use library::Library;
use textures::Textures;

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
    let mut geometry = read_geometry(files, path, report)?;
    if let Some(fault) = geometry.tally.fault().filter(|_| geometry.is_lost()) {
        return Err(fault);
    }
    std::mem::take(&mut geometry.tally).warn(report);

    let mut textures = Textures::new(&folder);
    let library = Library::read(&geometry, path, &folder, &mut textures, report);
    let found: Vec<_> = geometry.uses.iter().map(|used| library.find(used, report)).collect();
    let mut scene = Scene { materials: library.materials, ..Scene::default() };

    let Geometry { mut vectors, colors, faces, groups, .. } = geometry;
    let colors = colors.linear(report);
    let mut parts = faces.parts.parts;
    smoothing::fill(&mut parts, &vectors.positions, &mut vectors.normals)?;
    let mut defaults = HashMap::new();
    for part in parts {
        let name = groups.get(part.group).to_owned();
        let material = part.material.and_then(|number| *found.get(number as usize)?);
        let mut mesh = assemble::mesh(part, &vectors, &colors)?;
        mesh.name = name;
        mesh.material = material.unwrap_or_else(|| {
            *defaults.entry(mesh.colors.is_empty()).or_insert_with_key(|&uncolored| {
                scene.materials.push(material::default(!uncolored));
                scene.materials.len() - 1
            })
        });
        if let Some(material) = scene.materials.get(mesh.material) {
            warn_unmet(material, &mesh, report);
        }
        if !mesh.triangles.is_empty() {
            scene.meshes.push(mesh);
        }
    }
    body::fill(&mut scene.meshes, &mut scene.materials, &library.refracting, report);
    scene.images = textures.into_images();
    let meshes = (0..scene.meshes.len()).collect();
    let translation = vectors.offset.unwrap_or_default();
    let transform = Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
    scene.nodes.push(Node { meshes, transform, ..Node::default() });
    Ok(scene)
}

fn read_geometry(files: Files<'_>, path: &Path, report: &mut Report) -> Result<Geometry, Fault> {
    let refused = |reason: &str| Fault::new("file", reason);
    let bytes = files.read(path).map_err(|reason| refused(&reason))?;
    if bytes.iter().all(u8::is_ascii_whitespace) {
        return Err(refused("is empty"));
    }
    if let Some(kind) = foreign(&bytes) {
        return Err(refused(kind));
    }
    let (text, note) = encoding::decode(&bytes);
    if is_binary(&text) {
        return Err(refused("is no text, and so no OBJ file"));
    }
    if let Some(note) = note {
        report.warn("file", note);
    }
    let mut geometry = Geometry::default();
    text::each_statement(&text, |statement| geometry.statement(statement, report));
    if geometry.known == 0 {
        return Err(refused("is no OBJ file: no line of it is a statement of one"));
    }
    geometry.faces.finish(&geometry.vectors, &mut geometry.tally);
    Ok(geometry)
}

impl Geometry {
    /// True if there are faces, but none of them can be drawn.
    fn is_lost(&self) -> bool {
        self.faces.count > 0 && self.faces.parts.parts.iter().all(|part| part.triangles.is_empty())
    }
}

/// Warns about data that a material needs and the mesh lacks, and about data of the mesh that the material does not use.
fn warn_unmet(material: &Material, mesh: &Mesh, report: &mut Report) {
    let element = format!("object \"{}\"", text::shortened(&mesh.name));
    if mesh.uvs[0].is_empty() && material.textures().next().is_some() {
        let reason = format!(
            "faces without texture coordinates have the material \"{}\"; its textures are one texel there",
            text::shortened(&material.name)
        );
        report.warn_once(&element, reason);
    }
    if material.alpha == Alpha::Opaque && mesh.colors.iter().any(|color| color[3] < 1.0) {
        report.warn_once(element, "the opacity of vertex colours is not read; it is drawn as 1");
    }
}
