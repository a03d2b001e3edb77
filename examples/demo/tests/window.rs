//! The window without a person: keys, mouse events and files go in, pictures come out. A software adapter suffices.

mod driver;

use asvgf::View;
use asvgf_demo::action::Action;
use asvgf_demo::state::{Motion, Source, State};
use driver::{Window, alike, mean};
use eframe::egui::{Key, vec2};
use egui_kittest::kittest::Queryable;

const SIZE: [f32; 2] = [900.0, 640.0];

/// Frames until blinking lamps go out for the first time: a second.
const LIT: u32 = 30;

fn still() -> Motion {
    Motion { blink: false, ..Motion::default() }
}

/// A state with both halves whose time stands still after the first frame.
fn paused() -> State {
    State { paused: true, split: true, motion: still(), ..State::default() }
}

#[test]
fn a_blink_lags_with_a_constant_and_not_with_an_adaptive_alpha() {
    let mut window = Window::open(SIZE, State { split: true, ..State::default() });
    window.until(LIT);
    let before = [Source::Adaptive, Source::Constant].map(|source| mean(&window.radiance(source)));
    assert!((before[0] / before[1] - 1.0).abs() < 0.1, "both show the lit room: {before:?}");
    // Every lamp is out, so the truth is black and any remaining light is history.
    window.frames(1);
    let first = mean(&window.radiance(Source::Constant));
    assert!(mean(&window.radiance(Source::Adaptive)) < 0.02 * before[0], "the adaptive one has forgotten the light");
    let more = 3;
    window.frames(more);
    let left = mean(&window.radiance(Source::Constant)) / first;
    // With α = 0.2 each frame keeps 0.8 of the history.
    assert!((left - 0.8_f32.powi(more as i32)).abs() < 0.03, "the constant one keeps {left} over {more} frames");
}

#[test]
fn the_split_shows_each_film_on_its_side() {
    // The halves differ most when the lamps are about to go out.
    let mut window = Window::open(SIZE, State { split: true, divider: 0.5, ..State::default() });
    window.until(LIT + 3);
    let films = [Source::Adaptive, Source::Constant].map(|source| window.picture(source));
    for (x, film) in [(0.2, 0), (0.45, 0), (0.55, 1), (0.8, 1)] {
        let (texels, centres): (Vec<_>, Vec<_>) =
            [0.35, 0.6, 0.85].map(|y| films[film].texel([x, y])).into_iter().unzip();
        let shown = window.shown(&centres);
        assert!(texels.iter().zip(&shown).all(|(&a, &b)| alike(a, b)), "at {x}: {shown:?}, not {texels:?}");
    }
    assert!(films[0].texels != films[1].texels);
}

#[test]
fn one_picture_is_shown_whole() {
    let mut window = Window::open(SIZE, State { motion: still(), ..State::default() });
    window.frames(3);
    window.key(Key::Space);
    let film = window.picture(Source::Adaptive);
    let places = [[0.1, 0.5], [0.4, 0.8], [0.6, 0.3], [0.9, 0.9]];
    let (texels, centres): (Vec<_>, Vec<_>) = places.map(|place| film.texel(place)).into_iter().unzip();
    let shown = window.shown(&centres);
    assert!(texels.iter().zip(&shown).all(|(&a, &b)| alike(a, b)), "{shown:?}, not {texels:?}");
}

#[test]
fn every_key_has_its_effect_in_the_next_frame() {
    let mut window = Window::open(SIZE, paused());
    let lit = mean(&window.radiance(Source::Adaptive));
    assert!(lit > 0.01);
    let count = window.demo().frames();
    window.settle();
    assert_eq!(window.demo().frames(), count, "time stands still");
    window.key(Key::S);
    assert_eq!(window.demo().frames(), count + 1, "one step");
    // The view changes without a new frame: the lamps are out, and the picture is black.
    window.key(Key::L);
    window.key(Key::R);
    assert_eq!(mean(&window.radiance(Source::Adaptive)), 0.0);
    window.key(Key::L);
    assert!(mean(&window.radiance(Source::Adaptive)) > 0.5 * lit);

    window.key(Key::A);
    assert_eq!((window.demo().state.left, window.demo().state.right), (Source::Constant, Source::Adaptive));
    window.key(Key::D);
    assert!(!window.demo().state.split);
    assert!(window.demo().has_frame(Source::Constant) && !window.demo().has_frame(Source::Adaptive));
    window.key(Key::A);
    assert!(window.demo().has_frame(Source::Adaptive), "what is switched to has a frame at once");

    for (key, view) in [(Key::Num3, View::Albedo), (Key::Num4, View::Normal), (Key::Num1, View::Denoised)] {
        window.key(key);
        assert_eq!(window.demo().state.view(), view);
        let expected = window.expected(Source::Adaptive, view);
        assert!(window.picture(Source::Adaptive).texels == expected.texels, "{view:?} is what is shown");
    }

    let eye = window.eye();
    window.key(Key::C);
    assert_ne!(window.eye(), eye, "a cut");
    window.key(Key::ArrowUp);
    window.key(Key::H);
    assert_eq!(window.eye(), eye, "home again");
    window.key(Key::P);
    window.settle();
    assert!(window.demo().has_frame(Source::Reference), "plots need the truth");
}

#[test]
fn every_source_and_view_can_be_looked_at() {
    let playing = ["move-object", "move-camera"].map(String::from).to_vec();
    let mut window = Window::open(SIZE, State { motion: Motion { playing, ..still() }, ..State::default() });
    for source in Source::SHOWN {
        window.state(|state| state.left = source);
        window.frames(2);
        let picture = window.picture(source);
        assert!(picture.texels.iter().any(|t| t[0] > 30), "{source:?}");
    }
    for &view in View::ALL {
        window.state(|state| {
            state.left = Source::Adaptive;
            state.view = view.name().into();
        });
        window.frames(1);
        // If there is no such view, the window shows the picture instead, with a note.
        let picture = window.picture(Source::Adaptive);
        let varied = picture.texels.iter().any(|t| *t != picture.texels[0]);
        // These frames have no faults, so these two views are black.
        let wrong = matches!(view, View::NonFinite | View::Outliers);
        assert_eq!(varied, !wrong, "{view:?}");
    }
}

#[test]
fn every_view_is_what_is_shown_where_something_shines() {
    let playing = ["move-object", "move-camera"].map(String::from).to_vec();
    let motion = Motion { playing, ..still() };
    let mut window = Window::open(SIZE, State { scene: "gloss".into(), motion, ..State::default() });
    window.frames(2);
    // The mean exists in Mode::Reference alone.
    for &view in View::ALL.iter().filter(|&&view| view != View::Mean) {
        window.state(|state| state.view = view.name().into());
        window.frames(1);
        let expected = window.expected(Source::Adaptive, view);
        let picture = window.picture(Source::Adaptive);
        assert!(picture.texels == expected.texels, "{view:?} is what is shown");
        // These frames have no faults, so these two views are black.
        let wrong = matches!(view, View::NonFinite | View::Outliers);
        let varied = picture.texels.iter().any(|t| *t != picture.texels[0]);
        assert!(varied || wrong, "{view:?}");
    }
}

#[test]
fn the_reference_converges_while_time_stands_still() {
    // Plots need two references, with noise of their own.
    let mut window = Window::open(SIZE, State { plots: true, ..paused() });
    // The squared difference of two independent means of n frames is twice the variance of one, divided by n.
    let scatter = |window: &Window| {
        let [a, b] = [Source::Reference, Source::Witness].map(|source| window.radiance(source));
        let squares = a.iter().flatten().zip(b.iter().flatten()).map(|(a, b)| (a - b).powi(2));
        squares.sum::<f32>() / a.len() as f32
    };
    let (count, before) = (window.demo().picture.embed.converged, scatter(&window));
    (0..20).for_each(|_| window.settle());
    let (more, after) = (window.demo().picture.embed.converged, scatter(&window));
    assert!(more > count + 10, "{more} frames");
    let (found, expected) = (before / after, more as f32 / count as f32);
    // A few bright paths carry much of the variance, so its estimate from one image is rough.
    assert!(found > 0.5 * expected && found < 2.0 * expected, "{found}, not {expected}");
}

#[test]
fn the_mouse_turns_the_camera_and_the_wheel_comes_nearer() {
    let mut window = Window::open(SIZE, State { split: false, ..paused() });
    let (eye, before) = (window.eye(), window.radiance(Source::Adaptive));
    window.drag([0.6, 0.5], [0.7, 0.55]);
    assert_ne!(window.eye(), eye);
    assert!(window.radiance(Source::Adaptive) != before, "the picture follows");
    let far = window.eye();
    window.wheel([0.5, 0.5], 100.0);
    assert_ne!(window.eye(), far);
}

#[test]
fn the_divider_is_dragged_and_the_camera_stays() {
    let mut window = Window::open(SIZE, paused());
    let eye = window.eye();
    window.drag([0.5, 0.5], [0.3, 0.5]);
    assert!((window.demo().state.divider - 0.3).abs() < 0.02, "{}", window.demo().state.divider);
    assert_eq!(window.eye(), eye);
}

#[test]
fn a_broken_file_is_named_and_the_old_scene_stays() {
    let mut window = Window::open(SIZE, paused());
    let before = window.radiance(Source::Adaptive);
    let broken = window.folder.file("broken.glb", b"this is not glTF");
    window.drop_file(&broken);
    assert!(window.harness.query_by_label_contains("broken.glb").is_some(), "a message");
    assert_eq!(window.demo().state.scene, "cornell");
    window.key(Key::R);
    assert!(mean(&window.radiance(Source::Adaptive)) > 0.5 * mean(&before));

    let missing = window.folder.path("missing.gltf");
    window.drop_file(&missing);
    assert!(window.harness.query_by_label_contains("missing.gltf").is_some(), "a message");
    window.harness.get_by_label("dismiss").click();
    window.settle();
    window.settle();
    assert!(window.harness.query_by_label_contains("missing.gltf").is_none(), "dismissed");

    let scene = window.folder.file("square.obj", b"v -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nf 1 2 3 4\n");
    window.drop_file(&scene);
    assert!(window.demo().state.scene.ends_with("square.obj"));
    assert!(mean(&window.radiance(Source::Adaptive)) > 0.01, "a sky lights what has no light");
}

#[test]
fn files_in_memory_are_opened_as_a_page_gets_them() {
    let mut window = Window::open(SIZE, paused());
    let mut receive = |files: &[(&str, &str)]| {
        let files = files.iter().map(|(name, text)| (name.into(), text.as_bytes().to_vec())).collect();
        window.demo_mut().act(Action::Receive(files));
        window.settle();
    };
    receive(&[
        ("square.obj", "mtllib red.mtl\nv -1 0 1\nv 1 0 1\nv 1 0 -1\nv -1 0 -1\nusemtl red\nf 1 2 3 4\n"),
        ("red.mtl", "newmtl red\nKd 0.8 0 0\n"),
    ]);
    let radiance = window.radiance(Source::Adaptive);
    assert_eq!(window.demo().state.scene, "square.obj");
    assert!(radiance.iter().any(|[red, green, _]| *red > 0.01 && *green < 0.01 * red), "red, under a sky");
    let mut receive = |name: &str, text: &str| {
        window.demo_mut().act(Action::Receive([(name.into(), text.as_bytes().to_vec())].into()));
        window.settle();
        window.demo().messages()
    };
    assert_eq!(
        receive("good.json", r#"{"left": "Noisy", "paused": true, "scene": "square.obj"}"#),
        "good.json was loaded"
    );
    for (name, text) in [("broken.glb", "this is not glTF"), ("wood.png", ""), ("bad.json", "{]")] {
        let messages = receive(name, text);
        assert!(messages.contains(name), "{messages}");
    }
    assert_eq!(window.demo().state.scene, "square.obj");
    assert_eq!(window.demo().state.left, Source::Noisy);
}

#[test]
fn what_was_chosen_can_be_loaded_and_a_broken_file_changes_nothing() {
    let mut window = Window::open(SIZE, paused());
    let good = window.folder.file("good.json", br#"{"left": "Noisy", "paused": true, "settings": {"iterations": 2}}"#);
    window.drop_file(&good);
    assert_eq!(window.demo().state.left, Source::Noisy);
    assert_eq!(window.demo().state.settings.filter.iterations, 2);
    let before = window.demo().state.clone();
    let bad = window.folder.file("bad.json", br#"{"left": "Noisy", "settings": {"iterations": 99}}"#);
    window.drop_file(&bad);
    assert!(window.harness.query_by_label_contains("bad.json").is_some(), "a message");
    assert_eq!(window.demo().state, before);
}

#[test]
fn any_size_will_do() {
    let mut window = Window::open(SIZE, paused());
    let before = window.demo().picture.embed.size;
    window.harness.set_size(vec2(700.0, 500.0));
    window.settle();
    window.settle();
    let after = window.demo().picture.embed.size;
    assert!(after[0] < before[0] && after[1] < before[1], "{before:?}, {after:?}");
    assert!(mean(&window.radiance(Source::Adaptive)) > 0.01, "a frame of the new size");
    // A minimised window has no room for the picture at all.
    window.harness.set_size(vec2(0.0, 0.0));
    window.settle();
    window.harness.set_size(vec2(700.0, 500.0));
    window.settle();
    window.settle();
    let again = window.demo().picture.embed.size;
    assert!(again.iter().all(|&side| side > 8), "{again:?}");
    assert!(mean(&window.radiance(Source::Adaptive)) > 0.01);
}

#[test]
fn a_lost_device_is_told() {
    let mut window = Window::open(SIZE, paused());
    window.gpu.device.destroy();
    window.gpu.device.poll(asvgf::wgpu::PollType::Poll).ok();
    window.harness.run_steps(3);
    assert!(window.harness.query_by_label_contains("the GPU was lost").is_some(), "a message");
}

#[test]
fn pictures_are_written() {
    let mut window = Window::open(SIZE, State { split: false, ..paused() });
    let shown = window.picture(Source::Adaptive);
    for name in ["picture.png", "picture.exr"] {
        let path = window.folder.path(name);
        window.demo_mut().picture.wanted_file = Some(path.clone());
        window.settle();
        window.settle();
        assert!(path.exists(), "{name}");
    }
    let (width, height, texels) = asvgf::image_io::read_png(window.folder.path("picture.png")).unwrap();
    assert_eq!([width, height], shown.size);
    assert!(texels == shown.texels, "the file holds what is shown");
}

#[test]
fn a_split_picture_is_written_with_both_halves() {
    // The halves differ most when the lamps have just gone out.
    let mut window = Window::open(SIZE, State { split: true, divider: 0.3, ..State::default() });
    window.until(LIT + 3);
    window.state(|state| state.paused = true);
    window.settle();
    for name in ["split.png", "split.exr"] {
        window.demo_mut().picture.wanted_file = Some(window.folder.path(name));
        window.settle();
        window.settle();
    }
    let halves = [Source::Adaptive, Source::Constant];
    let films = halves.map(|source| window.picture(source));
    let width = films[0].size[0] as usize;
    let divider = (0.3 * width as f32).round() as usize;
    let half = |texel: usize| usize::from(texel % width >= divider);
    let (.., texels) = asvgf::image_io::read_png(window.folder.path("split.png")).unwrap();
    for (i, texel) in texels.into_iter().enumerate() {
        let expected = if i % width == divider { [255; 4] } else { films[half(i)].texels[i] };
        assert_eq!(texel, expected, "texel {} of row {}", i % width, i / width);
    }
    let numbers = asvgf::image_io::read_exr(window.folder.path("split.exr")).unwrap();
    let radiance = halves.map(|source| window.radiance(source));
    let expected: Vec<f32> = (0..width * films[0].size[1] as usize).map(|i| radiance[half(i)][i][1]).collect();
    assert!(numbers.get("G").unwrap() == expected, "numbers have no divider");
    assert!(radiance[0] != radiance[1]);
}
