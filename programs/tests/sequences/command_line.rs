//! Options of `denoise`.

use asvgf::image_io::{Compression, SampleType};
use asvgf::{FilterSettings, View};
use asvgf_programs::arguments::Format;
use asvgf_programs::denoise::options::{Options, Request, parse};
use asvgf_programs::sequence::layers::{Layer, Mapping, Meaning};

fn options(line: &str) -> Result<Options, String> {
    match parse(line.split(' ').map(Into::into)) {
        Ok(Request::Denoise(options)) => Ok(*options),
        Ok(Request::Help) => Err("help".into()),
        Err(usage) => Err(usage.to_string()),
    }
}

#[test]
fn what_is_not_said_is_the_default() {
    let options = options("in --out out").unwrap();
    assert_eq!((options.source.input.to_str(), options.out.to_str()), (Some("in"), Some("out")));
    assert_eq!(options.preset, FilterSettings::default());
    assert_eq!((options.constant, options.source.fov_y, options.in_place, options.causal), (None, None, false, false));
    assert_eq!((options.sample_type, options.compression, options.keep_channels), (None, None, false));
    assert_eq!((options.outputs, options.formats), (vec![("denoised", View::Denoised)], vec![Format::Exr]));
}

#[test]
fn everything_that_can_be_said_is_heard() {
    let line = "in --out out --alpha constant:0.1 --iterations 3 --preset classic --outputs denoised,lambda,history --format exr,png \
                --map albedo=base --map depth=far:ray --map motion=pass:0,pass:1:up --frames 101-148 --cut 110,120 \
                --layer Main --type half --compression piz --causal --edges sharp --keep-channels --same-names";
    let options = options(line).unwrap();
    assert_eq!(options.constant, Some(0.1));
    // The order of the options does not matter.
    assert_eq!(options.preset, FilterSettings { iterations: 3, ..FilterSettings::classic() });
    assert_eq!(options.outputs.iter().map(|o| o.0).collect::<Vec<_>>(), ["denoised", "lambda", "history"]);
    assert_eq!(options.formats, [Format::Exr, Format::Png]);
    let mapping = |layer, names: &[&str], meaning| {
        let names = names.iter().map(|name| (*name).to_owned()).collect();
        Mapping { layer, names, meaning }
    };
    let expected = [
        mapping(Layer::Albedo, &["base"], None),
        mapping(Layer::Depth, &["far"], Some(Meaning::AlongRay)),
        mapping(Layer::Motion, &["pass:0", "pass:1"], Some(Meaning::Upwards)),
    ];
    assert_eq!(options.source.names, expected);
    assert_eq!(options.source.frames, Some([101, 148]));
    assert_eq!(options.source.cuts, [110, 120]);
    assert_eq!(options.source.view_layer.as_deref(), Some("Main"));
    assert_eq!((options.sample_type, options.compression), (Some(SampleType::Half), Some(Compression::Piz)));
    assert_eq!(options.smooth_edges, Some(false));
    assert!(options.causal && options.keep_channels && options.same_names);
}

#[test]
fn what_is_wrong_is_named() {
    for (line, reason) in [
        ("--out out", "IN is missing"),
        ("in", "--out OUT_DIR is missing"),
        ("in in --out out", "a second IN"),
        ("in --out out --alpha 2", "--alpha 2: must be adaptive, or constant:A"),
        ("in --out out --map albdo=x", "--map albdo=x: must be LAYER=NAME, with LAYER one of color, albedo"),
        ("in --out out --map albedo=", "--map albedo=: must be LAYER=NAME"),
        ("in --out out --frames 9-1", "--frames 9-1: must be two numbers of frames"),
        ("in --out out --compression gzip", "--compression gzip: must be one of none, rle"),
        ("in --out out --iterations 9", "--iterations 9: must be a whole number from 0 to 8"),
        ("in --out out --outputs specular,rays", "--outputs rays: must be one of denoised"),
        ("in --out out --sharpen", "--sharpen"),
    ] {
        let error = options(line).map(|o| o.outputs).expect_err(line);
        assert!(error.contains(reason), "{line}: «{error}» does not say {reason}");
    }
}
