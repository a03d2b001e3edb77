//! EXR and PNG files.

use asvgf::image_io::{
    Attribute, Channels, Compression, ExrFile, SampleType, Window, read_exr, read_png, write_exr, write_exr_rgb,
    write_png,
};
use exr::meta::attribute::AttributeValue;
use exr::prelude::{
    AnyChannel, AnyChannels, Encoding, FlatSamples, Image, Layer, LayerAttributes, Vec2, WritableImage as _, f16,
};

use crate::common::*;

fn files(folder: &Folder) -> Vec<String> {
    let mut files: Vec<_> = std::fs::read_dir(&folder.0).unwrap().map(|entry| name(&entry.unwrap().path())).collect();
    files.sort();
    files
}

#[test]
fn named_channels_survive_unchanged() {
    let folder = Folder::new();
    let path = folder.0.join("frame.exr");
    let samples = vec![0.0, -1.5, f32::INFINITY, 1e-40, 3.25, 1e30];
    let channels = ["B", "G", "R", "Z", "albedo.R", "motion.x"].map(|name| (name.to_owned(), samples.clone())).to_vec();
    let image = Channels { width: 3, height: 2, channels };
    write_exr(&path, &image).unwrap();
    let read = read_exr(&path).unwrap();
    assert_eq!(read, image);
    assert_eq!(read.get("albedo.R"), Some(samples.as_slice()));
    assert_eq!(read.get("albedo.G"), None);
    // The file is written again in its place, and nothing else is left behind.
    write_exr_rgb(&path, 1, 1, &[[1.0, 2.0, 3.0]]).unwrap();
    assert_eq!(read_exr(&path).unwrap().get("G"), Some([2.0].as_slice()));
    assert_eq!(files(&folder), ["frame.exr"]);
}

#[test]
fn half_floats_integers_and_parts() {
    let folder = Folder::new();
    let path = folder.0.join("parts.exr");
    let layer = |name: &str, channels: Vec<AnyChannel<FlatSamples>>| {
        Layer::new((2, 1), LayerAttributes::named(name), Encoding::FAST_LOSSLESS, AnyChannels::sort(channels.into()))
    };
    let half = |name: &str| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(0.5), f16::from_f32(2.0)]));
    let id = AnyChannel::new("id", FlatSamples::U32(vec![7, 9]));
    let image =
        Image::empty(exr::meta::header::ImageAttributes::new(exr::prelude::IntegerBounds::from_dimensions((2, 1))))
            .with_layer(layer("beauty", vec![half("R"), id]))
            .with_layer(layer("albedo", vec![half("R"), half("albedo.G")]));
    image.write().to_file(&path).unwrap();
    let read = read_exr(&path).unwrap();
    let mut names: Vec<_> = read.channels.iter().map(|(name, _)| name.as_str()).collect();
    names.sort_unstable();
    assert_eq!(names, ["albedo.G", "albedo.R", "beauty.R", "beauty.id"]);
    assert_eq!(read.get("beauty.R"), Some([0.5, 2.0].as_slice()));
    assert_eq!(read.get("beauty.id"), Some([7.0, 9.0].as_slice()));
}

/// Windows, attributes, types and compression survive a change of the colours.
#[test]
fn what_an_exr_file_says_beside_its_samples_is_kept() {
    let folder = Folder::new();
    let path = folder.0.join("crop.exr");
    let mut attributes = LayerAttributes::named("main");
    attributes.layer_position = Vec2(8, -2);
    attributes.software_name = Some("a renderer".into());
    attributes.world_to_camera = Some(std::array::from_fn(|i| i as f32));
    attributes.other.insert("shutter".into(), AttributeValue::F32(0.5));
    let half = |name: &str| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(0.5); 4]));
    let id = AnyChannel::new("id", FlatSamples::U32(vec![1, 2, 3, 4_000_000_000]));
    let encoding = Encoding { compression: exr::prelude::Compression::PIZ, ..Encoding::SMALL_LOSSLESS };
    let channels = [half("A"), half("B"), half("G"), half("R"), id];
    let layer = Layer::new((2, 2), attributes, encoding, AnyChannels::sort(channels.into_iter().collect()));
    let mut shared = exr::meta::header::ImageAttributes::new(exr::prelude::IntegerBounds::from_dimensions((16, 12)));
    shared.pixel_aspect = 2.0;
    Image { attributes: shared.clone(), layer_data: layer }.write().to_file(&path).unwrap();

    let mut file = ExrFile::read(&path).unwrap();
    assert_eq!(file.data_window(), Window { position: [8, -2], size: [2, 2] });
    assert_eq!((file.display_window().size, file.pixel_aspect()), ([16, 12], 2.0));
    assert_eq!(file.attribute("shutter"), Some(Attribute::Number(0.5)));
    assert!(matches!(file.attribute("worldToCamera"), Some(Attribute::Matrix(m)) if m[1] == [4.0, 5.0, 6.0, 7.0]));
    assert_eq!(file.attribute("absent"), None);
    let colors =
        |value: f32| ["R", "G", "B"].map(|name| (name.to_owned(), vec![value, 1e6, 0.0, f32::INFINITY])).to_vec();
    file.with_channels("R", &colors(3.0)).write(folder.0.join("colors.exr")).unwrap();
    file.replace(&colors(4.0));
    file.write(folder.0.join("whole.exr")).unwrap();
    for (name, expected, count) in [("colors.exr", 3.0, 3), ("whole.exr", 4.0, 5)] {
        let read = exr::prelude::read_all_data_from_file(folder.0.join(name)).unwrap();
        let part = &read.layer_data[0];
        assert_eq!((read.attributes.pixel_aspect, part.attributes.layer_position), (2.0, Vec2(8, -2)));
        assert_eq!(part.attributes.software_name, Some("a renderer".into()));
        assert_eq!(part.encoding.compression, exr::prelude::Compression::PIZ);
        assert_eq!(part.channel_data.list.len(), count);
        let red = part.channel_data.list.iter().find(|channel| channel.name == *"R").unwrap();
        let FlatSamples::F16(samples) = &red.sample_data.get_level(Vec2(0, 0)).unwrap() else {
            panic!("no half floats")
        };
        let samples: Vec<f32> = samples.iter().map(|x| x.to_f32()).collect();
        assert_eq!(samples, [expected, 65504.0, 0.0, f32::INFINITY], "what is finite stays so");
    }
    let read = read_exr(folder.0.join("whole.exr")).unwrap();
    assert_eq!(read.get("id").unwrap()[3], 4e9);
    file.set_sample_type(SampleType::Float, &file.names());
    file.set_compression(Compression::Zip);
    file.write(&path).unwrap();
    let read = exr::prelude::read_all_data_from_file(&path).unwrap();
    assert_eq!(read.layer_data[0].encoding.compression, exr::prelude::Compression::ZIP16);
}

#[test]
fn windows_are_placed_in_others() {
    let window = |x, y, w, h| Window { position: [x, y], size: [w, h] };
    let small = window(-1, 2, 2, 2);
    assert_eq!(small.union(window(3, 0, 1, 1)), window(-1, 0, 5, 4));
    let into = window(-2, 1, 3, 3);
    assert_eq!(small.place(&[1.0, 2.0, 3.0, 4.0], into, 0.0), [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 3.0, 4.0]);
    // One window is cut at all sides; another has nothing in common.
    assert_eq!(into.place(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0], window(-1, 2, 1, 1), 9.0), [4.0]);
    assert_eq!(small.place(&[1.0; 4], window(40, 40, 1, 2), 9.0), [9.0, 9.0]);
    assert_eq!(small.place(&[1.0; 4], window(-40, -40, 1, 2), 9.0), [9.0, 9.0]);
}

#[test]
fn png_files_survive_unchanged() {
    let folder = Folder::new();
    let path = folder.0.join("picture.png");
    let pixels = [[1, 2, 3, 4], [255, 0, 0, 255]];
    write_png(&path, 2, 1, &pixels).unwrap();
    assert_eq!(read_png(&path).unwrap(), (2, 1, pixels.to_vec()));
    assert_eq!(files(&folder), ["picture.png"]);
}

#[test]
fn nothing_is_written_that_could_not_be_read() {
    let folder = Folder::new();
    let path = folder.0.join("bad.exr");
    let image = |width, height, channels: &[(&str, usize)]| Channels {
        width,
        height,
        channels: channels.iter().map(|&(name, length)| (name.to_owned(), vec![0.0; length])).collect(),
    };
    for (image, reason) in [
        (image(0, 1, &[("R", 0)]), "0 pixels a side"),
        (image(20_000, 1, &[("R", 20_000)]), "20000 pixels a side"),
        (image(1, 1, &[]), "no channels"),
        (image(2, 1, &[("R", 1)]), "channel R has 1 samples, where 2 belong"),
        (image(1, 1, &[("R", 1), ("R", 1)]), "\"R\" is used twice"),
        (image(1, 1, &[("", 1)]), "cannot be the name"),
        (image(1, 1, &[("日本", 1)]), "cannot be the name"),
    ] {
        let error = write_exr(&path, &image).unwrap_err();
        assert!(error.file.ends_with("bad.exr") && error.reason.contains(reason), "{error}");
    }
    assert!(write_png(&path, 2, 2, &[[0; 4]; 3]).unwrap_err().reason.contains("3 pixels, where 4 belong"));
    assert!(write_png(folder.0.join("no/such/folder.png"), 1, 1, &[[0; 4]]).unwrap_err().reason.contains("written"));
    assert!(files(&folder).is_empty());
}

#[test]
fn broken_files_are_errors() {
    let folder = Folder::new();
    let path = folder.0.join("whole.exr");
    write_exr_rgb(&path, 4, 4, &[[0.5; 3]; 16]).unwrap();
    let whole = std::fs::read(&path).unwrap();
    for length in (0..whole.len()).step_by(7) {
        assert!(read_exr(folder.write("cut.exr", &whole[..length])).is_err(), "{length} of {} bytes", whole.len());
    }
    for at in 0..whole.len() {
        let mut changed = whole.clone();
        changed[at] ^= 0x55;
        let path = folder.write("changed.exr", changed);
        assert!(std::panic::catch_unwind(|| read_exr(path).is_ok()).is_ok(), "panic with byte {at} changed");
    }
    assert!(read_exr(folder.0.join("absent.exr")).unwrap_err().reason.contains("cannot be read"));
    assert!(read_png(folder.write("no.png", "no")).unwrap_err().reason.contains("cannot be decoded"));
}
