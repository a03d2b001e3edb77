//! FLIP of the images in images/, against the numbers from NVIDIA's flip-evaluator 1.7 that images/recipe.py prints.

use crate::perception::image;
use crate::{assert_near, grey};
use asvgf::metrics::{MetricError, PIXELS_PER_DEGREE, Pair, flip};

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
fn a_mask_chooses_among_the_pixels() {
    let (reference, size) = image("reference.png");
    let (image, _) = image("noisy.png");
    let mask: Vec<bool> = (0..image.len()).map(|i| i == 14 * 40 + 20).collect();
    let pair = Pair::new(&image, &reference).unwrap().counting(&mask).unwrap();
    let flip = flip(&pair, size, PIXELS_PER_DEGREE).unwrap();
    assert_eq!(flip.mean, f64::from(flip.map[14 * 40 + 20]));
}

#[test]
fn a_size_that_is_not_the_images() {
    let image = grey(&[0.0; 6]);
    let pair = Pair::new(&image, &image).unwrap();
    let wrong = MetricError::Size { width: 4, height: 2, found: 6 };
    assert_eq!(flip(&pair, [4, 2], PIXELS_PER_DEGREE).unwrap_err(), wrong);
    assert!(flip(&Pair::new(&[], &[]).unwrap(), [0, 0], PIXELS_PER_DEGREE).is_err());
}
