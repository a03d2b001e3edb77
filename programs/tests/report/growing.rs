//! Growth of costs.

use asvgf::scene::{Mesh, Scene, builtin};
use asvgf_programs::report::fit::{Power, line};
use asvgf_programs::report::growth::{Cost, Growth};
use asvgf_programs::report::tessellation::tessellated;
use asvgf_programs::report::{plots, words_growth};

#[test]
fn a_line_is_found_again() {
    let points = [0.0, 1.0, 4.0].map(|x| (x, 3.0 * x - 2.0));
    // The second case has errors that cancel: ±1 at the same places.
    for (points, expected) in
        [(&points[..], [3.0, -2.0]), (&[(0.0, 1.0), (0.0, -1.0), (1.0, 6.0), (1.0, 4.0)], [5.0, 0.0])]
    {
        let (slope, height) = line(points).unwrap();
        assert!((slope - expected[0]).abs() < 1e-12 && (height - expected[1]).abs() < 1e-12, "{slope}, {height}");
    }
    assert_eq!(line(&[(1.0, 2.0)]), None);
    assert_eq!(line(&[(1.0, 2.0), (1.0, 3.0)]), None);
}

#[test]
fn a_power_is_found_again() {
    for exponent in [-1.0, 0.0, 0.5, 1.0, 2.0] {
        let points: Vec<_> = (1..6).map(|x| (f64::from(x), 7.0 * f64::from(x).powf(exponent))).collect();
        let power = Power::through(&points).unwrap();
        assert!((power.exponent - exponent).abs() < 1e-12, "{}, not {exponent}", power.exponent);
        assert!((power.factor - 7.0).abs() < 1e-10 && (power.at(9.0) - 7.0 * 9f64.powf(exponent)).abs() < 1e-8);
    }
    // Equal relative errors in both directions cancel.
    let power = Power::through(&[(1.0, 2.0), (1.0, 0.5), (4.0, 8.0), (4.0, 2.0)]).unwrap();
    assert!((power.exponent - 1.0).abs() < 1e-12 && (power.factor - 1.0).abs() < 1e-12);
    assert!(Power::through(&[(1.0, 1.0)]).is_none());
}

/// Returns twice the area, and its first moments: a surface and its place.
fn moments(mesh: &Mesh) -> [f64; 4] {
    let mut sums = [0.0; 4];
    for triangle in &mesh.triangles {
        let [a, b, c] = triangle.map(|vertex| mesh.positions[vertex as usize].map(f64::from));
        let [u, v]: [[f64; 3]; 2] = [b, c].map(|corner| std::array::from_fn(|i| corner[i] - a[i]));
        let normal = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]];
        let area = normal.iter().map(|x| x * x).sum::<f64>().sqrt();
        sums[0] += area;
        (0..3).for_each(|i| sums[i + 1] += area * (a[i] + b[i] + c[i]) / 3.0);
    }
    sums
}

fn emits(scene: &Scene, mesh: &Mesh) -> bool {
    scene.materials[mesh.material].emissive != [0.0; 3]
}

#[test]
fn what_is_cut_is_the_same_surface() {
    let scene = builtin::scene("cornell", "static").unwrap();
    for n in [1, 2, 3, 7] {
        let cut = tessellated(&scene, n);
        for (old, new) in scene.meshes.iter().zip(&cut.meshes) {
            let factor = if emits(&scene, old) { 1 } else { n * n };
            assert_eq!(new.triangles.len(), old.triangles.len() * factor as usize, "{}", old.name);
            for (before, after) in moments(old).into_iter().zip(moments(new)) {
                assert!((before - after).abs() < 1e-5 * moments(old)[0], "{}: {before} and {after}", old.name);
            }
            // All triangles have one size.
            let normal =
                |mesh: &Mesh, i: usize| moments(&Mesh { triangles: vec![mesh.triangles[i]], ..mesh.clone() })[0];
            let part = normal(old, 0) / f64::from(factor);
            assert!((0..factor as usize).all(|i| (normal(new, i) - part).abs() < 1e-4 * part), "{}", old.name);
        }
    }
}

/// Returns costs of a filter with a microsecond per pixel, and of tracing that takes ten times as long for a hundred
/// times the triangles.
fn measured() -> Growth {
    let cost = |width: u32, triangles: usize| {
        let pixels = f64::from(width * 100);
        let (tracing, filter) = ((triangles as f64).sqrt() * pixels.sqrt() * 1e-3, pixels * 1e-3);
        let (images, scene) = (u64::from(width * 100) * 150, 64 * triangles as u64);
        Cost { size: [width, 100], triangles, tree: triangles > 64, tracing, filter, rays: 1e5, images, scene }
    };
    let sizes = [100, 200, 400].map(|width| cost(width, 48)).to_vec();
    Growth { key: String::new(), sizes, triangles: [48, 100, 10_000].map(|count| cost(100, count)).to_vec() }
}

#[test]
fn growth_is_told_and_drawn() {
    let folder = std::env::temp_dir().join(format!("asvgf-growth-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let names = plots::draw_growth(&folder, &measured()).unwrap();
    let text = words_growth::growth(&measured(), &names);
    for part in [
        "| 200×100 | 20.00 | 0.98 | 2.9 | 150 |",
        "| exponent | 1.00 | 0.50 | 1.00 | |",
        // 10⁵ rays in √48 · 0.1 ms.
        "| 48 (no tree) | 0.69 | 144.3 | 0.00 |",
        "| exponent, with a tree | 0.50 | | 1.00 |",
        "![growth-triangles](growth-triangles.svg)",
    ] {
        assert!(text.contains(part), "{part} is not in\n{text}");
    }
    for name in names {
        let svg = std::fs::read_to_string(folder.join(format!("{name}.svg"))).unwrap();
        assert!(svg.contains("exponent") && folder.join(format!("{name}.png")).is_file(), "{name}");
    }
    std::fs::remove_dir_all(folder).unwrap();
}
