//! Vertex attributes. A broken attribute is lost alone.

use gltf::json::accessor::Type;
use gltf::json::mesh::{Primitive, Semantic};
use gltf::json::validation::Checked;
use gltf::json::{Accessor, Index};

use super::accessor::{Elements, REAL};
use super::source::Source;
use crate::scene::description::{Material, Mesh};
use crate::scene::load::common::report::{Fault, Report};

/// The vertices that a primitive uses.
pub(super) struct Vertices<'a> {
    pub source: &'a Source<'a>,
    pub primitive: &'a Primitive,
    /// Number of vertices.
    pub count: usize,
    /// The vertices in use, in increasing order.
    pub kept: &'a [u32],
    /// The primitive, as messages name it.
    pub element: &'a str,
}

impl<'a> Vertices<'a> {
    /// The accessor of an attribute.
    pub fn attribute(&self, semantic: Semantic) -> Option<Index<Accessor>> {
        self.primitive.attributes.get(&Checked::Valid(semantic)).copied()
    }

    /// Opens an attribute of all vertices.
    pub fn open(
        &self,
        accessor: Index<Accessor>,
        shape: Type,
        components: &[gltf::json::accessor::ComponentType],
        user: &str,
    ) -> Result<Elements<'a>, Fault> {
        let elements = Elements::open(self.source, accessor, shape, components, user)?;
        if elements.len() != self.count {
            return Err(Fault::new(user, format!("{} elements, but POSITION has {}", elements.len(), self.count)));
        }
        Ok(elements)
    }

    /// The normals of the file, or an empty list.
    pub fn normals(&self, report: &mut Report) -> Vec<[f32; 3]> {
        self.vectors((Semantic::Normals, "NORMAL", Type::Vec3), "the triangles' own normals are used", report)
    }

    /// The tangents of the file, or an empty list.
    pub fn tangents(&self, report: &mut Report) -> Vec<[f32; 4]> {
        let instead = "tangents are made from the texture coordinates";
        self.vectors((Semantic::Tangents, "TANGENT", Type::Vec4), instead, report)
    }

    /// The vectors of an attribute, or an empty list. `instead` names their replacement in the warning.
    fn vectors<const N: usize>(
        &self,
        (semantic, name, shape): (Semantic, &str, Type),
        instead: &str,
        report: &mut Report,
    ) -> Vec<[f32; N]> {
        let Some(accessor) = self.attribute(semantic) else { return Vec::new() };
        match self.open(accessor, shape, REAL, &format!("{}.attributes.{name}", self.element)) {
            Ok(elements) => gather(&elements, self.kept),
            Err(fault) => {
                report.replace(fault, instead);
                Vec::new()
            }
        }
    }

    /// Texture coordinates of a set, or an empty list.
    pub fn uvs(&self, set: u32, report: &mut Report) -> Vec<[f32; 2]> {
        let Some(accessor) = self.attribute(Semantic::TexCoords(set)) else { return Vec::new() };
        let user = format!("{}.attributes.TEXCOORD_{set}", self.element);
        let elements = match self.open(accessor, Type::Vec2, REAL, &user) {
            Ok(elements) => elements,
            Err(fault) => {
                report.replace(fault, "0 is used");
                return vec![[0.0; 2]; self.kept.len()];
            }
        };
        let mut uvs: Vec<[f32; 2]> = gather(&elements, self.kept);
        let mut broken = 0;
        for uv in uvs.iter_mut().filter(|uv| uv.iter().any(|x| !x.is_finite())) {
            *uv = [0.0; 2];
            broken += 1;
        }
        if broken > 0 {
            report.warn(user, format!("{broken} texture coordinates are not finite; 0 is used"));
        }
        uvs
    }

    /// Linear colours and opacities. Empty if all are white, because some exporters always write white ones.
    pub fn colors(&self, report: &mut Report) -> Vec<[f32; 4]> {
        let Some(accessor) = self.attribute(Semantic::Colors(0)) else { return Vec::new() };
        let user = format!("{}.attributes.COLOR_0", self.element);
        let three = self.source.get(accessor, &user).is_ok_and(|accessor| accessor.type_ == Checked::Valid(Type::Vec3));
        let elements = match self.open(accessor, if three { Type::Vec3 } else { Type::Vec4 }, REAL, &user) {
            Ok(elements) => elements,
            Err(fault) => {
                report.replace(fault, "white is used");
                return Vec::new();
            }
        };
        if elements.is_whole() {
            report.warn_once(&user, "colours are integers that are not normalised; they are read as normalised");
        }
        let opaque = !elements.has_shape(Type::Vec4);
        let mut broken = 0;
        let color = |&vertex: &u32| {
            let mut color = elements.normalized::<4>(vertex as usize);
            if opaque {
                color[3] = 1.0;
            }
            if color.iter().any(|channel| !(-1e-4..=1.0001).contains(channel)) {
                broken += 1;
            }
            color.map(|channel| if channel.is_nan() { 1.0 } else { channel.clamp(0.0, 1.0) })
        };
        let colors: Vec<[f32; 4]> = self.kept.iter().map(color).collect();
        if broken > 0 {
            report.warn(user, format!("{broken} colours are outside 0…1; they are clamped"));
        }
        if colors.iter().all(|color| *color == [1.0; 4]) { Vec::new() } else { colors }
    }
}

/// The elements of some vertices.
pub(super) fn gather<const N: usize>(elements: &Elements, kept: &[u32]) -> Vec<[f32; N]> {
    kept.iter().map(|&vertex| elements.vector(vertex as usize)).collect()
}

/// Warns once about each kind of data of a primitive that is not read.
pub(super) fn warn_unread(primitive: &Primitive, element: &str, report: &mut Report) {
    for semantic in primitive.attributes.keys() {
        let reason = match semantic {
            Checked::Valid(Semantic::TexCoords(2..)) => "texture coordinates beyond TEXCOORD_1 are not read",
            Checked::Valid(Semantic::Colors(1..)) => "colours beyond COLOR_0 are not read",
            Checked::Invalid => "an attribute of a name that glTF does not have is not read",
            _ => continue,
        };
        report.warn_once(element, reason);
    }
}

/// Warns if the textures of a material have no coordinates.
pub(super) fn warn_missing_uvs(material: &Material, mesh: &Mesh, element: &str, report: &mut Report) {
    for (_, texture) in material.textures() {
        let set = texture.uv_set;
        let removed = report.is_removed(&format!("{element}.attributes.TEXCOORD_{set}"));
        if mesh.uvs.get(set).is_none_or(|uvs| uvs.is_empty()) && !removed {
            let reason = format!("its material uses TEXCOORD_{set}, which it does not have; 0 is used");
            report.warn(element, reason);
            return;
        }
    }
}
