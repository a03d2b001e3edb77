//! Normals, tangents, texture coordinates and colours of triangles.

use super::drawn::Posed;
use super::groups::Face;
use super::tangents::{self, Tangents, mapped};
use crate::scene::description::{Material, Scene};
use glam::{Vec2, Vec3};

/// Places of a triangle's words in the attributes: three normals, three tangents, then three (u, v) per set, then three colours, each
/// only if the scene needs it.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Layout {
    pub stride: usize,
    pub normals: bool,
    /// True if there are tangents, and so normals.
    pub tangents: bool,
    pub uv: [Option<usize>; 2],
    /// Four numbers of 16 bits a corner.
    pub color: Option<usize>,
}

impl Layout {
    /// The attributes that a scene needs.
    pub fn of(scene: &Scene) -> Self {
        let used = |set: usize| {
            let reads = |m: &Material| m.textures().any(|(_, texture)| texture.uv_set == set);
            scene.meshes.iter().any(|mesh| reads(&scene.materials[mesh.material]))
        };
        let tangents = scene.meshes.iter().any(|mesh| mapped(mesh, &scene.materials[mesh.material]).is_some());
        let normals = tangents || scene.meshes.iter().any(|mesh| !mesh.normals.is_empty());
        let stride = 3 * usize::from(normals) + 3 * usize::from(tangents);
        let mut layout = Layout { stride, normals, tangents, ..Default::default() };
        for set in 0..2 {
            if used(set) {
                layout.uv[set] = Some(layout.stride);
                layout.stride += 6;
            }
        }
        if scene.meshes.iter().any(|mesh| !mesh.colors.is_empty()) {
            layout.color = Some(layout.stride);
            layout.stride += 6;
        }
        layout
    }

    /// Appends the words of a face. `tangents` are those of its mesh as it is, if it has a normal map. `normals` are words of each vertex,
    /// if they are known.
    pub fn push(
        &self,
        attributes: &mut Vec<u32>,
        posed: &Posed<'_>,
        (tangents, normals): (Option<&Tangents>, Option<&[u32]>),
        face: &Face,
    ) {
        let mesh = posed.mesh;
        let mirrored = face.placement.determinant() < 0.0;
        let corners = face.in_order(posed, mesh.triangles[face.triangle]);
        if self.normals {
            // Normals transform by the transpose of the inverse.
            let words = match (normals, posed.normals()) {
                // Images of normals need one to be relative to.
                (_, []) => [if tangents.is_some() { normal_word(face.area_normal()) } else { 0 }; 3],
                (Some(words), _) => corners.map(|corner| words[corner as usize]),
                (None, of_mesh) => {
                    let map = face.placement.inverse().transpose().as_mat3();
                    corners.map(|corner| normal_word(map * Vec3::from(of_mesh[corner as usize])))
                }
            };
            attributes.extend(words);
        }
        if self.tangents {
            let map = face.placement.as_mat3();
            let packed = tangents.and_then(|tangents| {
                let [a, b, c] = tangents::posed(tangents, posed, face.triangle).map(|tangent| {
                    let direction = (map * tangent.truncate()).try_normalize()?;
                    Some(pack_tangent(direction, (tangent.w < 0.0) != mirrored))
                });
                Some(face.in_order(posed, [a?, b?, c?]))
            });
            attributes.extend(packed.unwrap_or([0; 3]));
        }
        for (set, offset) in self.uv.iter().enumerate() {
            if offset.is_some() {
                attributes.extend(face.uvs(posed, set).as_flattened().iter().map(|x| x.to_bits()));
            }
        }
        if self.color.is_some() {
            for corner in corners {
                let [r, g, b, a] = mesh.colors.get(corner as usize).copied().unwrap_or([1.0; 4]);
                attributes.extend([pack_unorm([r, g]), pack_unorm([b, a])]);
            }
        }
    }
}

/// The word of a normal of any length: 0 if it has no direction.
pub(crate) fn normal_word(normal: Vec3) -> u32 {
    normal.try_normalize().map_or(0, pack_octahedral)
}

/// A unit vector as two 16-bit numbers on the unfolded octahedron. Never 0, which means no normal.
fn pack_octahedral(n: Vec3) -> u32 {
    let q = (unfolded(n) * 65535.0).round().clamp(Vec2::ONE, Vec2::splat(65535.0));
    q.x as u32 | (q.y as u32) << 16
}

/// A unit tangent as numbers of 16 and 15 bits, and a bit that is set if w is −1. Never 0, which means no tangent.
fn pack_tangent(t: Vec3, negative: bool) -> u32 {
    let q = (unfolded(t) * Vec2::new(65535.0, 32767.0)).round().max(Vec2::ONE);
    q.x as u32 | (q.y as u32) << 16 | u32::from(negative) << 31
}

/// The point of the unfolded octahedron at which a unit vector lies, 0…1 (Meyer et al. 2010).
fn unfolded(n: Vec3) -> Vec2 {
    let p = Vec2::new(n.x, n.y) / (n.x.abs() + n.y.abs() + n.z.abs());
    let sign = Vec2::new(1.0_f32.copysign(p.x), 1.0_f32.copysign(p.y));
    let folded = if n.z < 0.0 { (1.0 - Vec2::new(p.y, p.x).abs()) * sign } else { p };
    folded * 0.5 + 0.5
}

/// Two numbers within 0…1 as `unpack2x16unorm` of WGSL reads them.
fn pack_unorm(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|x| (x.clamp(0.0, 1.0) * 65535.0).round() as u32);
    low | high << 16
}
