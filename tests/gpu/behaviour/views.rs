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

/// The views of scenes in which something shines.
pub const OF_GLOSS: [View; 11] = [
    View::DiffuseNoisy,
    View::SpecularNoisy,
    View::Specular,
    View::SpecularAlbedo,
    View::Roughness,
    View::HitDistance,
    View::ReflectionMotion,
    View::Agreement,
    View::SpecularHistoryLength,
    View::SpecularPairNow,
    View::SpecularPairBefore,
];

fn shining() -> Stage {
    let mut stage = Stage::built_in("gloss", "all", SIZE, Settings::adaptive());
    stage.frames(5);
    stage
}

#[test]
fn the_signals_and_emission_sum_up_to_the_whole() {
    let mut stage = shining();
    let views = [View::DiffuseNoisy, View::SpecularNoisy, View::Emission, View::Noisy];
    let [diffuse, specular, emission, all] = views.map(|view| stage.view(view));
    for (i, all) in all.iter().enumerate() {
        for c in 0..3 {
            let sum = diffuse[i][c] + specular[i][c] + emission[i][c];
            assert!((sum - all[c]).abs() <= 1e-6 * all[c], "pixel {i}: {sum} is not {}", all[c]);
        }
    }
    for (view, light) in [(View::DiffuseNoisy, diffuse), (View::SpecularNoisy, specular)] {
        assert!(light.iter().any(|c| c[0] > 0.01), "{view:?}");
    }
    let [filtered, specular] = [View::Denoised, View::Specular].map(|view| stage.view(view));
    assert!(
        filtered.iter().zip(&specular).all(|(a, s)| (0..3).all(|c| s[c] <= a[c] * 1.000_001)),
        "a part of the whole"
    );
}

#[test]
fn numbers_of_gloss_are_within_their_documented_ranges() {
    let mut stage = shining();
    let albedo = stage.view(View::SpecularAlbedo);
    let shines: Vec<bool> = albedo.iter().map(|c| c[0] > 0.0).collect();
    assert!(shines.contains(&true) && shines.contains(&false));
    let mut check = |view, holds: &dyn Fn([f32; 3], bool) -> bool| {
        for (value, &shines) in stage.view(view).into_iter().zip(&shines) {
            assert!(holds(value, shines), "{view:?}: {value:?}, shines: {shines}");
        }
    };
    let unit = |x: f32| (0.0..=1.0).contains(&x);
    let within = |x: f32, least: f32| (least * 0.999..=1.0).contains(&x);
    check(View::SpecularAlbedo, &|c, shines| c.iter().all(|&x| if shines { within(x, 0.02) } else { x == 0.0 }));
    check(View::Roughness, &|r, shines| unit(r[0]) && (shines || r[0] == 1.0));
    check(View::HitDistance, &|h, shines| h.iter().all(|x| x.is_finite() && *x >= 0.0) && (h[0] > 0.0) == shines);
    check(View::ReflectionMotion, &|m, shines| m[0].abs() <= 1e6 && (shines || m == [0.0; 3]));
    check(View::Agreement, &|w, shines| unit(w[0]) && (shines || w[0] == 0.0));
    check(View::SpecularHistoryLength, &|n, shines| if shines { (1.0..=5.0).contains(&n[0]) } else { n[0] == 0.0 });
    check(View::Specular, &|c, shines| c.iter().all(|x| x.is_finite() && *x >= 0.0) && (shines || c[0] == 0.0));
}

#[test]
fn the_reflection_of_a_still_surface_moves_alone() {
    // Only what the mirrors show moves.
    let mut stage = Stage::built_in("gloss", "move-reflected", [96, 54], Settings::adaptive());
    stage.frames(3);
    let [surface, reflection] = [View::Motion, View::ReflectionMotion].map(|view| stage.view(view));
    let still = |motion: &[f32; 2]| motion.iter().all(|x| x.abs() < 0.01);
    let seen = |(s, r): &(&[f32; 3], &[f32; 3])| still(&[s[0], s[1]]) && !still(&[r[0], r[1]]);
    let moved = surface.iter().zip(&reflection).filter(seen).count();
    assert!(moved > 3, "in {moved} pixels");
}

#[test]
fn the_specular_pairs_are_the_specular_light_of_the_same_paths() {
    let mut stage = Stage::built_in("gloss", "static", SIZE, Settings::adaptive()).leaving_nothing_out();
    stage.frames(5);
    let [now, before] = [View::SpecularPairNow, View::SpecularPairBefore].map(|view| stage.view(view));
    let (of_diffuse, specular) = (stage.view(View::PairNow), stage.view(View::SpecularNoisy));
    assert!(now.iter().any(|c| c[0] > 0.0), "some path has specular light");
    for (i, pair) in now.iter().zip(&before).enumerate() {
        assert_eq!(pair.0, pair.1, "pixel {i}: nothing has changed");
        assert_eq!(pair.0[0] < 0.0, of_diffuse[i][0] < 0.0, "pixel {i}: both signals repeat one path");
        let near = (0..3).all(|c| (pair.0[c] - specular[i][c]).abs() <= 1e-5 * specular[i][c]);
        assert!(pair.0[0] < 0.0 || near, "pixel {i}: {:?} is not {:?}", pair.0, specular[i]);
    }
}

#[test]
fn every_view_has_a_picture_with_something_in_it() {
    let mut stage = stage();
    let mut reference =
        Stage::built_in("cornell", "static", SIZE, Settings { mode: Mode::Reference, ..Settings::adaptive() });
    reference.frame();
    let mut shining = shining();
    let target = gpu().target(SIZE, TextureFormat::Rgba8Unorm);
    for &view in View::ALL {
        let stage = match view {
            View::Mean => &mut reference,
            _ if OF_GLOSS.contains(&view) => &mut shining,
            _ => &mut stage,
        };
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
