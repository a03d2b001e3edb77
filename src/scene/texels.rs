//! All images and the environment in one buffer of words.

use super::lights::luminance;
use super::{Environment, Image, Texture, Wrap, alias};
use bytemuck::{Pod, Zeroable};
use std::f64::consts::PI;

/// Where an image lies.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    first: u32,
    width: u32,
    height: u32,
}

/// `TextureUse` of shaders/shared/scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(super) struct GpuTexture {
    first: u32,
    width: u32,
    height: u32,
    mode: u32,
    row_u: [f32; 4],
    row_v: [f32; 4],
}

/// Appends images and returns where they lie.
pub(super) fn add_images(images: &[Image], texels: &mut Vec<u32>) -> Vec<Place> {
    images
        .iter()
        .map(|image| {
            let first = texels.len() as u32;
            texels.extend(image.texels.iter().map(|t| u32::from_le_bytes(*t)));
            Place { first, width: image.width, height: image.height }
        })
        .collect()
}

/// A material's use of an image; all zero where there is none.
pub(super) fn texture_use(texture: Option<Texture>, places: &[Place]) -> GpuTexture {
    let Some(t) = texture else { return GpuTexture::default() };
    let wrap = |w: Wrap| match w {
        Wrap::Repeat => 0,
        Wrap::Mirror => 1,
        Wrap::Clamp => 2,
    };
    let Place { first, width, height } = places[t.image];
    let mode =
        wrap(t.wrap[0]) | wrap(t.wrap[1]) << 2 | u32::from(t.nearest) << 4 | u32::from(t.uv_set == 1) << 5 | 1 << 31;
    let row = |r: [f32; 3]| [r[0], r[1], r[2], 0.0];
    GpuTexture { first, width, height, mode, row_u: row(t.transform[0]), row_v: row(t.transform[1]) }
}

/// Where the environment lies, and Σ luminance · solid angle over its texels.
pub(super) struct EnvironmentPlace {
    pub radiance: u32,
    pub alias: u32,
    pub weight: f64,
}

/// Appends the environment's radiances and the alias table by which its directions are chosen: texels by luminance times
/// solid angle, which for a row of an equirectangular image is 2π/width · (cos of its upper − cos of its lower edge).
pub(super) fn add_environment(environment: &Environment, texels: &mut Vec<u32>) -> EnvironmentPlace {
    let (width, height) = (environment.width as usize, environment.height as usize);
    let radiance = texels.len() as u32;
    texels.extend(environment.radiance.iter().flatten().map(|c| c.to_bits()));
    let edge = |row: usize| (PI * row as f64 / height as f64).cos();
    let weights: Vec<f64> = environment
        .radiance
        .iter()
        .enumerate()
        .map(|(i, &c)| luminance(c) * 2.0 * PI / width as f64 * (edge(i / width) - edge(i / width + 1)))
        .collect();
    let start = texels.len() as u32;
    for entry in alias::table(&weights) {
        texels.extend([entry.threshold.to_bits(), entry.alias]);
    }
    EnvironmentPlace { radiance, alias: start, weight: weights.iter().sum() }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn a_use_of_a_texture_lies_where_the_shaders_read_it() {
        let fields = fields!(GpuTexture: first, width, height, mode, row_u, row_v);
        assert_layout("TextureUse", fields, size_of::<GpuTexture>());
    }
}
