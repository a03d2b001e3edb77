//! Normals, texture coordinates and colours of triangles.

use super::groups::Face;
use crate::scene::description::{Material, Mesh, Scene};
use glam::{Vec2, Vec3};

/// Places of a triangle's words in the attributes: three normals, then three (u, v) per set, then three colours, each only if the
/// scene needs it.
#[derive(Clone, Copy, Default)]
pub(crate) struct Layout {
    pub stride: usize,
    pub normals: bool,
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
        let mut layout = Layout { normals: scene.meshes.iter().any(|m| !m.normals.is_empty()), ..Default::default() };
        layout.stride = if layout.normals { 3 } else { 0 };
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

    /// Appends the words of a face.
    pub fn push(&self, attributes: &mut Vec<u32>, mesh: &Mesh, face: &Face) {
        let [a, b, c] = mesh.triangles[face.triangle];
        let corners = if face.placement.determinant() < 0.0 { [a, c, b] } else { [a, b, c] };
        if self.normals {
            // Normals transform by the transpose of the inverse.
            let map = face.placement.inverse().transpose().as_mat3();
            for corner in corners {
                let normal = mesh.normals.get(corner as usize).map_or(Vec3::ZERO, |&n| map * Vec3::from(n));
                attributes.push(normal.try_normalize().map_or(0, pack_octahedral));
            }
        }
        for (set, offset) in self.uv.iter().enumerate() {
            if offset.is_some() {
                for corner in corners {
                    let uv = mesh.uvs[set].get(corner as usize).copied().unwrap_or_default();
                    attributes.extend(uv.map(f32::to_bits));
                }
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

/// A unit vector as two 16-bit numbers on the unfolded octahedron (Meyer et al. 2010). Never 0, which means no normal.
fn pack_octahedral(n: Vec3) -> u32 {
    let p = Vec2::new(n.x, n.y) / (n.x.abs() + n.y.abs() + n.z.abs());
    let sign = Vec2::new(1.0_f32.copysign(p.x), 1.0_f32.copysign(p.y));
    let folded = if n.z < 0.0 { (1.0 - Vec2::new(p.y, p.x).abs()) * sign } else { p };
    let q = ((folded * 0.5 + 0.5) * 65535.0).round().clamp(Vec2::ONE, Vec2::splat(65535.0));
    q.x as u32 | (q.y as u32) << 16
}

/// Two numbers within 0…1 as `unpack2x16unorm` of WGSL reads them.
fn pack_unorm(pair: [f32; 2]) -> u32 {
    let [low, high] = pair.map(|x| (x.clamp(0.0, 1.0) * 65535.0).round() as u32);
    low | high << 16
}
