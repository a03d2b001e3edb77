//! The way of recording frames makes no difference.

use crate::common::gpu::{Gpu, gpu};
use crate::common::stage::Stage;
use asvgf::scene::builtin;
use asvgf::{Denoiser, DenoiserDescriptor, Settings};
use wgpu::InstanceFlags;

const SIZE: [u32; 2] = [40, 24];

fn stage(scene: &str) -> Stage {
    Stage::built_in(scene, "all", SIZE, Settings::adaptive())
}

#[test]
fn the_same_frames_are_the_same_to_the_last_bit() {
    for scene in ["cornell", "pillars"] {
        let (mut a, mut b) = (stage(scene), stage(scene));
        for _ in 0..6 {
            assert_eq!(a.frame().image(), b.frame().image(), "{scene}");
        }
    }
}

#[test]
fn frames_may_share_an_encoder() {
    let (mut together, mut apart) = (stage("cornell"), stage("cornell"));
    for _ in 0..2 {
        gpu().submit(|encoder| (0..3).for_each(|_| together.record(encoder).unwrap()));
        apart.frames(3);
        assert_eq!(together.image(), apart.image());
    }
}

#[test]
fn denoisers_may_share_an_encoder_and_a_scene() {
    let (mut large, mut alone) = (stage("cornell"), stage("cornell"));
    let mut small = Stage::built_in("cornell", "static", [9, 5], Settings::classic());
    let mut small_alone = Stage::built_in("cornell", "static", [9, 5], Settings::classic());
    for _ in 0..4 {
        gpu().submit(|encoder| {
            large.record(encoder).unwrap();
            small.record(encoder).unwrap();
        });
    }
    assert_eq!(large.image(), alone.frames(4).image());
    assert_eq!(small.image(), small_alone.frames(4).image());
}

#[test]
fn a_device_that_is_strict_about_webgpu_suffices() {
    // The device is leaked, like the shared one: tests end with the process.
    let strict: &'static Gpu = Box::leak(Box::new(Gpu::new(InstanceFlags::STRICT_WEBGPU_COMPLIANCE)));
    let scene = || builtin::scene("cornell", "all").unwrap();
    let mut there = Stage::on(strict, scene(), SIZE, Settings::adaptive());
    let mut here = Stage::on(gpu(), scene(), SIZE, Settings::adaptive());
    assert_eq!(there.frames(4).image(), here.frames(4).image());
}

/// The tracer's own samples need no cleaning, and zeros would take the place of a host's counts.
#[test]
fn traced_frames_count_no_input() {
    let counting = DenoiserDescriptor { size: SIZE, diagnostics: true, ..Default::default() };
    let mut stage = stage("cornell");
    stage.denoiser = Denoiser::new(&gpu().device, &gpu().queue, &counting).unwrap();
    stage.frames(2);
    stage.image();
    assert!(stage.denoiser.take_counts().is_none());
}
