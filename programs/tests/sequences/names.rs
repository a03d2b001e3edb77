//! Other renderers' names of the channels.

use crate::folder::{Folder, add, rename, wall};
use asvgf_programs::sequence::layers::{Layer, Mapping};
use asvgf_programs::sequence::{Sequence, SequenceError, Source};

fn open(folder: &Folder, names: &[(Layer, &str)]) -> Result<Sequence, SequenceError> {
    let mapping = |&(layer, name): &(Layer, &str)| Mapping { layer, names: vec![name.to_owned()], meaning: None };
    let names = names.iter().map(mapping).collect();
    Sequence::open(Source { names, fov_y: Some(1.0), ..Source::from(folder.0.as_path()) }, |_| {})
}

#[test]
fn blenders() {
    let folder = Folder::new();
    let mut image = wall([6, 4]);
    add(&mut image, Layer::Albedo, &[0.25, 0.5, 0.75]);
    add(&mut image, Layer::Motion, &[1.5, 2.5]);
    for c in ["R", "G", "B"] {
        rename(&mut image, c, &format!("ViewLayer.Combined.{c}"));
        rename(&mut image, &format!("albedo.{c}"), &format!("ViewLayer.Denoising Albedo.{c}"));
    }
    for c in ["X", "Y", "Z"] {
        rename(&mut image, &format!("normal.{c}"), &format!("ViewLayer.Denoising Normal.{c}"));
    }
    rename(&mut image, "depth.Z", "ViewLayer.Depth.Z");
    rename(&mut image, "motion.X", "ViewLayer.Vector.X");
    rename(&mut image, "motion.Y", "ViewLayer.Vector.Y");
    folder.write(7, &image);
    let sequence = open(&folder, &[]).unwrap();
    let found = [Layer::Color, Layer::Albedo, Layer::Normal, Layer::Depth, Layer::Motion];
    assert_eq!(sequence.layers, found);
    let pixels = sequence.read(0).unwrap();
    assert_eq!(&pixels.get(Layer::Albedo).unwrap()[..3], [0.25, 0.5, 0.75]);
    // Blender's y points up.
    assert_eq!(&pixels.get(Layer::Motion).unwrap()[..2], [1.5, -2.5]);
}

#[test]
fn mitsubas_with_distances_along_the_ray() {
    let folder = Folder::new();
    let mut image = wall([6, 4]);
    rename(&mut image, "depth.Z", "depth.T");
    for c in ["X", "Y", "Z"] {
        rename(&mut image, &format!("normal.{c}"), &format!("sh_normal.{c}"));
    }
    folder.write(0, &image);
    let sequence = open(&folder, &[]).unwrap();
    let pixels = sequence.read(0).unwrap();
    let depth = pixels.get(Layer::Depth).unwrap();
    // One unit along the ray of the corner's pixel, −5/6·½·1.5·tan ½ to the side and ¾·tan ½ up.
    let tangent = 0.5_f64.tan();
    let [x, y] = [5.0 / 6.0 * 1.5 * tangent, 0.75 * tangent];
    let expected = 1.0 / (1.0 + x * x + y * y).sqrt();
    assert!((f64::from(depth[0]) - expected).abs() < 1e-6, "{} is not {expected}", depth[0]);
}

#[test]
fn a_users_own() {
    let folder = Folder::new();
    let mut image = wall([6, 4]);
    add(&mut image, Layer::Albedo, &[0.25, 0.5, 0.75]);
    for (from, to) in [("albedo.R", "base.r"), ("albedo.G", "base.g"), ("albedo.B", "base.b"), ("depth.Z", "far")] {
        rename(&mut image, from, to);
    }
    folder.write(0, &image);
    assert_eq!(open(&folder, &[(Layer::Albedo, "base")]).unwrap().layers, [Layer::Color, Layer::Albedo, Layer::Normal]);
    let sequence = open(&folder, &[(Layer::Albedo, "base"), (Layer::Depth, "far")]).unwrap();
    assert_eq!(sequence.layers, [Layer::Color, Layer::Albedo, Layer::Normal, Layer::Depth]);
    let error = open(&folder, &[(Layer::Albedo, "bass"), (Layer::Depth, "far")]).unwrap_err().to_string();
    assert!(error.contains("--map albedo=bass") && error.contains("the file has"), "{error}");
}
