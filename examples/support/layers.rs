//! The layers of a frame, and the names that channels have for them in the files of several renderers.

use asvgf::image_io::Channels;

/// Something that is known of every pixel.
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
}

/// How numbers differ from those of the format.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Meaning {
    /// They do not.
    Same,
    /// The second component points up in the image.
    Upwards,
    /// Distances along the pixel's ray, not along the view axis.
    AlongRay,
}

/// A name that other programs have for a layer, its channels, and what they hold.
struct Alias(&'static str, &'static [&'static str], Meaning);

const RGB: &[&str] = &["R", "G", "B"];
const XYZ: &[&str] = &["X", "Y", "Z"];
const XY: &[&str] = &["X", "Y"];

impl Layer {
    pub const ALL: [Self; 11] = [
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
    ];

    /// What it is called; what stands before the dot in its channels' names, but for the colour.
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
        }
    }

    /// The last parts of its channels' names.
    pub fn components(self) -> &'static [&'static str] {
        match self {
            Self::Color | Self::Albedo | Self::Emission | Self::GradientCurrent | Self::GradientPrevious => RGB,
            Self::Normal => XYZ,
            Self::Motion => XY,
            Self::Depth | Self::PreviousDepth => &["Z"],
            Self::Id => &["I"],
            Self::Lambda => &["Y"],
        }
    }

    /// Whether nothing can be done without it.
    pub fn required(self) -> bool {
        matches!(self, Self::Color | Self::Normal | Self::Depth)
    }

    /// Whether it holds what paths were repeated, of which a frame may have none.
    pub fn is_of_pairs(self) -> bool {
        matches!(self, Self::GradientCurrent | Self::GradientPrevious)
    }

    /// The full names of its channels.
    pub fn channels(self) -> Vec<String> {
        let front = if self == Self::Color { "" } else { self.name() };
        self.components().iter().map(|component| join(front, component)).collect()
    }

    /// What Blender (4 and earlier) and Mitsuba 3 call it. Names that Mitsuba leaves to its user are those of its manual.
    fn aliases(self) -> &'static [Alias] {
        use Meaning::*;
        match self {
            Self::Color => &[Alias("Combined", RGB, Same), Alias("image", RGB, Same)],
            Self::Albedo => &[Alias("Denoising Albedo", RGB, Same), Alias("Denoising Albedo", XYZ, Same)],
            Self::Emission => &[Alias("Emit", RGB, Same), Alias("Emission", RGB, Same)],
            Self::Normal => &[
                Alias("Normal", XYZ, Same),
                Alias("Denoising Normal", XYZ, Same),
                Alias("sh_normal", XYZ, Same),
                Alias("normals", XYZ, Same),
                Alias("nn", XYZ, Same),
            ],
            Self::Depth => &[
                Alias("Depth", &["Z"], Same),
                Alias("Depth", &["V"], Same),
                Alias("depth", &["T"], AlongRay),
                Alias("dd", &["T"], AlongRay),
            ],
            // Blender's Vector holds previous − current in X and Y, and Y is up.
            Self::Motion => &[Alias("Vector", XY, Upwards)],
            Self::Id => &[
                Alias("IndexOB", &["X"], Same),
                Alias("Object Index", &["X"], Same),
                Alias("shape_index", &["I"], Same),
            ],
            Self::PreviousDepth | Self::GradientCurrent | Self::GradientPrevious | Self::Lambda => &[],
        }
    }
}

/// Names of a user's own: which layer, and what its channels are called before the last dot.
pub type Names = Vec<(Layer, String)>;

/// Where a layer is in a file: the numbers of its channels.
#[derive(Clone, Debug, PartialEq)]
pub struct Place {
    pub channels: Vec<usize>,
    pub meaning: Meaning,
}

/// Finds a layer in a file, `None` if there is none of its names. The error is the channel that is missing beside others.
pub fn find(layer: Layer, names: &Names, image: &Channels) -> Result<Option<Place>, String> {
    if let Some((_, name)) = names.iter().find(|(named, _)| *named == layer) {
        return own(layer, name, image).map(Some);
    }
    if let Some(place) = exact(&layer.channels(), Meaning::Same, image) {
        return Ok(Some(place));
    }
    // Some of the format's own channels, but not all.
    let (there, absent): (Vec<_>, Vec<_>) = layer.channels().into_iter().partition(|name| image.get(name).is_some());
    if let (Some(there), Some(absent)) = (there.first(), absent.first()) {
        return Err(format!("there is no channel {absent} beside {there}"));
    }
    Ok(layer.aliases().iter().find_map(|Alias(name, components, meaning)| within(name, components, *meaning, image)))
}

/// A layer under a name of the user's: the name of its one channel, or what stands before the components.
fn own(layer: Layer, name: &str, image: &Channels) -> Result<Place, String> {
    let whole = [name.to_owned()];
    let single = if layer.components().len() == 1 { exact(&whole, Meaning::Same, image) } else { None };
    let usual = [layer.components(), RGB, XYZ, XY, &["r", "g", "b"], &["x", "y", "z"], &["V"]];
    let fitting = usual.into_iter().filter(|components| components.len() == layer.components().len());
    let prefixed = || {
        fitting
            .into_iter()
            .find_map(|c| exact(&c.iter().map(|c| join(name, c)).collect::<Vec<_>>(), Meaning::Same, image))
    };
    single.or_else(prefixed).ok_or_else(|| {
        let wanted: Vec<String> = layer.components().iter().map(|c| join(name, c)).collect();
        format!(
            "there is no channel {}, which --map {}={name} asks for; {}",
            wanted.join(", "),
            layer.name(),
            known(image)
        )
    })
}

/// The channels of exactly these names.
fn exact(names: &[String], meaning: Meaning, image: &Channels) -> Option<Place> {
    let number = |name: &String| image.channels.iter().position(|(known, _)| known == name);
    Some(Place { channels: names.iter().map(number).collect::<Option<_>>()?, meaning })
}

/// The channels of these components of a name, with or without the name of a view layer in front; the first view layer counts.
fn within(name: &str, components: &[&str], meaning: Meaning, image: &Channels) -> Option<Place> {
    let first = join(name, components[0]);
    image.channels.iter().find_map(|(known, _)| {
        let front = known.strip_suffix(first.as_str()).filter(|front| front.is_empty() || front.ends_with('.'))?;
        exact(&components.iter().map(|c| format!("{front}{}", join(name, c))).collect::<Vec<_>>(), meaning, image)
    })
}

/// What there is to choose from.
pub fn known(image: &Channels) -> String {
    let names: Vec<&str> = image.channels.iter().map(|(name, _)| name.as_str()).collect();
    format!("the file has {}", names.join(", "))
}

fn join(front: &str, component: &str) -> String {
    if front.is_empty() { component.to_owned() } else { format!("{front}.{component}") }
}
