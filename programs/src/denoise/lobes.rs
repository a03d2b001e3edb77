//! Light by the lobe of the surface that reflects it.

use crate::sequence::Pixels;
use crate::sequence::layers::Layer;

/// Splits a frame's light, if its layers can: leaves diffuse light and emission as the colour, specular light as
/// [`Layer::Specular`], and the albedo of each. Light of the other lobes, such as Blender's transmission, counts as diffuse.
pub fn split(pixels: &mut Pixels) {
    let Some(all) = pixels.get(Layer::Color).map(<[f32]>::to_vec) else { return };
    let Some(specular) = specular(pixels).filter(|specular| is_part(specular, &all)) else {
        pixels.set(Layer::Specular, None);
        undivided(pixels);
        return;
    };
    let diffuse = diffuse(pixels, &all, &specular);
    take_diffuse_color(pixels);
    pixels.set(Layer::Color, Some(diffuse));
    pixels.set(Layer::Specular, Some(specular));
}

/// Parts of a number within which two sums count as equal: twice the rounding of 16-bit floats.
const EQUAL: f32 = 1.0 / 512.0;

/// Part of the numbers that may be brighter than all light, by filters or by rounding.
const FEW: f32 = 0.02;

/// True if specular light is part of all light. Failure: a layer of another meaning, such as a material's specular weight,
/// would be filtered and added as light. Reason: `specular` is a common name. Rule: light exceeds all light nowhere.
fn is_part(specular: &[f32], all: &[f32]) -> bool {
    let lit = || {
        specular.iter().zip(all).filter(|(specular, all)| specular.is_finite() && all.is_finite() && **specular > 0.0)
    };
    let beyond = lit().filter(|(specular, all)| **specular > **all * (1.0 + EQUAL) + 1e-4).count();
    beyond as f32 <= FEW * lit().count() as f32
}

/// The light that is not specular, emission included. Failure: a renderer that writes diffuse, specular, coat and transmission apart
/// would lose the last two. Reason: diffuse light is not all the rest. Rule: the layer counts where it is the rest, because a
/// difference of rounded numbers is less exact; elsewhere the difference counts.
fn diffuse(pixels: &Pixels, all: &[f32], specular: &[f32]) -> Vec<f32> {
    let (given, emission) = (pixels.get(Layer::Diffuse), pixels.get(Layer::Emission));
    let rest = |i: usize| {
        let emitted = emission.map_or(0.0, |emission| emission[i]);
        let given = given.map(|diffuse| diffuse[i] + emitted);
        let is_rest = |given: &f32| (given + specular[i] - all[i]).abs() <= EQUAL * all[i].abs() + 1e-5;
        given.filter(is_rest).unwrap_or_else(|| difference(all[i], specular[i]))
    };
    (0..all.len()).map(rest).collect()
}

/// The rest of the light. A number that is missing, or infinite, stays so.
fn difference(all: f32, specular: f32) -> f32 {
    if all.is_finite() && specular.is_finite() { (all - specular).max(0.0) } else { all }
}

/// Gives a frame Blender's colours of the diffuse and the other lobes as its albedo, if it has them. True if it does.
fn take_diffuse_color(pixels: &mut Pixels) -> bool {
    let Some(color) = pixels.get(Layer::DiffuseColor) else { return false };
    let through = pixels.get(Layer::TransmissionColor);
    let albedo = color.iter().enumerate().map(|(i, color)| color + through.map_or(0.0, |through| through[i])).collect();
    pixels.set(Layer::Albedo, Some(albedo));
    true
}

/// Prepares the reflectances of a frame whose light is one radiance. Failure: a metal was divided by its reflectance twice. Reason:
/// Blender's denoising albedo holds the specular colour already. Rule: a specular reflectance counts beside a roughness alone, which
/// Blender does not write, and Blender's Diffuse Color is then the albedo.
fn undivided(pixels: &mut Pixels) {
    if pixels.get(Layer::Roughness).is_none() {
        pixels.set(Layer::SpecularAlbedo, None);
    } else if pixels.get(Layer::SpecularAlbedo).is_some() {
        take_diffuse_color(pixels);
    }
}

/// The specular light, with its reflectance.
fn specular(pixels: &Pixels) -> Option<Vec<f32>> {
    if let Some(specular) = pixels.get(Layer::Specular) {
        return Some(specular.to_vec());
    }
    // Failure: a room by Cycles had a relMSE of 0.0149 with its passes apart, and of 0.0134 without. Reason: no pass says where
    // reflections are. Rule: the passes are split beside a roughness or a distance alone.
    pixels.get(Layer::Roughness).or(pixels.get(Layer::HitDistance))?;
    let color = pixels.get(Layer::SpecularAlbedo)?;
    // Both are needed: light of one alone would leave the other in the diffuse light.
    let (direct, indirect) = (pixels.get(Layer::GlossyDirect)?, pixels.get(Layer::GlossyIndirect)?);
    Some(color.iter().zip(direct.iter().zip(indirect)).map(|(color, (a, b))| color * (a + b)).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn frame(layers: &[(Layer, f32)]) -> Pixels {
        let mut pixels = Pixels(vec![None; Layer::ALL.len()]);
        for &(layer, value) in layers {
            pixels.set(layer, Some(vec![value; 3]));
        }
        pixels
    }

    fn first(pixels: &Pixels, layer: Layer) -> Option<f32> {
        pixels.get(layer).map(|samples| samples[0])
    }

    #[test]
    fn light_of_other_lobes_is_kept() {
        let mut pixels = frame(&[(Layer::Color, 1.0), (Layer::Diffuse, 0.25), (Layer::Specular, 0.5)]);
        split(&mut pixels);
        assert_eq!(first(&pixels, Layer::Color), Some(0.5), "a quarter is of neither lobe");
        let whole = [(Layer::Color, 1.0), (Layer::Emission, 0.25), (Layer::Diffuse, 0.25), (Layer::Specular, 0.5)];
        let mut pixels = frame(&whole);
        split(&mut pixels);
        assert_eq!(first(&pixels, Layer::Color), Some(0.5), "diffuse light and emission");
    }

    #[test]
    fn a_layer_that_is_brighter_than_all_light_is_no_light() {
        let mut pixels = frame(&[(Layer::Color, 0.1), (Layer::Specular, 0.5), (Layer::Diffuse, 1.0)]);
        split(&mut pixels);
        assert_eq!((first(&pixels, Layer::Color), first(&pixels, Layer::Specular)), (Some(0.1), None));
    }

    #[test]
    fn blenders_passes_are_multiplied() {
        let glossy = [(Layer::SpecularAlbedo, 0.5), (Layer::GlossyDirect, 1.0), (Layer::GlossyIndirect, 0.5)];
        let rest = [(Layer::Color, 1.0), (Layer::DiffuseColor, 0.25), (Layer::TransmissionColor, 0.5)];
        let mut pixels = frame(&[&glossy[..], &rest[..], &[(Layer::Roughness, 0.5)]].concat());
        split(&mut pixels);
        let found = [Layer::Specular, Layer::Color, Layer::Albedo].map(|layer| first(&pixels, layer));
        assert_eq!(found, [Some(0.75), Some(0.25), Some(0.75)]);
    }

    #[test]
    fn a_reflectance_that_an_albedo_contains_is_left_out() {
        let mut pixels = frame(&[(Layer::Color, 1.0), (Layer::Albedo, 0.5), (Layer::SpecularAlbedo, 0.5)]);
        split(&mut pixels);
        assert_eq!(first(&pixels, Layer::SpecularAlbedo), None);
    }
}
