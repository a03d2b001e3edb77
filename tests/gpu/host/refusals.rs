//! Each mistake is refused by name, and costs no history.

use super::{SIZE, Uploaded, colors, denoiser, recorded, replay, reshading, target, upload};
use crate::common::gpu::gpu;
use crate::common::stage::Stage;
use asvgf::{
    Denoiser, Error, FilterSettings, Gloss, Gradient, Lambda, Matrices, Pairs, Settings, Shading, Surfaces, View,
    ViewOptions,
};
use wgpu::{TextureFormat, TextureUsages, TextureView};

fn with(gradient: Gradient) -> Settings {
    Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() }
}

/// A view that has never been written.
fn blank(size: [u32; 2], format: TextureFormat) -> TextureView {
    gpu().texture(size, format, TextureUsages::TEXTURE_BINDING).create_view(&Default::default())
}

fn unreadable(format: TextureFormat) -> TextureView {
    gpu().texture(SIZE, format, TextureUsages::COPY_DST).create_view(&Default::default())
}

/// Checks that an error is the expected one.
type Due = Box<dyn Fn(&Error) -> bool>;

/// Views of the wrong format, size, usage and shape.
fn wrong_views(name: &'static str, good: TextureFormat) -> [(TextureView, Due); 4] {
    let layers = gpu().device.create_texture(&wgpu::TextureDescriptor {
        label: None,
        size: wgpu::Extent3d { width: SIZE[0], height: SIZE[1], depth_or_array_layers: 2 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: good,
        usage: TextureUsages::TEXTURE_BINDING,
        view_formats: &[],
    });
    let format = TextureFormat::Rgba8Sint;
    let missing = TextureUsages::TEXTURE_BINDING;
    [
        (
            blank(SIZE, format),
            Box::new(move |e| matches!(e, Error::ViewFormat { view, format: f, .. } if *view == name && *f == format)),
        ),
        (
            blank([SIZE[0], SIZE[1] - 1], good),
            Box::new(
                move |e| matches!(e, Error::ViewSize { view, found, .. } if *view == name && *found == [SIZE[0], SIZE[1] - 1]),
            ),
        ),
        (
            unreadable(good),
            Box::new(move |e| matches!(e, Error::ViewUsage { view, missing: m } if *view == name && *m == missing)),
        ),
        (
            layers.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2),
                array_layer_count: Some(1),
                ..Default::default()
            }),
            Box::new(move |e| matches!(e, Error::ViewShape { view, .. } if *view == name)),
        ),
    ]
}

fn begin(denoiser: &mut Denoiser, surfaces: &Surfaces<'_>) -> Error {
    gpu().submit(|e| denoiser.begin_frame(&gpu().device, e, surfaces).map(|_| ())).unwrap_err()
}

fn denoise(denoiser: &mut Denoiser, shading: &Shading<'_>) -> Error {
    gpu().submit(|e| denoiser.denoise(&gpu().device, e, shading)).unwrap_err()
}

#[test]
fn every_view_is_checked_and_no_mistake_costs_history() {
    let frames = recorded(Settings::adaptive());
    let mut tried = denoiser(reshading());
    replay(&mut tried, &frames[..3]);
    let host = Uploaded::new(gpu(), &frames[3]);
    let target = target();
    let good = TextureFormat::Rgba32Float;
    for name in ["depth", "normal", "motion", "previous_depth", "instance"] {
        for (view, expected) in wrong_views(name, if name == "instance" { TextureFormat::R32Uint } else { good }) {
            let mut surfaces = host.surfaces();
            match name {
                "depth" => surfaces.depth = &view,
                "normal" => surfaces.normal = &view,
                "motion" => surfaces.motion = &view,
                "previous_depth" => surfaces.previous_depth = Some(&view),
                _ => surfaces.instance = Some(&view),
            }
            let error = begin(&mut tried, &surfaces);
            assert!(expected(&error) && error.to_string().contains(&format!("`{name}`")), "{name}: {error}");
        }
    }
    let matrices = Matrices { view: [[0.0; 4]; 4], projection: [[0.0; 4]; 4], jitter: [0.0; 2] };
    let error = begin(&mut tried, &Surfaces { camera: matrices.into(), ..host.surfaces() });
    assert!(matches!(error, Error::Camera { element: "view", .. }), "{error}");
    let error = denoise(&mut tried, &host.shading(&target));
    assert!(matches!(error, Error::NotBegun), "{error}");
    gpu().submit(|e| tried.begin_frame(&gpu().device, e, &host.surfaces())).unwrap();
    for name in ["radiance", "albedo", "emission"] {
        for (view, expected) in wrong_views(name, good) {
            let mut shading = host.shading(&target);
            match name {
                "radiance" => shading.radiance = &view,
                "albedo" => shading.albedo = Some(&view),
                _ => shading.emission = Some(&view),
            }
            let error = denoise(&mut tried, &shading);
            assert!(expected(&error) && error.to_string().contains(&format!("`{name}`")), "{name}: {error}");
        }
    }
    for name in ["gloss.radiance", "gloss.reflectance", "gloss.roughness", "gloss.hit_distance", "gloss.motion"] {
        for (view, expected) in wrong_views(name, good) {
            let mut gloss = Gloss { radiance: Some(&host.light), ..Default::default() };
            match name {
                "gloss.radiance" => gloss.radiance = Some(&view),
                "gloss.reflectance" => gloss.reflectance = Some(&view),
                "gloss.roughness" => gloss.roughness = Some(&view),
                "gloss.hit_distance" => gloss.hit_distance = Some(&view),
                _ => gloss.motion = Some(&view),
            }
            let error = denoise(&mut tried, &Shading { gloss: Some(gloss), ..host.shading(&target) });
            assert!(expected(&error) && error.to_string().contains(&format!("`{name}`")), "{name}: {error}");
        }
    }
    let error = denoise(&mut tried, &host.shading(&host.light));
    assert!(matches!(error, Error::ViewUsage { view: "target", .. }), "{error}");
    let error =
        gpu().submit(|e| tried.show(&gpu().device, e, View::Depth, ViewOptions::default(), &target)).unwrap_err();
    assert!(matches!(error, Error::NoView { .. }), "{error}");
    // After all refusals, the frame is the same as without them.
    gpu().submit(|e| tried.denoise(&gpu().device, e, &host.shading(&target))).unwrap();
    let images = replay(&mut denoiser(reshading()), &frames[..4]);
    assert_eq!(colors(&target), images[3]);
}

#[test]
fn a_gradient_without_its_views_says_what_to_hand_in() {
    let frames = recorded(Settings::adaptive());
    let host = Uploaded::new(gpu(), &frames[0]);
    let target = target();
    for (gradient, name) in [(Gradient::Pairs, "pairs"), (Gradient::Lambda, "lambda")] {
        let mut denoiser = denoiser(with(gradient));
        gpu().submit(|e| denoiser.begin_frame(&gpu().device, e, &host.surfaces())).unwrap();
        let error = denoise(&mut denoiser, &host.shading(&target));
        assert!(matches!(error, Error::ViewMissing { view, .. } if view == name), "{error}");
    }
}

#[test]
fn pairs_and_lambda_that_do_not_fit() {
    let frames = recorded(Settings::adaptive());
    let host = Uploaded::new(gpu(), &frames[0]);
    let target = target();
    let mut denoiser = denoiser(with(Gradient::Pairs));
    gpu().submit(|e| denoiser.begin_frame(&gpu().device, e, &host.surfaces())).unwrap();
    let (color, luminance) = (blank(SIZE, TextureFormat::Rgba16Float), blank(SIZE, TextureFormat::R32Float));
    let strata = blank([16, 12], TextureFormat::Rgba16Float);
    let mut error = |current, previous, in_place| {
        let pairs = Some(Pairs { current, previous, in_place });
        denoise(&mut denoiser, &Shading { pairs, ..host.shading(&target) })
    };
    let mixed = error(&color, &luminance, false);
    assert!(matches!(mixed, Error::ViewFormat { view: "pairs.previous", .. }), "{mixed}");
    let sizes = error(&strata, &color, false);
    assert!(matches!(sizes, Error::ViewSize { view: "pairs.previous", expected: [16, 12], .. }), "{sizes}");
    let place = error(&strata, &strata, true);
    assert!(matches!(place, Error::ViewSize { view: "pairs.current", expected: SIZE, .. }), "{place}");
    let mut error = |current, previous| {
        let gloss = Gloss { radiance: Some(&color), pairs: Some(Pairs::new(current, previous)), ..Default::default() };
        let shading = Shading { pairs: Some(Pairs::new(&color, &color)), gloss: Some(gloss), ..host.shading(&target) };
        denoise(&mut denoiser, &shading)
    };
    let mixed = error(&color, &luminance);
    assert!(matches!(mixed, Error::ViewFormat { view: "gloss.pairs.previous", .. }), "{mixed}");
    let sizes = error(&strata, &color);
    assert!(matches!(sizes, Error::ViewSize { view: "gloss.pairs.previous", expected: [16, 12], .. }), "{sizes}");

    denoiser.set_settings(with(Gradient::Lambda)).unwrap();
    gpu().submit(|e| denoiser.begin_frame(&gpu().device, e, &host.surfaces())).unwrap();
    let lambda = upload(gpu(), [10, 8], &[[0.0_f32]; 80]);
    let mut error = |block| {
        let lambda = Some(Lambda { view: &lambda, block, confidence: false });
        denoise(&mut denoiser, &Shading { lambda, ..host.shading(&target) })
    };
    let size = error(4);
    assert!(matches!(size, Error::ViewSize { view: "lambda", expected: [12, 9], .. }), "{size}");
    let block = error(0);
    assert!(matches!(block, Error::Setting { setting: "Lambda::block", .. }), "{block}");
}

#[test]
fn gradients_that_the_frames_cannot_have() {
    let frames = recorded(Settings::adaptive());
    let host = Uploaded::new(gpu(), &frames[0]);
    let error = begin(&mut denoiser(with(Gradient::BlinnPhong)), &host.surfaces());
    assert!(matches!(error, Error::GradientSource { asked: "blinn-phong", .. }), "{error}");
    for gradient in [Gradient::Pairs, Gradient::Lambda] {
        let mut stage = Stage::built_in("cornell", "static", SIZE, with(gradient));
        let error = gpu().submit(|encoder| stage.record(encoder)).unwrap_err();
        assert!(matches!(error, Error::GradientSource { asked, .. } if asked == gradient.name()), "{error}");
    }
}

#[test]
fn a_view_of_a_frame_that_was_dropped_says_what_to_finish() {
    let frames = recorded(Settings::adaptive());
    let target = target();
    let mut tried = denoiser(reshading());
    let show =
        |tried: &mut Denoiser| gpu().submit(|e| tried.show(&gpu().device, e, View::Depth, Default::default(), &target));
    let drops: [fn(&mut Denoiser); 3] =
        [|_| {}, Denoiser::reset, |tried| tried.set_settings(Settings::classic()).unwrap()];
    for drop in drops {
        replay(&mut tried, &frames[..1]);
        show(&mut tried).unwrap();
        let host = Uploaded::new(gpu(), &frames[1]);
        gpu().submit(|e| tried.begin_frame(&gpu().device, e, &host.surfaces())).unwrap();
        drop(&mut tried);
        let error = show(&mut tried).unwrap_err();
        assert!(matches!(error, Error::NoView { view: View::Depth, .. }), "{error}");
        assert!(error.to_string().contains("a frame was begun"), "{error}");
    }
}
