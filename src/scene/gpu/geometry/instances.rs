//! Trees placed in the world, the top level above them, and their records as shaders/shared/scene.wgsl reads them.

use super::centre::relative;
use crate::scene::description::Pose;
use crate::scene::gpu::memory::folded::{self, Texel};
use crate::scene::gpu::tree::{self, Quantization};
use glam::{DMat4, DVec3, Mat4, Vec3, Vec4};

/// Texels of a [`tree::Node`] and of an instance's record, as in shaders/shared/scene.wgsl.
pub(crate) const NODE_TEXELS: usize = 2;
const RECORD_TEXELS: usize = 10;

/// A tree placed in the world.
#[derive(Debug)]
pub(crate) struct Instance {
    /// The node that places the tree. `None` if it is in world space already: for the static geometry, and for meshes that joints place.
    pub node: Option<usize>,
    /// Origin of the tree's coordinates, in the space of the node.
    pub centre: DVec3,
    pub root: u32,
    pub first_row: u32,
    pub row_count: u32,
    /// First number in the visibility buffer.
    pub first_id: u32,
    pub first_light: u32,
    pub bounds: [[f32; 3]; 2],
    pub grid: Quantization,
    /// Number of its first triangle among those that change their shape, if they do.
    pub first_corner: Option<u32>,
}

impl Instance {
    /// The placement in a pose, relative to the scene's centre.
    pub fn placement(&self, pose: &Pose, centre: DVec3) -> Mat4 {
        self.node.map_or(Mat4::IDENTITY, |n| relative(&pose.world[n], self.centre, centre))
    }
}

/// Maximum number of nodes of a top level over this many instances: each inner node joins two.
pub(crate) fn top_level_nodes(instances: usize) -> usize {
    instances.saturating_sub(1).max(1)
}

/// Texels of the top level and the records, in whole rows.
pub(crate) fn top_level_texels(instances: usize) -> usize {
    (top_level_nodes(instances) * NODE_TEXELS + instances * RECORD_TEXELS).next_multiple_of(folded::WIDTH)
}

/// The top level and the records of instances.
pub(crate) struct Placed {
    pub texels: Vec<Texel>,
    /// Depth of the top level.
    pub depth: u32,
    pub grid: Quantization,
}

/// The top level, of at most `deepest` levels, and the instances' records in a pose, relative to the scene's centre.
pub(crate) fn place(instances: &[Instance], pose: &Pose, centre: DVec3, first_node: u32, deepest: u32) -> Placed {
    let boxes: Vec<_> = instances.iter().map(|i| transform_box(i.placement(pose, centre), i.bounds)).collect();
    let top = tree::over_instances(&boxes, first_node, deepest);
    let mut texels = folded::texels(&top.nodes).to_vec();
    // Room for the most nodes that a tree over these instances can have, so that the records never move.
    texels.resize(top_level_nodes(instances.len()) * NODE_TEXELS, Texel::default());
    for (instance, bounds) in instances.iter().zip(&boxes) {
        let now = instance.placement(pose, centre);
        let back = inverse(now);
        let mirrored = u32::from(now.determinant() < 0.0);
        texels.extend(rows(now));
        texels.extend(rows(back));
        texels.push(padded(instance.grid.base));
        texels.push(padded(instance.grid.step));
        texels.push([instance.root, instance.first_id, instance.first_light, instance.first_row << 1 | mirrored]);
        let [x, y, z, _] = padded(rounding(now, back, *bounds));
        texels.push([x, y, z, instance.first_corner.map_or(0, |first| first + 1)]);
    }
    Placed { texels, depth: top.depth, grid: top.grid }
}

/// The placements alone, by which a later frame knows where instances were.
pub(crate) fn rows_of(instances: &[Instance], pose: &Pose, centre: DVec3) -> Vec<Texel> {
    instances.iter().flat_map(|instance| rows(instance.placement(pose, centre))).collect()
}

fn padded(v: [f32; 3]) -> Texel {
    [v[0].to_bits(), v[1].to_bits(), v[2].to_bits(), 0]
}

/// The three rows of an affine matrix.
fn rows(m: Mat4) -> [Texel; 3] {
    [m.row(0), m.row(1), m.row(2)].map(|r: Vec4| r.to_array().map(f32::to_bits))
}

/// The inverse, in double precision. A placement that flattens has none: 0 replaces it, and the instance is never hit.
fn inverse(m: Mat4) -> Mat4 {
    let m = m.as_dmat4();
    if m.determinant() == 0.0 { Mat4::ZERO } else { m.inverse().as_mat4() }
}

/// The largest shift along each axis, in world space, that f32 adds to a point of a box on its way into an instance's space: four
/// roundings of the terms of each sum.
fn rounding(now: Mat4, back: Mat4, [low, high]: [[f32; 3]; 2]) -> [f32; 3] {
    if back == Mat4::IDENTITY {
        return [0.0; 3];
    }
    let (now, back) = (now.as_dmat4(), back.as_dmat4());
    let farthest = Vec3::from(low).abs().max(Vec3::from(high).abs()).as_dvec3();
    let terms = |m: DMat4, v: DVec3| m.x_axis.abs() * v.x + m.y_axis.abs() * v.y + m.z_axis.abs() * v.z;
    let inside = terms(back, farthest) + back.w_axis.abs();
    (terms(now, inside.truncate()).truncate() * 4.0 * f64::from(f32::EPSILON / 2.0)).as_vec3().to_array()
}

/// The box around a box that was placed.
fn transform_box(m: Mat4, [low, high]: [[f32; 3]; 2]) -> [[f32; 3]; 2] {
    let (mut a, mut b) = (Vec3::splat(f32::INFINITY), Vec3::splat(f32::NEG_INFINITY));
    for corner in 0..8 {
        let pick = |axis: usize| if corner >> axis & 1 == 0 { low[axis] } else { high[axis] };
        let p = m.transform_point3(Vec3::new(pick(0), pick(1), pick(2)));
        a = a.min(p);
        b = b.max(p);
    }
    // Without a margin, rounding in the transformation could lose a hit on the face of the box.
    let margin = (a.abs().max(b.abs())) * 4e-7;
    [(a - margin).to_array(), (b + margin).to_array()]
}
