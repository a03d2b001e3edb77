//! The same frames in other forms: irrelevant differences change nothing, to the last bit.

use crate::folder::Folder;
use asvgf::image_io::{Channels, Compression, ExrFile, SampleType, Window, write_exr};
use asvgf_programs::sequence::layers::{Layer, Mapping, Meaning};
use asvgf_programs::sequence::{Break, Sequence, Source};
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, IntegerBounds, Layer as Part, LayerAttributes, Vec2,
    WritableImage as _,
};
use proptest::prelude::*;
use std::fs;
use std::path::Path;

const SIZE: [u32; 2] = [9, 7];

/// Returns the sample of a channel of the format in a frame.
fn sample(channel: usize, frame: u32, i: usize) -> f32 {
    let noise = ((i as u32 * 7 + frame * 31 + channel as u32 * 13) % 29) as f32 / 29.0;
    match channel {
        // The normal, unit and towards the camera.
        6 | 7 => 0.0,
        8 => 1.0,
        9 => 2.0 + (i % SIZE[0] as usize) as f32 * 0.125,
        10 | 11 => 0.25 * frame as f32,
        _ => 0.25 + 0.5 * noise,
    }
}

const CHANNELS: [&str; 12] = [
    "R", "G", "B", "albedo.R", "albedo.G", "albedo.B", "normal.X", "normal.Y", "normal.Z", "depth.Z", "motion.X",
    "motion.Y",
];

fn samples(channel: usize, frame: u32) -> Vec<f32> {
    (0..(SIZE[0] * SIZE[1]) as usize).map(|i| sample(channel, frame, i)).collect()
}

fn plain(frame: u32) -> Channels {
    let channels = CHANNELS.iter().enumerate().map(|(c, name)| ((*name).to_owned(), samples(c, frame))).collect();
    Channels { width: SIZE[0], height: SIZE[1], channels }
}

const FRAMES: u32 = 3;

fn plain_folder() -> Folder {
    let folder = Folder::new();
    (0..FRAMES).for_each(|frame| folder.write(frame, &plain(frame)));
    folder
}

/// Reads every layer's samples in every frame, cut out of the window of the frame's own file.
fn read(sequence: &Sequence) -> Vec<Vec<Option<Vec<f32>>>> {
    let cut = |index: usize| {
        let window = sequence.file(index).unwrap().data_window();
        let pixels = sequence.read(index).unwrap();
        let layers = Layer::ALL.into_iter().map(|layer| {
            let count = layer.components().len();
            let samples = pixels.get(layer)?;
            let channel = |c: usize| samples.iter().skip(c).step_by(count).copied().collect::<Vec<f32>>();
            Some((0..count).flat_map(|c| sequence.window.place(&channel(c), window, f32::NAN)).collect())
        });
        layers.collect()
    };
    (0..sequence.frames()).map(cut).collect()
}

/// Names that renderers give to the layers, as prefixes of the components, with or without inverted motion.
#[derive(Clone, Copy, Debug)]
enum Naming {
    Own,
    Blender(&'static str),
    BlenderWithNoisyImage,
    LowerCase,
}

fn name(naming: Naming, channel: usize) -> String {
    let own = CHANNELS[channel];
    let (layer, component) = own.rsplit_once('.').unwrap_or(("", own));
    let blender = |front: &str| {
        let layer = match layer {
            "" => "Combined",
            "albedo" => "Denoising Albedo",
            "normal" => "Normal",
            "depth" => "Depth",
            _ => "Vector",
        };
        format!("{front}.{layer}.{component}")
    };
    match naming {
        Naming::Own => own.to_owned(),
        Naming::Blender(front) => blender(front),
        Naming::BlenderWithNoisyImage => blender("View Layer.001").replace("Combined", "Noisy Image"),
        Naming::LowerCase => own.to_lowercase(),
    }
}

/// True if this naming's motion points up.
fn upwards(naming: Naming, channel: usize) -> bool {
    channel == 11 && matches!(naming, Naming::Blender(_) | Naming::BlenderWithNoisyImage)
}

#[derive(Clone, Debug)]
struct Form {
    naming: Naming,
    /// One part for each layer, in the order of this number; else one part.
    parts: Option<usize>,
    window: [i32; 2],
    compression: exr::prelude::Compression,
    tiles: bool,
    /// Layers of another view layer, or of the compositor, in front.
    decoys: bool,
}

fn forms() -> impl Strategy<Value = Form> {
    use exr::prelude::Compression as C;
    let naming = prop_oneof![
        Just(Naming::Own),
        Just(Naming::Blender("ViewLayer")),
        Just(Naming::Blender("Main")),
        Just(Naming::BlenderWithNoisyImage),
        Just(Naming::LowerCase)
    ];
    let compression = prop_oneof![Just(C::Uncompressed), Just(C::RLE), Just(C::ZIP1), Just(C::ZIP16), Just(C::PIZ)];
    let window = [-20..20, -20..20];
    (naming, proptest::option::of(0..24_usize), window, compression, any::<bool>(), any::<bool>()).prop_map(
        |(naming, parts, window, compression, tiles, decoys)| Form {
            naming,
            parts,
            window,
            compression,
            tiles,
            decoys,
        },
    )
}

fn write(path: &Path, form: &Form, frame: u32) {
    let channel = |c: usize| {
        let samples = samples(c, frame);
        let turned = samples.iter().map(|x| if upwards(form.naming, c) { -x } else { *x }).collect();
        AnyChannel::new(name(form.naming, c).as_str(), FlatSamples::F32(turned))
    };
    let mut channels: Vec<AnyChannel<FlatSamples>> = (0..CHANNELS.len()).map(channel).collect();
    if form.decoys {
        let decoy = |name: &str| AnyChannel::new(name, FlatSamples::F32(vec![9.0; (SIZE[0] * SIZE[1]) as usize]));
        channels.extend(["R", "G", "B"].map(|c| decoy(&format!("Composite.Combined.{c}"))));
        channels.extend(["X", "Y", "Z"].map(|c| decoy(&format!("Aux.Normal.{c}"))));
        if matches!(form.naming, Naming::BlenderWithNoisyImage) {
            channels.extend(["R", "G", "B"].map(|c| decoy(&format!("View Layer.001.Combined.{c}"))));
        }
    }
    let mut groups: Vec<(String, Vec<AnyChannel<FlatSamples>>)> = Vec::new();
    for channel in channels {
        let full = channel.name.to_string();
        let group = match form.parts {
            Some(_) => full.rsplit_once('.').map_or("rgba", |(front, _)| front).to_owned(),
            None => String::new(),
        };
        match groups.iter_mut().find(|(name, _)| *name == group) {
            Some((_, list)) => list.push(channel),
            None => groups.push((group, vec![channel])),
        }
    }
    let turns = form.parts.unwrap_or(0) % groups.len();
    groups.rotate_left(turns);
    let blocks = if form.tiles { exr::prelude::Blocks::Tiles(Vec2(4, 4)) } else { exr::prelude::Blocks::ScanLines };
    let encoding = Encoding { compression: form.compression, blocks, ..Encoding::UNCOMPRESSED };
    let part = |(name, channels): (String, Vec<AnyChannel<FlatSamples>>)| {
        let mut attributes = LayerAttributes::default();
        if !name.is_empty() {
            attributes = LayerAttributes::named(name.as_str());
        }
        attributes.layer_position = Vec2(form.window[0] + 40, form.window[1] + 40);
        let size = Vec2(SIZE[0] as usize, SIZE[1] as usize);
        Part::new(size, attributes, encoding, AnyChannels::sort(channels.into_iter().collect()))
    };
    let shared = exr::meta::header::ImageAttributes::new(IntegerBounds::from_dimensions((99, 87)));
    let image =
        Image { attributes: shared, layer_data: groups.into_iter().map(part).collect::<exr::prelude::Layers<_>>() };
    image.write().to_file(path).unwrap();
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 48, failure_persistence: None, ..ProptestConfig::default() })]

    /// Varies names, parts, their order, windows, compressions, tiles, and other view layers beside.
    #[test]
    fn the_form_of_files_does_not_matter(form in forms()) {
        let expected = read(&plain_folder().open().unwrap());
        let folder = Folder::new();
        for frame in 0..FRAMES {
            write(&folder.0.join(format!("shot.{:04}.exr", 1001 + frame)), &form, frame);
        }
        let sequence = folder.open().unwrap();
        let picture = sequence.raster.picture;
        prop_assert_eq!((sequence.size, picture), (SIZE, [99, 87]));
        prop_assert_eq!(sequence.raster.offset, form.window.map(|x| x + 40));
        prop_assert_eq!(read(&sequence), expected);
    }
}

/// A moving crop is one picture: pixels outside of a frame's window are no surface.
#[test]
fn crops_lie_in_one_picture() {
    let folder = Folder::new();
    let form = |x| Form {
        naming: Naming::Own,
        parts: None,
        window: [x, 0],
        compression: exr::prelude::Compression::ZIP16,
        tiles: false,
        decoys: false,
    };
    (0..FRAMES).for_each(|frame| write(&folder.0.join(format!("{frame}.exr")), &form(2 * frame as i32), frame));
    let sequence = folder.open().unwrap();
    assert_eq!(sequence.window, Window { position: [40, 40], size: [SIZE[0] + 4, SIZE[1]] });
    assert_eq!(read(&sequence), read(&plain_folder().open().unwrap()));
    let depth = sequence.read(1).unwrap().get(Layer::Depth).unwrap().to_vec();
    let row: Vec<bool> = depth[..SIZE[0] as usize + 4].iter().map(|z| *z > 0.0).collect();
    let expected: Vec<bool> = (0..SIZE[0] + 4).map(|x| (2..SIZE[0] + 2).contains(&x)).collect();
    assert_eq!(row, expected);
}

#[test]
fn file_names_are_read_as_people_write_them() {
    let names = |names: &[&str]| {
        let folder = Folder::new();
        names.iter().for_each(|name| write_exr(folder.0.join(name), &plain(0)).unwrap());
        folder
    };
    for list in [
        ["0001.exr", "0002.exr", "0003.exr"],
        ["shot.1001.exr", "shot.1002.exr", "shot.1003.exr"],
        ["frame_00001.exr", "frame_00002.exr", "frame_00003.exr"],
        ["cam2_9_v03.exr", "cam2_10_v03.exr", "cam2_11_v03.exr"],
        ["a-1.EXR", "a-2.EXR", "a-10.EXR"],
    ] {
        let folder = names(&list);
        let sequence = folder.open().unwrap();
        let found: Vec<_> =
            sequence.files.iter().map(|file| file.path.file_name().unwrap().to_str().unwrap()).collect();
        assert_eq!(found, list);
    }
    // Results and references beside the frames are no frames.
    let folder = names(&["0001.exr", "0002.exr", "denoised_0001.exr", "reference_0001.exr"]);
    assert_eq!(folder.open().unwrap().frames(), 2);
    let outputs = asvgf_programs::denoise::options::OUTPUTS.map(|(name, _)| name);
    for name in outputs.into_iter().chain(asvgf::View::ALL.iter().map(|view| view.name())) {
        let folder = names(&["0001.exr", "0002.exr", &format!("{name}_0001.exr"), &format!("{name}_0002.exr")]);
        assert_eq!(folder.open().unwrap().frames(), 2, "{name}");
    }
    // A folder with two sequences needs a pattern or one of the frames to name one.
    let folder = names(&["a.1.exr", "a.2.exr", "b.7.exr"]);
    let error = folder.open().unwrap_err().to_string();
    assert!(error.contains("has several sequences, a.####.exr (2), b.####.exr (1)"), "{error}");
    for input in ["a.####.exr", "a.2.exr"] {
        assert_eq!(Sequence::open(folder.0.join(input).as_path(), |_| {}).unwrap().frames(), 2);
    }
    // For names with several numbers, a pattern or a file determines the frame's number. Hidden files are no frames.
    let grid = ["cam1_1.exr", "cam1_2.exr", "cam2_1.exr", "cam2_2.exr", "cam3_1.exr", "cam3_2.exr", "._cam1_1.exr"];
    let folder = names(&grid);
    for input in ["cam1_####.exr", "cam1_1.exr"] {
        let sequence = Sequence::open(folder.0.join(input).as_path(), |_| {}).unwrap();
        assert_eq!(sequence.files.iter().map(|file| file.number).collect::<Vec<_>>(), [1, 2], "{input}");
    }
    let numbers = |list: &[&str]| {
        let sequence = names(list).open().unwrap();
        sequence.files.iter().map(|file| file.number).collect::<Vec<_>>()
    };
    assert_eq!(numbers(&["f_-002.exr", "f_-001.exr", "f_0000.exr", "f_0001.exr"]), [-2, -1, 0, 1]);
    assert_eq!(numbers(&["take-1.exr", "take-2.exr"]), [1, 2]);
    assert_eq!(numbers(&["noisy_0001.exr", "noisy_0002.exr"]), [1, 2], "the only ones that there are");
    let folder = names(&["a_01.exr", "a_1.exr"]);
    assert!(folder.open().unwrap_err().to_string().contains("is frame 1, and so is"));
}

#[test]
fn gaps_and_cuts_begin_anew() {
    let folder = Folder::new();
    let write = |numbers: &[u32]| {
        let _ = fs::remove_dir_all(&folder.0);
        fs::create_dir_all(&folder.0).unwrap();
        numbers.iter().for_each(|&number| folder.write(number, &plain(0)));
    };
    write(&[0, 1, 2, 4, 5]);
    let sequence = folder.open().unwrap();
    assert_eq!((sequence.step, sequence.breaks.as_slice()), (1, [None, None, None, Some(Break::Gap), None].as_slice()));
    // On twos, nothing is missing.
    write(&[1, 3, 5, 9]);
    let sequence = folder.open().unwrap();
    assert_eq!((sequence.step, sequence.breaks.as_slice()), (2, [None, None, None, Some(Break::Gap)].as_slice()));
    // A cut in a frame that was not rendered.
    fs::write(folder.0.join("manifest.json"), r#"{"cuts": [4]}"#).unwrap();
    assert_eq!(folder.open().unwrap().breaks, [None, None, Some(Break::Cut), Some(Break::Gap)]);
    // A part of a sequence with a gap has that gap.
    let part = Source { frames: Some([5, 9]), ..Source::from(folder.0.as_path()) };
    assert_eq!(Sequence::open(part, |_| {}).unwrap().breaks, [None, Some(Break::Gap)]);
    write(&[1, 2, 3, 4]);
    fs::write(folder.0.join("manifest.json"), r#"{"cuts": [3]}"#).unwrap();
    let source = || Source { cuts: vec![2], ..Source::from(folder.0.as_path()) };
    let sequence = Sequence::open(source(), |_| {}).unwrap();
    assert_eq!(sequence.breaks, [None, Some(Break::Cut), Some(Break::Cut), None]);
    let sequence = Sequence::open(Source { frames: Some([2, 3]), ..source() }, |_| {}).unwrap();
    assert_eq!((sequence.frames(), sequence.files[0].number), (2, 2));
    for (source, reason) in [
        (Source { cuts: vec![9], ..source() }, "has frames 1 to 4, none of which is that of --cut 9"),
        (Source { frames: Some([7, 9]), ..source() }, "has frames 1 to 4, none of --frames 7-9"),
    ] {
        let error = Sequence::open(source, |_| {}).unwrap_err().to_string();
        assert!(error.contains(reason), "{error}");
    }
}

/// With a manifest for all frames, the frames that are read have their own cameras.
#[test]
fn frames_keep_their_cameras() {
    let folder = Folder::new();
    [1, 2, 4].iter().for_each(|&number| folder.write(number, &plain(0)));
    let camera =
        |x: f64| serde_json::json!({"o": [x, 0, 0], "fw": [0, 0, -1], "r": [1, 0, 0], "up": [0, 1, 0], "th": 0.5});
    let eyes = |cameras: &[f64], range: Option<[i64; 2]>| {
        let cameras: Vec<_> = cameras.iter().map(|&x| camera(x)).collect();
        let manifest = serde_json::json!({ "cameras": cameras }).to_string();
        fs::write(folder.0.join("manifest.json"), manifest).unwrap();
        let source = Source { frames: range, ..Source::from(folder.0.as_path()) };
        let sequence = Sequence::open(source, |_| {}).unwrap();
        (0..sequence.frames()).map(|index| sequence.camera(index).eye[0]).collect::<Vec<_>>()
    };
    assert_eq!(eyes(&[1.0, 2.0, 4.0], None), [1.0, 2.0, 4.0]);
    assert_eq!(eyes(&[1.0, 2.0, 3.0, 4.0], None), [1.0, 2.0, 4.0]);
    assert_eq!(eyes(&[1.0, 2.0, 4.0], Some([2, 9])), [2.0, 4.0]);
    assert_eq!(eyes(&[7.0], None), [7.0; 3], "one for all");
    // Cameras of a whole shot, of which a part was rendered again: the user has to say which they are.
    let cameras: Vec<_> = (0..6).map(|x| camera(f64::from(x))).collect();
    let open = |manifest: serde_json::Value| {
        fs::write(folder.0.join("manifest.json"), manifest.to_string()).unwrap();
        folder.open()
    };
    let error = open(serde_json::json!({ "cameras": cameras.clone() })).unwrap_err().to_string();
    assert!(error.contains("has 6 cameras for 3 frames"), "{error}");
    let sequence = open(serde_json::json!({ "cameras": cameras, "frames": [0, 1, 2, 3, 4, 5] })).unwrap();
    assert_eq!((0..3).map(|index| sequence.camera(index).eye[0]).collect::<Vec<_>>(), [1.0, 2.0, 4.0]);
}

#[test]
fn a_mapping_says_what_the_numbers_are() {
    let folder = Folder::new();
    let mut image = plain(1);
    for (channel, name) in image.channels.iter_mut().zip([
        "ch00",
        "ch01",
        "ch02",
        "x.R",
        "x.G",
        "x.B",
        "ch03",
        "ch04",
        "ch05",
        "distance.T",
        "my.vector.X",
        "my.vector.Y",
    ]) {
        channel.0 = name.to_owned();
    }
    folder.write(0, &image);
    let open = |mappings: &[(Layer, &str, Option<Meaning>)]| {
        let color = [(Layer::Color, "ch00,ch01,ch02", None), (Layer::Normal, "ch03,ch04,ch05", None)];
        let names = color.iter().chain(mappings).map(|&(layer, names, meaning)| Mapping {
            layer,
            names: names.split(',').map(Into::into).collect(),
            meaning,
        });
        let source = Source { names: names.collect(), fov_y: Some(1.0), ..Source::from(folder.0.as_path()) };
        Sequence::open(source, |_| {})
    };
    let first = |mappings: &[(Layer, &str, Option<Meaning>)], layer: Layer, c: usize| {
        open(mappings).unwrap().read(0).unwrap().get(layer).unwrap()[c]
    };
    let motion = |meaning| first(&[(Layer::Motion, "my.vector", meaning)], Layer::Motion, 1);
    assert_eq!([motion(None), motion(Some(Meaning::Same)), motion(Some(Meaning::Upwards))], [-0.25, 0.25, -0.25]);
    let depth = |meaning| first(&[(Layer::Depth, "distance", meaning)], Layer::Depth, 0);
    assert!(depth(None) < 2.0 && depth(Some(Meaning::AlongRay)) < 2.0 && depth(Some(Meaning::Same)) == 2.0);
    let error = open(&[(Layer::Albedo, "x.R,x.G", None)]).unwrap_err().to_string();
    assert!(error.contains("albedo takes 3 channels, not 2"), "{error}");
    let error = open(&[(Layer::Albedo, "x.R,x.G,x.W", None)]).unwrap_err().to_string();
    assert!(error.contains("there is no channel x.W") && error.contains("the file has"), "{error}");
}

/// The compositor's picture is composed: its colours do not belong to a view layer's guides.
#[test]
fn a_composite_is_not_taken_unasked() {
    let folder = Folder::new();
    let mut image = plain(0);
    image.channels.iter_mut().take(3).for_each(|(name, _)| *name = format!("Composite.Combined.{name}"));
    folder.write(0, &image);
    let error = folder.open().unwrap_err().to_string();
    assert!(error.contains("Composite is not taken unasked"), "{error}");
    let names = vec![Mapping { layer: Layer::Color, names: vec!["Composite.Combined".into()], meaning: None }];
    let sequence = Sequence::open(Source { names, ..Source::from(folder.0.as_path()) }, |_| {}).unwrap();
    assert!(sequence.has(Layer::Color) && sequence.has(Layer::Depth));
}

#[test]
fn a_view_layer_can_be_asked_for() {
    let folder = Folder::new();
    let mut image = plain(0);
    let other = image.channels.clone();
    image.channels.iter_mut().for_each(|(name, _)| *name = renamed("A", name));
    image.channels.extend(
        other.into_iter().map(|(name, samples)| (renamed("B", &name), samples.iter().map(|x| x + 1.0).collect())),
    );
    folder.write(0, &image);
    let open = |view_layer: Option<&str>| {
        let source = Source { view_layer: view_layer.map(Into::into), ..Source::from(folder.0.as_path()) };
        Sequence::open(source, |_| {})
    };
    let first = |view_layer| open(view_layer).unwrap().read(0).unwrap().get(Layer::Color).unwrap()[0];
    assert_eq!(first(None), sample(0, 0, 0));
    assert_eq!(first(Some("B")), sample(0, 0, 0) + 1.0);
    let sequence = open(None).unwrap();
    assert_eq!(
        (sequence.view_layer.as_str(), sequence.other_view_layers.as_slice()),
        ("A", ["B".to_owned()].as_slice())
    );
    let error = open(Some("C")).unwrap_err().to_string();
    assert!(error.contains("there is no view layer C, which --layer asks for; the file has"), "{error}");
}

fn renamed(front: &str, name: &str) -> String {
    if name.contains('.') { format!("{front}.{name}") } else { format!("{front}.Combined.{name}") }
}

/// A file with half floats yields half floats, alpha and attributes, and all of its channels on request.
#[test]
fn what_goes_in_comes_out() {
    use asvgf_programs::arguments::Format;
    use asvgf_programs::denoise::options::{Request, parse};
    let folder = Folder::new();
    let mut image = plain(0);
    image.channels.push(("A".into(), vec![0.75; (SIZE[0] * SIZE[1]) as usize]));
    image.channels.push(("crypto.r".into(), vec![0.125; (SIZE[0] * SIZE[1]) as usize]));
    for number in [7, 8] {
        let path = folder.0.join(format!("shot.{number:06}.exr"));
        write_exr(&path, &image).unwrap();
        let mut file = ExrFile::read(&path).unwrap();
        let names = file.names();
        file.set_sample_type(SampleType::Half, &names);
        file.set_compression(Compression::Piz);
        file.write(&path).unwrap();
    }
    let out = Folder::new();
    let sequence = folder.open().unwrap();
    let write = |extra: &str| {
        let line = format!("{} --out {}{extra}", folder.0.display(), out.0.display());
        let Ok(Request::Denoise(options)) = parse(line.split(' ').map(Into::into)) else { panic!("{line}") };
        assert_eq!(options.formats[0], Format::Exr);
        let gray = vec![[0.5; 3]; (SIZE[0] * SIZE[1]) as usize];
        let mut files =
            asvgf_programs::denoise::output::Files { options: &options, sequence: &sequence, after: &|| {} };
        asvgf_programs::denoise::look_ahead::Sink::denoised(&mut files, 0, &gray).unwrap();
    };
    write("");
    let file = ExrFile::read(out.0.join("denoised_000007.exr")).unwrap();
    assert_eq!(file.names(), ["A", "B", "G", "R"]);
    let found = file.channels();
    assert_eq!((found.get("R").unwrap()[3], found.get("A").unwrap()[3]), (0.5, 0.75));
    write(" --keep-channels --same-names --type float");
    let found = ExrFile::read(out.0.join("shot.000007.exr")).unwrap().channels();
    assert_eq!(found.channels.len(), CHANNELS.len() + 2);
    assert_eq!((found.get("R").unwrap()[3], found.get("crypto.r").unwrap()[3]), (0.5, 0.125));
    let names: Vec<_> = fs::read_dir(&out.0).unwrap().map(|entry| entry.unwrap().file_name()).collect();
    assert_eq!(names.len(), 2, "nothing half-written is left: {names:?}");
}

/// Depths below 0 are those in front of the camera; depths of 0 everywhere are absent.
#[test]
fn depths_of_either_sign_are_read() {
    let written = |factor: f32| {
        let folder = Folder::new();
        let mut image = plain(0);
        image.channels[9].1.iter_mut().for_each(|z| *z *= factor);
        folder.write(0, &image);
        let sequence = folder.open().unwrap();
        (sequence.has_surfaces(), sequence.blank_depth, sequence.read(0).unwrap().get(Layer::Depth).unwrap()[3])
    };
    let expected = sample(9, 0, 3);
    assert_eq!(written(1.0), (true, false, expected));
    assert_eq!(written(-1.0), (true, false, expected));
    assert_eq!(written(0.0), (false, true, 1.0), "a wall stands in");
}

/// Input files are never written.
#[test]
fn no_output_is_a_frame() {
    use asvgf_programs::denoise::options::{Request, parse};
    let folder = Folder::new();
    (1..3).for_each(|number| write_exr(folder.0.join(format!("denoised_{number:04}.exr")), &plain(0)).unwrap());
    let sequence = folder.open().unwrap();
    let line = format!("{0} --out {0} --outputs denoised,lambda --format exr,png", folder.0.display());
    let Ok(Request::Denoise(options)) = parse(line.split(' ').map(Into::into)) else { panic!("{line}") };
    let paths = asvgf_programs::denoise::output::paths(&options, &sequence, 0);
    let names: Vec<_> = paths.iter().map(|path| path.file_name().unwrap().to_str().unwrap()).collect();
    assert_eq!(names, ["denoised_0001.exr", "denoised_0001.png", "lambda_0001.exr", "lambda_0001.png"]);
    assert!(sequence.files[0].path == paths[0], "that is what `denoise` refuses");
}
