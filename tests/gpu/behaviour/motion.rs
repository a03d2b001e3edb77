//! Motion and depth of a turning quad under a moving, jittered camera, against cameras and planes in f64.

use crate::common::plane::{Pinhole, V, add, cross, dot, scale, sub};
use crate::common::scenes::{lambert, quad, scene};
use crate::common::stage::Stage;
use asvgf::scene::{Node, Scene, Transform, WorldMatrix};
use asvgf::{Camera, Settings, View};

const SIZE: [u32; 2] = [48, 32];

/// A movable card in front of a fixed wall.
fn card_and_wall() -> Scene {
    let card = quad([-0.5, -0.5, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], 0);
    let wall = quad([-4.0, -4.0, -2.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0], 0);
    let mut scene = scene(vec![lambert([0.5; 3])], vec![card, wall]);
    scene.nodes[0].movable = true;
    scene
}

/// The card's placement in a frame: it drifts, comes nearer, turns and grows.
fn placement(frame: u32) -> Transform {
    let t = frame as f32;
    let angle = 0.1 * t;
    Transform::Trs {
        translation: [0.07 * t, -0.03 * t, 0.05 * t],
        rotation: [0.0, (angle / 2.0).sin(), 0.0, (angle / 2.0).cos()],
        scale: [1.0 + 0.1 * t, 1.0, 1.0],
    }
}

fn camera(frame: u32) -> Camera {
    let t = frame as f32;
    let d = f64::from(frame);
    Camera {
        eye: [0.1 * d, 0.05 * d, 4.0 - 0.1 * d],
        target: [0.0, 0.02 * d, 0.0],
        up: [0.02 * t, 1.0, 0.0],
        fov_y: 0.7 + 0.01 * t,
        jitter: [0.3 - 0.2 * t, 0.1 * t],
    }
}

/// A parallelogram in world space.
struct Card {
    corner: V,
    u: V,
    v: V,
}

impl Card {
    fn of(matrix: WorldMatrix, [corner, u, v]: [V; 3]) -> Self {
        let m = matrix.map(|column| [column[0], column[1], column[2]]);
        let vector = |p: V| add(add(scale(m[0], p[0]), scale(m[1], p[1])), scale(m[2], p[2]));
        Self { corner: add(vector(corner), m[3]), u: vector(u), v: vector(v) }
    }

    /// Depth at which a ray meets the plane, and the coordinates of that point along u and v.
    fn meet(&self, eye: V, ray: V) -> [f64; 3] {
        let n = cross(self.u, self.v);
        let depth = dot(n, sub(self.corner, eye)) / dot(n, ray);
        let p = sub(add(eye, scale(ray, depth)), self.corner);
        [depth, dot(cross(p, self.v), n) / dot(n, n), dot(cross(self.u, p), n) / dot(n, n)]
    }

    fn at(&self, s: f64, t: f64) -> V {
        add(self.corner, add(scale(self.u, s), scale(self.v, t)))
    }
}

const CARD: [V; 3] = [[-0.5, -0.5, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
const WALL: [V; 3] = [[-4.0, -4.0, -2.0], [8.0, 0.0, 0.0], [0.0, 8.0, 0.0]];

#[test]
fn motion_is_where_the_same_point_of_the_surface_was() {
    let mut stage = Stage::new(card_and_wall(), SIZE, Settings::adaptive());
    let mut worst = 0.0_f64;
    for frame in 0..4 {
        let cards = [frame.max(1) - 1, frame].map(|f| {
            let mut moved = stage.scene.clone();
            moved.nodes[0] = Node { transform: placement(f), ..moved.nodes[0].clone() };
            let pose = moved.pose(None, 0.0);
            (pose.world.iter().zip([CARD, WALL]).map(|(&m, at)| Card::of(m, at)).collect::<Vec<_>>(), pose)
        });
        stage.camera = Some(camera(frame));
        stage.frame_in(&cards[1].1);
        if frame == 0 {
            continue;
        }
        let [before, now] = [frame - 1, frame].map(|f| Pinhole::new(&camera(f), SIZE));
        let jitter = camera(frame).jitter.map(f64::from);
        let (motion, depth) = (stage.view(View::Motion), stage.view(View::Depth));
        let mut seen = [0; 2];
        for (i, (m, d)) in motion.iter().zip(&depth).enumerate() {
            let x = (i as u32 % SIZE[0]) as f64 + 0.5 + jitter[0];
            let y = (i as u32 / SIZE[0]) as f64 + 0.5 + jitter[1];
            let ray = now.ray(x, y);
            let hits: Vec<[f64; 3]> = cards[1].0.iter().map(|c| c.meet(now.eye, ray)).collect();
            // The point is on the card, or so near to its edge that rounding decides.
            let inside = hits[0][1..].iter().all(|w| (1e-4..=1.0 - 1e-4).contains(w));
            let outside = hits[0][1..].iter().any(|w| !(-1e-4..=1.0 + 1e-4).contains(w));
            assert!(inside || outside, "no pixel of this test meets the edge");
            let which = usize::from(outside);
            let [z, s, t] = hits[which];
            let was = before.project(cards[0].0[which].at(s, t));
            let expected = [was[0] - x, was[1] - y, was[2]];
            // Motion is stored in steps of 1/256 pixel and depth in steps of 2⁻¹⁴ of itself; rounding changes both by half a step.
            // On top of that, f32 keeps 24 bits of image coordinates below 64 and of depths below 8, over some ten operations.
            let rounding = [1.0 / 512.0, 1.0 / 512.0, expected[2] * 2.0_f64.powi(-15)];
            for ((actual, expected), rounding) in m.iter().map(|&a| f64::from(a)).zip(expected).zip(rounding) {
                let error = (actual - expected).abs();
                worst = worst.max(error);
                assert!(error < rounding + 1e-4, "frame {frame}, ({x}, {y}): {m:?}, not {expected:?}");
            }
            assert!((f64::from(d[0]) - z).abs() < 1e-5 * z, "depth {d:?}, not {z}");
            seen[which] += 1;
        }
        assert!(seen.iter().all(|&n| n > 50), "{seen:?}");
    }
    println!("largest error of a motion: {worst:.1e} pixels");
}
