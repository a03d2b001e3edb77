//! The triangles of a scene with few of them, as shaders/shared/few_triangles.wgsl reads them.

use bytemuck::{Pod, Zeroable};
use glam::{DVec3, Mat4};

/// Maximum number of triangles that are tested one by one. On an adapter that is the CPU this is faster than a tree: at 48 triangles,
/// three times as fast. There is a limit because shaders grow with each triangle.
pub(crate) const MOST: usize = 64;

/// Number of triangles that are tested together.
const GROUP: usize = 8;

/// Number of facets for which the shaders are compiled.
pub(crate) fn padded(count: usize) -> usize {
    count.next_multiple_of(GROUP).max(GROUP)
}

/// `Facet` of few_triangles.wgsl: a corner, a normal of any length, and the maps to the weights of the other two corners.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, PartialEq, Pod, Zeroable)]
pub(crate) struct Facet {
    corner: [f32; 3],
    normal: [f32; 3],
    to_u: [f32; 3],
    to_v: [f32; 3],
}

impl Facet {
    /// A triangle after a placement. A triangle without area becomes a facet that is never hit.
    pub fn new(corners: [[f32; 3]; 3], placement: Mat4) -> Self {
        let placement = placement.as_dmat4();
        let [a, b, c] = corners.map(|p| placement.transform_point3(DVec3::from(p.map(f64::from))));
        let (edge_b, edge_c) = (b - a, c - a);
        let normal = edge_b.cross(edge_c);
        let narrow = |v: DVec3| v.as_vec3().to_array();
        let facet = Self {
            corner: narrow(a),
            // With length 1, tiny and huge triangles stay within the range of f32.
            normal: narrow(normal.normalize_or_zero()),
            to_u: narrow(edge_c.cross(normal) / normal.length_squared()),
            to_v: narrow(normal.cross(edge_b) / normal.length_squared()),
        };
        let numbers = [facet.normal, facet.to_u, facet.to_v];
        if numbers.iter().flatten().all(|x| x.is_finite()) { facet } else { Self::default() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::Vec3;

    #[test]
    fn a_facet_maps_corners_to_their_weights() {
        let corners = [[1.0, 2.0, 3.0], [4.0, 2.5, 3.0], [1.5, 7.0, -2.0]];
        let placement = Mat4::from_scale(Vec3::new(2.0, -1.0, 0.5));
        let f = Facet::new(corners, placement);
        for (i, expected) in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].into_iter().enumerate() {
            let p = placement.transform_point3(corners[i].into()) - Vec3::from(f.corner);
            let weights = [Vec3::from(f.to_u).dot(p), Vec3::from(f.to_v).dot(p)];
            assert!((Vec3::from(f.normal).dot(p)).abs() < 1e-5);
            assert!(weights.iter().zip(expected).all(|(w, e)| (w - e).abs() < 1e-6), "{weights:?}");
        }
    }

    #[test]
    fn a_triangle_without_area_is_never_hit() {
        let line = [[0.0; 3], [1.0, 1.0, 1.0], [2.0, 2.0, 2.0]];
        assert_eq!(Facet::new(line, Mat4::IDENTITY), Facet::default());
    }
}
