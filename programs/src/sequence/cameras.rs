//! Cameras of a sequence without a manifest: from attributes, or from the images of the frames.

use super::camera_fit::{Fit, fit};
use super::layers::{Layer, Meaning};
use super::{Eye, Frame, Sequence, interleave};
use crate::sequence::camera::Camera;

/// Default vertical field of view, in radians, if it is undetermined.
const DEFAULT_FOV_Y: f32 = std::f32::consts::FRAC_PI_4;

/// Camera data of a frame.
pub enum Seen {
    Described(Camera),
    Fitted(Fit),
    Nothing,
}

impl Seen {
    fn described(&self) -> Option<Camera> {
        if let Self::Described(camera) = self { Some(*camera) } else { None }
    }

    fn fitted(&self) -> Option<Fit> {
        if let Self::Fitted(fit) = self { Some(*fit) } else { None }
    }
}

impl Sequence {
    /// Returns the camera data of a frame.
    pub(super) fn see(&self, frame: &Frame) -> Seen {
        if let Some(camera) = frame.described {
            return Seen::Described(camera);
        }
        let samples = |layer: Layer| -> Option<(Vec<f32>, Meaning)> {
            let place = frame.places.get(layer)?;
            let channels: Vec<Vec<f32>> = place.channels.iter().map(|&c| frame.image.channels[c].1.clone()).collect();
            Some((interleave(&channels, place.meaning), place.meaning))
        };
        let (Some((normals, _)), Some((depths, meaning))) = (samples(Layer::Normal), samples(Layer::Depth)) else {
            return Seen::Nothing;
        };
        // Some programs write negative depths.
        let below = depths.iter().all(|z| *z <= 0.0);
        let depths: Vec<f32> = depths.into_iter().map(|z| if below { -z } else { z }).collect();
        let raster = frame.raster();
        let along_ray = meaning == Meaning::AlongRay;
        let slope = self.source.fov_y.map(|fov| raster.slope_of(fov.into()));
        fit(&normals, &depths, raster, along_ray, slope).map_or(Seen::Nothing, Seen::Fitted)
    }

    /// Returns cameras for all frames, the source of the cameras, and the frames that borrow theirs.
    pub(super) fn cameras_of(&self, seen: &[Seen]) -> (Vec<Camera>, Eye, Vec<String>) {
        let borrowed = |tells: &dyn Fn(&Seen) -> bool| -> Vec<String> {
            let silent = seen.iter().zip(&self.files).filter(|(seen, _)| !tells(seen));
            silent.map(|(_, file)| file.digits.clone()).collect()
        };
        if let Some(cameras) = nearest(seen, Seen::described) {
            return (cameras, Eye::Described, borrowed(&|seen| seen.described().is_some()));
        }
        let Some(fits) = nearest(seen, Seen::fitted) else {
            let fov_y = self.source.fov_y.unwrap_or(DEFAULT_FOV_Y);
            return (vec![Camera::at_rest(fov_y.into(), self.raster)], Eye::Assumed, Vec::new());
        };
        let borrowed = borrowed(&|seen| seen.fitted().is_some());
        if self.source.fov_y.is_some() {
            return (fits.iter().map(|fit| fit.camera).collect(), Eye::Turned, borrowed);
        }
        // Frames with a determined field of view lend it to the others.
        let mut slopes: Vec<f64> = fits.iter().filter(|fit| fit.determined).map(|fit| fit.camera.slope()).collect();
        slopes.sort_by(f64::total_cmp);
        let (slope, eye) = match slopes.get(slopes.len() / 2) {
            Some(&slope) => (slope, Eye::Fitted),
            None => (self.raster.slope_of(DEFAULT_FOV_Y.into()), Eye::Turned),
        };
        let camera = |fit: &Fit| if fit.determined { fit.camera } else { fit.camera.with_slope(slope) };
        (fits.iter().map(camera).collect(), eye, borrowed)
    }
}

/// Returns each frame's value, or that of the nearest frame with one; `None` if no frame has one.
fn nearest<T: Copy>(seen: &[Seen], told: impl Fn(&Seen) -> Option<T>) -> Option<Vec<T>> {
    let told: Vec<Option<T>> = seen.iter().map(told).collect();
    let of = |i: usize| {
        let known = told.iter().enumerate().filter_map(|(k, told)| Some((k.abs_diff(i), (*told)?)));
        known.min_by_key(|(distance, _)| *distance).map(|(_, told)| told)
    };
    (0..told.len()).map(of).collect()
}
