//! Shapes, sizes and places of surfaces, in a furnace.

use super::furnace::{Furnace, ROUNDING, grey};
use super::{Breaks, Case, Named, Worst};
use crate::stability::common::scenes::{before_corner, corner, emitter, quad};
use crate::stability::common::stage::Stage;
use crate::stability::common::statistics::mean;
use asvgf::scene::{Mesh, Node, Scene, Transform};
use asvgf::{Camera, Settings, TracerSettings};
use std::f32::consts::PI;

const SIZE: [u32; 2] = [32, 24];

/// Quantity that every case of this group measures.
const QUANTITY: &str = "largest difference of a pixel from ½ (surface) or 1 (sky); infinite if no surface is seen";
const ORIGIN: &str =
    "a convex surface of albedo ½ under a white sky reflects ½, and no ray may meet the surface that it left";

pub const CASES: &[Case] = &[
    Case {
        name: "scales",
        varied: "a ball of 720 triangles and a plane of two, sizes 10⁻⁵ … 10⁷",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: scales,
        breaks: Breaks::Found(scales_break),
    },
    Case {
        name: "far from the origin",
        varied: "a plane of 10 × 10 and the camera with it, 0 … 10⁶ away",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: far_away,
        breaks: Breaks::Found(far_away_break),
    },
    Case {
        name: "a corner far from the origin",
        varied: "a floor and a wall 8 km, 33 km and 524 km away, by their vertices, by nodes, and by nodes that a host may move",
        quantity: "relative difference of the image's mean from that at the origin",
        bound: 1e-3,
        origin: "coordinates count from the scene's centre, so the numbers are the same; the errors were 1 %, 4.6 % and 12.6 % before",
        measure: far_corner,
        breaks: Breaks::Known(
            "a surface far from the middle of its own scene has the errors of “a corner in a large scene”",
        ),
    },
    Case {
        name: "a corner in a large scene",
        varied: "a floor and a wall 2, 4 and 16 km from the scene's centre, under a sky and under a lamp 6 cm above the floor",
        quantity: "relative difference of the image's mean from that at the centre",
        bound: 5e-3,
        origin: "contact shadows narrower than the offset of rays are lost: some 10⁻⁶ of the distance",
        measure: corner_in_large_scene,
        breaks: Breaks::Found(large_scene_break),
    },
    Case {
        name: "bodies in a large scene",
        varied: "balls, and plates of several tilts, 10 … 10⁴ times their size from the scene's centre; static, and as instances that are turned",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: bodies_in_large_scene,
        breaks: Breaks::Known("a body as small as a few steps of f32 at its place loses its shape"),
    },
    Case {
        name: "within a solid in a large scene",
        varied: "a closed box of 12 triangles and a ball of 720 round the eye, 10 … 10⁴ times their size from the scene's centre",
        quantity: "light that leaks in, over the sky's",
        bound: 0.0,
        origin: "no ray leaves a closed surface, not even through an edge or a vertex",
        measure: enclosed_in_large_scene,
        breaks: Breaks::Known("a body as small as a few steps of f32 at its place loses its shape"),
    },
    Case {
        name: "range of depths",
        varied: "planes at 10⁻⁴, 10⁻², 1, 10², 10⁴, 10⁶, 10⁸, all in one image",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: depths,
        breaks: Breaks::Known("a host's depth outside 10⁻¹⁸ … 10¹⁸ is a miss"),
    },
    Case {
        name: "grazing angles",
        varied: "a plane seen at 10°, 1°, 0.1°, 0.01°, 0.001°",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: grazing,
        breaks: Breaks::Never("the distance from a tangent plane has no depth gradient"),
    },
    Case {
        name: "huge triangles from nearby",
        varied: "a plane of two triangles, 10 … 1000 times as large as its distance",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: huge,
        breaks: Breaks::Found(huge_break),
    },
    Case {
        name: "degenerate triangles",
        varied: "a ball with zero-area triangles, needles of 1 : 10⁶, each triangle twice, or a copy within 10⁻⁷",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: degenerate,
        breaks: Breaks::Known("needles whose area is a denormal number (below 10⁻¹⁹ a side) are not seen"),
    },
    Case {
        name: "few and many triangles",
        varied: "0, 1, 2, 3, 4, 1000 triangles; 1000 at one point",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: counts,
        breaks: Breaks::Known(
            "none: 10⁶ triangles at one point make a tree too, see the tests of `src/scene/gpu/tree/build.rs`",
        ),
    },
    Case {
        name: "eyes and rays in awkward places",
        varied: "the eye on a vertex, on an edge, in the plane of a surface; rays parallel to an axis",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: awkward,
        breaks: Breaks::Never("a triangle seen edge-on has no area in the image"),
    },
    Case {
        name: "the eye within a solid",
        varied: "a closed box of 12 triangles and a ball of 720 round the eye, sizes 10⁻⁵ … 10⁷; its middle, near a wall, in a corner",
        quantity: "pixels that see the sky, and light that leaks in, over the sky's",
        bound: 0.0,
        origin: "no ray leaves a closed surface, not even through an edge or a vertex",
        measure: enclosed,
        breaks: Breaks::Never("triangles reach over their edges, and paths start within them"),
    },
    Case {
        name: "smaller than a pixel, with jitter",
        varied: "400 cards of 1, 0.3 and 0.1 pixels before the sky; each frame with another jitter",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: "all lit surfaces are lit alike, so the choice of taps must not matter",
        measure: sub_pixel,
        breaks: Breaks::Never("weights are normalised"),
    },
    Case {
        name: "fields of view",
        varied: "10⁻⁶, 10⁻³, 1, 3, π − 10⁻³ radians",
        quantity: QUANTITY,
        bound: ROUNDING,
        origin: ORIGIN,
        measure: fields_of_view,
        breaks: Breaks::Known(
            "at π − 10⁻⁵, rays meet surfaces 10⁶ times as far away as the eye is from their plane, and rounding destroys the depth; 0 and π are refused by name",
        ),
    },
];

/// Builds a ball of 12 × 30 quads around a place.
pub(super) fn ball(radius: f32, centre: [f32; 3]) -> Mesh {
    let (rings, sectors) = (12_u32, 30_u32);
    let point = |ring: u32, sector: u32| {
        let (polar, azimuth) = (PI * ring as f32 / rings as f32, 2.0 * PI * (sector % sectors) as f32 / sectors as f32);
        let unit = [polar.sin() * azimuth.cos(), polar.cos(), polar.sin() * azimuth.sin()];
        [0, 1, 2].map(|i| centre[i] + radius * unit[i])
    };
    let positions: Vec<[f32; 3]> = (0..=rings).flat_map(|r| (0..sectors).map(move |s| point(r, s))).collect();
    let at = |ring: u32, sector: u32| ring * sectors + sector % sectors;
    let triangles = (0..rings)
        .flat_map(|r| (0..sectors).map(move |s| (r, s)))
        .flat_map(|(r, s)| [[at(r, s), at(r, s + 1), at(r + 1, s)], [at(r + 1, s), at(r, s + 1), at(r + 1, s + 1)]])
        .collect();
    Mesh { positions, triangles, ..Default::default() }
}

/// Builds a plane that faces +Z, around a place.
fn plane(half: f32, [x, y, z]: [f32; 3]) -> Mesh {
    quad([x - half, y - half, z], [2.0 * half, 0.0, 0.0], [0.0, 2.0 * half, 0.0], 0)
}

/// Returns a camera at a place that looks towards −Z.
fn looking(eye: [f64; 3]) -> Camera {
    Camera { eye, target: [eye[0], eye[1], eye[2] - eye[2].abs().max(1.0)], ..Default::default() }
}

fn at_scale(furnace: &mut Furnace, scale: f32) -> f64 {
    let eye = [0.3, 0.2, 3.0].map(|x| x * f64::from(scale));
    let camera = |_| Camera { eye, target: [0.0; 3], ..Default::default() };
    let scenes = [grey(vec![ball(scale, [0.0; 3])]), grey(vec![plane(scale, [0.0; 3])])];
    scenes.into_iter().map(|scene| furnace.farthest_seen(scene, 3, camera)).fold(0.0, f64::max)
}

fn scales() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    for power in [-5, -3, -1, 0, 2, 4, 7] {
        let scale = 10.0_f32.powi(power);
        worst.add(at_scale(&mut furnace, scale), || format!("10^{power}"));
    }
    worst
}

fn scales_break() -> String {
    let mut furnace = Furnace::new(SIZE);
    let mut find =
        |step: i32| (1..=30).map(|n| n * step).find(|&power| at_scale(&mut furnace, 10.0_f32.powi(power)) > ROUNDING);
    let tell = |power: Option<i32>| power.map_or("none".into(), |p| format!("10^{p}"));
    let [small, large] = [-1, 1].map(|step| tell(find(step)));
    format!("{small}, {large}")
}

fn away(furnace: &mut Furnace, distance: f32) -> f64 {
    let place = [distance, 0.0, 0.0];
    let eye = [distance.into(), 0.0, 12.0];
    furnace.farthest_seen(grey(vec![plane(5.0, place)]), 3, |_| looking(eye))
}

fn far_away() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    for distance in [0.0, 1e2, 1e3, 1e4, 1e5, 1e6] {
        worst.add(away(&mut furnace, distance), || format!("{distance:e} away"));
    }
    worst
}

fn far_away_break() -> String {
    let mut furnace = Furnace::new(SIZE);
    (6..=12)
        .map(|power| 10.0_f32.powi(power))
        .find(|&d| away(&mut furnace, d) > ROUNDING)
        .map_or("none up to 10¹²".into(), |d| format!("{d:e} away"))
}

/// Returns the mean of a corner's image with noise that is always the same.
fn corner_mean(scene: Scene, place: [f64; 3]) -> f64 {
    let tracer = TracerSettings { samples: 64, ..Default::default() };
    let mut stage = Stage::new(scene, [64, 48], Settings { tracer, ..Settings::adaptive() });
    stage.camera = Some(before_corner(place));
    mean(&stage.frame().image())
}

/// Builds a corner elsewhere, moved by its vertices or by its nodes.
fn corner_at(place: [f64; 3], by_nodes: bool) -> Scene {
    let translation = place.map(|x| x as f32);
    if !by_nodes {
        return grey(corner(translation));
    }
    let mut scene = grey(corner([0.0; 3]));
    scene.nodes.iter_mut().for_each(|node| node.transform = moved(translation));
    scene
}

fn moved(translation: [f32; 3]) -> Transform {
    Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] }
}

fn far_corner() -> Worst {
    let mut worst = Worst::default();
    let near = corner_mean(corner_at([0.0; 3], false), [0.0; 3]);
    for distance in [8192.0, 32_768.0, 524_288.0] {
        let place = [distance, 0.0, -distance];
        for (name, by_nodes, movable) in [("vertices", false, false), ("nodes", true, false), ("movable", true, true)] {
            let mut scene = corner_at(place, by_nodes);
            scene.nodes.iter_mut().for_each(|node| node.movable = movable);
            worst.add((corner_mean(scene, place) / near - 1.0).abs(), || format!("{distance} m, {name}"));
        }
    }
    worst
}

/// Builds copies of a small triangle on the other side of the origin, so that the scene is as large there as around a
/// place.
fn opposite([x, y, z]: [f32; 3], copies: usize) -> Mesh {
    let positions = vec![[-x, -y, -z], [-x + 1e-2, -y, -z], [-x, -y + 1e-2, -z]];
    Mesh { positions, triangles: vec![[0, 1, 2]; copies], ..Default::default() }
}

/// So few triangles that a software adapter tests each, and so many that it builds a tree of them.
const FEW_AND_MANY: [usize; 2] = [1, 70];

/// Light source of a corner.
#[derive(Clone, Copy, Debug)]
enum Lit {
    BySky,
    /// A low, tilted lamp.
    ByLamp,
}

fn corner_off_centre(lit: Lit, distance: f32) -> f64 {
    let lit_corner = |place: [f32; 3]| {
        let mut scene = grey(corner(place));
        if let Lit::ByLamp = lit {
            scene.environment = None;
            scene.materials.push(emitter([4.0; 3]));
            let at = [place[0] - 0.25, place[1] + 0.0625, place[2] + 0.25];
            scene.meshes.push(quad(at, [0.5, 0.125, 0.0], [0.0, 0.0625, 0.5], 1));
            scene.nodes.push(Node { meshes: vec![2], ..Default::default() });
        }
        scene
    };
    // No direction has only round coordinates.
    let place = [distance, 0.125 * distance, -0.5 * distance];
    let mut scene = lit_corner(place);
    scene.meshes.push(opposite(place, 70));
    scene.nodes.push(Node { meshes: vec![scene.meshes.len() - 1], ..Default::default() });
    (corner_mean(scene, place.map(f64::from)) / corner_mean(lit_corner([0.0; 3]), [0.0; 3]) - 1.0).abs()
}

fn corner_in_large_scene() -> Worst {
    let mut worst = Worst::default();
    for (lit, distance) in [2048.0, 4096.0, 16_384.0].into_iter().flat_map(|d| [(Lit::BySky, d), (Lit::ByLamp, d)]) {
        worst.add(corner_off_centre(lit, distance), || format!("{lit:?}, {distance} m"));
    }
    worst
}

fn large_scene_break() -> String {
    let found = (12..=24).map(|power| 2.0_f32.powi(power)).find(|&d| corner_off_centre(Lit::BySky, d) > 5e-3);
    found.map_or("none up to 16 000 km".into(), |d| format!("{:.0} km from the centre", d / 1000.0))
}

/// Returns a place whose coordinates are not round.
fn off_centre(distance: f32) -> [f32; 3] {
    [0.83, 0.31, -0.47].map(|x| x * distance)
}

/// Builds a tilted plate around a place.
fn plate(tilt: f32, centre: [f32; 3]) -> Mesh {
    let (s, c) = tilt.sin_cos();
    let (u, v) = ([2.0 * c, 0.3, -2.0 * s], [0.2 * s, 2.0, 0.2 * c]);
    quad([0, 1, 2].map(|i| centre[i] - 0.5 * (u[i] + v[i])), u, v, 0)
}

fn bodies_in_large_scene() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new(SIZE);
    for distance in [10.0, 1e2, 1e3, 1e4] {
        let place = off_centre(distance);
        let bodies = [0.0, 0.2, 0.7, -0.5].map(|tilt| (format!("a plate at {tilt}"), plate(tilt, [0.0; 3])));
        for (name, body) in bodies.into_iter().chain([("a ball".to_owned(), ball(1.0, [0.0; 3]))]) {
            for (turned, count) in FEW_AND_MANY.into_iter().flat_map(|n| [(false, n), (true, n)]) {
                // A movable node turns the body, or the vertices move it.
                let mut own = body.clone();
                if !turned {
                    own.positions.iter_mut().for_each(|p| *p = [0, 1, 2].map(|i| p[i] + place[i]));
                }
                let mut scene = grey(vec![own, opposite(place, count)]);
                if turned {
                    let rotation = [0.1_f32, 0.2, 0.1, 0.969_536];
                    scene.nodes[0].transform = Transform::Trs { translation: place, rotation, scale: [1.0, 0.9, 1.1] };
                    scene.nodes[0].movable = true;
                }
                let at = place.map(f64::from);
                let eye = [at[0] + 0.4, at[1] + 0.3, at[2] + 3.0];
                let camera = |_| Camera { eye, target: at, ..Default::default() };
                let value = furnace.farthest_seen(scene, 3, camera);
                worst.add(value, || format!("{name}, {distance} away, turned: {turned}, beside {count} triangles"));
            }
        }
    }
    worst
}

fn enclosed_in_large_scene() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new([33, 25]);
    for distance in [10.0, 1e2, 1e3, 1e4] {
        let place = off_centre(distance);
        for (name, mut body) in [("box", closed_box(1.0)), ("ball", ball(1.0, [0.0; 3]))] {
            body.positions.iter_mut().for_each(|p| *p = [0, 1, 2].map(|i| p[i] + place[i]));
            let starts = [[0.0, 0.0, 0.0], [0.9, 0.1, 0.2], [0.5, 0.5, 0.5]];
            for (start, count) in starts.into_iter().flat_map(|s| FEW_AND_MANY.map(|n| (s, n))) {
                let eye = std::array::from_fn(|i| start[i] + f64::from(place[i]));
                let camera = |frame| {
                    let towards = [[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.1], [0.3, -0.7, 0.2]];
                    let way: [f64; 3] = towards[frame as usize % 4];
                    let target = std::array::from_fn(|i| way[i] + f64::from(place[i]));
                    Camera { eye, target, fov_y: 2.0, ..Default::default() }
                };
                let value = furnace.brightest(grey(vec![body.clone(), opposite(place, count)]), 8, camera);
                worst.add(value, || format!("a {name}, {distance} away, {start:?}, beside {count} triangles"));
            }
        }
    }
    worst
}

fn depths() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    // Each plane is a little to the side, so that the camera sees all of them.
    let planes = [1e-4, 1e-2, 1.0, 1e2, 1e4, 1e6, 1e8_f32].into_iter().enumerate().map(|(i, z)| {
        let x = z * (0.16 * i as f32 - 0.5);
        plane(0.07 * z, [x, 0.0, -z])
    });
    worst.add(furnace.farthest_seen(grey(planes.collect()), 4, |_| looking([0.0; 3])), || "all".into());
    worst
}

fn grazing() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    for degrees in [10.0, 1.0, 0.1, 0.01, 0.001_f32] {
        let height = 10.0 * degrees.to_radians().tan();
        let floor = quad([-50.0, 0.0, 50.0], [100.0, 0.0, 0.0], [0.0, 0.0, -100.0], 0);
        // The middle of the image meets the floor at that angle.
        let camera = |_| Camera {
            eye: [0.0, height.into(), 10.0],
            target: [0.0; 3],
            fov_y: (2.0 * degrees).to_radians(),
            ..Default::default()
        };
        worst.add(furnace.farthest_seen(grey(vec![floor]), 3, camera), || format!("{degrees}°"));
    }
    worst
}

/// Measures a plane of this size, seen from 3 away.
fn large(furnace: &mut Furnace, half: f32) -> f64 {
    let camera = |_| Camera { eye: [0.3, 0.2, 3.0], target: [0.0; 3], ..Default::default() };
    furnace.farthest_seen(grey(vec![plane(half, [0.0; 3])]), 3, camera)
}

fn huge() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new(SIZE);
    for half in [30.0, 300.0, 3000.0] {
        worst.add(large(&mut furnace, half), || format!("{half}"));
    }
    worst
}

fn huge_break() -> String {
    let mut furnace = Furnace::new(SIZE);
    let first = (4..=12).map(|power| 3.0 * 10.0_f32.powi(power)).find(|&half| large(&mut furnace, half) > ROUNDING);
    first.map_or("none up to 10¹²".into(), |half| {
        format!("{:.0e} times: the square of a triangle's area is infinite there", half / 3.0)
    })
}

fn degenerate() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    let kinds: [Named<fn(&mut Mesh)>; 4] = [
        ("zero area", |m| {
            m.triangles.extend((0..300).flat_map(|i| [[i, i, i], [i, i + 1, i + 1], [i, i, i + 30]]));
        }),
        ("needles", |m| {
            let first = m.positions.len() as u32;
            for i in 0..100 {
                let x = -1.0 + 0.02 * i as f32;
                m.positions.extend([[x, -2.0, -1.5], [x + 4e-6, -2.0, -1.5], [x, 2.0, -1.5]]);
                m.triangles.push([0, 1, 2].map(|corner| first + 3 * i + corner));
            }
        }),
        ("each twice", |m| m.triangles.extend_from_within(..)),
        ("a copy within 1e-7", |m| {
            let first = m.positions.len() as u32;
            m.positions.extend(m.positions.clone().into_iter().map(|p| p.map(|x| x * (1.0 - 1e-7))));
            m.triangles.extend(m.triangles.clone().into_iter().map(|t| t.map(|corner| first + corner)));
        }),
    ];
    for (name, spoil) in kinds {
        let mut mesh = ball(1.0, [0.0; 3]);
        spoil(&mut mesh);
        let camera = |_| Camera { eye: [0.4, 0.3, 3.0], target: [0.0; 3], ..Default::default() };
        worst.add(furnace.farthest_seen(grey(vec![mesh]), 3, camera), || name.into());
    }
    worst
}

/// Builds triangles of a plane, side by side, or all in one place.
fn triangles(count: u32, one_place: bool) -> Scene {
    let width = if one_place { 0.1 } else { 2.0 / count.max(1) as f32 };
    let corner = |i: u32| if one_place { 0.0 } else { -1.0 + 2.0 * i as f32 / count as f32 };
    let positions = (0..count)
        .flat_map(|i| [[corner(i), -1.0, 0.0], [corner(i) + width, -1.0, 0.0], [corner(i), 1.0, 0.0]])
        .collect();
    let triangles = (0..count).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    grey(vec![Mesh { positions, triangles, ..Default::default() }])
}

fn counts() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    let kinds = [0, 1, 2, 3, 4, 1000].map(|n| (n, false)).into_iter().chain([(1000, true)]);
    for (count, one_place) in kinds {
        let scene = triangles(count, one_place);
        let camera = |_| looking([0.0, 0.0, 3.0]);
        // Triangles in one place cover no pixel's centre.
        let value = if count == 0 || one_place {
            furnace.farthest(scene, 2, camera)
        } else {
            furnace.farthest_seen(scene, 2, camera)
        };
        worst.add(value, || format!("{count} triangles, in one place: {one_place}"));
    }
    worst
}

fn awkward() -> Worst {
    // The size is odd, so that the middle pixel's ray is the axis itself.
    let mut furnace = Furnace::new([33, 25]);
    let mut worst = Worst::default();
    let eyes = [
        ("on a corner", [1.0, 1.0, 0.0], [0.0, 0.0, -1.0]),
        ("on the diagonal", [0.0, 0.0, 0.0], [0.0, 0.0, -1.0]),
        ("in the plane", [5.0, 0.0, 0.0], [0.0, 0.0, 0.0]),
        ("along an axis at a corner", [1.0, 1.0, 3.0], [1.0, 1.0, 0.0]),
        ("along an axis at the diagonal", [0.0, 0.0, 3.0], [0.0, 0.0, 0.0]),
    ];
    for (name, eye, target) in eyes {
        let camera = |_| Camera { eye, target, ..Default::default() };
        // A camera in a surface's plane does not see the surface.
        worst.add(furnace.farthest(grey(vec![plane(1.0, [0.0; 3])]), 3, camera), || name.into());
    }
    worst
}

/// Builds a closed box with the corners ±`half`.
fn closed_box(half: f32) -> Mesh {
    let at = |x: i32, y: i32, z: i32| [x, y, z].map(|sign| sign as f32 * half);
    let positions = (0..8).map(|i| at((i & 1) * 2 - 1, (i & 2) - 1, (i & 4) / 2 - 1)).collect();
    let quads = [[0, 1, 3, 2], [4, 5, 7, 6], [0, 1, 5, 4], [2, 3, 7, 6], [0, 2, 6, 4], [1, 3, 7, 5]];
    let triangles = quads.into_iter().flat_map(|[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    Mesh { positions, triangles, ..Default::default() }
}

fn enclosed() -> Worst {
    let mut worst = Worst::default();
    let mut furnace = Furnace::new([33, 25]);
    for power in [-5, -2, 0, 3, 7] {
        let scale = 10.0_f32.powi(power);
        for (name, mesh) in [("box", closed_box(scale)), ("ball", ball(scale, [0.0; 3]))] {
            let eyes = [("the middle", [0.0, 0.0, 0.0]), ("a wall", [0.9, 0.1, 0.2]), ("a corner", [0.5, 0.5, 0.5])];
            for (place, eye) in eyes {
                let eye = eye.map(|x: f64| x * f64::from(scale));
                let camera = |frame| {
                    // The targets are a vertex of the box, an edge, and faces.
                    let target =
                        [[1.0, 1.0, 1.0], [1.0, 1.0, 0.0], [0.0, 1.0, 0.1], [0.3, -0.7, 0.2]][frame as usize % 4];
                    Camera { eye, target: target.map(|x: f64| x * f64::from(scale)), fov_y: 2.0, ..Default::default() }
                };
                let scene = grey(vec![mesh.clone()]);
                worst.add(furnace.brightest(scene, 8, camera), || format!("a {name} of 10^{power}, {place}"));
            }
        }
    }
    worst
}

fn sub_pixel() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    // At distance 5, a pixel is 5 · 2 · tan(0.4) / 24 ≈ 0.18 wide.
    for pixels in [1.0, 0.3, 0.1_f32] {
        // All cards are in one plane, so that none shadows another.
        let card = |i: u32| plane(0.09 * pixels, [-1.5 + 0.15 * (i % 20) as f32, -1.5 + 0.15 * (i / 20) as f32, 0.0]);
        // Thirds and quarters give all twelve places in twelve frames.
        let jitter = |frame: u32| [(frame % 3) as f32 / 3.0 - 0.33, (frame % 4) as f32 / 4.0 - 0.375];
        let camera = |frame| Camera { jitter: jitter(frame), ..looking([0.0, 0.0, 5.0]) };
        worst.add(furnace.farthest_seen(grey((0..400).map(card).collect()), 24, camera), || format!("{pixels} pixels"));
    }
    worst
}

fn fields_of_view() -> Worst {
    let mut furnace = Furnace::new(SIZE);
    let mut worst = Worst::default();
    for fov_y in [1e-6, 1e-3, 1.0, 3.0, PI - 1e-3] {
        let camera = |_| Camera { eye: [0.3, 0.2, 3.0], target: [0.0; 3], fov_y, ..Default::default() };
        // The plane is as wide as the view.
        let half = (10.0 * (0.5 * fov_y).tan()).max(1.0);
        worst.add(furnace.farthest_seen(grey(vec![plane(half, [0.0; 3])]), 3, camera), || format!("{fov_y} rad"));
    }
    worst
}
