//! Intermediate images as numbers and as pictures.

use crate::common::gpu::gpu;
use crate::common::stage::Stage;
use asvgf::{Mode, Settings, View, ViewOptions};
use wgpu::TextureFormat;

const SIZE: [u32; 2] = [31, 17];

fn stage() -> Stage {
    let mut stage = Stage::built_in("cornell", "all", SIZE, Settings::adaptive());
    stage.frames(5);
    stage
}

#[test]
fn the_denoised_view_is_the_target() {
    let mut stage = stage();
    assert_eq!(stage.view(View::Denoised), stage.image());
}

#[test]
fn the_noisy_view_is_what_noisy_mode_shows() {
    // Without a gradient, all pixels take paths of their own, as in noisy mode.
    let settings = Settings::adaptive().constant(0.1);
    let mut filtered = Stage::built_in("cornell", "all", SIZE, settings);
    let mut noisy = Stage::built_in("cornell", "all", SIZE, Settings { mode: Mode::Noisy, ..Settings::adaptive() });
    assert_eq!(filtered.frames(3).view(View::Noisy), noisy.frames(3).image());
}

#[test]
fn the_mean_is_what_a_reference_shows() {
    let settings = Settings { mode: Mode::Reference, ..Settings::adaptive() };
    let mut stage = Stage::built_in("cornell", "static", SIZE, settings);
    stage.frames(3);
    assert_eq!(stage.view(View::Mean), stage.image());
}

#[test]
fn numbers_are_within_their_documented_ranges() {
    let mut stage = stage();
    let depth = stage.view(View::Depth);
    let hit: Vec<bool> = depth.iter().map(|d| d[0] > 0.0).collect();
    assert!(hit.contains(&true) && hit.contains(&false));
    let mut check = |view, holds: &dyn Fn([f32; 3], bool) -> bool| {
        for (value, &hit) in stage.view(view).into_iter().zip(&hit) {
            assert!(holds(value, hit), "{view:?}: {value:?}, hit: {hit}");
        }
    };
    let unit = |x: f32| (0.0..=1.0).contains(&x);
    check(View::Albedo, &|c, hit| c.iter().all(|&x| if hit { (1e-3 * 0.999..=1.0).contains(&x) } else { x == 0.0 }));
    check(View::Normal, &|n, hit| (n.iter().map(|x| x * x).sum::<f32>() - f32::from(u8::from(hit))).abs() < 5e-3);
    check(View::TriangleId, &|id, hit| id[2] == f32::from(u8::from(hit)) && (!hit || id[0] < 48.0 && id[1] == 0.0));
    check(View::Gradient, &|g, _| unit(g[0]));
    check(View::Lambda, &|l, hit| unit(l[0]) && (hit || l[0] == 0.0));
    // α is λ where a path is repeated, because that is no new sample, and so it may be 0.
    check(View::Alpha, &|a, hit| unit(a[0]) && (hit || a[0] == 0.0));
    check(View::HistoryLength, &|n, hit| if hit { (1.0..=5.0).contains(&n[0]) } else { n[0] == 0.0 });
    check(View::Variance, &|v, _| v[0] >= 0.0 && v[0].is_finite());
    check(View::NonFinite, &|x, _| x[0] == 0.0);
}

#[test]
fn the_gradients_pairs_are_in_the_pixels_of_their_paths() {
    let mut stage = Stage::built_in("cornell", "static", SIZE, Settings::adaptive()).leaving_nothing_out();
    stage.frames(5);
    let [now, before] = [View::PairNow, View::PairBefore].map(|view| stage.view(view));
    let (noisy, emission) = (stage.view(View::Noisy), stage.view(View::Emission));
    let mut found = vec![0; (SIZE[0].div_ceil(3) * SIZE[1].div_ceil(3)) as usize];
    for (i, pair) in now.iter().zip(&before).enumerate().filter(|(_, (now, _))| now[0] >= 0.0) {
        let (x, y) = (i as u32 % SIZE[0], i as u32 / SIZE[0]);
        found[(y / 3 * SIZE[0].div_ceil(3) + x / 3) as usize] += 1;
        // The pixel repeats the path, and nothing has changed.
        assert_eq!(pair.0, pair.1, "pixel {i}");
        for c in 0..3 {
            let reflected = noisy[i][c] - emission[i][c];
            assert!((pair.0[c] - reflected).abs() <= 1e-5 * noisy[i][c], "pixel {i}: {} is not {reflected}", pair.0[c]);
        }
    }
    assert!(found.iter().all(|&n| n <= 1) && found.contains(&1), "{found:?}");
    assert!(before.iter().zip(&now).all(|(b, n)| (b[0] < 0.0) == (n[0] < 0.0)), "a pair is whole or absent");
}

#[test]
fn every_view_has_a_picture_with_something_in_it() {
    let mut stage = stage();
    let mut reference =
        Stage::built_in("cornell", "static", SIZE, Settings { mode: Mode::Reference, ..Settings::adaptive() });
    reference.frame();
    let target = gpu().target(SIZE, TextureFormat::Rgba8Unorm);
    for &view in View::ALL {
        let stage = if view == View::Mean { &mut reference } else { &mut stage };
        let options = ViewOptions { exposure: 1.0, range: view.default_range() };
        gpu().submit(|e| stage.denoiser.show(&gpu().device, e, view, options, &target)).unwrap();
        let texels = gpu().read(target.texture());
        assert!(texels.chunks_exact(4).all(|t| t[3] == 255), "{view:?} is opaque");
        let varied = texels.chunks_exact(4).any(|t| t != &texels[..4]);
        // These frames have no faults, so these two views are black.
        let wrong = matches!(view, View::NonFinite | View::Outliers);
        assert_eq!(varied, !wrong, "{view:?}");
    }
}
