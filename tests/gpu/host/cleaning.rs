//! Values that are not a number, infinite or negative do not spread, and are counted.

use super::{Recorded, SIZE, Uploaded, colors, recorded, target, upload};
use crate::common::gpu::gpu;
use crate::common::statistics::Rgb;
use asvgf::{Denoiser, DenoiserDescriptor, FilterSettings, Gradient, InputCounts, Pairs, Settings, Shading, View};
use std::time::Duration;

fn counting(gradient: Gradient) -> Denoiser {
    let filter = FilterSettings { gradient, ..Default::default() };
    let settings = Settings { filter, ..Settings::adaptive() };
    let descriptor = DenoiserDescriptor { size: SIZE, settings, diagnostics: true, views: true, ..Default::default() };
    Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap()
}

/// A frame with an invalid channel in every 7th pixel, each kind in turn; the same frame cleaned by hand; and the number of pixels
/// that are not finite and of those that are negative.
fn soiled(frame: &Recorded) -> (Recorded, Recorded, [u32; 2]) {
    let (mut bad, mut good, mut counts) = (frame.clone(), frame.clone(), [0; 2]);
    let kinds = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, -1.0, -f32::NAN, -1e30];
    for (k, i) in (0..frame.light.len()).step_by(7).enumerate() {
        let value = kinds[k % kinds.len()];
        bad.light[i][k % 3] = value;
        match value {
            // A pixel that is not a number has no sample at all.
            _ if value.is_nan() => good.light[i] = [f32::NAN; 3],
            // An infinite channel marks the pixel, whatever is in the other channels.
            f32::INFINITY => good.light[i][k % 3] = value,
            _ => good.light[i][k % 3] = 0.0,
        }
        counts[usize::from(value.is_finite())] += 1;
    }
    (bad, good, counts)
}

fn denoise(denoiser: &mut Denoiser, frame: &Recorded) -> Vec<Rgb> {
    let (host, target) = (Uploaded::new(gpu(), frame), target());
    gpu().submit(|encoder| {
        denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
        denoiser.denoise(&gpu().device, encoder, &host.shading(&target)).unwrap();
    });
    colors(&target)
}

/// The counts of a finished frame. Another test's poll of the shared device may be the one that delivers them.
fn counts(denoiser: &mut Denoiser) -> InputCounts {
    for _ in 0..1000 {
        if let Some(counts) = denoiser.take_counts() {
            return counts;
        }
        gpu().wait();
        std::thread::sleep(Duration::from_millis(1));
    }
    panic!("no counts of a finished frame");
}

#[test]
fn bad_radiance_is_replaced_and_counted() {
    let frames = recorded(Settings::adaptive());
    let (mut a, mut b) = (counting(Gradient::Reshade), counting(Gradient::Reshade));
    for frame in &frames[..4] {
        let (bad, good, [non_finite, negative]) = soiled(frame);
        assert!(denoise(&mut a, &bad) == denoise(&mut b, &good), "frame {}", frame.index);
        let [found, cleaned] = [&mut a, &mut b].map(counts);
        assert_eq!([found.frame, found.non_finite, found.negative], [frame.index, non_finite, negative]);
        let missing = good.light.iter().filter(|c| c.iter().any(|x| !x.is_finite())).count() as u32;
        assert_eq!([cleaned.surfaces, cleaned.non_finite, cleaned.negative, cleaned.pairs], [0, missing, 0, 0]);
        assert!(a.take_counts().is_none(), "one count for each frame");
    }
    assert!(super::view(&mut a, View::NonFinite).iter().all(|c| c[0] == 0.0));
}

#[test]
fn bad_surfaces_are_left_out_and_counted() {
    let mut frame = recorded(Settings::adaptive()).swap_remove(0);
    frame.normal[3] = [f32::NAN, 0.0, 0.0];
    frame.normal[50] = [0.0; 3];
    frame.motion[70] = [f32::INFINITY, 0.0];
    frame.previous_depth[90] = f32::NAN;
    // These pixels have no surface, which is allowed.
    (frame.depth[120], frame.depth[121], frame.depth[122], frame.depth[123]) = (0.0, -1.0, f32::INFINITY, f32::NAN);
    let mut denoiser = counting(Gradient::Off);
    let image = denoise(&mut denoiser, &frame);
    assert!(image.iter().flatten().all(|c| c.is_finite() && *c >= 0.0));
    assert_eq!(counts(&mut denoiser).surfaces, 4);
    let depth = super::view(&mut denoiser, View::Depth);
    for i in [3, 50, 120, 121, 122, 123] {
        assert_eq!(depth[i][0], 0.0, "pixel {i} sees nothing");
    }
    let motion = super::view(&mut denoiser, View::Motion);
    assert!(motion[70][0] < -1e5 && motion[90][0] < -1e5, "those were nowhere");
}

#[test]
fn bad_pairs_are_left_out_and_counted() {
    let frames = recorded(Settings::adaptive());
    let mut denoiser = counting(Gradient::Pairs);
    let target = target();
    for frame in &frames[..3] {
        let host = Uploaded::new(gpu(), frame);
        // Values go into each stratum's first pixel; every fifth is not finite.
        let mut values = vec![[-1.0_f32; 3]; frame.light.len()];
        let mut broken = 0;
        let [width, height] = SIZE.map(|s| s as usize);
        let firsts = (0..height).step_by(3).flat_map(|y| (0..width).step_by(3).map(move |x| y * width + x));
        for (k, i) in firsts.enumerate() {
            values[i] = [0.5; 3];
            if k % 5 == 0 {
                (values[i][k % 3], broken) = (f32::NAN, broken + 1);
            }
        }
        let pair = upload(gpu(), SIZE, &values);
        gpu().submit(|encoder| {
            denoiser.begin_frame(&gpu().device, encoder, &host.surfaces()).unwrap();
            let pairs = Some(Pairs { current: &pair, previous: &pair, in_place: false });
            denoiser.denoise(&gpu().device, encoder, &Shading { pairs, ..host.shading(&target) }).unwrap();
        });
        assert!(colors(&target).iter().flatten().all(|c| c.is_finite()));
        assert_eq!(counts(&mut denoiser).pairs, broken);
    }
    assert!(super::view(&mut denoiser, View::Lambda).iter().all(|l| l[0] == 0.0), "both values are equal");
}

/// Four pixels that are a million times too bright, in frames that have a history.
#[test]
fn outliers_are_counted_shown_and_leave_no_trace() {
    let frames = recorded(Settings::adaptive());
    let (mut spoilt, mut clean) = (counting(Gradient::Statistics), counting(Gradient::Statistics));
    // These frames are before the lamp goes out.
    for (number, frame) in frames[..6].iter().enumerate() {
        let mut hit = frame.clone();
        let seen = (0..hit.light.len()).filter(|&i| hit.depth[i] > 0.0 && number >= 2);
        let chosen: Vec<usize> = seen.skip(40 + 17 * number).step_by(151).take(4).collect();
        chosen.iter().for_each(|&i| hit.light[i] = [1e6; 3]);
        let images = [(&mut spoilt, &hit), (&mut clean, frame)].map(|(denoiser, frame)| denoise(denoiser, frame));
        assert_eq!(counts(&mut spoilt).outliers, chosen.len() as u32 + counts(&mut clean).outliers, "frame {number}");
        let [shown, others] = [&mut spoilt, &mut clean].map(|denoiser| super::view(denoiser, View::Outliers));
        for i in 0..shown.len() {
            let expected = if chosen.contains(&i) { 1.0 } else { others[i][0] };
            assert_eq!(shown[i][0], expected, "frame {number}, pixel {i}");
        }
        let [a, b] = images.map(|image| crate::common::statistics::mean(&image));
        assert!((a / b - 1.0).abs() < 0.01, "frame {number}: {a}, and {b} without");
    }
}

#[test]
fn without_diagnostics_nothing_is_counted() {
    let frames = recorded(Settings::adaptive());
    let mut denoiser = super::denoiser(super::reshading());
    denoise(&mut denoiser, &frames[0]);
    assert!(denoiser.take_counts().is_none());
}
