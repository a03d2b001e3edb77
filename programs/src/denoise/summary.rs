//! Messages of `denoise`: its findings, its substitutes for missing data, and likely mistakes.

use crate::denoise::look_ahead::{Ahead, Denoised};
use crate::sequence::layers::Layer;
use crate::sequence::pixels::Area;
use crate::sequence::{Break, Eye, Sequence};
use asvgf::{Gradient, Settings};

/// Returns the messages before the first frame.
pub fn before(sequence: &Sequence, settings: &Settings, ahead: Option<&Ahead>) -> String {
    let [width, height] = sequence.size;
    let (first, last) = (&sequence.files[0], &sequence.files[sequence.frames() - 1]);
    let step = if sequence.step > 1 { format!(", every {}", ordinal(sequence.step)) } else { String::new() };
    let mut out = format!("frames {} to {}{step}, {width}×{height}", first.digits, last.digits);
    let picture = sequence.raster.picture;
    if sequence.size != picture || sequence.raster.offset != [0; 2] {
        out += &format!(" of a picture of {}×{}", picture[0], picture[1]);
    }
    out += "\n";
    for (layer, names) in &sequence.taken {
        out += &format!("  {:<27}{names}\n", layer.name());
    }
    if !sequence.other_view_layers.is_empty() {
        let others = sequence.other_view_layers.join(", ");
        out += &format!("view layer {}: there is {others} too, see --layer\n", quoted(&sequence.view_layer));
    }
    let absent: Vec<&str> = Layer::ALL.into_iter().filter(|&layer| matters(sequence, layer)).map(Layer::name).collect();
    if !absent.is_empty() {
        out += &format!("left out, because the files lack it: {}\n", absent.join(", "));
    }
    out += &format!("level: {}\n", level(sequence, settings, ahead));
    for (index, broken) in sequence.breaks.iter().enumerate() {
        if let Some(broken) = broken {
            let digits = &sequence.files[index].digits;
            out += &format!("note: frame {digits} begins anew: {}\n", reason(*broken));
        }
    }
    for note in notes(sequence) {
        out += &format!("note: {note}\n");
    }
    out
}

/// True if a layer is absent and its absence costs something. Gloss has layers of its own in files that have any of them.
fn matters(sequence: &Sequence, layer: Layer) -> bool {
    let of_gloss = [
        Layer::Specular,
        Layer::SpecularAlbedo,
        Layer::Roughness,
        Layer::HitDistance,
        Layer::SpecularGradientCurrent,
        Layer::SpecularGradientPrevious,
    ];
    let shines = sequence.has(Layer::Specular) || sequence.has(Layer::Roughness);
    let known = (layer as usize) <= Layer::Lambda as usize || shines && of_gloss.contains(&layer);
    known && !sequence.has(layer) && !(layer == Layer::Specular && sequence.has(Layer::GlossyDirect))
}

fn ordinal(step: i64) -> String {
    match step {
        2 => "second".into(),
        3 => "third".into(),
        step => format!("{step}th"),
    }
}

fn quoted(name: &str) -> String {
    if name.is_empty() { "without a name".into() } else { name.into() }
}

/// Describes the guides of edges, the source of motion, and the source of an adaptive α.
fn level(sequence: &Sequence, settings: &Settings, ahead: Option<&Ahead>) -> String {
    let edges = match (sequence.has(Layer::Normal), sequence.has_surfaces()) {
        (true, true) => "edges by normals and depth",
        (false, true) => "edges by depth, and normals made of it",
        (true, false) => "edges by normals",
        (false, false) => "edges by light alone",
    };
    let albedo =
        if sequence.has(Layer::Albedo) { ", textures kept" } else { ", textures blurred where they are faint" };
    let followed = if sequence.has(Layer::Motion) {
        "surfaces followed"
    } else if follows(sequence) {
        "surfaces followed by the camera"
    } else {
        "nothing assumed to move"
    };
    let alpha = match settings.filter.gradient {
        Gradient::Pairs => "α by pairs",
        Gradient::Lambda => "α by λ",
        Gradient::Off => "α constant",
        _ => "α by the image alone",
    };
    let future = match ahead.filter(|_| sequence.frames() > 1) {
        Some(ahead) if ahead.smooth_edges => "past and future, edges of whole pixels",
        Some(_) => "past and future, edges of points",
        None => "past",
    };
    let passes = [Layer::GlossyDirect, Layer::GlossyIndirect, Layer::SpecularAlbedo];
    let placed = sequence.has(Layer::Roughness) || sequence.has(Layer::HitDistance);
    let apart = sequence.has(Layer::Specular) || placed && passes.iter().all(|&layer| sequence.has(layer));
    let gloss = match (apart, sequence.has(Layer::HitDistance), sequence.has(Layer::Roughness)) {
        (true, true, _) => "; specular light apart, which follows reflections",
        (true, false, _) => "; specular light apart, which follows reflections half the depth away",
        (false, _, true) => "; specular light in one radiance, whose history is short where reflections slide",
        (false, _, false) => "",
    };
    format!("{edges}{albedo}{gloss}; {followed}; {alpha}; {future}")
}

/// True if motion is known: from vectors, or from a moving camera in front of known surfaces.
fn follows(sequence: &Sequence) -> bool {
    sequence.has(Layer::Motion) || (sequence.has_surfaces() && sequence.cameras.len() > 1)
}

/// Returns the reason for a new beginning, in words.
fn reason(broken: Break) -> &'static str {
    match broken {
        Break::Gap => "frames are missing before it",
        Break::Cut => "a cut",
    }
}

/// Lists the assumptions for missing data, and their risks.
fn notes(sequence: &Sequence) -> Vec<String> {
    let mut notes = Vec::new();
    if sequence.blank_depth {
        notes.push("all depths are 0: they count as absent".into());
    } else if sequence.depth_sign < 0.0 {
        notes.push("all depths are below 0: their sign is flipped, so that they lie in front of the camera".into());
    }
    if !sequence.borrowed.is_empty() {
        let frames = sequence.borrowed.join(", ");
        notes.push(format!("frames {frames} have no camera: each takes that of the nearest frame with one"));
    }
    if !sequence.has_surfaces() {
        notes.push(
            "no depth: only light separates near surfaces from far ones, borders between surfaces of one light are blurred, and sky \
             looks like a surface"
                .into(),
        );
    } else {
        let camera = match sequence.eye {
            Eye::Given => None,
            Eye::Described => Some("cameras are those that the files' attributes describe"),
            Eye::Fitted => {
                Some("no cameras in manifest.json: all but their positions is derived from normals and depth")
            }
            Eye::Turned => Some(
                "no cameras in manifest.json, and no surface determines the field of view: it is that of --fov-y, or 45 \
                 degrees, in the direction that normals and depth show",
            ),
            Eye::Assumed => Some(
                "no cameras in manifest.json: the assumed one is at the origin and looks along -Z with +Y up; normals should \
                 be in its space, and --fov-y right",
            ),
        };
        notes.extend(camera.map(Into::into));
    }
    if sequence.normals_of_view.is_some() {
        notes.push("normals are read in the camera's own space, because surfaces are flat there".into());
    }
    if !sequence.has(Layer::Motion) {
        let motion = match sequence.eye {
            Eye::Given | Eye::Described if sequence.has_surfaces() => "only the camera is assumed to move",
            Eye::Fitted | Eye::Turned if sequence.has_surfaces() => "the camera is assumed to turn, nothing to move",
            _ => "nothing is assumed to move; moving surfaces are smeared or noisy",
        };
        notes.push(format!("motion is absent: {motion}"));
    }
    let area = sequence.area.map(|area| match area {
        Area::Scattered => "pixels are areas: depths are those of points all over them; if not, use --edges sharp",
        Area::Blender => "pixels are areas, as Blender's are; if not, use --edges sharp",
    });
    notes.extend(area.map(Into::into));
    if sequence.frames() == 1 {
        notes.push("one frame: there is nothing to average over time".into());
    }
    notes
}

/// Returns the messages after the last frame.
pub fn after(denoised: &Denoised) -> String {
    let mut out = String::new();
    if let Some(frame) = denoised.repeated {
        out += &format!(
            "note: frames before {frame} are the same, to the last bit, wherever nothing moves: each frame is denoised by itself from \
             there on, as long as that is so; another seed in each frame would allow averages over time\n"
        );
    }
    if !denoised.cuts.is_empty() {
        let cuts: Vec<String> = denoised.cuts.iter().map(i64::to_string).collect();
        out += &format!(
            "note: frames {} begin another shot: no surface in them is where it was; their histories begin anew\n",
            cuts.join(", ")
        );
    }
    if let Some(complaint) = &denoised.complaint {
        out += &format!("warning: {complaint}\n");
    }
    out
}
