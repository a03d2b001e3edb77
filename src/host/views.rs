//! Checks of the host's views when they are handed in, and the features that follow from them.

use super::{Gloss, Lambda, Pairs, Shading, Surfaces};
use crate::Error;
use crate::passes::{Grid, HostView};
use crate::plan::{Changes, HostInputs, PairInputs};
use crate::settings::{Gradient, Mode, Settings};
use wgpu::TextureFormat::{self, *};
use wgpu::{TextureDimension, TextureUsages, TextureView};

const DEPTH: &[TextureFormat] = &[R32Float, R16Float, Rg16Float, Rg32Float, Rgba16Float, Rgba32Float];
const DEPTH_WORDS: &str =
    "r32float, r16float, rg16float, rg32float, rgba16float or rgba32float (linear depth in the first channel)";

const DIRECT_NORMAL: &[TextureFormat] = &[Rgba16Float, Rgba32Float, Rgba8Snorm];
const MAPPED_NORMAL: &[TextureFormat] = &[Rgba8Unorm, Rgb10a2Unorm];
const OCTAHEDRAL_NORMAL: &[TextureFormat] = &[Rg16Float, Rg32Float, Rg8Snorm, Rg16Snorm];
const MAPPED_OCTAHEDRAL_NORMAL: &[TextureFormat] = &[Rg8Unorm, Rg16Unorm];
const NORMAL_WORDS: &str = "rgba16float, rgba32float or rgba8snorm (xyz), rgba8unorm or rgb10a2unorm (xyz mapped to 0…1), rg16float, \
    rg32float, rg8snorm, rg16snorm, rg8unorm or rg16unorm (octahedral), or r32uint (octahedral, 2×16 bits)";

const MOTION: &[TextureFormat] = &[Rg16Float, Rg32Float, Rgba16Float, Rgba32Float];
const MOTION_WORDS: &str = "rg16float, rg32float, rgba16float or rgba32float (pixels, previous − current)";

const UINT_INSTANCE: &[TextureFormat] =
    &[R8Uint, R16Uint, R32Uint, Rg8Uint, Rg16Uint, Rg32Uint, Rgba8Uint, Rgba16Uint, Rgba32Uint];
const FLOAT_INSTANCE: &[TextureFormat] = &[R16Float, R32Float, Rg16Float, Rg32Float, Rgba16Float, Rgba32Float];
const INSTANCE_WORDS: &str =
    "r32uint, r16uint, r8uint, r32float or r16float, or more channels of these (a number in the first)";

const RADIANCE: &[TextureFormat] = &[Rgba16Float, Rgba32Float, Rg11b10Ufloat, Rgb9e5Ufloat];
const RADIANCE_WORDS: &str = "rgba16float, rgba32float, rg11b10ufloat or rgb9e5ufloat";

const ALBEDO: &[TextureFormat] = &[
    Rgba8Unorm,
    Rgba8UnormSrgb,
    Bgra8Unorm,
    Bgra8UnormSrgb,
    Rgb10a2Unorm,
    Rgba16Float,
    Rgba32Float,
    Rg11b10Ufloat,
    Rgb9e5Ufloat,
];
const ALBEDO_WORDS: &str = "rgba8unorm, bgra8unorm (-srgb too), rgb10a2unorm, rgba16float, rgba32float, rg11b10ufloat or \
    rgb9e5ufloat";

const PAIR: &[TextureFormat] = &[Rgba16Float, Rgba32Float];
const LUMINANCE_PAIR: &[TextureFormat] = &[R16Float, R32Float];
const PAIR_WORDS: &str = "rgba16float or rgba32float (radiance), or r16float or r32float (luminance)";

const ROUGHNESS: &[TextureFormat] = &[R8Unorm, R16Float, R32Float, Rg8Unorm, Rg16Float, Rg32Float];
const ROUGHNESS_IN_ALPHA: &[TextureFormat] = &[Rgba8Unorm, Rgba16Float, Rgba32Float];
const ROUGHNESS_WORDS: &str = "r8unorm, r16float, r32float or two channels of these (the first), or rgba8unorm, rgba16float or rgba32float (the fourth)";
const HIT_DISTANCE_WORDS: &str =
    "r32float, r16float, rg16float, rg32float, rgba16float or rgba32float (a distance in the first channel)";

const LAMBDA: &[TextureFormat] =
    &[R8Unorm, R16Float, R32Float, Rg8Unorm, Rg16Float, Rg32Float, Rgba8Unorm, Rgba16Float, Rgba32Float];
const LAMBDA_WORDS: &str = "r8unorm, r16float or r32float, or more channels of these (λ in the first)";

/// Checks a view that is read, and returns its format.
fn read(
    name: &'static str,
    view: &TextureView,
    size: [u32; 2],
    formats: &[&[TextureFormat]],
    accepted: &'static str,
) -> Result<TextureFormat, Error> {
    let texture = view.texture();
    let format = texture.format();
    if !formats.iter().any(|list| list.contains(&format)) {
        return Err(Error::ViewFormat { view: name, format, accepted });
    }
    shape(name, view)?;
    let found = [texture.width(), texture.height()];
    if found != size {
        return Err(Error::ViewSize { view: name, found, expected: size });
    }
    let missing = TextureUsages::TEXTURE_BINDING - texture.usage();
    if !missing.is_empty() {
        return Err(Error::ViewUsage { view: name, missing });
    }
    Ok(format)
}

/// Checks a view that is written, and returns its format.
pub(crate) fn target(target: &TextureView, size: [u32; 2], accepted: &[TextureFormat]) -> Result<TextureFormat, Error> {
    let texture = target.texture();
    let format = texture.format();
    shape("target", target)?;
    if !accepted.contains(&format) {
        let accepted = match accepted.len() {
            2 => "rgba16float or rgba32float",
            _ => "rgba8unorm, rgba16float or rgba32float",
        };
        return Err(Error::ViewFormat { view: "target", format, accepted });
    }
    let found = [texture.width(), texture.height()];
    if found != size {
        return Err(Error::ViewSize { view: "target", found, expected: size });
    }
    let missing = TextureUsages::STORAGE_BINDING - texture.usage();
    if !missing.is_empty() {
        return Err(Error::ViewUsage { view: "target", missing });
    }
    Ok(format)
}

/// Checks that a view is of a plain image.
fn shape(view: &'static str, of: &TextureView) -> Result<(), Error> {
    let texture = of.texture();
    if texture.dimension() != TextureDimension::D2 || texture.depth_or_array_layers() != 1 {
        return Err(Error::ViewShape { view, found: "not one image" });
    }
    if texture.sample_count() != 1 {
        return Err(Error::ViewShape { view, found: "multisampled" });
    }
    Ok(())
}

impl<'a> Surfaces<'a> {
    /// The view of this kind, if it is one of the surfaces' and was given.
    pub(crate) fn view(&self, kind: HostView) -> Option<&'a TextureView> {
        match kind {
            HostView::Depth => Some(self.depth),
            HostView::Normal => Some(self.normal),
            HostView::Motion => Some(self.motion),
            HostView::PreviousDepth => self.previous_depth,
            HostView::Instance => self.instance,
            _ => None,
        }
    }
}

impl<'a> Shading<'a> {
    /// The view of this kind, if it is one of the light's and was given.
    pub(crate) fn view(&self, kind: HostView) -> Option<&'a TextureView> {
        match kind {
            HostView::Radiance => Some(self.radiance),
            HostView::Albedo => self.albedo,
            HostView::Emission => self.emission,
            HostView::PairNow => self.pairs.map(|pairs| pairs.current),
            HostView::PairBefore => self.pairs.map(|pairs| pairs.previous),
            HostView::Lambda => self.lambda.map(|lambda| lambda.view),
            HostView::SpecularRadiance => self.gloss?.radiance,
            HostView::Reflectance => self.gloss?.reflectance,
            HostView::Roughness => self.gloss?.roughness,
            HostView::HitDistance => self.gloss?.hit_distance,
            HostView::ReflectionMotion => self.gloss?.motion,
            HostView::SpecularPairNow => Some(self.gloss?.pairs?.current),
            HostView::SpecularPairBefore => Some(self.gloss?.pairs?.previous),
            _ => None,
        }
    }
}

/// Checks the G-buffer's views, and notes their contents.
pub(crate) fn surfaces(inputs: &mut HostInputs, given: &Surfaces<'_>, size: [u32; 2]) -> Result<(), Error> {
    read("depth", given.depth, size, &[DEPTH], DEPTH_WORDS)?;
    let lists = [DIRECT_NORMAL, MAPPED_NORMAL, OCTAHEDRAL_NORMAL, MAPPED_OCTAHEDRAL_NORMAL, &[R32Uint]];
    let normal = read("normal", given.normal, size, &lists, NORMAL_WORDS)?;
    inputs.packed_normals = normal == R32Uint;
    inputs.mapped_normals = MAPPED_NORMAL.contains(&normal) || MAPPED_OCTAHEDRAL_NORMAL.contains(&normal);
    inputs.octahedral_normals = OCTAHEDRAL_NORMAL.contains(&normal) || MAPPED_OCTAHEDRAL_NORMAL.contains(&normal);
    read("motion", given.motion, size, &[MOTION], MOTION_WORDS)?;
    if let Some(view) = given.previous_depth {
        read("previous_depth", view, size, &[DEPTH], DEPTH_WORDS)?;
    }
    inputs.previous_depth = given.previous_depth.is_some();
    if let Some(view) = given.instance {
        let format = read("instance", view, size, &[UINT_INSTANCE, FLOAT_INSTANCE], INSTANCE_WORDS)?;
        inputs.float_instances = FLOAT_INSTANCE.contains(&format);
    }
    inputs.instances = given.instance.is_some();
    Ok(())
}

/// Checks the light's views, and notes their contents.
pub(crate) fn shading(
    inputs: &mut HostInputs,
    given: &Shading<'_>,
    size: [u32; 2],
    (settings, changes): (&Settings, Changes),
) -> Result<(), Error> {
    read("radiance", given.radiance, size, &[RADIANCE], RADIANCE_WORDS)?;
    if let Some(view) = given.albedo {
        read("albedo", view, size, &[ALBEDO], ALBEDO_WORDS)?;
    }
    if let Some(view) = given.emission {
        read("emission", view, size, &[RADIANCE], RADIANCE_WORDS)?;
    }
    inputs.albedo = given.albedo.is_some();
    inputs.emission = given.emission.is_some();
    inputs.demodulated = given.demodulated;
    let Gloss { radiance, reflectance, roughness, .. } = given.gloss.unwrap_or_default();
    let light = [Some(given.radiance), given.albedo, given.emission, radiance, reflectance, roughness];
    inputs.in_target = light.into_iter().flatten().any(|view| view.texture() == given.target.texture());
    let specular_pairs = gloss(inputs, given.gloss.unwrap_or_default(), size)?;
    if settings.mode != Mode::Denoise {
        return Ok(());
    }
    inputs.pairs = given.pairs.map(|_| PairInputs::default());
    inputs.lambda = given.lambda.is_some();
    let missing = |view, setting, remedy| Error::ViewMissing { view, setting, remedy };
    match settings.filter.gradient.hosted(inputs.lambda, inputs.pairs.is_some()) {
        // Pairs are not needed, because the scene has not changed.
        Gradient::Pairs if !changes.scene => {
            inputs.specular_pairs = specular_pairs.map(|_| PairInputs::default());
            Ok(())
        }
        Gradient::Pairs => {
            let none = missing("pairs", "Gradient::Pairs", "fill `Shading::pairs`, or choose Gradient::Automatic");
            inputs.pairs = Some(pairs(PAIRS, given.pairs.as_ref().ok_or(none)?, size)?);
            let specular = specular_pairs.map(|given| pairs(SPECULAR_PAIRS, &given, size)).transpose()?;
            inputs.specular_pairs = specular;
            Ok(())
        }
        Gradient::Lambda => {
            let none = missing("lambda", "Gradient::Lambda", "fill `Shading::lambda`, or choose Gradient::Automatic");
            lambda(inputs, given.lambda.as_ref().ok_or(none)?, size)
        }
        _ => Ok(()),
    }
}

/// Names of a view of pairs now, of one before, and of what the latter's format must match.
const PAIRS: [&str; 2] = ["pairs.current", "pairs.previous"];
const SPECULAR_PAIRS: [&str; 2] = ["gloss.pairs.current", "gloss.pairs.previous"];

/// Checks pairs, and notes their contents.
fn pairs([now, before]: [&'static str; 2], given: &Pairs<'_>, size: [u32; 2]) -> Result<PairInputs, Error> {
    let texture = given.current.texture();
    let found = [texture.width(), texture.height()];
    // A 1×1 image has one pixel and one stratum: it does not matter which is meant.
    let per_stratum = found == Grid::Strata.extent(size) && !given.in_place;
    let size = if per_stratum { found } else { size };
    let current = read(now, given.current, size, &[PAIR, LUMINANCE_PAIR], PAIR_WORDS)?;
    let luminance = LUMINANCE_PAIR.contains(&current);
    let (list, words) = if luminance {
        (LUMINANCE_PAIR, "r16float or r32float, as pairs.current holds luminances")
    } else {
        (PAIR, "rgba16float or rgba32float, as pairs.current holds radiances")
    };
    read(before, given.previous, size, &[list], words)?;
    Ok(PairInputs { luminance, per_stratum, in_place: given.in_place })
}

/// Checks the views of gloss, notes their contents, and returns the specular pairs.
fn gloss<'a>(inputs: &mut HostInputs, given: Gloss<'a>, size: [u32; 2]) -> Result<Option<Pairs<'a>>, Error> {
    if let Some(view) = given.radiance {
        read("gloss.radiance", view, size, &[RADIANCE], RADIANCE_WORDS)?;
    }
    if let Some(view) = given.reflectance {
        read("gloss.reflectance", view, size, &[ALBEDO], ALBEDO_WORDS)?;
    }
    if let Some(view) = given.roughness {
        let format = read("gloss.roughness", view, size, &[ROUGHNESS, ROUGHNESS_IN_ALPHA], ROUGHNESS_WORDS)?;
        inputs.roughness_in_alpha = ROUGHNESS_IN_ALPHA.contains(&format);
    }
    // These place a signal of its own, and are not looked at without one.
    let split = given.radiance.is_some();
    if let Some(view) = given.hit_distance.filter(|_| split) {
        read("gloss.hit_distance", view, size, &[DEPTH], HIT_DISTANCE_WORDS)?;
    }
    if let Some(view) = given.motion.filter(|_| split) {
        read("gloss.motion", view, size, &[MOTION], MOTION_WORDS)?;
    }
    inputs.specular = split;
    inputs.reflectance = given.reflectance.is_some();
    inputs.roughness = given.roughness.is_some();
    inputs.hit_distance = split && given.hit_distance.is_some();
    inputs.reflection_motion = split && given.motion.is_some();
    Ok(given.pairs.filter(|_| split))
}

fn lambda(inputs: &mut HostInputs, given: &Lambda<'_>, size: [u32; 2]) -> Result<(), Error> {
    if !(1..=32768).contains(&given.block) {
        let value = given.block.into();
        return Err(Error::Setting { setting: "Lambda::block", value, accepted: "1…32768 pixels" });
    }
    let size = size.map(|s| s.div_ceil(given.block));
    read("lambda", given.view, size, &[LAMBDA], LAMBDA_WORDS)?;
    inputs.confidence = given.confidence;
    Ok(())
}
