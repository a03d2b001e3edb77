//! Tangents for normal maps: those of the mesh, or those of MikkTSpace (Mikkelsen 2008, "Simulation of Wrinkled Surfaces Revisited"),
//! which bakers of normal maps use and glTF prescribes.

use super::drawn::Posed;
use crate::scene::description::{Material, Mesh, Texture, turned_tangent};
use bevy_mikktspace::{Geometry, TangentSpace, generate_tangents};
use glam::{Vec3, Vec4};

/// The tangents of each triangle's corners: a direction, and ±1 for the bitangent `w · normal × tangent`. A direction of 0 is none.
pub(crate) type Tangents = Vec<[Vec4; 3]>;

/// The normal map that tells a mesh's tangents, if the mesh has the coordinates for it.
pub(crate) fn mapped(mesh: &Mesh, material: &Material) -> Option<Texture> {
    material.normal_maps().find(|texture| !mesh.uvs[texture.uv_set].is_empty())
}

/// The tangents of a mesh that has a normal map.
pub(crate) fn of(mesh: &Mesh, material: &Material) -> Option<Tangents> {
    let texture = mapped(mesh, material)?;
    if !has_own(mesh) {
        return Some(made(mesh, &texture));
    }
    let tangent = |corner: u32| Vec4::from(mesh.tangents[corner as usize]);
    Some(mesh.triangles.iter().map(|corners| corners.map(tangent)).collect())
}

/// True if the tangents of the mesh count. Without normals a mesh is flat, and tangents that belong to others have no meaning.
fn has_own(mesh: &Mesh) -> bool {
    !mesh.normals.is_empty() && !mesh.tangents.is_empty()
}

/// The tangents of a triangle's corners in a shape of the mesh. Those that MikkTSpace made follow joints, but no morph target has
/// offsets for them.
pub(crate) fn posed(tangents: &Tangents, posed: &Posed<'_>, triangle: usize) -> [Vec4; 3] {
    let at_rest = tangents[triangle];
    let Some(shape) = posed.shape else { return at_rest };
    let vertices = posed.mesh.triangles[triangle].map(|vertex| vertex as usize);
    if has_own(posed.mesh) {
        return vertices.map(|vertex| shape.tangents[vertex].into());
    }
    [0, 1, 2].map(|corner| {
        let turn = shape.turns.get(vertices[corner]);
        turn.map_or(at_rest[corner], |turn| turned_tangent(turn, at_rest[corner]))
    })
}

/// The tangents that MikkTSpace makes.
fn made(mesh: &Mesh, texture: &Texture) -> Tangents {
    let mut corners = Corners { mesh, texture, tangents: vec![[Vec4::ZERO; 3]; mesh.triangles.len()] };
    match generate_tangents(&mut corners) {
        Ok(()) => corners.tangents,
        // The error has no values.
        Err(_) => vec![[Vec4::ZERO; 3]; mesh.triangles.len()],
    }
}

/// The corners of a mesh, as MikkTSpace reads them and writes their tangents.
struct Corners<'a> {
    mesh: &'a Mesh,
    texture: &'a Texture,
    tangents: Tangents,
}

impl Corners<'_> {
    fn vertex(&self, face: usize, corner: usize) -> usize {
        self.mesh.triangles[face][corner] as usize
    }
}

impl Geometry for Corners<'_> {
    fn num_faces(&self) -> usize {
        self.mesh.triangles.len()
    }

    fn num_vertices_of_face(&self, _face: usize) -> usize {
        3
    }

    fn position(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.positions[self.vertex(face, corner)]
    }

    fn normal(&self, face: usize, corner: usize) -> [f32; 3] {
        self.mesh.normals.get(self.vertex(face, corner)).copied().unwrap_or_else(|| {
            let [a, b, c] = [0, 1, 2].map(|corner| Vec3::from(self.position(face, corner)));
            (b - a).cross(c - a).normalize_or_zero().to_array()
        })
    }

    /// The place in the image, because its axes are those of the normals.
    fn tex_coord(&self, face: usize, corner: usize) -> [f32; 2] {
        let [u, v] = self.mesh.uvs[self.texture.uv_set][self.vertex(face, corner)];
        // A place that is not a number would be unlike itself when vertices are compared.
        self.texture.transform.map(|row| row[0] * u + row[1] * v + row[2]).map(|x| if x.is_finite() { x } else { 0.0 })
    }

    fn set_tangent(&mut self, space: Option<TangentSpace>, face: usize, corner: usize) {
        let Some(space) = space else { return };
        let direction = Vec3::from(space.tangent());
        if direction.is_finite() {
            // MikkTSpace's bitangent points to where v grows, which is downwards in the image.
            let w = if space.is_orientation_preserving() { -1.0 } else { 1.0 };
            self.tangents[face][corner] = direction.extend(w);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A square of two triangles in the plane z = 0 with these coordinates.
    fn square(uvs: [[f32; 2]; 4]) -> Mesh {
        Mesh {
            positions: vec![[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.0]],
            uvs: [uvs.to_vec(), Vec::new()],
            triangles: vec![[0, 1, 2], [0, 2, 3]],
            ..Mesh::default()
        }
    }

    fn with_map(texture: Texture) -> Material {
        Material { normal_texture: Some(texture), ..Material::default() }
    }

    #[track_caller]
    fn assert_all(tangents: Option<Tangents>, expected: [f32; 4]) {
        for tangent in tangents.unwrap().into_iter().flatten() {
            assert!((tangent - Vec4::from(expected)).abs().max_element() < 1e-6, "{tangent}, not {expected:?}");
        }
    }

    #[test]
    fn tangents_lead_along_u_and_bitangents_up_in_the_image() {
        let plain = with_map(Texture::new(0));
        // The image upright: v grows downwards, so the bitangent n × t = +y is its upward direction.
        let upright = [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]];
        assert_all(of(&square(upright), &plain), [1.0, 0.0, 0.0, 1.0]);
        // Mirrored in u, and in v.
        let mirrored = upright.map(|[u, v]| [1.0 - u, v]);
        assert_all(of(&square(mirrored), &plain), [-1.0, 0.0, 0.0, -1.0]);
        let upside_down = upright.map(|[u, v]| [u, 1.0 - v]);
        assert_all(of(&square(upside_down), &plain), [1.0, 0.0, 0.0, -1.0]);
        // A quarter turn of the texture turns its axes.
        let turned = Texture { transform: [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]], ..Texture::new(0) };
        assert_all(of(&square(upright), &with_map(turned)), [0.0, -1.0, 0.0, 1.0]);
    }

    #[test]
    fn tangents_of_the_mesh_count_if_it_has_normals() {
        let plain = with_map(Texture::new(0));
        let mut mesh = square([[0.0, 1.0], [1.0, 1.0], [1.0, 0.0], [0.0, 0.0]]);
        mesh.tangents = vec![[0.0, 1.0, 0.0, -1.0]; 4];
        assert_all(of(&mesh, &plain), [1.0, 0.0, 0.0, 1.0]);
        mesh.normals = vec![[0.0, 0.0, 1.0]; 4];
        assert_all(of(&mesh, &plain), [0.0, 1.0, 0.0, -1.0]);
        assert!(of(&mesh, &Material::default()).is_none());
        let second = with_map(Texture { uv_set: 1, ..Texture::new(0) });
        assert!(of(&mesh, &second).is_none(), "the second set has no coordinates");
    }

    #[test]
    fn meshes_of_any_kind_make_no_harm() {
        let plain = with_map(Texture::new(0));
        let numbers = [0.0, -0.0, 1.0, -1.0, 1e-38, 1e-20, 1e20, 3e38, -3e38, 0.5];
        let mut state = 1_u32;
        let mut next = |count: usize| {
            state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
            (state >> 16) as usize % count
        };
        for _ in 0..2000 {
            let vertices = 1 + next(8);
            let mut mesh = Mesh::default();
            for _ in 0..vertices {
                mesh.positions.push([0; 3].map(|_| numbers[next(numbers.len())]));
                mesh.normals.push([0; 3].map(|_| numbers[next(numbers.len())]));
                mesh.uvs[0].push([0; 2].map(|_| numbers[next(numbers.len())]));
            }
            mesh.triangles = (0..next(12)).map(|_| [0; 3].map(|_| next(vertices) as u32)).collect();
            let tangents = of(&mesh, &plain).unwrap();
            assert_eq!(tangents.len(), mesh.triangles.len());
            assert!(tangents.iter().flatten().all(|tangent| tangent.is_finite()), "{mesh:?}");
        }
    }
}
