//! Conversion of primitives to triangle lists.

use std::collections::HashMap;

use glam::Vec3;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, Mesh as MeshSource};

use super::accessor::{Elements, INDEX, REAL};
use super::attributes::{self, Vertices};
use super::material::default_material;
use super::morph;
use super::normals::repair_normals;
use super::skin;
use super::source::Source;
use crate::scene::description::{Material, Mesh, Scene};
use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of triangles of all meshes of one file. The size of the file does not bound them, because primitives may share an
/// index buffer.
const MAX_TRIANGLES: usize = 1 << 26;

/// Maximum number of vertices of all meshes of one file. The size of the file does not bound them, because accessors without data
/// cost nothing.
const MAX_VERTICES: usize = 1 << 27;

/// Maximum number of offsets of morph targets of all meshes of one file. The size of the file does not bound them, because targets may
/// share accessors.
const MAX_OFFSETS: usize = 1 << 26;

/// The meshes of a file that were requested.
pub(super) struct Meshes<'a> {
    source: &'a Source<'a>,
    triangles: usize,
    vertices: usize,
    offsets: usize,
    default_material: Option<usize>,
    /// The meshes of the scene for each mesh of the file, one per primitive. A mesh with a skin of another number of joints is another.
    known: HashMap<(usize, Option<usize>), Vec<usize>>,
}

impl<'a> Meshes<'a> {
    pub fn new(source: &'a Source) -> Self {
        Self { source, triangles: 0, vertices: 0, offsets: 0, default_material: None, known: HashMap::new() }
    }

    /// The meshes of the scene for a mesh of the file, whose skin has this number of joints. The first call reads them.
    pub fn get(
        &mut self,
        index: Index<MeshSource>,
        joints: Option<usize>,
        report: &mut Report,
        scene: &mut Scene,
    ) -> Vec<usize> {
        let key = (index.value(), joints);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let Ok(mesh) = self.source.get(index, "") else { return Vec::new() };
        let mut parts = Vec::new();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let element = format!("meshes[{index}].primitives[{number}]");
            let name = mesh.name.clone().unwrap_or_default();
            match self.read(primitive, joints, &element, report, &mut scene.materials) {
                Ok(Some(part)) => {
                    parts.push(scene.meshes.len());
                    scene.meshes.push(Mesh { name, ..part });
                }
                Ok(None) => {}
                Err(fault) => report.lose(fault),
            }
        }
        self.known.insert(key, parts.clone());
        parts
    }

    /// Reads a primitive. `None` if there is nothing to draw.
    fn read(
        &mut self,
        primitive: &Primitive,
        joints: Option<usize>,
        element: &str,
        report: &mut Report,
        materials: &mut Vec<Material>,
    ) -> Result<Option<Mesh>, Fault> {
        let mode = match primitive.mode {
            Checked::Valid(Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip) => {
                report.warn_once(element, "points and lines are not drawn");
                return Ok(None);
            }
            Checked::Valid(mode) => mode,
            Checked::Invalid => return Err(Fault::new(format!("{element}.mode"), "is not within 0…6")),
        };
        attributes::warn_unread(primitive, element, report);
        let extensions = primitive.extensions.as_ref().map(|extensions| &extensions.others);
        if extensions.is_some_and(|others| others.contains_key("KHR_draco_mesh_compression")) {
            let reason = "is compressed with KHR_draco_mesh_compression, which is not supported";
            return Err(Fault::new(element, reason));
        }

        let position = primitive.attributes.get(&Checked::Valid(Semantic::Positions)).copied();
        let position = position.ok_or_else(|| Fault::new(format!("{element}.attributes"), "there is no POSITION"))?;
        let position_element = format!("{element}.attributes.POSITION");
        let positions = Elements::open(self.source, position, Type::Vec3, REAL, &position_element)?;

        let triangles = self.triangles(primitive, mode, positions.len(), element, report)?;
        if triangles.is_empty() {
            report.warn(element, "there are no triangles");
            return Ok(None);
        }
        // Many primitives often share a vertex buffer, and each uses a part of it.
        let kept = used(triangles.as_flattened(), positions.len());
        let vertices = Vertices { source: self.source, primitive, count: positions.len(), kept: &kept, element };
        self.vertices = self.vertices.saturating_add(kept.len());
        if self.vertices > MAX_VERTICES {
            return Err(Fault::new(element, format!("the file has more than {MAX_VERTICES} vertices in its meshes")));
        }
        let mut mesh = Mesh { triangles: renumbered(triangles, &kept), ..Mesh::default() };
        mesh.positions = attributes::gather(&positions, &kept);
        mesh.normals = vertices.normals(report);
        mesh.material = self.material(primitive, element, report, materials);
        let material = materials.get(mesh.material);
        // A mesh without normals is flat, so that its tangents have no meaning.
        if !mesh.normals.is_empty() && material.is_some_and(|material| material.normal_texture.is_some()) {
            mesh.tangents = vertices.tangents(report);
        }
        for set in 0..mesh.uvs.len() {
            mesh.uvs[set] = vertices.uvs(set as u32, report);
        }
        mesh.colors = vertices.colors(report);
        let offsets = primitive.targets.as_ref().map_or(0, Vec::len).saturating_mul(kept.len());
        self.offsets = self.offsets.saturating_add(offsets);
        if self.offsets <= MAX_OFFSETS {
            mesh.targets = morph::targets(&vertices, &mesh, report);
        } else {
            let reason = format!("the file has more than {MAX_OFFSETS} offsets of morph targets; they are left out");
            report.warn_once(format!("{element}.targets"), reason);
        }
        if let Some(joints) = joints {
            mesh.influences = skin::influences(&vertices, joints, report);
            // They take as much memory as the vertices.
            self.vertices = self.vertices.saturating_add(mesh.influences.len() / 4);
        }

        leave_out_broken(&mut mesh, &kept, &position_element, report)?;
        if !mesh.normals.is_empty() {
            let replaced = repair_normals(&mut mesh);
            if replaced > 0 {
                let reason = format!("{replaced} normals have no direction; that of the triangles is used");
                report.warn(format!("{element}.attributes.NORMAL"), reason);
            }
        }
        let broken = mesh.tangents.iter().filter(|tangent| !is_direction(**tangent)).count();
        if broken > 0 {
            mesh.tangents = Vec::new();
            let reason = format!("{broken} tangents have no direction; all are made from the texture coordinates");
            report.warn(format!("{element}.attributes.TANGENT"), reason);
        }
        if let Some(material) = material {
            attributes::warn_missing_uvs(material, &mesh, element, report);
        }
        Ok(Some(mesh))
    }

    /// The vertices of each triangle, all of them below `vertices`.
    fn triangles(
        &mut self,
        primitive: &Primitive,
        mode: Mode,
        vertices: usize,
        element: &str,
        report: &mut Report,
    ) -> Result<Vec<[u32; 3]>, Fault> {
        let user = format!("{element}.indices");
        let indices = match primitive.indices {
            Some(indices) => Some(Elements::open(self.source, indices, Type::Scalar, INDEX, &user)?),
            None => None,
        };
        let count = indices.as_ref().map_or(vertices, Elements::len);
        // A strip or fan has about as many triangles as corners.
        let triangles = if mode == Mode::Triangles { count / 3 } else { count };
        self.triangles = self.triangles.saturating_add(triangles);
        if self.triangles > MAX_TRIANGLES {
            return Err(Fault::new(element, format!("the file has more than {MAX_TRIANGLES} triangles in its meshes")));
        }
        if mode == Mode::Triangles && !count.is_multiple_of(3) {
            report.warn(element, format!("{count} corners are no whole number of triangles; the rest is not drawn"));
        }
        let Some(indices) = indices else {
            return Ok(assemble(mode, &(0..count as u32).collect::<Vec<_>>()));
        };
        let corners: Vec<u32> = (0..count).map(|index| indices.integer(index)).collect();
        match corners.iter().position(|&corner| corner as usize >= vertices) {
            // All indices are suspect then, because a wrong buffer is likelier than one wrong number.
            Some(at) => {
                let reason = format!("index {at} is {}, but there are only {vertices} vertices", corners[at]);
                Err(Fault::new(user, reason))
            }
            None => Ok(assemble(mode, &corners)),
        }
    }

    fn material(
        &mut self,
        primitive: &Primitive,
        element: &str,
        report: &mut Report,
        materials: &mut Vec<Material>,
    ) -> usize {
        if let Some(index) = primitive.material {
            match self.source.get(index, &format!("{element}.material")) {
                Ok(_) => return index.value(),
                Err(fault) => report.replace(fault, "the default material is used"),
            }
        }
        *self.default_material.get_or_insert_with(|| {
            materials.push(default_material());
            materials.len() - 1
        })
    }
}

/// True if a tangent has a direction and is finite.
fn is_direction([x, y, z, w]: [f32; 4]) -> bool {
    w.is_finite() && Vec3::new(x, y, z).try_normalize().is_some()
}

/// The triangles between corners.
fn assemble(mode: Mode, corners: &[u32]) -> Vec<[u32; 3]> {
    match (mode, corners) {
        (Mode::TriangleStrip, corners) => {
            let windows = corners.windows(3).filter_map(|window| window.first_chunk::<3>());
            // Every other triangle of a strip has the opposite winding.
            windows.enumerate().map(|(i, &[a, b, c])| if i % 2 == 0 { [a, b, c] } else { [a, c, b] }).collect()
        }
        (Mode::TriangleFan, [hub, rim @ ..]) => {
            let windows = rim.windows(2).filter_map(|window| window.first_chunk::<2>());
            windows.map(|&[a, b]| [a, b, *hub]).collect()
        }
        (_, corners) => corners.as_chunks::<3>().0.to_vec(),
    }
}

/// The vertices that corners use, in increasing order, each once.
fn used(corners: &[u32], vertices: usize) -> Vec<u32> {
    if vertices > corners.len() {
        // A list of all vertices could be far longer than the list of those in use.
        let mut used = corners.to_vec();
        used.sort_unstable();
        used.dedup();
        return used;
    }
    let mut marks = vec![false; vertices];
    for &corner in corners {
        if let Some(mark) = marks.get_mut(corner as usize) {
            *mark = true;
        }
    }
    (0..).zip(marks).filter_map(|(vertex, used)| used.then_some(vertex)).collect()
}

/// Triangles whose corners are positions in `kept`, which is sorted.
fn renumbered(mut triangles: Vec<[u32; 3]>, kept: &[u32]) -> Vec<[u32; 3]> {
    // The list is sorted without duplicates: if the last one is in its place, all are.
    let all = kept.last().is_none_or(|&last| last as usize + 1 == kept.len());
    if !all {
        for corner in triangles.as_flattened_mut() {
            *corner = kept.partition_point(|vertex| vertex < corner) as u32;
        }
    }
    triangles
}

/// Removes the triangles that have a corner without a finite position.
fn leave_out_broken(mesh: &mut Mesh, kept: &[u32], element: &str, report: &mut Report) -> Result<(), Fault> {
    let is_finite = |position: &[f32; 3]| position.iter().all(|number| number.is_finite());
    let Some(first) = mesh.positions.iter().position(|position| !is_finite(position)) else { return Ok(()) };
    let vertex = kept.get(first).copied().unwrap_or_default();
    let fault = Fault::new(element, format!("vertex {vertex} is not finite: {:?}", mesh.positions[first]));
    let all = mesh.triangles.len();
    let positions = &mesh.positions;
    mesh.triangles.retain(|corners| corners.iter().all(|&corner| is_finite(&positions[corner as usize])));
    if mesh.triangles.is_empty() {
        return Err(fault);
    }
    for position in mesh.positions.iter_mut().filter(|position| !is_finite(position)) {
        *position = [0.0; 3];
    }
    report.replace(fault, &format!("{} of {all} triangles are not drawn", all - mesh.triangles.len()));
    Ok(())
}
