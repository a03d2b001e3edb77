//! SSIM and FLIP of the images in images/, against the numbers that images/recipe.py prints: from scikit-image 0.26.0 and NVIDIA's
//! flip-evaluator 1.7.

use crate::assert_near;
use asvgf::image_io::read_png;
use asvgf::metrics::{PIXELS_PER_DEGREE, Pair, encode, flip, ssim};
use std::path::Path;

/// An image as displays show it, and its size.
fn image(name: &str) -> (Vec<[f32; 3]>, [u32; 2]) {
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
fn flip_is_that_of_its_authors() {
    let (reference, size) = image("reference.png");
    let places = [(3, 3), (20, 14), (30, 20)].map(|(x, y): (usize, usize)| y * size[0] as usize + x);
    for (name, mean, expected) in [
        ("reference.png", 0.0, [0.0; 3]),
        ("noisy.png", 0.157_576, [0.318_81, 0.120_36, 0.160_54]),
        ("blurred.png", 0.202_474, [0.332_64, 0.168_49, 0.060_90]),
    ] {
        let (image, _) = image(name);
        let flip = flip(&Pair::new(&image, &reference).unwrap(), size, PIXELS_PER_DEGREE).unwrap();
        assert_near(flip.mean, mean, 1e-4);
        for (place, expected) in places.into_iter().zip(expected) {
            assert_near(flip.map[place].into(), expected, 1e-4);
        }
        assert_eq!(flip.picture().len(), image.len());
    }
}

#[test]
fn masks_choose_among_the_pixels() {
    let (reference, size) = image("reference.png");
    let (image, _) = image("noisy.png");
    let mask: Vec<bool> = (0..image.len()).map(|i| i == 14 * 40 + 20).collect();
    let pair = Pair::new(&image, &reference).unwrap().counting(&mask).unwrap();
    let flip = flip(&pair, size, PIXELS_PER_DEGREE).unwrap();
    assert_eq!(flip.mean, f64::from(flip.map[14 * 40 + 20]));
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
