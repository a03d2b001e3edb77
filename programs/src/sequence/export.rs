//! Export of the path tracer's own frames as a sequence for `denoise`.

use crate::film::Film;
use crate::sequence::camera::{Camera, Lens, Raster, dot};
use crate::sequence::layers::Layer;
use asvgf::image_io::{self, Channels};
use asvgf::{Error, View};
use serde_json::json;
use std::fs;
use std::path::Path;

/// Writer of one sequence, whose frames all have the same layers.
#[derive(Default)]
pub struct Export {
    /// Layers of the first frame: the denoiser is new then, and so has left nothing out.
    layers: Option<Vec<Layer>>,
}

impl Export {
    /// Writes the last frame.
    pub fn write(&mut self, path: &Path, film: &mut Film<'_>) -> Result<(), Box<dyn std::error::Error>> {
        let [width, height] = film.denoiser.size();
        let mut image = Channels { width, height, channels: Vec::new() };
        let mut found = Vec::new();
        for layer in Layer::ALL {
            let Some((view, value)) = source(layer) else { continue };
            if self.layers.as_ref().is_some_and(|layers| !layers.contains(&layer)) {
                continue;
            }
            let pixels = match film.numbers(view) {
                Ok(pixels) => pixels,
                // Nothing changed, so no path was repeated.
                Err(Error::NoView { .. }) if self.layers.is_some() && layer.is_of_pairs() => {
                    vec![[-1.0; 3]; (width * height) as usize]
                }
                // Nothing emits, nothing shines, nothing moves by itself, or α does not adapt.
                Err(Error::NoView { .. }) => continue,
                Err(error) => return Err(error.into()),
            };
            found.push(layer);
            for (i, name) in layer.channels().into_iter().enumerate() {
                image.channels.push((name, pixels.iter().map(|&pixel| value(pixel)[i]).collect()));
            }
        }
        self.layers.get_or_insert(found);
        Ok(image_io::write_exr(path, &image)?)
    }
}

/// Function that picks a layer's components from a pixel of a view.
type Components = fn([f32; 3]) -> [f32; 3];

/// Returns the view that holds a layer, and the components in its pixels.
fn source(layer: Layer) -> Option<(View, Components)> {
    let same: Components = |pixel| pixel;
    Some(match layer {
        Layer::Color => (View::Noisy, same),
        Layer::Albedo => (View::Albedo, same),
        Layer::Emission => (View::Emission, same),
        Layer::Normal => (View::Normal, same),
        Layer::Depth => (View::Depth, same),
        Layer::Motion => (View::Motion, same),
        Layer::PreviousDepth => (View::Motion, |[_, _, z]| [z; 3]),
        Layer::Id => (View::Object, |[low, high, _]| [low + 65536.0 * high; 3]),
        Layer::GradientCurrent => (View::PairNow, same),
        Layer::GradientPrevious => (View::PairBefore, same),
        Layer::Diffuse => (View::DiffuseNoisy, same),
        Layer::Specular => (View::SpecularNoisy, same),
        Layer::SpecularAlbedo => (View::SpecularAlbedo, same),
        Layer::Roughness => (View::Roughness, same),
        // The denoiser of the sequence smooths the distances by itself.
        Layer::HitDistance => (View::HitDistance, |[_, own, _]| [own; 3]),
        Layer::SpecularMotion => (View::ReflectionMotion, same),
        Layer::SpecularGradientCurrent => (View::SpecularPairNow, same),
        Layer::SpecularGradientPrevious => (View::SpecularPairBefore, same),
        _ => return None,
    })
}

/// Writes the cameras of the frames, beside them.
pub fn write_manifest(folder: &Path, size: [u32; 2], cameras: &[asvgf::Camera]) -> Result<(), String> {
    let cameras: Vec<_> = cameras.iter().map(|&c| camera(c, size).to_json()).collect();
    let [width, height] = size;
    let manifest = json!({
        "width": width, "height": height, "frames": cameras.len(), "gradient_in_place": true, "cameras": cameras,
    });
    let path = folder.join("manifest.json");
    fs::write(&path, format!("{manifest:#}\n")).map_err(|e| format!("{}: cannot be written: {e}", path.display()))
}

/// Returns the same camera by its directions.
fn camera(seen: asvgf::Camera, size: [u32; 2]) -> Camera {
    let (eye, target, up) = (seen.eye, seen.target, seen.up.map(f64::from));
    let forward = unit(std::array::from_fn(|i| target[i] - eye[i]));
    let right = unit(cross(forward, up));
    let lens = Lens::Perspective(Raster::whole(size).slope_of(seen.fov_y.into()));
    let directions = [right, cross(right, forward), forward];
    Camera { eye, jitter: seen.jitter.map(f64::from), ..Camera::looking(directions, lens) }
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

fn unit(a: [f64; 3]) -> [f64; 3] {
    let length = dot(a, a).sqrt();
    a.map(|x| x / length)
}
