//! A folder of frames: `frame_0000.exr`, `frame_0001.exr`, …, and what `manifest.json` says of them.

use crate::camera::{Camera, dot};
use crate::camera_fit;
use crate::layers::{self, Layer, Meaning, Names, Place};
use asvgf::image_io::{self, Channels};
use serde_json::Value;
use std::fmt;
use std::fs;
use std::path::{Path, PathBuf};

/// What is wrong with a sequence: which file, and what would do.
#[derive(Debug)]
pub struct SequenceError(String);

impl std::error::Error for SequenceError {}

impl fmt::Display for SequenceError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.0)
    }
}

fn wrong(file: &Path, reason: impl fmt::Display) -> SequenceError {
    SequenceError(format!("{}: {reason}", file.display()))
}

/// How the cameras are known.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// From the manifest.
    Given,
    /// From the frames themselves, but for where they are.
    Fitted,
    /// Not at all.
    Assumed,
}

/// What is taken where nothing tells.
const DEFAULT_FOV_Y: f32 = std::f32::consts::FRAC_PI_4;

/// Frames that were looked at, each: all are whole, of one size, and have the same layers.
#[derive(Debug)]
pub struct Sequence {
    folder: PathBuf,
    names: Names,
    /// The numbers of the first and the last frame.
    pub first: u32,
    pub last: u32,
    pub size: [u32; 2],
    /// What there is of every frame.
    pub layers: Vec<Layer>,
    /// One for each frame, or one for all.
    pub cameras: Vec<Camera>,
    /// How they are known.
    pub eye: Eye,
    /// The gradient's paths stand in the colour in the place of their pixels' own.
    pub in_place: bool,
}

/// One frame: the layers' samples, pixel by pixel.
#[derive(Debug)]
pub struct Pixels(Vec<Option<Vec<f32>>>);

impl Pixels {
    pub fn get(&self, layer: Layer) -> Option<&[f32]> {
        self.0[layer as usize].as_deref()
    }
}

impl Sequence {
    /// Looks at every frame, calling back after each with how many there are. A vertical field of view (in radians) says that
    /// there is a camera at the origin, where there is no other.
    pub fn open(
        folder: &Path,
        names: Names,
        fov_y: Option<f32>,
        mut looked: impl FnMut(u32),
    ) -> Result<Self, SequenceError> {
        let (first, last) = numbers(folder)?;
        let mut sequence = Self {
            folder: folder.to_owned(),
            names,
            first,
            last,
            size: [0; 2],
            layers: Vec::new(),
            cameras: Vec::new(),
            eye: Eye::Given,
            in_place: false,
        };
        sequence.read_manifest()?;
        let given = !sequence.cameras.is_empty();
        let mut fitted = Some(Vec::new()).filter(|_| !given && fov_y.is_none());
        for frame in first..=last {
            let image = sequence.look_at(frame)?;
            fitted = fitted.and_then(|mut cameras: Vec<Camera>| {
                cameras.push(sequence.fit(frame, &image)?);
                Some(cameras)
            });
            looked(last - first + 1);
        }
        if let Some(cameras) = fitted {
            (sequence.cameras, sequence.eye) = (cameras, Eye::Fitted);
        } else if !given {
            let assumed = Camera::at_rest(fov_y.unwrap_or(DEFAULT_FOV_Y).into(), sequence.size);
            (sequence.cameras, sequence.eye) = (vec![assumed], Eye::Assumed);
        }
        Ok(sequence)
    }

    fn path(&self, frame: u32) -> PathBuf {
        self.folder.join(format!("frame_{frame:04}.exr"))
    }

    pub fn has(&self, layer: Layer) -> bool {
        self.layers.contains(&layer)
    }

    pub fn camera(&self, frame: u32) -> Camera {
        let index = (frame - self.first) as usize;
        self.cameras[index.min(self.cameras.len() - 1)]
    }

    /// Reads a frame.
    pub fn read(&self, frame: u32) -> Result<Pixels, SequenceError> {
        let path = self.path(frame);
        let image = image_io::read_exr(&path).map_err(|e| SequenceError(e.to_string()))?;
        let places = self.places(&path, &image)?;
        let count = (self.size[0] * self.size[1]) as usize;
        let samples = Layer::ALL.into_iter().zip(places).map(|(layer, place)| match place {
            Some(place) => Some(self.samples(frame, &place, &image)),
            // There is no pair in this frame.
            None if self.has(layer) && layer.is_of_pairs() => Some(vec![-1.0; layer.components().len() * count]),
            None => None,
        });
        Ok(Pixels(samples.collect()))
    }

    /// Where each layer is in a file, in the order of [`Layer::ALL`].
    fn places(&self, path: &Path, image: &Channels) -> Result<Vec<Option<Place>>, SequenceError> {
        let places = Layer::ALL.map(|layer| layers::find(layer, &self.names, image).map_err(|e| wrong(path, e)));
        let places = places.into_iter().collect::<Result<Vec<_>, _>>()?;
        for (layer, place) in Layer::ALL.into_iter().zip(&places) {
            if place.is_none() && layer.required() {
                let (wanted, name) = (layer.channels().join(", "), layer.name());
                let known = layers::known(image);
                return Err(wrong(path, format!("there is no channel {wanted}; {known}; say --map {name}=NAME")));
            }
        }
        let pairs = [Layer::GradientCurrent, Layer::GradientPrevious];
        if let [Some(_), None] | [None, Some(_)] = pairs.map(|layer| places[layer as usize].as_ref()) {
            return Err(wrong(
                path,
                "gradient.current and gradient.previous only mean something together; one is missing",
            ));
        }
        Ok(places)
    }

    /// The samples of a layer's channels, pixel by pixel, as the format has them.
    fn samples(&self, frame: u32, place: &Place, image: &Channels) -> Vec<f32> {
        let channels: Vec<&[f32]> = place.channels.iter().map(|&c| image.channels[c].1.as_slice()).collect();
        let width = self.size[0];
        let mut samples = Vec::with_capacity(channels.len() * channels[0].len());
        for i in 0..channels[0].len() {
            let values = channels.iter().map(|channel| channel[i]);
            match place.meaning {
                Meaning::Same => samples.extend(values),
                Meaning::Upwards => samples.extend(values.enumerate().map(|(c, v)| if c == 1 { -v } else { v })),
                Meaning::AlongRay => {
                    let pixel = [i as u32 % width, i as u32 / width];
                    let ray = self.camera(frame).ray(pixel, self.size);
                    let length = dot(ray, ray).sqrt();
                    samples.extend(values.map(|v| (f64::from(v) / length) as f32));
                }
            }
        }
        samples
    }

    /// The camera that a frame shows by its normals and depths.
    fn fit(&self, frame: u32, image: &Channels) -> Option<Camera> {
        let place = |layer| layers::find(layer, &self.names, image).ok().flatten();
        // A distance along the ray is no depth before the ray is known.
        let depth = place(Layer::Depth).filter(|place| place.meaning == Meaning::Same)?;
        let samples = |place: &Place| self.samples(frame, place, image);
        camera_fit::fit(&samples(&place(Layer::Normal)?), &samples(&depth), self.size)
    }

    /// Reads a frame whole and compares it with the first.
    fn look_at(&mut self, frame: u32) -> Result<Channels, SequenceError> {
        let path = self.path(frame);
        if !path.exists() {
            let (first, last) = (self.first, self.last);
            return Err(wrong(&path, format!("is missing, and there are frames from {first} to {last}")));
        }
        let image = image_io::read_exr(&path).map_err(|e| SequenceError(e.to_string()))?;
        let found = Layer::ALL.into_iter().zip(self.places(&path, &image)?);
        let found: Vec<Layer> = found.filter(|(_, place)| place.is_some()).map(|(layer, _)| layer).collect();
        let size = [image.width, image.height];
        if frame == self.first {
            (self.size, self.layers) = (size, found);
            return Ok(image);
        }
        let start = format!("frame_{:04}.exr", self.first);
        if size != self.size {
            let ([w, h], [width, height]) = (size, self.size);
            return Err(wrong(
                &path,
                format!("is {w}×{h} pixels, and {start} is {width}×{height}: all must be of one size"),
            ));
        }
        // A frame in which nothing has changed needs no pairs.
        let pairs = found.iter().copied().filter(|layer| layer.is_of_pairs() && !self.has(*layer));
        self.layers.extend(pairs.collect::<Vec<_>>());
        for layer in Layer::ALL.into_iter().filter(|layer| !layer.is_of_pairs()) {
            let channels = layer.channels().join(", ");
            match (found.contains(&layer), self.has(layer)) {
                (false, true) => {
                    return Err(wrong(&path, format!("there is no channel {channels}, which {start} has")));
                }
                (true, false) => return Err(wrong(&path, format!("has {channels}, which {start} has not"))),
                _ => {}
            }
        }
        Ok(image)
    }

    /// Takes the cameras, and whether the gradient is in place, where there is a manifest.
    fn read_manifest(&mut self) -> Result<(), SequenceError> {
        let path = self.folder.join("manifest.json");
        if !path.exists() {
            return Ok(());
        }
        let text = fs::read_to_string(&path).map_err(|e| wrong(&path, format!("cannot be read: {e}")))?;
        let json: Value = serde_json::from_str(&text).map_err(|e| wrong(&path, e))?;
        self.in_place = json["gradient_in_place"] == true;
        let Some(list) = json["cameras"].as_array() else { return Ok(()) };
        let frames = (self.last - self.first + 1) as usize;
        if list.len() < frames {
            let found = list.len();
            return Err(wrong(&path, format!("has {found} cameras for {frames} frames: give one for each, in order")));
        }
        let camera = |(i, value)| Camera::from_json(value).map_err(|e| wrong(&path, format!("camera {i}: {e}")));
        self.cameras = list.iter().take(frames).enumerate().map(camera).collect::<Result<_, _>>()?;
        Ok(())
    }
}

/// The least and the greatest number of the frames in a folder.
fn numbers(folder: &Path) -> Result<(u32, u32), SequenceError> {
    let entries = fs::read_dir(folder).map_err(|e| wrong(folder, format!("cannot be read: {e}")))?;
    let number = |entry: fs::DirEntry| {
        let name = entry.file_name();
        let digits = name.to_str()?.strip_prefix("frame_")?.strip_suffix(".exr")?;
        digits.parse::<u32>().ok().filter(|_| (4..=9).contains(&digits.len()))
    };
    let numbers: Vec<u32> = entries.filter_map(|entry| number(entry.ok()?)).collect();
    let range = numbers.iter().min().zip(numbers.iter().max());
    let (&first, &last) =
        range.ok_or_else(|| wrong(folder, "there are no frames: they are called frame_0000.exr, …"))?;
    Ok((first, last))
}
