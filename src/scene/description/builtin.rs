//! Scenes made in code, which need no download.
//!
//! Each plays one of [`ANIMATIONS`]. Objects that this animation does not move are static geometry.

use super::{
    Animation, Channel, Environment, Interpolation, Material, Mesh, Node, Perspective, Scene, Target, Transform,
};

/// Names of the built-in scenes.
pub const NAMES: [&str; 3] = ["cornell", "pillars", "gloss"];

/// Names of the animations that each scene has.
pub const ANIMATIONS: [&str; 6] = ["static", "blink", "move-light", "move-object", "move-camera", "all"];

/// Names of the animations of `gloss`: those that each scene has, and one in which only something moves that mirrors show.
pub const GLOSS_ANIMATIONS: [&str; 7] =
    ["static", "blink", "move-light", "move-object", "move-camera", "all", "move-reflected"];

/// Names of a scene's animations.
pub fn animations(scene: &str) -> &'static [&'static str] {
    if scene == "gloss" { &GLOSS_ANIMATIONS } else { &ANIMATIONS }
}

/// Seconds in which every animation repeats.
pub const PERIOD: f32 = 4.0;

/// A built-in scene by name with one of its animations, or `None` if there is no such name.
pub fn scene(name: &str, animation: &str) -> Option<Scene> {
    if !animations(name).contains(&animation) {
        return None;
    }
    match name {
        "cornell" => Some(cornell(animation)),
        "pillars" => Some(pillars(animation)),
        "gloss" => Some(gloss(animation)),
        _ => None,
    }
}

/// The box of Cornell with two blocks, a lamp in the ceiling and a small blue one on the floor.
fn cornell(animation: &str) -> Scene {
    let mut b = Builder::default();
    let white = b.diffuse("white", [0.73, 0.73, 0.73]);
    let red = b.diffuse("red", [0.63, 0.065, 0.05]);
    let green = b.diffuse("green", [0.14, 0.45, 0.091]);
    let lamp = b.emitter("lamp", [18.0, 13.0, 7.0]);
    let blue = b.emitter("blue lamp", [0.6, 1.4, 4.0]);
    b.place("floor", quad([-1.0, 0.0, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]), white);
    b.place("ceiling", quad([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]), white);
    b.place("back", quad([-1.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]), white);
    b.place("left", quad([-1.0, 0.0, 1.0], [0.0, 0.0, -2.0], [0.0, 2.0, 0.0]), red);
    b.place("right", quad([1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0]), green);
    let lamp_node = b.place("lamp", quad([-0.25, 0.0, -0.25], [0.5, 0.0, 0.0], [0.0, 0.0, 0.5]), lamp);
    b.move_to(lamp_node, [0.0, 1.985, 0.0]);
    let tall = b.place("tall block", block([0.6, 1.2, 0.6]), white);
    b.turn(tall, [-0.36, 0.6, -0.32], 0.3);
    let short = b.place("short block", block([0.6, 0.6, 0.6]), white);
    b.turn(short, [0.36, 0.3, 0.3], -0.3);
    let small = b.place("blue lamp", block([0.12, 0.08, 0.12]), blue);
    b.turn(small, [-0.62, 0.04, 0.55], 0.5);
    let camera = b.camera(0.686, [0.0, 1.0, 3.9]);
    b.animate(animation, |kind| match kind {
        Moved::Blink => blink(lamp),
        Moved::Light => sway(lamp_node, [[-0.55, 1.985, -0.3], [0.55, 1.985, 0.3]]),
        Moved::Object => sway(tall, [[-0.45, 0.6, -0.42], [0.15, 0.6, -0.32]]),
        Moved::Camera => sway(camera, [[-0.25, 0.9, 3.75], [0.25, 1.1, 3.9]]),
        // Nothing reflects, and there is no such animation.
        Moved::Reflected => sway(camera, [[0.0; 3]; 2]),
    });
    b.scene
}

/// Many thin pillars on a large floor under one area light. When the light moves, many narrow shadows sweep.
fn pillars(animation: &str) -> Scene {
    let mut b = Builder::default();
    let floor = b.diffuse("floor", [0.7, 0.68, 0.64]);
    let wall = b.diffuse("wall", [0.55, 0.57, 0.62]);
    let stone = b.diffuse("stone", [0.62, 0.5, 0.38]);
    let lamp = b.emitter("lamp", [60.0, 52.0, 40.0]);
    b.place("floor", quad([-8.0, 0.0, 6.0], [16.0, 0.0, 0.0], [0.0, 0.0, -12.0]), floor);
    b.place("wall", quad([-8.0, 0.0, -6.0], [16.0, 0.0, 0.0], [0.0, 7.0, 0.0]), wall);
    let pillar = b.mesh("pillar", block([0.14, 2.4, 0.14]), stone);
    for row in 0..4 {
        for column in 0..12 {
            let offset = if row % 2 == 0 { 0.0 } else { 0.35 };
            let node = b.node("pillar", vec![pillar]);
            b.move_to(node, [-3.85 + 0.7 * column as f32 + offset, 1.2, -3.0 + 1.2 * row as f32]);
        }
    }
    let lamp_node = b.place("lamp", quad([-0.5, 0.0, -0.5], [1.0, 0.0, 0.0], [0.0, 0.0, 1.0]), lamp);
    b.move_to(lamp_node, [0.0, 5.0, -1.0]);
    let ball = b.place("block", block([1.2, 0.9, 1.2]), stone);
    b.turn(ball, [-1.5, 0.45, 2.8], 0.4);
    let camera = b.camera(0.75, [0.0, 2.6, 9.0]);
    b.scene.environment = Some(Environment::uniform([0.05, 0.06, 0.08]));
    b.animate(animation, |kind| match kind {
        Moved::Blink => blink(lamp),
        Moved::Light => sway(lamp_node, [[-2.5, 5.0, -2.0], [2.5, 5.0, 0.0]]),
        Moved::Object => sway(ball, [[-2.5, 0.45, 2.8], [2.5, 0.45, 2.8]]),
        Moved::Camera => sway(camera, [[-1.0, 2.6, 9.0], [1.0, 2.8, 8.6]]),
        Moved::Reflected => sway(camera, [[0.0; 3]; 2]),
    });
    b.scene
}

/// A room with a mirror, a floor of plastic, and bodies of metal and plastic; a lamp behind the camera that is seen in them alone.
fn gloss(animation: &str) -> Scene {
    let mut b = Builder::default();
    let white = b.diffuse("white", [0.7, 0.7, 0.68]);
    let red = b.diffuse("red", [0.6, 0.08, 0.06]);
    let green = b.diffuse("green", [0.12, 0.42, 0.1]);
    let floor = b.plastic("floor", [0.3, 0.28, 0.25], 0.35);
    let mirror = b.metal("mirror", [0.9, 0.9, 0.92], 0.1);
    let gold = b.metal("gold", [0.95, 0.72, 0.35], 0.4);
    let steel = b.metal("steel", [0.75, 0.76, 0.78], 0.25);
    let blue = b.plastic("blue plastic", [0.06, 0.1, 0.5], 0.28);
    let lamp = b.emitter("lamp", [17.0, 15.0, 12.0]);
    let hidden = b.emitter("hidden lamp", [6.0, 2.5, 0.8]);
    b.place("floor", quad([-1.0, 0.0, 1.0], [2.0, 0.0, 0.0], [0.0, 0.0, -2.0]), floor);
    b.place("ceiling", quad([-1.0, 2.0, -1.0], [2.0, 0.0, 0.0], [0.0, 0.0, 2.0]), white);
    b.place("back", quad([-1.0, 0.0, -1.0], [2.0, 0.0, 0.0], [0.0, 2.0, 0.0]), white);
    b.place("left", quad([-1.0, 0.0, 1.0], [0.0, 0.0, -2.0], [0.0, 2.0, 0.0]), red);
    b.place("right", quad([1.0, 0.0, -1.0], [0.0, 0.0, 2.0], [0.0, 2.0, 0.0]), green);
    b.place("mirror", quad([-0.55, 0.75, -0.98], [1.2, 0.0, 0.0], [0.0, 0.9, 0.0]), mirror);
    let lamp_node = b.place("lamp", quad([-0.3, 0.0, -0.3], [0.6, 0.0, 0.0], [0.0, 0.0, 0.6]), lamp);
    b.move_to(lamp_node, [0.0, 1.985, 0.1]);
    let hidden_node = b.place("hidden lamp", block([0.35, 0.35, 0.05]), hidden);
    b.move_to(hidden_node, [0.0, 1.2, 4.6]);
    let gold_ball = b.place("gold ball", ball(0.34), gold);
    b.move_to(gold_ball, [0.4, 0.34, 0.25]);
    let steel_ball = b.place("steel ball", ball(0.24), steel);
    b.move_to(steel_ball, [-0.55, 0.24, 0.45]);
    let box_node = b.place("box", block([0.45, 0.7, 0.45]), blue);
    b.turn(box_node, [-0.3, 0.35, -0.45], 0.4);
    let camera = b.camera(0.6, [0.0, 1.05, 3.9]);
    b.animate(animation, |kind| match kind {
        Moved::Blink => blink(lamp),
        Moved::Light => sway(lamp_node, [[-0.5, 1.985, -0.2], [0.5, 1.985, 0.4]]),
        Moved::Object => sway(gold_ball, [[0.55, 0.34, 0.1], [0.25, 0.34, 0.4]]),
        Moved::Camera => sway(camera, [[-0.5, 1.0, 3.8], [0.5, 1.1, 3.9]]),
        Moved::Reflected => sway(hidden_node, [[-0.9, 1.1, 4.6], [0.9, 1.3, 4.6]]),
    });
    b.scene
}

#[derive(Clone, Copy)]
enum Moved {
    Reflected,
    Blink,
    Light,
    Object,
    Camera,
}

/// Switches on and off, for a quarter of the period each.
fn blink(material: usize) -> Channel {
    let quarter = PERIOD / 4.0;
    Channel {
        target: Target::Emission(material),
        interpolation: Interpolation::Step,
        times: vec![0.0, quarter, 2.0 * quarter, 3.0 * quarter, PERIOD],
        values: [1.0, 0.0, 1.0, 0.0, 1.0].map(|x| [x, 0.0, 0.0, 0.0]).to_vec(),
    }
}

/// Moves from one place to another and back at constant speed, starting half way.
fn sway(node: usize, [a, b]: [[f32; 3]; 2]) -> Channel {
    let middle = [0, 1, 2].map(|i| 0.5 * (a[i] + b[i]));
    let quarter = PERIOD / 4.0;
    Channel {
        target: Target::Translation(node),
        interpolation: Interpolation::Linear,
        times: vec![0.0, quarter, 3.0 * quarter, PERIOD],
        values: [middle, b, a, middle].map(|p| [p[0], p[1], p[2], 0.0]).to_vec(),
    }
}

#[derive(Default)]
struct Builder {
    scene: Scene,
}

impl Builder {
    fn diffuse(&mut self, name: &str, color: [f32; 3]) -> usize {
        let base_color = [color[0], color[1], color[2], 1.0];
        self.scene.materials.push(Material { name: name.into(), base_color, ..Default::default() });
        self.scene.materials.len() - 1
    }

    fn metal(&mut self, name: &str, color: [f32; 3], roughness: f32) -> usize {
        let material = self.diffuse(name, color);
        let shiny =
            Material { metallic: 1.0, roughness, specular: [0.04; 3], ..self.scene.materials[material].clone() };
        self.scene.materials[material] = shiny;
        material
    }

    fn plastic(&mut self, name: &str, color: [f32; 3], roughness: f32) -> usize {
        let material = self.diffuse(name, color);
        let shiny = Material { roughness, specular: [0.04; 3], ..self.scene.materials[material].clone() };
        self.scene.materials[material] = shiny;
        material
    }

    fn emitter(&mut self, name: &str, emissive: [f32; 3]) -> usize {
        let material = self.diffuse(name, [0.5; 3]);
        self.scene.materials[material].emissive = emissive;
        material
    }

    fn mesh(&mut self, name: &str, mesh: Mesh, material: usize) -> usize {
        self.scene.meshes.push(Mesh { name: name.into(), material, ..mesh });
        self.scene.meshes.len() - 1
    }

    fn node(&mut self, name: &str, meshes: Vec<usize>) -> usize {
        self.scene.nodes.push(Node { name: name.into(), meshes, ..Default::default() });
        self.scene.nodes.len() - 1
    }

    fn place(&mut self, name: &str, mesh: Mesh, material: usize) -> usize {
        let mesh = self.mesh(name, mesh, material);
        self.node(name, vec![mesh])
    }

    fn camera(&mut self, fov_y: f32, position: [f32; 3]) -> usize {
        self.scene.cameras.push(Perspective { fov_y });
        let node = self.node("camera", Vec::new());
        self.scene.nodes[node].camera = Some(0);
        self.move_to(node, position);
        node
    }

    fn move_to(&mut self, node: usize, translation: [f32; 3]) {
        self.turn(node, translation, 0.0);
    }

    /// Places a node, turned by an angle about +Y.
    fn turn(&mut self, node: usize, translation: [f32; 3], angle: f32) {
        let rotation = [0.0, (angle / 2.0).sin(), 0.0, (angle / 2.0).cos()];
        self.scene.nodes[node].transform = Transform::Trs { translation, rotation, scale: [1.0; 3] };
    }

    fn animate(&mut self, name: &str, channel: impl Fn(Moved) -> Channel) {
        let moved: &[Moved] = match name {
            "blink" => &[Moved::Blink],
            "move-light" => &[Moved::Light],
            "move-object" => &[Moved::Object],
            "move-camera" => &[Moved::Camera],
            "move-reflected" => &[Moved::Reflected],
            "all" => &[Moved::Blink, Moved::Light, Moved::Object, Moved::Camera],
            _ => &[],
        };
        let channels = moved.iter().map(|&m| channel(m)).collect();
        self.scene.animations.push(Animation { name: name.into(), channels });
    }
}

/// A parallelogram whose front looks along `u × v`.
fn quad(corner: [f32; 3], u: [f32; 3], v: [f32; 3]) -> Mesh {
    let at = |s: f32, t: f32| [0, 1, 2].map(|i| corner[i] + s * u[i] + t * v[i]);
    Mesh {
        positions: vec![at(0.0, 0.0), at(1.0, 0.0), at(1.0, 1.0), at(0.0, 1.0)],
        triangles: vec![[0, 1, 2], [0, 2, 3]],
        ..Default::default()
    }
}

/// Parts of a ball's circumference, and of a meridian.
const AROUND: u32 = 48;
const ALONG: u32 = 24;

/// A ball about the origin, with the normals of a sphere.
fn ball(radius: f32) -> Mesh {
    let mut mesh = Mesh::default();
    for (i, j) in (0..=ALONG).flat_map(|i| (0..AROUND).map(move |j| (i, j))) {
        let (polar, turn) =
            (std::f32::consts::PI * i as f32 / ALONG as f32, std::f32::consts::TAU * j as f32 / AROUND as f32);
        let normal = [polar.sin() * turn.cos(), polar.cos(), -polar.sin() * turn.sin()];
        mesh.positions.push(normal.map(|x| radius * x));
        mesh.normals.push(normal);
        if i < ALONG {
            let next = (j + 1) % AROUND;
            let [a, b] = [i * AROUND, (i + 1) * AROUND].map(|row| [row + j, row + next]);
            // At the poles one of the two has no area.
            mesh.triangles.extend((i < ALONG - 1).then_some([a[0], b[0], b[1]]));
            mesh.triangles.extend((i > 0).then_some([a[0], b[1], a[1]]));
        }
    }
    mesh
}

/// A cuboid about the origin.
fn block([x, y, z]: [f32; 3]) -> Mesh {
    let (x, y, z) = (x / 2.0, y / 2.0, z / 2.0);
    let sides = [
        quad([-x, -y, z], [2.0 * x, 0.0, 0.0], [0.0, 2.0 * y, 0.0]),
        quad([x, -y, -z], [-2.0 * x, 0.0, 0.0], [0.0, 2.0 * y, 0.0]),
        quad([x, -y, z], [0.0, 0.0, -2.0 * z], [0.0, 2.0 * y, 0.0]),
        quad([-x, -y, -z], [0.0, 0.0, 2.0 * z], [0.0, 2.0 * y, 0.0]),
        quad([-x, y, z], [2.0 * x, 0.0, 0.0], [0.0, 0.0, -2.0 * z]),
        quad([-x, -y, -z], [2.0 * x, 0.0, 0.0], [0.0, 0.0, 2.0 * z]),
    ];
    let mut mesh = Mesh::default();
    for side in sides {
        let first = mesh.positions.len() as u32;
        mesh.positions.extend(side.positions);
        mesh.triangles.extend(side.triangles.iter().map(|t| t.map(|i| i + first)));
    }
    mesh
}
