//! Small scenes made by hand.

use asvgf::Camera;
use asvgf::scene::{Image, Interior, Light, LightKind, Material, Mesh, Node, Scene, Transform};

/// A parallelogram whose front looks along u × v.
pub fn quad(corner: [f32; 3], u: [f32; 3], v: [f32; 3], material: usize) -> Mesh {
    let at = |s: f32, t: f32| [0, 1, 2].map(|i| corner[i] + s * u[i] + t * v[i]);
    Mesh {
        positions: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
        uvs: [vec![[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]], Vec::new()],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        material,
        ..Default::default()
    }
}

/// A closed box whose faces look outwards.
pub fn block(low: [f32; 3], high: [f32; 3], material: usize) -> Vec<Mesh> {
    let [x, y, z] = [0, 1, 2].map(|i| high[i] - low[i]);
    let [a, b, c] = low;
    let [p, q, r] = high;
    vec![
        quad([a, b, r], [x, 0.0, 0.0], [0.0, y, 0.0], material),
        quad([p, b, c], [-x, 0.0, 0.0], [0.0, y, 0.0], material),
        quad([a, b, c], [0.0, 0.0, z], [0.0, y, 0.0], material),
        quad([p, b, r], [0.0, 0.0, -z], [0.0, y, 0.0], material),
        quad([a, q, r], [x, 0.0, 0.0], [0.0, 0.0, -z], material),
        quad([a, b, c], [x, 0.0, 0.0], [0.0, 0.0, z], material),
    ]
}

/// A floor at y = 0 that faces +Y, with u along +X and v along −Z: its tangent is +X, and upwards in its images is +Z.
pub fn floor(material: usize) -> Mesh {
    quad([-9.0, 0.0, 9.0], [18.0, 0.0, 0.0], [0.0, 0.0, -18.0], material)
}

/// The floor with an image of one opaque texel, which the material may use, without light.
pub fn textured_floor([r, g, b]: [u8; 3], material: Material) -> Scene {
    let image = Image { width: 1, height: 1, texels: vec![[r, g, b, 255]], ..Default::default() };
    Scene { images: vec![image], ..scene(vec![material], vec![floor(0)]) }
}

/// A Lambertian surface.
pub fn lambert(color: [f32; 3]) -> Material {
    Material { base_color: [color[0], color[1], color[2], 1.0], ..Default::default() }
}

/// Clear glass that mirrors as much as its index says: a pane, or the skin of a body that absorbs.
pub fn glass(index: f32, roughness: f32, absorption: Option<[f32; 3]>) -> Material {
    let root = (index - 1.0) / (index + 1.0);
    Material {
        roughness,
        specular: [root * root; 3],
        transmission: 1.0,
        interior: Interior { index, absorption },
        ..lambert([1.0; 3])
    }
}

/// A surface that emits light and reflects nothing.
pub fn emitter(radiance: [f32; 3]) -> Material {
    Material { emissive: radiance, ..lambert([0.0; 3]) }
}

/// A scene with each mesh at the place that it was made for.
pub fn scene(materials: Vec<Material>, meshes: Vec<Mesh>) -> Scene {
    let nodes = (0..meshes.len()).map(|mesh| Node { meshes: vec![mesh], ..Default::default() }).collect();
    Scene { materials, meshes, nodes, ..Default::default() }
}

/// Adds a light without area that shines down from a place.
pub fn shine(scene: &mut Scene, kind: LightKind, intensity: [f32; 3], range: f32, from: [f32; 3]) {
    scene.lights.push(Light { kind, intensity, range });
    // A quarter turn about x turns −Z to −Y.
    let half = std::f32::consts::FRAC_1_SQRT_2;
    let transform = Transform::Trs { translation: from, rotation: [-half, 0.0, 0.0, half], scale: [1.0; 3] };
    scene.nodes.push(Node { light: Some(scene.lights.len() - 1), transform, ..Default::default() });
}

/// A floor of 2 × 2 that faces +Y and a wall of 2 × 1 on it that faces +Z; the middle of their common edge is at a place.
pub fn corner([x, y, z]: [f32; 3]) -> Vec<Mesh> {
    let floor = quad([x - 1.0, y, z + 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0], 0);
    let wall = quad([x - 1.0, y, z], [2.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0);
    vec![floor, wall]
}

/// A camera that looks at a corner.
pub fn before_corner([x, y, z]: [f64; 3]) -> Camera {
    Camera { eye: [x, y + 0.75, z + 2.0], target: [x, y + 0.25, z], fov_y: 0.7, ..Default::default() }
}
