//! Frames that see later ones, cuts, wrong motion, and albedos that are noise.

use crate::folder::{Folder, Frames, add, random, wall};
use asvgf::Settings;
use asvgf_programs::denoise::clean_albedo;
use asvgf_programs::denoise::look_ahead::{self, Ahead, Denoised};
use asvgf_programs::film::Film;
use asvgf_programs::gpu::Gpu;
use asvgf_programs::sequence::camera::{Camera, Raster};
use asvgf_programs::sequence::layers::Layer;
use asvgf_programs::sequence::motion::{READINGS, complaint, readings};
use asvgf_programs::sequence::pixels::Area;
use asvgf_programs::sequence::surfaces::surfaces;
use asvgf_programs::sequence::{Pixels, Sequence};

const SIZE: [u32; 2] = [36, 24];

fn settings() -> Settings {
    let mut settings = Settings::adaptive();
    settings.filter.gradient = asvgf::Gradient::Statistics;
    settings
}

fn denoised(sequence: &Sequence, ahead: bool) -> (Vec<Vec<[f32; 3]>>, Denoised) {
    let gpu = Gpu::new().unwrap();
    let mut film = Film::new(&gpu, sequence.size, settings()).unwrap();
    let backwards = ahead.then(|| Ahead { settings: look_ahead::settings(&settings()), smooth_edges: true });
    let mut frames = Vec::new();
    let told = look_ahead::denoise(&mut film, backwards.as_ref(), sequence, &mut Frames(&mut frames));
    (frames, told.unwrap())
}

/// Writes a wall of radiance `light(frame)` with exponential noise.
fn lit(folder: &Folder, frames: u32, light: &dyn Fn(u32) -> f32) {
    for frame in 0..frames {
        let mut image = wall(SIZE);
        for (_, samples) in image.channels.iter_mut().take(3) {
            for (i, x) in samples.iter_mut().enumerate() {
                *x = -light(frame) * (1.0 - random(i as u32, frame)).ln();
            }
        }
        folder.write(frame, &image);
    }
}

/// Returns the mean squared error over the squared light.
fn error(frame: &[[f32; 3]], light: f32) -> f64 {
    let square = |c: &[f32; 3]| f64::from((c[0] - light) / light).powi(2);
    frame.iter().map(square).sum::<f64>() / frame.len() as f64
}

#[test]
fn a_frame_sees_what_comes_after_it() {
    let folder = Folder::new();
    lit(&folder, 10, &|_| 1.0);
    let sequence = folder.open().unwrap();
    let (past, both) = (denoised(&sequence, false).0, denoised(&sequence, true).0);
    let (alone, seen) = (error(&past[0], 1.0), error(&both[0], 1.0));
    println!("the first frame alone {alone:.5}, with nine after it {seen:.5}");
    assert!(seen < 0.6 * alone);
    let sum = |frames: &[Vec<[f32; 3]>]| frames.iter().map(|frame| error(frame, 1.0)).sum::<f64>();
    assert!(sum(&both) < 0.9 * sum(&past), "{} of {}", sum(&both), sum(&past));
    // The last frame has no future: its estimate is that of its past.
    let last: f64 = both[9].iter().zip(&past[9]).map(|(a, b)| f64::from((a[0] - b[0]).abs())).sum();
    assert!(last / (36.0 * 24.0) < 0.02, "{last}");
}

/// After a change of the light, the past does not know the new light, and the future does; before it, the other way
/// round.
#[test]
fn neither_past_nor_future_lights_the_other() {
    let folder = Folder::new();
    let light = |frame: u32| if frame < 6 { 4.0 } else { 1.0 };
    lit(&folder, 12, &light);
    let (frames, told) = denoised(&folder.open().unwrap(), true);
    for (i, frame) in frames.iter().enumerate() {
        let mean = frame.iter().map(|c| f64::from(c[0])).sum::<f64>() / frame.len() as f64;
        let expected = f64::from(light(i as u32));
        assert!((mean / expected - 1.0).abs() < 0.1, "frame {i}: {mean:.3} is not {expected}");
    }
    assert!(told.cuts.is_empty() && told.complaint.is_none());
}

/// Two shots of different surfaces: the second begins anew, and the program says so.
#[test]
fn cuts_are_found() {
    let folder = Folder::new();
    for frame in 0..6 {
        let mut image = wall(SIZE);
        let (light, depth) = if frame < 3 { (0.9, 1.0) } else { (0.1, 7.0) };
        image.channels.iter_mut().take(3).for_each(|(_, samples)| samples.fill(light));
        image.channels.last_mut().unwrap().1.fill(depth);
        folder.write(frame, &image);
    }
    let (frames, told) = denoised(&folder.open().unwrap(), true);
    assert_eq!(told.cuts, [3]);
    for (i, frame) in frames.iter().enumerate() {
        let light = if i < 3 { 0.9 } else { 0.1 };
        assert!(frame.iter().all(|c| (c[0] - light).abs() < 2e-3), "frame {i}: {:?}", frame[0]);
    }
}

/// Returns bars of many depths and directions that move by a vector, and the frame before.
fn moving_bars(by: [i32; 2]) -> [Pixels; 2] {
    let frame = |by: [i32; 2]| {
        let mut pixels = Pixels(vec![None; Layer::ALL.len()]);
        let places = (0..SIZE[1] as i32).flat_map(|y| (0..SIZE[0] as i32).map(move |x| [x - by[0], y - by[1]]));
        let cell = |[x, y]: [i32; 2]| random((x.div_euclid(4) * 91 + y.div_euclid(4) * 7919) as u32, 3);
        pixels.set(Layer::Depth, Some(places.clone().map(|p| 1.0 + 9.0 * cell(p)).collect()));
        let normal = |p| if cell(p) < 0.5 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
        pixels.set(Layer::Normal, Some(places.flat_map(normal).collect()));
        pixels
    };
    [frame(by), frame([0, 0])]
}

/// A wrong sign, axis or unit of motion is named, and right motion causes no complaint.
#[test]
fn motion_that_leads_astray_is_told() {
    let by = [5, 4];
    let [now, before] = moving_bars(by);
    let raster = Raster::whole(SIZE);
    let count = (SIZE[0] * SIZE[1]) as usize;
    let right = [-by[0] as f32, -by[1] as f32];
    let told = |vector: [f32; 2]| complaint(&readings(&now, &before, &vector.repeat(count), raster));
    assert_eq!(told(right), None);
    let [width, height] = SIZE.map(|side| side as f32);
    let [x, y] = right;
    let wrong = [
        [x, -y],
        [-x, -y],
        [-x, y],
        [y, x],
        [x / 2.0, y / 2.0],
        [2.0 * x, 2.0 * y],
        [x / width, y / height],
        [2.0 * x / width, 2.0 * y / height],
        [2.0 * x / width, -2.0 * y / height],
    ];
    for (vector, (reading, _)) in wrong.into_iter().zip(READINGS) {
        let told = told(vector).expect(reading);
        assert!(told.contains(reading), "{vector:?}: «{told}» is not «{reading}»");
    }
    let told = told([11.0, 5.0]).expect("nothing fits");
    assert!(told.contains("its sign, its unit or its axis is wrong"), "{told}");
}

/// An albedo as a function of the frame and of the place on the surface.
type Albedo<'a> = &'a dyn Fn(u32, f32, f32) -> f32;

/// Returns the part of a surface that counts as noise.
fn noise(albedo: Albedo<'_>, motion: [f32; 2]) -> f32 {
    let frame = |number: u32| {
        let mut pixels = Pixels(vec![None; Layer::ALL.len()]);
        let count = (SIZE[0] * SIZE[1]) as usize;
        pixels.set(Layer::Depth, Some(vec![2.0; count]));
        pixels.set(Layer::Normal, Some([0.0, 0.0, 1.0].repeat(count)));
        let value = |i: usize| {
            let place = [i as u32 % SIZE[0], i as u32 / SIZE[0]].map(|x| x as f32);
            // The surface has moved on since the first frame.
            let at = [0, 1].map(|k| place[k] + number as f32 * motion[k]);
            [albedo(number * count as u32 + i as u32, at[0], at[1]); 3]
        };
        pixels.set(Layer::Albedo, Some((0..count).flat_map(value).collect()));
        pixels
    };
    let (before, now) = (frame(0), frame(1));
    let vectors = motion.repeat((SIZE[0] * SIZE[1]) as usize);
    let parts = clean_albedo::noise(
        &now,
        now.get(Layer::Albedo).unwrap(),
        Some(&before),
        &vectors,
        &surfaces(&now, SIZE),
        SIZE,
    );
    parts.iter().sum::<f32>() / parts.len() as f32
}

#[test]
fn textures_are_told_from_noise() {
    let checks = |_: u32, x: f32, y: f32| {
        let square = ((x / 5.0).floor() + (y / 5.0).floor()) as i32;
        if square.rem_euclid(2) == 0 { 0.8_f32 } else { 0.0 }
    };
    let waves = |_: u32, x: f32, y: f32| 0.5 + 0.4 * (0.7 * x).sin() * (0.5 * y).cos();
    let lines = |_: u32, x: f32, _: f32| if (x as i32).rem_euclid(6) == 0 { 0.0 } else { 0.9 };
    for motion in [[0.0, 0.0], [1.3, -0.6], [-0.4, 0.2]] {
        for (name, texture) in [("checks", &checks as Albedo<'_>), ("waves", &waves)] {
            let part = noise(texture, motion);
            assert!(part < 0.01, "{name} that move by {motion:?}: {part} of them is taken for noise");
        }
    }
    let part = noise(&lines, [0.0, 0.0]);
    assert!(part < 0.01, "lines of ink: {part}");
    let paths: [(&str, Albedo<'_>); 3] = [
        ("any", &|i, _, _| random(i, 1)),
        ("nothing in one of ten", &|i, _, _| if random(i, 2) < 0.1 { 0.0 } else { 0.7 }),
        ("above 1 in one of twenty", &|i, _, _| if random(i, 3) < 0.05 { 4.0 } else { 0.7 }),
    ];
    for (name, albedo) in paths {
        let part = noise(albedo, [0.3, 0.1]);
        assert!(part > 0.03, "{name}: {part}");
    }
}

/// A metal whose albedo comes from single paths: radiance and albedo have the same zeros and peaks.
#[test]
fn a_noisy_albedo_leaves_no_holes() {
    let folder = Folder::new();
    for frame in 0..8 {
        let mut image = wall(SIZE);
        add(&mut image, Layer::Albedo, &[0.5; 3]);
        let paths: Vec<f32> = (0..SIZE[0] * SIZE[1])
            .map(|i| match random(i, frame) {
                x if x < 0.15 => 0.0,
                x if x > 0.97 => 5.0,
                x => x,
            })
            .collect();
        let light: Vec<f32> = (0..SIZE[0] * SIZE[1]).map(|i| -(1.0 - random(i, 100 + frame)).ln()).collect();
        for (name, samples) in &mut image.channels {
            let of_albedo = name.starts_with("albedo");
            if of_albedo || !name.contains('.') {
                samples
                    .iter_mut()
                    .enumerate()
                    .for_each(|(i, x)| *x = paths[i] * if of_albedo { 1.0 } else { light[i] });
            }
        }
        folder.write(frame, &image);
    }
    let (frames, _) = denoised(&folder.open().unwrap(), true);
    // ∫ x over 0.15…0.97, and 3 % of 5.
    let expected = 0.5 * (0.97 * 0.97 - 0.15 * 0.15) + 0.15;
    let mean = |frame: &[[f32; 3]]| frame.iter().map(|c| f64::from(c[0])).sum::<f64>() / frame.len() as f64;
    for (i, frame) in frames.iter().enumerate() {
        let dark = frame.iter().filter(|c| c[0] < 0.5 * expected).count();
        let off = mean(frame) / f64::from(expected) - 1.0;
        println!("frame {i}: {:+.1} %, {dark} dark pixels", 100.0 * off);
        assert!(off.abs() < 0.15 && dark <= 1);
    }
}

/// Without guides the filter has less information, and still yields a picture: noise goes, borders of light stay.
#[test]
fn colours_alone_are_denoised() {
    let folder = Folder::new();
    let side = |i: usize| if i as u32 % SIZE[0] < SIZE[0] / 2 { 1.0 } else { 8.0 };
    for frame in 0..8 {
        let mut image = wall(SIZE);
        image.channels.truncate(3);
        for (_, samples) in &mut image.channels {
            for (i, x) in samples.iter_mut().enumerate() {
                *x = side(i) * (0.5 + random(i as u32, frame));
            }
        }
        folder.write(frame, &image);
    }
    let sequence = folder.open().unwrap();
    assert!(sequence.layers == [Layer::Color] && !sequence.has_surfaces());
    let (frames, _) = denoised(&sequence, true);
    let relative = |i: usize, c: f32| f64::from(c / side(i) - 1.0).abs();
    let border = |i: &usize| (SIZE[0] / 2 - 1..=SIZE[0] / 2).contains(&(*i as u32 % SIZE[0]));
    let beside = (0..frames[4].len()).filter(border).map(|i| relative(i, frames[4][i][0])).sum::<f64>() / 48.0;
    let mean = frames[4].iter().enumerate().map(|(i, c)| relative(i, c[0])).sum::<f64>() / frames[4].len() as f64;
    println!("noise of 0.25 becomes {mean:.3}, and {beside:.3} beside the border");
    assert!(mean < 0.05 && beside < 0.5);
}

/// Normals made from depths are those of the surfaces.
#[test]
fn normals_are_made_of_depths() {
    let folder = Folder::new();
    let mut image = wall(SIZE);
    let raster = Raster::whole(SIZE);
    let camera = Camera::at_rest(1.0, raster);
    // Two planes that meet in the middle.
    let n = |i: u32| if i % SIZE[0] < SIZE[0] / 2 { [0.6, 0.0, 0.8] } else { [0.0, -0.6, 0.8] };
    let depth = |i: u32| {
        let ray = camera.position([i % SIZE[0], i / SIZE[0]], 1.0, raster);
        let along: f64 = (0..3).map(|k| ray[k] * n(i)[k]).sum();
        (-2.0 / along) as f32
    };
    image.channels.retain(|(name, _)| !name.starts_with("normal"));
    image.channels.last_mut().unwrap().1 = (0..SIZE[0] * SIZE[1]).map(depth).collect();
    folder.write(0, &image);
    let source = asvgf_programs::sequence::Source {
        fov_y: Some(1.0),
        ..asvgf_programs::sequence::Source::from(folder.0.as_path())
    };
    let pixels = Sequence::open(source, |_| {}).unwrap().read(0).unwrap();
    let normals = pixels.get(Layer::Normal).unwrap();
    // At the border, either normal will do.
    for i in (0..SIZE[0] * SIZE[1]).filter(|i| !(17..=18).contains(&(i % SIZE[0]))) {
        let cosine: f64 = (0..3).map(|k| f64::from(normals[3 * i as usize + k]) * n(i)[k]).sum();
        assert!(cosine > 0.999, "pixel {i}: {:?}", &normals[3 * i as usize..][..3]);
    }
}

/// A surface whose albedo is black where it shines, and white where it does not: the albedo is not used. Dark ink stays
/// ink.
#[test]
fn an_albedo_that_the_light_belies_is_not_used() {
    let folder = Folder::new();
    let shines = |i: usize| (i as u32 % SIZE[0]) < SIZE[0] / 2;
    let frames = |belied: bool| {
        for frame in 0..8 {
            let mut image = wall(SIZE);
            add(&mut image, Layer::Albedo, &[0.0; 3]);
            for (name, samples) in &mut image.channels {
                for (i, x) in samples.iter_mut().enumerate() {
                    let light = 0.5 + random(i as u32, frame);
                    let (black, bright) = if belied { (shines(i), shines(i)) } else { (!shines(i), shines(i)) };
                    match name.as_str() {
                        "albedo.R" | "albedo.G" | "albedo.B" => *x = if black { 0.0 } else { 1.0 },
                        "R" | "G" | "B" => *x = if bright { light } else { 0.0 },
                        _ => {}
                    }
                }
            }
            folder.write(frame, &image);
        }
        denoised(&folder.open().unwrap(), true).0
    };
    for belied in [true, false] {
        for (number, frame) in frames(belied).iter().enumerate() {
            let off = |i: usize| f64::from((frame[i][0] - if shines(i) { 1.0 } else { 0.0 }).abs());
            // Pixels away from the border, which only the light reveals.
            let inner = (0..frame.len()).filter(|i| (i % 36).abs_diff(18) > 4);
            let worst = inner.map(off).fold(0.0, f64::max);
            println!("{belied}: frame {number} is off by {worst:.3} at most");
            assert!(worst < 0.35, "frame {number}: {worst}");
        }
    }
}

/// Checks finer than pixels, seen at another place in each frame: each frame is black or white, all together are grey.
#[test]
fn edges_are_as_the_whole_pixel_shows_them() {
    let folder = Folder::new();
    let white = |i: u32, frame: u32| (i % SIZE[0] + i / SIZE[0] + frame).is_multiple_of(2);
    for frame in 0..7 {
        let mut image = wall(SIZE);
        add(&mut image, Layer::Albedo, &[0.0; 3]);
        for (name, samples) in &mut image.channels {
            let values = samples.iter_mut().enumerate().map(|(i, x)| (x, white(i as u32, frame)));
            match name.as_str() {
                "albedo.R" | "albedo.G" | "albedo.B" | "R" | "G" | "B" => {
                    values.for_each(|(x, w)| *x = if w { 0.8 } else { 0.2 })
                }
                _ => {}
            }
        }
        folder.write(frame, &image);
    }
    let sequence = folder.open().unwrap();
    let contrast = |frame: &[[f32; 3]]| (f64::from(frame[100][0]) - f64::from(frame[101][0])).abs();
    let (alone, seen) = (denoised(&sequence, false).0, denoised(&sequence, true).0);
    assert!(contrast(&alone[3]) > 0.5, "{}", contrast(&alone[3]));
    // (3 + 2·1)·0.8 and 2·2·0.2, over 9, and the other way round: 0.6/9 apart.
    assert!(contrast(&seen[3]) < 0.1, "{}", contrast(&seen[3]));
    let mean = seen[3].iter().map(|c| f64::from(c[0])).sum::<f64>() / seen[3].len() as f64;
    assert!((mean - 0.5).abs() < 0.02, "{mean}");
}

/// A floor whose depths belong to the pixels' middles, or to any points in them.
#[test]
fn points_all_over_the_pixels_are_noticed() {
    for (scatter, expected) in [(0.0, None), (0.3, Some(Area::Scattered)), (1.0, Some(Area::Scattered))] {
        let folder = Folder::new();
        for frame in 0..2 {
            let mut image = wall(SIZE);
            for (name, samples) in &mut image.channels {
                for (i, x) in samples.iter_mut().enumerate() {
                    let row = (i as u32 / SIZE[0]) as f32 + 0.5 + scatter * (random(i as u32, frame) - 0.5);
                    match name.as_str() {
                        "normal.Y" => *x = 1.0,
                        "normal.Z" => *x = 0.0,
                        // A floor below the horizon, which is above the image.
                        "depth.Z" => *x = 40.0 / (row + 10.0),
                        _ => {}
                    }
                }
            }
            folder.write(frame, &image);
        }
        assert_eq!(folder.open().unwrap().area, expected, "{scatter}");
    }
}

/// A few pixels of a lit wall whose albedo is black, or below it, as pixel filters make it: they shine no more than the
/// others.
#[test]
fn a_lone_black_albedo_does_not_shine() {
    for black in [0.0, -0.01] {
        let folder = Folder::new();
        let is_black = |i: usize| i % 97 == 40;
        for frame in 0..6 {
            let mut image = wall(SIZE);
            add(&mut image, Layer::Albedo, &[0.7; 3]);
            for (name, samples) in &mut image.channels {
                for (i, x) in samples.iter_mut().enumerate() {
                    match name.as_str() {
                        "albedo.R" | "albedo.G" | "albedo.B" if is_black(i) => *x = black,
                        "R" | "G" | "B" => *x = 0.7 * (0.5 + random(i as u32, frame)),
                        _ => {}
                    }
                }
            }
            folder.write(frame, &image);
        }
        for (number, frame) in denoised(&folder.open().unwrap(), true).0.iter().enumerate() {
            let worst = frame.iter().map(|c| (c[0] / 0.7 - 1.0).abs()).fold(0.0, f32::max);
            assert!(worst < 0.3, "albedo {black}, frame {number}: off by {worst}");
        }
    }
}

/// Impossible motion of a few pixels costs only these.
#[test]
fn motion_out_of_all_bounds_is_borne() {
    let folder = Folder::new();
    for frame in 0..3 {
        let mut image = wall(SIZE);
        add(&mut image, Layer::Motion, &[0.0; 2]);
        for (k, value) in [-1e30, 1e30, f32::NAN, f32::INFINITY, f32::NEG_INFINITY].into_iter().enumerate() {
            let motion = image.channels.iter_mut().filter(|(name, _)| name.starts_with("motion"));
            motion.for_each(|(_, samples)| samples[100 + 7 * k] = value);
        }
        folder.write(frame, &image);
    }
    let (frames, told) = denoised(&folder.open().unwrap(), true);
    assert!(told.cuts.is_empty() && frames.iter().flatten().all(|c| (c[0] - 0.5).abs() < 1e-3));
}
