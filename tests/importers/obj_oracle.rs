//! Files without a defect, compared with the results of the `tobj` crate.

use std::io::Cursor;

use proptest::prelude::*;
use tobj::LoadOptions;

use crate::common::*;

/// Positions, texture coordinates and normals of the corners of a triangle.
type Corners = Vec<f32>;

/// Vectors, and faces of three corners with the same three indices each.
fn files() -> impl Strategy<Value = String> {
    let number = -100_i32..100;
    let vector =
        (number.clone(), number.clone(), number).prop_filter("a direction", |&(x, y, z)| (x, y, z) != (0, 0, 0));
    let vectors = prop::collection::vec(vector, 4..20);
    vectors.prop_flat_map(|vectors| {
        let count = vectors.len();
        let corner = (0..count, 0..count, 0..count).prop_filter("three", |(a, b, c)| a != b && b != c && a != c);
        let faces = prop::collection::vec((corner, 0..3_usize, any::<bool>()), 1..30);
        faces.prop_map(move |faces| {
            let mut text = String::new();
            for &(x, y, z) in &vectors {
                let [x, y, z] = [x, y, z].map(|number| f64::from(number) / 8.0);
                text += &format!("v {x} {y} {z}\nvt {x} {y}\nvn {x} {y} {z}\n");
            }
            for &((a, b, c), object, relative) in &faces {
                let index = |at: usize| {
                    if relative { (at as i64 - count as i64).to_string() } else { (at + 1).to_string() }
                };
                let [a, b, c] = [a, b, c].map(|at| format!("{0}/{0}/{0}", index(at)));
                text += &format!("o object{object}\nf {a} {b} {c}\n");
            }
            text
        })
    })
}

fn sorted(mut triangles: Vec<Corners>) -> Vec<Corners> {
    triangles.sort_by(|a, b| a.partial_cmp(b).unwrap());
    triangles
}

fn of_tobj(text: &str) -> Vec<Corners> {
    let options = LoadOptions { single_index: true, triangulate: true, ..LoadOptions::default() };
    let (models, _) = tobj::load_obj_buf(&mut Cursor::new(text), &options, |_| Ok(Default::default())).unwrap();
    let triangle = |mesh: &tobj::Mesh, corners: &[u32]| {
        let corner = |&at: &u32| {
            let at = at as usize;
            let [u, v] = [mesh.texcoords[2 * at], mesh.texcoords[2 * at + 1]];
            // In glTF, v grows downwards.
            [&mesh.positions[3 * at..3 * at + 3], &[u, 1.0 - v], &unit(&mesh.normals[3 * at..3 * at + 3])].concat()
        };
        corners.iter().flat_map(corner).collect()
    };
    let of_model = |model: &tobj::Model| {
        model.mesh.indices.chunks(3).map(|corners| triangle(&model.mesh, corners)).collect::<Vec<_>>()
    };
    sorted(models.iter().flat_map(of_model).collect())
}

/// The direction of a vector, in steps that hide rounding.
fn unit(vector: &[f32]) -> Vec<f32> {
    glam::Vec3::from_slice(vector).normalize().to_array().map(|x| (1024.0 * x).round()).into()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 64, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn triangles_are_those_of_another_reader(text in files()) {
        let scene = asvgf::scene::load(Folder::new().write("test.obj", &text)).unwrap().scene;
        let ours = scene.meshes.iter().flat_map(|mesh| {
            mesh.triangles.iter().map(|corners| {
                let corner = |&at: &u32| {
                    let at = at as usize;
                    [&mesh.positions[at][..], &mesh.uvs[0][at], &unit(&mesh.normals[at])].concat()
                };
                corners.iter().flat_map(corner).collect::<Corners>()
            })
        });
        prop_assert_eq!(sorted(ours.collect()), of_tobj(&text));
    }
}
