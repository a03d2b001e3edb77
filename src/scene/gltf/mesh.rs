//! Primitives to triangle lists.

use std::collections::HashMap;

use glam::Vec3;
use gltf::json::accessor::Type;
use gltf::json::mesh::{Mode, Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Index, Mesh as MeshSource};

use super::accessor::{Elements, INDEX, REAL};
use super::material::default_material;
use super::source::Source;
use crate::scene::description::{Material, Mesh, Scene};
use crate::scene::load::report::{Fault, Report};

/// Most triangles that the meshes of one file may have together. Primitives may share one index buffer, so that the
/// size of the file alone does not bound them.
const MAX_TRIANGLES: usize = 1 << 26;

/// The meshes of a file, as far as they were asked for.
pub(super) struct Meshes<'a> {
    source: &'a Source<'a>,
    triangles: usize,
    default_material: Option<usize>,
    /// Which meshes of the scene each mesh of the file became: one per primitive.
    known: HashMap<usize, Vec<usize>>,
}

impl<'a> Meshes<'a> {
    pub fn new(source: &'a Source) -> Self {
        Self { source, triangles: 0, default_material: None, known: HashMap::new() }
    }

    /// The meshes of the scene that a mesh of the file consists of, which are read on the first call.
    pub fn get(
        &mut self,
        index: Index<MeshSource>,
        user: &str,
        report: &mut Report,
        scene: &mut Scene,
    ) -> Result<Vec<usize>, Fault> {
        if let Some(known) = self.known.get(&index.value()) {
            return Ok(known.clone());
        }
        let mesh = self.source.get(index, user)?;
        let mut parts = Vec::new();
        for (number, primitive) in mesh.primitives.iter().enumerate() {
            let element = format!("meshes[{index}].primitives[{number}]");
            let name = mesh.name.clone().unwrap_or_default();
            if let Some(part) = self.read(primitive, &element, report, &mut scene.materials)? {
                parts.push(scene.meshes.len());
                scene.meshes.push(Mesh { name, ..part });
            }
        }
        self.known.insert(index.value(), parts.clone());
        Ok(parts)
    }

    /// Reads a primitive. `None` where there is nothing to draw.
    fn read(
        &mut self,
        primitive: &Primitive,
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
        warn_unread(primitive, element, report);

        let semantic = |semantic: Semantic| primitive.attributes.get(&Checked::Valid(semantic)).copied();
        let position = semantic(Semantic::Positions)
            .ok_or_else(|| Fault::new(format!("{element}.attributes"), "there is no POSITION"))?;
        let position_element = format!("{element}.attributes.POSITION");
        let positions = Elements::open(self.source, position, Type::Vec3, REAL, &position_element)?;
        let vertices = positions.len();

        let corners = self.corners(primitive, vertices, element)?;
        if mode == Mode::Triangles && !corners.len().is_multiple_of(3) {
            report.warn(
                element,
                format!("{} corners are no whole number of triangles; the rest is not drawn", corners.len()),
            );
        }
        // Vertex buffers are often shared by many primitives, each of which uses a part of it.
        let kept = used(&corners, vertices);
        let triangles = triangles(mode, &corners, &kept);
        drop(corners);
        if triangles.is_empty() {
            report.warn(element, "there are no triangles");
            return Ok(None);
        }

        let mut mesh = Mesh { triangles, ..Mesh::default() };
        mesh.positions = gather(&positions, &kept);
        if let Some((vertex, position)) = kept.iter().zip(&mesh.positions).find(|(_, position)| !finite(*position)) {
            return Err(Fault::new(position_element, format!("vertex {vertex} is not finite: {position:?}")));
        }
        if semantic(Semantic::Colors(0)).is_some_and(|colors| !is_white(self.source, colors, &kept)) {
            report.warn_once(element, "vertex colours are not read");
        }
        if let Some(normal) = semantic(Semantic::Normals) {
            let user = format!("{element}.attributes.NORMAL");
            let normals = open_attribute(self.source, normal, Type::Vec3, vertices, &user)?;
            mesh.normals = gather(&normals, &kept);
            let replaced = repair_normals(&mut mesh);
            if replaced > 0 {
                report.warn(user, format!("{replaced} normals have no direction; that of the triangles is used"));
            }
        }
        for set in 0..mesh.uvs.len() {
            if let Some(uv) = semantic(Semantic::TexCoords(set as u32)) {
                let user = format!("{element}.attributes.TEXCOORD_{set}");
                let elements = open_attribute(self.source, uv, Type::Vec2, vertices, &user)?;
                let mut uvs: Vec<[f32; 2]> = gather(&elements, &kept);
                let mut broken = 0;
                for uv in uvs.iter_mut().filter(|uv| !finite(*uv)) {
                    *uv = [0.0; 2];
                    broken += 1;
                }
                if broken > 0 {
                    report.warn(user, format!("{broken} texture coordinates are not finite; 0 is used"));
                }
                mesh.uvs[set] = uvs;
            }
        }

        mesh.material = match primitive.material {
            Some(index) => {
                let user = format!("{element}.material");
                self.source.get(index, &user)?;
                index.value()
            }
            None => *self.default_material.get_or_insert_with(|| {
                materials.push(default_material());
                materials.len() - 1
            }),
        };
        if let Some(material) = materials.get(mesh.material) {
            warn_missing_uvs(material, &mesh, element, report);
        }
        Ok(Some(mesh))
    }

    /// The vertex of each corner, all of them below `vertices`.
    fn corners(&mut self, primitive: &Primitive, vertices: usize, element: &str) -> Result<Vec<u32>, Fault> {
        let user = format!("{element}.indices");
        let indices = match primitive.indices {
            Some(indices) => Some(Elements::open(self.source, indices, Type::Scalar, INDEX, &user)?),
            None => None,
        };
        let count = indices.as_ref().map_or(vertices, Elements::len);
        // A strip or fan has about as many triangles as corners.
        self.triangles = self.triangles.saturating_add(if primitive.mode == Checked::Valid(Mode::Triangles) {
            count / 3
        } else {
            count
        });
        if self.triangles > MAX_TRIANGLES {
            return Err(Fault::new(element, format!("the file has more than {MAX_TRIANGLES} triangles in its meshes")));
        }
        let Some(indices) = indices else { return Ok((0..count as u32).collect()) };
        let corners: Vec<u32> = (0..count).map(|index| indices.integer(index)).collect();
        match corners.iter().position(|&corner| corner as usize >= vertices) {
            Some(at) => {
                let vertex = corners.get(at).copied().unwrap_or_default();
                Err(Fault::new(user, format!("index {at} is {vertex}, but there are only {vertices} vertices")))
            }
            None => Ok(corners),
        }
    }
}

/// The vertices that corners use, in increasing order, each once.
fn used(corners: &[u32], vertices: usize) -> Vec<u32> {
    if vertices > corners.len() {
        // A list of all vertices could be far longer than what is used of it.
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

/// Triangles between corners, renumbered to the position of each vertex in `kept`, which is sorted.
fn triangles(mode: Mode, corners: &[u32], kept: &[u32]) -> Vec<[u32; 3]> {
    // Sorted and each once: if the last one is in its place, all are.
    let all = kept.last().is_none_or(|&last| last as usize + 1 == kept.len());
    let renumbered = |corner: u32| if all { corner } else { kept.partition_point(|&vertex| vertex < corner) as u32 };
    let triangle = |corners: [u32; 3]| corners.map(renumbered);
    match (mode, corners) {
        (Mode::TriangleStrip, corners) => {
            let windows = corners.windows(3).filter_map(|window| window.first_chunk::<3>());
            // Every other triangle of a strip is wound the other way.
            windows
                .enumerate()
                .map(|(i, &[a, b, c])| triangle(if i % 2 == 0 { [a, b, c] } else { [a, c, b] }))
                .collect()
        }
        (Mode::TriangleFan, [hub, rim @ ..]) => {
            let windows = rim.windows(2).filter_map(|window| window.first_chunk::<2>());
            windows.map(|&[a, b]| triangle([a, b, *hub])).collect()
        }
        (_, corners) => corners.as_chunks::<3>().0.iter().map(|&corners| triangle(corners)).collect(),
    }
}

fn open_attribute<'a>(
    source: &'a Source<'a>,
    index: Index<gltf::json::Accessor>,
    shape: Type,
    vertices: usize,
    user: &str,
) -> Result<Elements<'a>, Fault> {
    let elements = Elements::open(source, index, shape, REAL, user)?;
    if elements.len() != vertices {
        return Err(Fault::new(user, format!("{} elements, but POSITION has {vertices}", elements.len())));
    }
    Ok(elements)
}

fn gather<const N: usize>(elements: &Elements, kept: &[u32]) -> Vec<[f32; N]> {
    kept.iter().map(|&vertex| elements.vector(vertex as usize)).collect()
}

fn finite(numbers: &[f32]) -> bool {
    numbers.iter().all(|number| number.is_finite())
}

/// Makes all normals unit vectors; those without a direction get that of the triangles around, weighted by area.
/// Returns how many those were.
fn repair_normals(mesh: &mut Mesh) -> usize {
    let mut replaced = 0;
    let mut around: Option<Vec<Vec3>> = None;
    for vertex in 0..mesh.normals.len() {
        let Some(&normal) = mesh.normals.get(vertex) else { break };
        let unit = Vec3::from(normal).try_normalize().unwrap_or_else(|| {
            replaced += 1;
            let around = around.get_or_insert_with(|| geometric_normals(mesh));
            around.get(vertex).and_then(|sum| sum.try_normalize()).unwrap_or(Vec3::Z)
        });
        if let Some(normal) = mesh.normals.get_mut(vertex) {
            *normal = unit.to_array();
        }
    }
    replaced
}

/// For each vertex, the sum of the (not normalised) normals of the triangles around.
fn geometric_normals(mesh: &Mesh) -> Vec<Vec3> {
    let mut sums = vec![Vec3::ZERO; mesh.positions.len()];
    let position = |corner: u32| mesh.positions.get(corner as usize).map_or(Vec3::ZERO, |&position| position.into());
    for &corners in &mesh.triangles {
        let [a, b, c] = corners.map(position);
        let normal = (b - a).cross(c - a);
        for corner in corners {
            if let Some(sum) = sums.get_mut(corner as usize) {
                *sum += normal;
            }
        }
    }
    sums
}

/// Whether vertex colours change nothing, as those that some exporters always write.
fn is_white(source: &Source<'_>, colors: Index<gltf::json::Accessor>, kept: &[u32]) -> bool {
    let white = |shape| {
        let elements = Elements::open(source, colors, shape, REAL, "COLOR_0");
        let white = |elements: Elements| gather(&elements, kept).iter().all(|color: &[f32; 3]| *color == [1.0; 3]);
        elements.is_ok_and(white)
    };
    white(Type::Vec3) || white(Type::Vec4)
}

/// Says once for each kind of data that a primitive has and that is not read.
fn warn_unread(primitive: &Primitive, element: &str, report: &mut Report) {
    for semantic in primitive.attributes.keys() {
        let reason = match semantic {
            Checked::Valid(Semantic::Tangents) => "tangents are not read",
            Checked::Valid(Semantic::Joints(_) | Semantic::Weights(_)) => "skins are not read; the rest shape is drawn",
            Checked::Valid(Semantic::TexCoords(2..)) => "texture coordinates beyond TEXCOORD_1 are not read",
            _ => continue,
        };
        report.warn_once(element, reason);
    }
    if primitive.targets.as_ref().is_some_and(|targets| !targets.is_empty()) {
        report.warn_once(element, "morph targets are not read; the base shape is drawn");
    }
}

fn warn_missing_uvs(material: &Material, mesh: &Mesh, element: &str, report: &mut Report) {
    let textures = [&material.base_color_texture, &material.metallic_roughness_texture, &material.emissive_texture];
    for texture in textures.into_iter().flatten() {
        if mesh.uvs.get(texture.uv_set).is_none_or(|uvs| uvs.is_empty()) {
            let set = texture.uv_set;
            report.warn(element, format!("its material uses TEXCOORD_{set}, which it does not have"));
            return;
        }
    }
}
