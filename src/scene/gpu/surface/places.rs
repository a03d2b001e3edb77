//! Places of the texels of all images.

use crate::scene::description::{Image, SceneError};
use crate::scene::gpu::memory::capacity::Capacity;
use crate::scene::gpu::memory::folded;
use wgpu::Limits;

/// Rows of a layer, as in shaders/shared/scene.wgsl. A layer is written at once, because wgpu first clears one that is written in part.
pub(crate) const ROWS: usize = 1024;

/// Texels of a layer.
pub(crate) const LAYER: usize = folded::WIDTH * ROWS;

/// The place of an image.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Place {
    pub first: u32,
    pub width: u32,
    pub height: u32,
}

/// The places of the images, one after the other.
///
/// # Errors
/// Names the images if they have more texels than a texture of the device can hold.
pub(crate) fn places(limits: &Limits, images: &[Image]) -> Result<Vec<Place>, SceneError> {
    let count = images.iter().map(|image| image.texels.len() as u64).sum();
    check(count, limits)?;
    let mut next = 0;
    let place = |image: &Image| {
        let first = next;
        next += image.texels.len() as u64;
        Place { first: first as u32, width: image.width, height: image.height }
    };
    Ok(images.iter().map(place).collect())
}

/// True if the images are larger than a storage binding, so that they go into a texture.
pub(crate) fn are_folded(images: &[Image], capacity: &Capacity) -> bool {
    let count: usize = images.iter().map(|image| image.texels.len()).sum();
    (count * size_of::<u32>()) as u64 > capacity.largest_buffer()
}

fn check(texels: u64, limits: &Limits) -> Result<(), SceneError> {
    // Texels have 32-bit numbers.
    let most = (u64::from(limits.max_texture_array_layers) * LAYER as u64).min(1 << 32);
    if texels <= most {
        return Ok(());
    }
    let reason = format!(
        "have {texels} texels together, the {} layers that a texture of the device may have hold {most}: scale images \
         down, or raise max_texture_array_layers",
        limits.max_texture_array_layers
    );
    Err(SceneError::of_scene("images", reason))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn images_that_are_too_large_are_named_with_a_remedy() {
        let limits = Limits::default();
        let most = 256 * LAYER as u64;
        assert!(check(most, &limits).is_ok());
        let error = check(most + 1, &limits).unwrap_err();
        assert_eq!(error.element, "images");
        for part in ["1073741825 texels", "hold 1073741824", "scale images down", "max_texture_array_layers"] {
            assert!(error.reason.contains(part), "{part}: {error}");
        }
    }
}
