//! A pair of legs that walks, deformed by a skin of five joints and a morph target; and the shape of any mesh in f64.

use super::plane::{V, add, cross, scale, sub};
use super::scenes::{lambert, quad};
use asvgf::Camera;
use asvgf::scene::{
    Animation, Channel, Influence, Mesh, MorphTarget, Node, Pose, Scene, Skin, Target, Transform, WorldMatrix,
};
use std::f32::consts::{PI, TAU};

/// Number of the node that draws the legs.
pub const LEGS: usize = 5;

/// Seconds of a stride.
pub const STRIDE: f32 = 1.0;

fn at(translation: [f32; 3]) -> Transform {
    Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
}

/// A curve of 16 keys over one stride.
fn curve(target: Target, value: impl Fn(f32) -> [f32; 4]) -> Channel {
    let times: Vec<f32> = (0..=16).map(|key| key as f32 / 16.0 * STRIDE).collect();
    let values = times.iter().map(|time| value(time / STRIDE)).collect();
    Channel::new(target, times, values)
}

/// A turn about z that swings by `most` radians around `middle`.
fn swing(node: usize, most: f32, middle: f32, phase: f32) -> Channel {
    curve(Target::Rotation(node), |t| {
        let half = (middle + most * (TAU * t + phase).sin()) / 2.0;
        [0.0, 0.0, half.sin(), half.cos()]
    })
}

/// Legs of this number of rings and sides, in front of a wall and on a floor. They walk along x. Joints: the hip, then thigh and shin of each
/// leg, each with the origin at its upper end.
pub fn walker(rings: u32, sides: u32) -> Scene {
    let child = |parent, translation| Node { parent, transform: at(translation), ..Default::default() };
    let joints = vec![
        child(None, [-0.3, 1.1, 0.0]),
        child(Some(0), [0.0, 0.0, 0.15]),
        child(Some(1), [0.0, -0.5, 0.0]),
        child(Some(0), [0.0, 0.0, -0.15]),
        child(Some(3), [0.0, -0.5, 0.0]),
    ];
    // The joints place the legs, so that their own node has no effect.
    let legs = Node { meshes: vec![0], skin: Some(0), transform: at([50.0, 0.0, 0.0]), ..Default::default() };
    let still = |mesh| Node { meshes: vec![mesh], ..Default::default() };
    let down = |y: f32, z: f32| [[1.0, 0.0, 0.0, 0.0], [0.0, 1.0, 0.0, 0.0], [0.0, 0.0, 1.0, 0.0], [0.0, y, z, 1.0]];
    let inverse_bind = vec![down(0.0, 0.0), down(0.0, -0.15), down(0.5, -0.15), down(0.0, 0.15), down(0.5, 0.15)];
    let channels = vec![
        curve(Target::Translation(0), |t| [-0.3 + 0.6 * t, 1.1 + 0.03 * (2.0 * TAU * t).cos(), 0.0, 0.0]),
        swing(1, 0.5, 0.0, 0.0),
        swing(2, 0.4, -0.4, PI / 2.0),
        swing(3, 0.5, 0.0, PI),
        swing(4, 0.4, -0.4, -PI / 2.0),
        curve(Target::Weight { node: LEGS, target: 0 }, |t| [0.5 - 0.5 * (TAU * t).cos(), 0.0, 0.0, 0.0]),
    ];
    Scene {
        meshes: vec![
            legs_mesh(rings, sides),
            quad([-3.0, -0.05, 2.0], [6.0, 0.0, 0.0], [0.0, 0.0, -3.0], 1),
            quad([-3.0, -0.05, -1.0], [6.0, 0.0, 0.0], [0.0, 4.0, 0.0], 1),
        ],
        materials: vec![lambert([0.7, 0.4, 0.2]), lambert([0.6; 3])],
        nodes: joints.into_iter().chain([legs, still(1), still(2)]).collect(),
        skins: vec![Skin { joints: vec![0, 1, 2, 3, 4], inverse_bind }],
        animations: vec![Animation { name: "walk".into(), channels }],
        ..Default::default()
    }
}

/// Two tubes from the hip at the origin down to the feet, each with three joints for each vertex, and muscles that swell.
fn legs_mesh(rings: u32, sides: u32) -> Mesh {
    let (mut mesh, mut muscles) = (Mesh::default(), MorphTarget::default());
    for (leg, z) in [(1, 0.15), (3, -0.15)] {
        let first = mesh.positions.len() as u32;
        for ring in 0..rings {
            let down = ring as f32 / (rings - 1) as f32;
            for side in 0..sides {
                let angle = TAU * side as f32 / sides as f32;
                let [x, depth] = [angle.cos(), angle.sin()];
                let normal = [x, 0.0, depth];
                if (0.1..0.45).contains(&down) {
                    muscles.vertices.push(mesh.positions.len() as u32);
                    muscles.positions.push(normal.map(|n| 0.04 * n));
                    muscles.normals.push([0.0, 0.2, 0.0]);
                }
                mesh.positions.push([0.1 * x, -down, z + 0.1 * depth]);
                mesh.normals.push(normal);
                let knee = ((down - 0.4) / 0.2).clamp(0.0, 1.0);
                let hip = (1.0 - down / 0.2).clamp(0.0, 1.0) * 0.5;
                let shares = [(0, hip), (leg, (1.0 - hip) * (1.0 - knee)), (leg + 1, (1.0 - hip) * knee)];
                mesh.influences.extend(shares.map(|(joint, weight)| Influence { joint, weight }));
            }
        }
        for (ring, side) in (0..rings - 1).flat_map(|ring| (0..sides).map(move |side| (ring, side))) {
            let corner = |ring: u32, side: u32| first + ring * sides + side % sides;
            let [a, b] = [side, side + 1].map(|side| corner(ring, side));
            let [c, d] = [side, side + 1].map(|side| corner(ring + 1, side));
            mesh.triangles.extend([[a, b, c], [c, b, d]]);
        }
    }
    mesh.targets.push(muscles);
    mesh
}

/// A camera that sees all of the walk.
pub fn camera() -> Camera {
    Camera { eye: [0.2, 0.9, 2.4], target: [0.0, 0.55, 0.0], fov_y: 0.8, ..Default::default() }
}

fn transformed(m: &WorldMatrix, p: V) -> V {
    let axis = |column: usize| [m[column][0], m[column][1], m[column][2]];
    add(axis(3), add(scale(axis(0), p[0]), add(scale(axis(1), p[1]), scale(axis(2), p[2]))))
}

/// World-space positions of a mesh with morph targets and influences, sum by sum: each joint moves the whole point, and the moved points
/// are averaged by their weights.
pub fn positions_in_f64(scene: &Scene, pose: &Pose, node: usize, mesh: usize) -> Vec<V> {
    let (description, mesh) = (&scene.nodes[node], &scene.meshes[mesh]);
    let each = mesh.influences.len() / mesh.positions.len();
    let moved = |(vertex, position): (usize, &[f32; 3])| {
        let mut p = position.map(f64::from);
        for (target, weight) in mesh.targets.iter().zip(&pose.weights[node]) {
            if let Some(place) = target.vertices.iter().position(|&v| v as usize == vertex) {
                p = add(p, scale(target.positions[place].map(f64::from), f64::from(*weight)));
            }
        }
        let Some(skin) = description.skin.filter(|_| each > 0).map(|skin| &scene.skins[skin]) else {
            return transformed(&pose.world[node], p);
        };
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for influence in &mesh.influences[vertex * each..(vertex + 1) * each] {
            let (joint, weight) = (influence.joint as usize, f64::from(influence.weight));
            let bound = transformed(&skin.inverse_bind[joint].map(|column| column.map(f64::from)), p);
            sum = add(sum, scale(transformed(&pose.world[skin.joints[joint]], bound), weight));
            total += weight;
        }
        scale(sum, 1.0 / total)
    };
    mesh.positions.iter().enumerate().map(moved).collect()
}

/// The nearest of some triangles that a ray meets: its number, the distance, and the weights of its three corners.
pub fn nearest(origin: V, ray: V, triangles: &[[V; 3]]) -> Option<(usize, f64, [f64; 3])> {
    let dot = super::plane::dot;
    let meet = |(number, [a, b, c]): (usize, &[V; 3])| {
        let normal = cross(sub(*b, *a), sub(*c, *a));
        let distance = dot(normal, sub(*a, origin)) / dot(normal, ray);
        let p = add(origin, scale(ray, distance));
        let share = |from: &V, to: &V| dot(cross(sub(*to, *from), sub(p, *from)), normal) / dot(normal, normal);
        let weights = [share(b, c), share(c, a), share(a, b)];
        (distance > 0.0 && weights.iter().all(|w| *w >= 0.0)).then_some((number, distance, weights))
    };
    triangles.iter().enumerate().filter_map(meet).min_by(|a, b| a.1.total_cmp(&b.1))
}
