//! SSIM of the images in images/, against the numbers from scikit-image 0.26.0 that images/recipe.py prints.

use crate::assert_near;
use asvgf::image_io::read_png;
use asvgf::metrics::{Pair, encode, ssim};
use std::path::Path;

/// An image encoded for displays, and its size.
pub fn image(name: &str) -> (Vec<[f32; 3]>, [u32; 2]) {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/metrics/images");
    let (width, height, pixels) = read_png(folder.join(name)).unwrap();
    let colors = pixels.iter().map(|&[r, g, b, _]| [r, g, b].map(|x| f32::from(x) / 255.0)).collect();
    (colors, [width, height])
}

#[test]
fn ssim_is_that_of_scikit_image() {
    let (reference, size) = image("reference.png");
    for (name, expected) in [("reference.png", 1.0), ("noisy.png", 0.719_866_40), ("blurred.png", 0.857_881_16)] {
        let (image, _) = image(name);
        assert_near(ssim(&Pair::new(&image, &reference).unwrap(), size).unwrap(), expected, 1e-6);
    }
}

#[test]
fn masks_choose_among_the_pixels() {
    let (reference, size) = image("reference.png");
    let (image, _) = image("noisy.png");
    let mask: Vec<bool> = (0..image.len()).map(|i| i == 14 * 40 + 20).collect();
    let pair = Pair::new(&image, &reference).unwrap().counting(&mask).unwrap();
    assert!((-1.0..1.0).contains(&ssim(&pair, size).unwrap()));
}

#[test]
fn colors_are_encoded_as_displays_expect() {
    let encoded = encode(&[[0.0, 0.001, 0.25], [0.5, 2.0, -1.0]], 2.0);
    let expected = [[0.0, 0.025_84, 0.735_357], [1.0, 1.0, 0.0]];
    for (found, expected) in encoded.as_flattened().iter().zip(expected.as_flattened()) {
        assert_near((*found).into(), *expected, 1e-5);
    }
}
