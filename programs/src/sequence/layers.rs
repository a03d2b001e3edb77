//! Layers of a frame, and the names of their channels in the files of several renderers.

use asvgf::image_io::Channels;

/// A quantity of every pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(usize)]
pub enum Layer {
    Color,
    Albedo,
    Emission,
    Normal,
    Depth,
    Motion,
    PreviousDepth,
    Id,
    GradientCurrent,
    GradientPrevious,
    Lambda,
    Diffuse,
    Specular,
    SpecularAlbedo,
    Roughness,
    HitDistance,
    SpecularMotion,
    SpecularGradientCurrent,
    SpecularGradientPrevious,
    /// Blender's passes of light by lobes: each light is divided by the colour.
    GlossyDirect,
    GlossyIndirect,
    DiffuseColor,
    TransmissionColor,
}

/// Differences of numbers from those of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// No difference.
    Same,
    /// The second component points up in the image.
    Upwards,
    /// Distances along the pixel's ray, not along the view axis.
    AlongRay,
}

/// A name of other programs for a layer, its channels, and their meaning. The name excludes the view layer in front;
/// without a name, the channels are the layer's own.
struct Alias(&'static str, &'static [&'static str], Meaning);

const RGB: &[&str] = &["R", "G", "B"];
const XYZ: &[&str] = &["X", "Y", "Z"];
const XY: &[&str] = &["X", "Y"];

impl Layer {
    pub const ALL: [Self; 23] = [
        Self::Color,
        Self::Albedo,
        Self::Emission,
        Self::Normal,
        Self::Depth,
        Self::Motion,
        Self::PreviousDepth,
        Self::Id,
        Self::GradientCurrent,
        Self::GradientPrevious,
        Self::Lambda,
        Self::Diffuse,
        Self::Specular,
        Self::SpecularAlbedo,
        Self::Roughness,
        Self::HitDistance,
        Self::SpecularMotion,
        Self::SpecularGradientCurrent,
        Self::SpecularGradientPrevious,
        Self::GlossyDirect,
        Self::GlossyIndirect,
        Self::DiffuseColor,
        Self::TransmissionColor,
    ];

    /// Returns the name, which precedes the dot in the names of all channels except the colour's.
    pub fn name(self) -> &'static str {
        match self {
            Self::Color => "color",
            Self::Albedo => "albedo",
            Self::Emission => "emission",
            Self::Normal => "normal",
            Self::Depth => "depth",
            Self::Motion => "motion",
            Self::PreviousDepth => "prev_depth",
            Self::Id => "id",
            Self::GradientCurrent => "gradient.current",
            Self::GradientPrevious => "gradient.previous",
            Self::Lambda => "lambda",
            Self::Diffuse => "diffuse",
            Self::Specular => "specular",
            Self::SpecularAlbedo => "specular_albedo",
            Self::Roughness => "roughness",
            Self::HitDistance => "hit_distance",
            Self::SpecularMotion => "specular_motion",
            Self::SpecularGradientCurrent => "specular_gradient.current",
            Self::SpecularGradientPrevious => "specular_gradient.previous",
            Self::GlossyDirect => "glossy_direct",
            Self::GlossyIndirect => "glossy_indirect",
            Self::DiffuseColor => "diffuse_color",
            Self::TransmissionColor => "transmission_color",
        }
    }

    /// Returns the last parts of the channels' names.
    pub fn components(self) -> &'static [&'static str] {
        match self {
            Self::Normal => XYZ,
            Self::Motion | Self::SpecularMotion => XY,
            Self::Depth | Self::PreviousDepth | Self::HitDistance => &["Z"],
            Self::Roughness => &["V"],
            Self::Id => &["I"],
            Self::Lambda => &["Y"],
            _ => RGB,
        }
    }

    /// True if it holds repeated paths, of which a frame may have none.
    pub fn is_of_pairs(self) -> bool {
        matches!(
            self,
            Self::GradientCurrent
                | Self::GradientPrevious
                | Self::SpecularGradientCurrent
                | Self::SpecularGradientPrevious
        )
    }

    /// Returns the full names of the channels.
    pub fn channels(self) -> Vec<String> {
        let front = if self == Self::Color { "" } else { self.name() };
        self.components().iter().map(|component| join(front, component)).collect()
    }

    /// Returns the names here and in renderers, best first. For a name that the user chooses in a renderer, the list
    /// has that of the renderer's manual.
    fn aliases(self) -> &'static [Alias] {
        use Meaning::*;
        match self {
            // If Noisy Image exists, Blender's Combined is denoised already.
            Self::Color => &[
                Alias("", RGB, Same),
                Alias("color", RGB, Same),
                Alias("Noisy Image", RGB, Same),
                Alias("Combined", RGB, Same),
                Alias("image", RGB, Same),
                Alias("rgba", RGB, Same),
                Alias("rgb", RGB, Same),
                Alias("beauty", RGB, Same),
                Alias("C", RGB, Same),
                Alias("Ci", RGB, Same),
                Alias("main", RGB, Same),
            ],
            Self::Albedo => &[
                Alias("albedo", RGB, Same),
                Alias("albedo", XYZ, Same),
                Alias("Denoising Albedo", RGB, Same),
                Alias("Denoising Albedo", XYZ, Same),
                Alias("diffuse_albedo", RGB, Same),
                Alias("VRayDiffuseFilter", RGB, Same),
            ],
            Self::Emission => &[Alias("emission", RGB, Same), Alias("Emit", RGB, Same)],
            Self::Normal => &[
                Alias("normal", XYZ, Same),
                Alias("Denoising Normal", XYZ, Same),
                Alias("sh_normal", XYZ, Same),
                Alias("normals", XYZ, Same),
                Alias("nn", XYZ, Same),
                Alias("Ns", XYZ, Same),
                Alias("N", XYZ, Same),
                Alias("normal", RGB, Same),
                Alias("normals", RGB, Same),
                Alias("N", RGB, Same),
            ],
            // Cycles' Denoising Depth and Mitsuba's depth are distances.
            Self::Depth => &[
                Alias("depth", &["Z"], Same),
                Alias("depth", &["V"], Same),
                Alias("depth", &["T"], AlongRay),
                Alias("dd", &["T"], AlongRay),
                Alias("distance", &["T"], AlongRay),
                Alias("distance", &["Z"], AlongRay),
                Alias("distance", &["V"], AlongRay),
                Alias("Denoising Depth", &["Z"], AlongRay),
                Alias("Denoising Depth", &["V"], AlongRay),
                Alias("", &["Z"], Same),
            ],
            // Blender's Vector holds previous − current in X and Y, and Y is up.
            Self::Motion => &[Alias("motion", XY, Same), Alias("Vector", XY, Upwards)],
            Self::PreviousDepth => &[Alias("prev_depth", &["Z"], Same)],
            Self::Id => &[
                Alias("id", &["I"], Same),
                Alias("IndexOB", &["X"], Same),
                Alias("Object Index", &["X"], Same),
                Alias("shape_index", &["I"], Same),
            ],
            Self::GradientCurrent => &[Alias("gradient.current", RGB, Same)],
            Self::GradientPrevious => &[Alias("gradient.previous", RGB, Same)],
            Self::Lambda => &[Alias("lambda", &["Y"], Same)],
            Self::Diffuse => &[Alias("diffuse", RGB, Same)],
            Self::Specular => &[Alias("specular", RGB, Same)],
            Self::SpecularAlbedo => {
                &[Alias("specular_albedo", RGB, Same), Alias("GlossCol", RGB, Same), Alias("Glossy Color", RGB, Same)]
            }
            Self::Roughness => &[
                Alias("roughness", &["V"], Same),
                Alias("roughness", &["Y"], Same),
                Alias("roughness", &["R"], Same),
                Alias("roughness", &["X"], Same),
                Alias("Denoising Roughness", &["X"], Same),
            ],
            Self::HitDistance => &[Alias("hit_distance", &["Z"], Same), Alias("hit_distance", &["V"], Same)],
            Self::SpecularMotion => &[Alias("specular_motion", XY, Same)],
            Self::SpecularGradientCurrent => &[Alias("specular_gradient.current", RGB, Same)],
            Self::SpecularGradientPrevious => &[Alias("specular_gradient.previous", RGB, Same)],
            Self::GlossyDirect => &[Alias("GlossDir", RGB, Same), Alias("Glossy Direct", RGB, Same)],
            Self::GlossyIndirect => &[Alias("GlossInd", RGB, Same), Alias("Glossy Indirect", RGB, Same)],
            Self::DiffuseColor => &[Alias("DiffCol", RGB, Same), Alias("Diffuse Color", RGB, Same)],
            Self::TransmissionColor => &[Alias("TransCol", RGB, Same), Alias("Transmission Color", RGB, Same)],
        }
    }
}

/// The user's mapping of a layer to channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Mapping {
    pub layer: Layer,
    /// The name before the last dot of its channels, or the names of all its channels.
    pub names: Vec<String>,
    /// Meaning of the numbers, if the user gave one.
    pub meaning: Option<Meaning>,
}

/// The user's own names.
pub type Names = Vec<Mapping>;

/// Place of a layer in a file: the numbers of its channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    pub channels: Vec<usize>,
    pub meaning: Meaning,
}

/// Places of all layers, in the order of [`Layer::ALL`].
#[derive(Clone, Debug, PartialEq)]
pub struct Places {
    pub of: Vec<Option<Place>>,
    /// View layer of the places, and the others in the file.
    pub view_layer: String,
    pub others: Vec<String>,
}

impl Places {
    pub fn get(&self, layer: Layer) -> Option<&Place> {
        self.of[layer as usize].as_ref()
    }
}

/// View layer of Blender's compositor: a composed image without guides of its own.
const COMPOSITE: &str = "composite";

/// Finds all layers in a file. All come from one view layer: the requested one, else the first that has colour, normals
/// and depth, else the first that has colour. The error says what is missing.
pub fn find(names: &Names, view_layer: Option<&str>, image: &Channels) -> Result<Places, String> {
    let fronts = fronts(image);
    let found: Vec<Vec<Option<Place>>> = fronts.iter().map(|front| in_view_layer(front, image)).collect();
    let has = |index: usize, layer: Layer| found[index][layer as usize].is_some();
    let is_composite = |index: usize| last_part(&fronts[index]) == COMPOSITE;
    let chosen = if let Some(wanted) = view_layer {
        let is_wanted = |front: &String| front.trim_end_matches('.') == wanted;
        let named = fronts.iter().map(|front| front.trim_end_matches('.')).filter(|front| !front.is_empty());
        let known: Vec<&str> = named.collect();
        let known = if known.is_empty() { "none with a name".into() } else { known.join(", ") };
        fronts
            .iter()
            .position(is_wanted)
            .ok_or_else(|| format!("there is no view layer {wanted}, which --layer asks for; the file has {known}"))?
    } else {
        let all = [Layer::Color, Layer::Normal, Layer::Depth];
        let candidates = || (0..fronts.len()).filter(|&index| !is_composite(index));
        let whole = candidates().find(|&index| all.into_iter().all(|layer| has(index, layer)));
        whole.or_else(|| candidates().find(|&index| has(index, Layer::Color))).unwrap_or(0)
    };
    let mut of = found[chosen].clone();
    for mapping in names {
        of[mapping.layer as usize] = Some(own(mapping, image)?);
    }
    // Rejects a file that has some of a layer's own channels, but not all.
    for layer in Layer::ALL.into_iter().filter(|&layer| of[layer as usize].is_none()) {
        let (there, absent): (Vec<_>, Vec<_>) = layer.channels().into_iter().partition(|n| image.get(n).is_some());
        if let (Some(there), Some(absent)) = (there.first(), absent.first()) {
            return Err(format!("there is no channel {absent} beside {there}"));
        }
    }
    if of[Layer::Color as usize].is_none() {
        let composite = (0..fronts.len()).any(|i| is_composite(i) && has(i, Layer::Color));
        let also = if composite { " (Composite is not taken unasked: it has been put together already)" } else { "" };
        return Err(format!("there is no channel R, G, B{also}; {}; say --map color=NAME", known(image)));
    }
    let others = (0..fronts.len()).filter(|&i| i != chosen && !fronts[i].is_empty() && has(i, Layer::Color));
    let others = others.map(|i| fronts[i].trim_end_matches('.').to_owned()).collect();
    Ok(Places { of, view_layer: fronts[chosen].trim_end_matches('.').to_owned(), others })
}

/// Returns the prefixes of known names, in the order of the file; the empty prefix is the first.
fn fronts(image: &Channels) -> Vec<String> {
    let mut fronts = vec![String::new()];
    for (name, _) in &image.channels {
        let aliases = Layer::ALL.into_iter().flat_map(Layer::aliases).filter(|Alias(known, ..)| !known.is_empty());
        let front =
            aliases.filter_map(|Alias(known, parts, _)| front_of(name, &join(known, parts[0]))).min_by_key(|f| f.len());
        if let Some(front) = front.filter(|front| !fronts.contains(&(*front).to_owned())) {
            fronts.push(front.to_owned());
        }
    }
    fronts
}

/// Returns the prefix of a name, a dot at its end included.
fn front_of<'a>(full: &'a str, name: &str) -> Option<&'a str> {
    // The comparison of names ignores spelling variants; the prefix stays unchanged.
    (0..full.len()).filter(|&at| at == 0 || full.as_bytes()[at - 1] == b'.').find_map(|at| {
        let rest = full.get(at..)?;
        (plain(rest) == plain(name)).then(|| &full[..at])
    })
}

/// Removes spelling variants from a name.
fn plain(name: &str) -> String {
    name.chars().filter(|c| !matches!(c, ' ' | '_')).flat_map(char::to_lowercase).collect()
}

fn last_part(front: &str) -> String {
    plain(front.trim_end_matches('.').rsplit('.').next().unwrap_or_default())
}

fn in_view_layer(front: &str, image: &Channels) -> Vec<Option<Place>> {
    let of = |layer: Layer| {
        layer.aliases().iter().find_map(|Alias(name, parts, meaning)| {
            let number = |part: &&str| {
                let wanted = join(name, part);
                image.channels.iter().position(|(known, _)| front_of(known, &wanted) == Some(front))
            };
            Some(Place { channels: parts.iter().map(number).collect::<Option<_>>()?, meaning: *meaning })
        })
    };
    Layer::ALL.into_iter().map(of).collect()
}

/// Finds a layer by the user's names: of its channels, of its one channel, or the part before the components.
fn own(mapping: &Mapping, image: &Channels) -> Result<Place, String> {
    let Mapping { layer, names, meaning } = mapping;
    let count = layer.components().len();
    let asked = || format!("which --map {}={} asks for; {}", layer.name(), names.join(","), known(image));
    let name = names.first().map_or("", String::as_str);
    let channels = if names.len() == count && (count > 1 || image.get(name).is_some()) {
        exact(names, image).ok_or_else(|| {
            let absent = names.iter().find(|name| image.get(name).is_none());
            format!("there is no channel {}, {}", absent.map_or("", String::as_str), asked())
        })?
    } else if names.len() == 1 {
        let usual = [layer.components(), RGB, XYZ, XY, &["r", "g", "b"], &["x", "y", "z"], &["V"], &["T"], &["R"]];
        let fitting = usual.into_iter().filter(|parts| parts.len() == count);
        let found = fitting
            .into_iter()
            .find_map(|parts| exact(&parts.iter().map(|part| join(name, part)).collect::<Vec<_>>(), image));
        found.ok_or_else(|| {
            let wanted: Vec<String> = layer.components().iter().map(|part| join(name, part)).collect();
            format!("there is no channel {}, {}", wanted.join(", "), asked())
        })?
    } else {
        return Err(format!(
            "{} takes {count} channels, not {}: --map {}={}",
            layer.name(),
            names.len(),
            layer.name(),
            names.join(",")
        ));
    };
    let first = &image.channels[channels[0]].0;
    Ok(Place { meaning: meaning.unwrap_or_else(|| inferred(*layer, first)), channels })
}

/// Returns the meaning of numbers that a renderer would have given a channel of this name.
fn inferred(layer: Layer, channel: &str) -> Meaning {
    let aliases = layer.aliases().iter().filter(|Alias(name, ..)| !name.is_empty());
    let known = aliases.into_iter().find(|Alias(name, parts, _)| front_of(channel, &join(name, parts[0])).is_some());
    if let Some(Alias(_, _, meaning)) = known {
        return *meaning;
    }
    let name = plain(channel);
    match layer {
        Layer::Depth if name.ends_with(".t") || name.contains("distance") => Meaning::AlongRay,
        Layer::Motion if name.contains("vector") => Meaning::Upwards,
        _ => Meaning::Same,
    }
}

/// Returns the channels of exactly these names.
fn exact(names: &[String], image: &Channels) -> Option<Vec<usize>> {
    names.iter().map(|name| image.channels.iter().position(|(known, _)| known == name)).collect()
}

/// Lists the channels to choose from.
pub fn known(image: &Channels) -> String {
    let names: Vec<&str> = image.channels.iter().map(|(name, _)| name.as_str()).collect();
    format!("the file has {}", names.join(", "))
}

fn join(front: &str, component: &str) -> String {
    if front.is_empty() { component.to_owned() } else { format!("{front}.{component}") }
}
