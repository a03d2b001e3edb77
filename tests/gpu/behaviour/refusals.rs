//! Impossible requests are refused by name, and cost no history.

use crate::behaviour::views::OF_GLOSS;
use crate::common::gpu::{Gpu, gpu};
use crate::common::stage::Stage;
use asvgf::{
    Camera, Denoiser, DenoiserDescriptor, Error, FilterSettings, Gradient, Mode, Settings, TracerSettings, View,
    ViewOptions,
};
use wgpu::{Features, Instance, InstanceDescriptor, TextureFormat, TextureUsages, TextureView};

const SIZE: [u32; 2] = [24, 16];

/// Two denoisers: one gets impossible requests, the other does not.
struct Pair {
    tried: Stage,
    control: Stage,
}

impl Pair {
    fn new() -> Self {
        let [tried, control] = [0; 2].map(|_| {
            let mut stage = Stage::built_in("cornell", "static", SIZE, Settings::adaptive());
            stage.frames(4);
            stage
        });
        Self { tried, control }
    }

    /// Renders into a target that is refused. Returns the error.
    fn refused(&mut self, target: TextureView, camera: Option<Camera>) -> Error {
        let target = std::mem::replace(&mut self.tried.target, target);
        let camera = std::mem::replace(&mut self.tried.camera, camera);
        let error = gpu().submit(|encoder| self.tried.record(encoder)).unwrap_err();
        (self.tried.target, self.tried.camera) = (target, camera);
        self.assert_unharmed(&error);
        error
    }

    /// Asserts that the next frame is the same to the last bit as without the refused request.
    fn assert_unharmed(&mut self, after: &Error) {
        assert_eq!(self.tried.frame().image(), self.control.frame().image(), "after: {after}");
    }
}

#[test]
fn a_target_that_does_not_fit() {
    let mut pair = Pair::new();
    let format = pair.refused(gpu().target(SIZE, TextureFormat::Rgba8Unorm), None);
    assert!(matches!(format, Error::ViewFormat { view: "target", format: TextureFormat::Rgba8Unorm, .. }), "{format}");
    let size = pair.refused(gpu().target([SIZE[1], SIZE[0]], TextureFormat::Rgba32Float), None);
    assert!(matches!(size, Error::ViewSize { view: "target", found: [16, 24], expected: SIZE }), "{size}");
    let unwritable = gpu().texture(SIZE, TextureFormat::Rgba16Float, TextureUsages::COPY_SRC);
    let usage = pair.refused(unwritable.create_view(&Default::default()), None);
    let missing = TextureUsages::STORAGE_BINDING;
    assert!(matches!(usage, Error::ViewUsage { view: "target", missing: m } if m == missing), "{usage}");
}

#[test]
fn a_camera_that_sees_nothing() {
    let mut pair = Pair::new();
    let cameras = [
        ("eye", Camera { eye: [f64::NAN; 3], ..Default::default() }),
        ("target", Camera { target: [0.0; 3], ..Default::default() }),
        ("up", Camera { up: [0.0, 0.0, 2.0], ..Default::default() }),
        ("fov_y", Camera { fov_y: 4.0, ..Default::default() }),
        ("jitter", Camera { jitter: [f32::INFINITY, 0.0], ..Default::default() }),
    ];
    for (name, camera) in cameras {
        let target = pair.tried.target.clone();
        let error = pair.refused(target, Some(camera));
        assert!(matches!(error, Error::Camera { element, .. } if element == name), "{name}: {error}");
    }
}

#[test]
fn a_setting_out_of_range() {
    let filter = FilterSettings::default();
    let wrong = |filter: FilterSettings| Settings { filter, ..Settings::adaptive() };
    let settings = [
        ("filter.alpha", wrong(FilterSettings { alpha: 1.1, ..filter.clone() })),
        ("filter.alpha", wrong(FilterSettings { alpha: f32::NAN, ..filter.clone() })),
        ("filter.max_history", wrong(FilterSettings { max_history: 0.0, ..filter.clone() })),
        ("filter.history_power", wrong(FilterSettings { history_power: -1.0, ..filter.clone() })),
        ("filter.gradient_gamma", wrong(FilterSettings { gradient_gamma: 2.0, ..filter.clone() })),
        ("filter.gradient_iterations", wrong(FilterSettings { gradient_iterations: 8, ..filter.clone() })),
        ("filter.iterations", wrong(FilterSettings { iterations: 9, ..filter.clone() })),
        ("filter.sigma_luminance", wrong(FilterSettings { sigma_luminance: -1.0, ..filter.clone() })),
        ("filter.sigma_depth", wrong(FilterSettings { sigma_depth: 0.0, ..filter.clone() })),
        ("filter.sigma_normal", wrong(FilterSettings { sigma_normal: f32::INFINITY, ..filter.clone() })),
        ("filter.ridge", wrong(FilterSettings { ridge: 0.0, ..filter })),
        (
            "tracer.samples",
            Settings { tracer: TracerSettings { samples: 0, ..Default::default() }, ..Settings::adaptive() },
        ),
        (
            "tracer.bounces",
            Settings { tracer: TracerSettings { bounces: 1025, ..Default::default() }, ..Settings::adaptive() },
        ),
    ];
    let mut pair = Pair::new();
    for (name, settings) in settings {
        let error = pair.tried.denoiser.set_settings(settings.clone()).unwrap_err();
        assert!(matches!(error, Error::Setting { setting, .. } if setting == name), "{name}: {error}");
        assert_eq!(pair.tried.denoiser.settings(), &Settings::adaptive());
        pair.assert_unharmed(&error);
        let descriptor = DenoiserDescriptor { size: SIZE, settings, ..Default::default() };
        assert!(matches!(Denoiser::new(&gpu().device, &gpu().queue, &descriptor), Err(Error::Setting { .. })));
    }
}

#[test]
fn a_size_that_no_texture_has() {
    let mut pair = Pair::new();
    let limit = gpu().device.limits().max_texture_dimension_2d;
    for size in [[0, 16], [24, 0], [limit + 1, 16]] {
        let named = |error: &Error| matches!(error, Error::Size { width, height, limit: l } if [*width, *height] == size && *l == limit);
        let descriptor = DenoiserDescriptor { size, ..Default::default() };
        let error = Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap_err();
        assert!(named(&error), "{error}");
        assert!(named(&pair.tried.denoiser.resize(&gpu().device, size).unwrap_err()));
        pair.assert_unharmed(&error);
    }
}

#[test]
fn timing_on_a_device_without_timestamps() {
    let descriptor = DenoiserDescriptor { size: SIZE, timing: true, ..Default::default() };
    let error = Denoiser::new(&gpu().device, &gpu().queue, &descriptor).unwrap_err();
    let missing = wgpu::Features::TIMESTAMP_QUERY;
    assert!(matches!(error, Error::Feature { missing: m, .. } if m == missing), "{error}");
}

#[test]
fn pipelines_of_another_device() {
    let instance = Instance::new(InstanceDescriptor::new_without_display_handle_from_env());
    let [own, other] = [0; 2].map(|_| Gpu::of(&instance, Features::empty()).unwrap());
    let plain = DenoiserDescriptor { size: SIZE, ..Default::default() };
    let pipelines = Denoiser::new(&own.device, &own.queue, &plain).unwrap().pipelines().clone();
    let shared = DenoiserDescriptor { pipelines: Some(pipelines), ..plain };
    assert!(matches!(Denoiser::new(&other.device, &other.queue, &shared), Err(Error::OtherDevice)));
    assert!(Denoiser::new(&own.device, &own.queue, &shared).is_ok());
}

#[test]
fn a_view_of_what_was_not_made() {
    let target = gpu().target(SIZE, TextureFormat::Rgba32Float);
    let show = |stage: &mut Stage, view| {
        gpu().submit(|e| stage.denoiser.show(&gpu().device, e, view, ViewOptions::default(), &target))
    };
    let expect = |stage: &mut Stage, missing: &[View]| {
        for &view in View::ALL {
            match show(stage, view) {
                Ok(()) => assert!(!missing.contains(&view), "{view:?}"),
                Err(Error::NoView { view: v, .. }) => assert!(missing.contains(&view) && v == view, "{view:?}"),
                Err(e) => panic!("{e}"),
            }
        }
    };
    let mut stage = Stage::built_in("cornell", "static", SIZE, Settings::adaptive());
    expect(&mut stage, View::ALL);
    // Nothing moves or repeats, so objects are not told apart. Nothing changes, so no path is repeated. Nothing is summed. Nothing shines.
    let lambertian = |missing: &[View]| [missing, &OF_GLOSS].concat();
    expect(stage.frames(2), &lambertian(&[View::Object, View::PairNow, View::PairBefore, View::Mean]));
    let everything = Stage::built_in("cornell", "static", SIZE, Settings::adaptive()).leaving_nothing_out();
    expect({ everything }.frames(2), &lambertian(&[View::Object, View::Mean]));
    let off = FilterSettings { gradient: Gradient::Off, ..Default::default() };
    stage.denoiser.set_settings(Settings { filter: off, ..Settings::adaptive() }).unwrap();
    let gradient = [View::Object, View::Gradient, View::PairNow, View::PairBefore, View::Mean];
    expect(stage.frame(), &lambertian(&gradient));
    let history = [View::Lambda, View::Alpha, View::Outliers, View::HistoryLength, View::Variance];
    let filtered = [View::Denoised, View::NonFinite];
    stage.denoiser.set_settings(Settings { mode: Mode::Noisy, ..Settings::adaptive() }).unwrap();
    expect(stage.frame(), &lambertian(&[history.as_slice(), &filtered, &gradient].concat()));
    stage.denoiser.set_settings(Settings { mode: Mode::Reference, ..Settings::adaptive() }).unwrap();
    let summed = &gradient[..gradient.len() - 1];
    expect(stage.frame(), &lambertian(&[history.as_slice(), &filtered, summed].concat()));
}

#[test]
fn a_view_of_specular_light_says_what_is_missing() {
    let target = gpu().target(SIZE, TextureFormat::Rgba32Float);
    let expect = |stage: &mut Stage, missing: &[(View, &str)]| {
        for view in OF_GLOSS {
            let shown = gpu().submit(|e| stage.denoiser.show(&gpu().device, e, view, ViewOptions::default(), &target));
            let expected = missing.iter().find(|(missing, _)| *missing == view);
            match (shown, expected) {
                (Ok(()), None) => {}
                (Err(Error::NoView { reason, .. }), Some((_, words))) => {
                    assert!(reason.contains(words), "{view:?}: {reason}");
                }
                (shown, _) => panic!("{view:?}: {shown:?}"),
            }
        }
    };
    let all_of = |words| OF_GLOSS.map(|view| (view, words));
    let mut dull = Stage::built_in("cornell", "static", SIZE, Settings::adaptive());
    expect(dull.frames(2), &all_of("nothing shines"));
    let mut stage = Stage::built_in("gloss", "static", SIZE, Settings::adaptive());
    let unchanged = "nothing changed";
    expect(
        stage.frames(2),
        &[(View::Agreement, unchanged), (View::SpecularPairNow, unchanged), (View::SpecularPairBefore, unchanged)],
    );
    let one_signal = FilterSettings { gloss: false, ..Default::default() };
    stage.denoiser.set_settings(Settings { filter: one_signal, ..Settings::adaptive() }).unwrap();
    expect(stage.frame(), &all_of("one signal"));
    let statistics = FilterSettings { gradient: Gradient::Statistics, ..Default::default() };
    let settings = Settings { filter: statistics, ..Settings::adaptive() };
    let mut stage = Stage::built_in("gloss", "all", SIZE, settings);
    let no_paths = "does not come from paths";
    expect(stage.frames(2), &[(View::SpecularPairNow, no_paths), (View::SpecularPairBefore, no_paths)]);
}
