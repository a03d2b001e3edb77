//! Light by the lobe of the surface that reflects it.

use crate::sequence::Pixels;
use crate::sequence::layers::Layer;

/// Splits a frame's light, if its layers can: leaves diffuse light and emission as the colour, specular light as
/// [`Layer::Specular`], and the albedo of each. Light of the other lobes, such as Blender's transmission, counts as diffuse.
pub fn split(pixels: &mut Pixels) {
    let Some(specular) = specular(pixels) else {
        undivided(pixels);
        return;
    };
    let emission = pixels.get(Layer::Emission).map(<[f32]>::to_vec);
    let diffuse = match (pixels.get(Layer::Diffuse), pixels.get(Layer::Color)) {
        (Some(diffuse), _) => {
            let emitted = |i: usize| emission.as_ref().map_or(0.0, |emission| emission[i]);
            diffuse.iter().enumerate().map(|(i, light)| light + emitted(i)).collect()
        }
        (None, Some(all)) => all.iter().zip(&specular).map(|(all, specular)| difference(*all, *specular)).collect(),
        (None, None) => return,
    };
    take_diffuse_color(pixels);
    pixels.set(Layer::Color, Some(diffuse));
    pixels.set(Layer::Specular, Some(specular));
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
/// Blender's denoising albedo holds the specular colour already. Rule: a specular reflectance counts beside an albedo that is
/// diffuse alone, as Blender's Diffuse Color is, or beside a roughness, which Blender does not write.
fn undivided(pixels: &mut Pixels) {
    if !take_diffuse_color(pixels) && pixels.get(Layer::Roughness).is_none() {
        pixels.set(Layer::SpecularAlbedo, None);
    }
}

/// The specular light, with its reflectance.
fn specular(pixels: &Pixels) -> Option<Vec<f32>> {
    if let Some(specular) = pixels.get(Layer::Specular) {
        return Some(specular.to_vec());
    }
    let parts = [Layer::GlossyDirect, Layer::GlossyIndirect].map(|layer| pixels.get(layer));
    let color = pixels.get(Layer::SpecularAlbedo)?;
    // Both are needed: light of one alone would leave the other in the diffuse light.
    let (direct, indirect) = (parts[0]?, parts[1]?);
    Some(color.iter().zip(direct.iter().zip(indirect)).map(|(color, (a, b))| color * (a + b)).collect())
}

/// The rest of the light. A number that is missing, or infinite, stays so.
fn difference(all: f32, specular: f32) -> f32 {
    if all.is_finite() && specular.is_finite() { (all - specular).max(0.0) } else { all }
}
