//! Errors measured pixel by pixel.

use crate::{assert_near, grey};
use asvgf::metrics::{EPSILON, Pair, bias, psnr, relative_mse, rmse};

#[test]
fn an_image_is_not_different_from_itself() {
    let image = grey(&[0.0, 0.5, 3.0]);
    let pair = Pair::new(&image, &image).unwrap();
    assert_eq!([rmse(&pair), relative_mse(&pair), bias(&pair)], [0.0; 3]);
    assert_eq!(psnr(&pair, 1.0), f64::INFINITY);
}

#[test]
fn a_constant_offset() {
    let reference = grey(&[0.25, 0.5, 1.0, 2.25]);
    let image: Vec<_> = reference.iter().map(|color| color.map(|x| x + 0.125)).collect();
    let pair = Pair::new(&image, &reference).unwrap();
    assert_eq!(rmse(&pair), 0.125);
    assert_eq!(bias(&pair), 0.125);
    assert_near(psnr(&pair, 1.0), 20.0 * 8_f64.log10(), 1e-12);
    let expected = [0.25_f64, 0.5, 1.0, 2.25].map(|b| 0.125 * 0.125 / (b * b + EPSILON));
    assert_near(relative_mse(&pair), expected.iter().sum::<f64>() / 4.0, 1e-12);
}

/// Uniform noise of width w has a variance of w²/12.
#[test]
fn known_noise() {
    let count = 1 << 16;
    // Successive multiples of the golden ratio fill 0…1 evenly.
    let noise = |i: usize| ((i as f64 * 0.618_033_988_749_894_9).fract() - 0.5) as f32;
    let reference = vec![[2.0; 3]; count];
    let image: Vec<[f32; 3]> = (0..count).map(|i| [2.0 + noise(i); 3]).collect();
    let pair = Pair::new(&image, &reference).unwrap();
    assert_near(rmse(&pair), (1.0_f64 / 12.0).sqrt(), 1e-4);
    assert_near(relative_mse(&pair), 1.0 / 12.0 / (4.0 + EPSILON), 1e-4);
    assert_near(bias(&pair), 0.0, 1e-4);
}

#[test]
fn only_counted_pixels_count() {
    let (image, reference) = (grey(&[1.5, 9.0, 1.0]), grey(&[1.0, 1.0, 1.0]));
    let pair = Pair::new(&image, &reference).unwrap().counting(&[true, false, true]).unwrap();
    assert_near(rmse(&pair), 0.125_f64.sqrt(), 1e-12);
    assert_eq!(bias(&pair), 0.25);
    let nothing = pair.counting(&[false; 3]).unwrap();
    assert!(rmse(&nothing).is_nan() && bias(&nothing).is_nan());
}

#[test]
fn nan_is_not_hidden() {
    let (image, reference) = (grey(&[f32::NAN, 1.0]), grey(&[1.0, 1.0]));
    let pair = Pair::new(&image, &reference).unwrap();
    assert!(rmse(&pair).is_nan() && relative_mse(&pair).is_nan() && bias(&pair).is_nan());
}
