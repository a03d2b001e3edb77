//! A sequence of frames from a renderer: its files, its layers, its cameras, and the data of `manifest.json`.

pub mod camera;
pub mod camera_fit;
mod cameras;
mod described_camera;
pub mod export;
pub mod files;
mod guides;
pub mod layers;
mod manifest;
pub mod motion;
pub mod pixels;
pub mod surfaces;

use asvgf::image_io::{Channels, ExrFile, Window};
use camera::{Camera, Raster};
use files::FrameFile;
use layers::{Layer, Meaning, Names, Place, Places};
use pixels::Area;
use std::fmt;
use std::path::{Path, PathBuf};

/// An error of a sequence: the file, and a remedy.
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

/// Data on a sequence that the caller gives beforehand.
#[derive(Clone, Debug, Default)]
pub struct Source {
    /// A folder, a pattern such as `shot.####.exr`, or any of the frames.
    pub input: PathBuf,
    /// The user's own names of channels.
    pub names: Names,
    /// View layer of all channels.
    pub view_layer: Option<String>,
    /// Vertical field of view, in radians.
    pub fov_y: Option<f32>,
    /// The first and the last frame to read.
    pub frames: Option<[i64; 2]>,
    /// Numbers of frames that begin another shot.
    pub cuts: Vec<i64>,
}

impl From<&Path> for Source {
    fn from(input: &Path) -> Self {
        Self { input: input.to_owned(), ..Self::default() }
    }
}

/// Source of the cameras.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Eye {
    /// The manifest gives them.
    Given,
    /// The attributes of the files describe them.
    Described,
    /// A fit to the frames, without positions.
    Fitted,
    /// A fit to the frames, with a field of view that the user gave or that was assumed.
    Turned,
    /// None: an assumed camera.
    Assumed,
}

/// Reason why a frame does not continue the one before.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Break {
    /// Frames are missing in between.
    Gap,
    /// The manifest or the user says that another shot begins.
    Cut,
}

/// Most columns and rows that all windows may span.
const LARGEST: u32 = 16_384;

/// Largest albedo before the cleaning.
const MOST_ALBEDO: f32 = 16.0;

/// A sequence whose frames are checked one by one: all are whole, belong to one picture, and have the same layers.
#[derive(Debug)]
pub struct Sequence {
    source: Source,
    pub files: Vec<FrameFile>,
    /// Usual step from one frame's number to the next one's.
    pub step: i64,
    /// Reason why a frame does not continue the one before, for each frame.
    pub breaks: Vec<Option<Break>>,
    /// Columns and rows with pixels in any frame.
    pub size: [u32; 2],
    /// Place of these columns and rows in the picture.
    pub window: Window,
    pub raster: Raster,
    /// Layers that every frame's file has.
    pub layers: Vec<Layer>,
    /// Layers, and the names of their channels in the first frame.
    pub taken: Vec<(Layer, String)>,
    /// View layer of these layers, and the others in the file.
    pub view_layer: String,
    pub other_view_layers: Vec<String>,
    /// One camera for each frame, or one for all.
    pub cameras: Vec<Camera>,
    /// Source of the cameras.
    pub eye: Eye,
    /// If normals are in the camera's own space: the sign of its view direction, along ±Z.
    pub normals_of_view: Option<f64>,
    /// Factor of depths: −1 if all are below 0, as some programs write them.
    pub depth_sign: f32,
    /// True if the files have depths, but all are 0.
    pub blank_depth: bool,
    /// Frames without data on their camera, which have the camera of the nearest frame with such data.
    pub borrowed: Vec<String>,
    /// True if the gradient's paths stand in the colour in the place of their pixels' own.
    pub in_place: bool,
    /// If pixels stand for areas and not for points: the evidence.
    pub area: Option<Area>,
}

/// One frame: the samples of the layers, pixel by pixel.
#[derive(Clone, Debug)]
pub struct Pixels(pub Vec<Option<Vec<f32>>>);

impl Pixels {
    pub fn get(&self, layer: Layer) -> Option<&[f32]> {
        self.0[layer as usize].as_deref()
    }

    pub fn set(&mut self, layer: Layer, samples: Option<Vec<f32>>) {
        self.0[layer as usize] = samples;
    }
}

/// A frame that was read: its file, and its layers there.
struct Frame {
    window: Window,
    display: Window,
    aspect: f32,
    image: Channels,
    places: Places,
    /// Camera that its attributes describe.
    described: Option<Camera>,
    of_blender: bool,
}

impl Frame {
    /// Returns the window of its pixels in the picture.
    fn raster(&self) -> Raster {
        raster(self.window, self.display, self.aspect)
    }
}

fn raster(window: Window, display: Window, aspect: f32) -> Raster {
    let aspect = if aspect.is_finite() && aspect > 0.0 { aspect.into() } else { 1.0 };
    let offset = [0, 1].map(|axis| window.position[axis] - display.position[axis]);
    Raster { size: window.size, offset, picture: display.size, aspect }
}

impl Sequence {
    /// Opens a sequence and checks every frame. Calls back after each with the number of frames.
    pub fn open(source: impl Into<Source>, mut looked: impl FnMut(u32)) -> Result<Self, SequenceError> {
        let source = source.into();
        let all = files::list(&source.input)?;
        let files = source.frames.map_or_else(|| all.clone(), |range| files::within(&all, range));
        let (first, last) = (all[0].number, all[all.len() - 1].number);
        let Some(start) = files.first() else {
            let [from, to] = source.frames.unwrap_or_default();
            return Err(wrong(&source.input, format!("has frames {first} to {last}, none of --frames {from}-{to}")));
        };
        let step = files::usual_step(&all);
        let gaps = files::gaps(&files, step);
        let count = files.len();
        let manifest = manifest::read(start.path.parent().unwrap_or(Path::new(".")), &all, &files, step)?;
        let cuts: Vec<i64> = source.cuts.iter().chain(&manifest.cuts).copied().collect();
        if let Some(cut) = source.cuts.iter().find(|cut| !(first..=last).contains(cut)) {
            return Err(wrong(
                &source.input,
                format!("has frames {first} to {last}, none of which is that of --cut {cut}"),
            ));
        }
        let break_at = |(i, file): (usize, &FrameFile)| {
            let before = i.checked_sub(1).map(|before| files[before].number)?;
            // In a render on twos, a cut between two frames begins with the second.
            let is_cut = cuts.iter().any(|cut| (before + 1..=file.number).contains(cut));
            if is_cut { Some(Break::Cut) } else { gaps.contains(&i).then_some(Break::Gap) }
        };
        let mut sequence = Self {
            breaks: files.iter().enumerate().map(break_at).collect(),
            source,
            files,
            step,
            size: [0; 2],
            window: Window { position: [0; 2], size: [1; 2] },
            raster: Raster::whole([1; 2]),
            layers: Vec::new(),
            taken: Vec::new(),
            view_layer: String::new(),
            other_view_layers: Vec::new(),
            cameras: manifest.cameras,
            eye: Eye::Given,
            normals_of_view: None,
            depth_sign: 1.0,
            blank_depth: false,
            borrowed: Vec::new(),
            in_place: manifest.in_place,
            area: None,
        };
        let given = !sequence.cameras.is_empty();
        let mut seen = Vec::new();
        let mut display = None;
        // Counts depths above and below 0.
        let mut signs = [0_usize; 2];
        let mut of_blender = false;
        for index in 0..count {
            let frame = sequence.look_at(index, display)?;
            sequence.window = if index == 0 { frame.window } else { sequence.window.union(frame.window) };
            display = Some((frame.display, frame.aspect));
            for &z in frame.places.get(Layer::Depth).iter().flat_map(|place| &frame.image.channels[place.channels[0]].1)
            {
                signs[0] += usize::from(z > 0.0);
                signs[1] += usize::from(z < 0.0);
            }
            let [width, height] = sequence.window.size;
            if width > LARGEST || height > LARGEST {
                return Err(wrong(
                    &sequence.files[index].path,
                    format!("its window and those before it span {width}×{height} pixels: at most {LARGEST} a side"),
                ));
            }
            if !given {
                seen.push(sequence.see(&frame));
            }
            of_blender |= frame.of_blender;
            looked(count as u32);
        }
        if sequence.has(Layer::Depth) && signs[0] == 0 {
            sequence.blank_depth = signs[1] == 0;
            if sequence.blank_depth {
                sequence.layers.retain(|layer| *layer != Layer::Depth);
            } else {
                sequence.depth_sign = -1.0;
            }
        }
        sequence.size = sequence.window.size;
        let (display, aspect) = display.unwrap_or((sequence.window, 1.0));
        sequence.raster = raster(sequence.window, display, aspect);
        if !given {
            (sequence.cameras, sequence.eye, sequence.borrowed) = sequence.cameras_of(&seen);
        }
        if matches!(sequence.eye, Eye::Given | Eye::Described) && sequence.has(Layer::Normal) {
            sequence.normals_of_view = sequence.space_of_normals()?;
        }
        if sequence.has(Layer::Depth) && sequence.has(Layer::Normal) {
            sequence.area = pixels::area(of_blender, &sequence.read(0)?, sequence.size);
        }
        Ok(sequence)
    }

    pub fn frames(&self) -> usize {
        self.files.len()
    }

    pub fn has(&self, layer: Layer) -> bool {
        self.layers.contains(&layer)
    }

    /// True if there are depths, so that surfaces can be distinguished and followed to their places.
    pub fn has_surfaces(&self) -> bool {
        self.has(Layer::Depth)
    }

    pub fn camera(&self, index: usize) -> Camera {
        self.cameras[index.min(self.cameras.len() - 1)]
    }

    /// Reads the file of a frame, with all its contents.
    pub fn file(&self, index: usize) -> Result<ExrFile, SequenceError> {
        ExrFile::read(&self.files[index].path).map_err(|e| SequenceError(e.to_string()))
    }

    /// Returns the names of the colour's channels among those of a frame.
    pub fn color_names(&self, index: usize, image: &Channels) -> Result<Vec<String>, SequenceError> {
        let places = self.places(&self.files[index].path, image)?;
        let color = places.get(Layer::Color).map(|place| place.channels.clone()).unwrap_or_default();
        Ok(color.into_iter().map(|c| image.channels[c].0.clone()).collect())
    }

    /// Reads a frame: its own layers over the whole window, and normals and depths even if it has none.
    pub fn read(&self, index: usize) -> Result<Pixels, SequenceError> {
        let frame = self.frame(index)?;
        let camera = self.camera(index);
        let count = (self.size[0] * self.size[1]) as usize;
        let samples = Layer::ALL.into_iter().zip(&frame.places.of).map(|(layer, place)| match place {
            Some(place) => Some(self.samples(place, &frame, &camera)),
            // This frame has no pair.
            None if self.has(layer) && layer.is_of_pairs() => Some(vec![-1.0; layer.components().len() * count]),
            None => None,
        });
        let mut pixels = Pixels(samples.collect());
        if !self.has_surfaces() {
            pixels.set(Layer::Depth, None);
        }
        if let Some(depths) = pixels.0[Layer::Depth as usize].as_mut() {
            depths.iter_mut().for_each(|z| *z *= self.depth_sign);
        }
        if let Some(albedo) = pixels.0[Layer::Albedo as usize].as_mut() {
            // Clamped, because pixel filters have lobes below 0, and paths through metal yield values of any size: neither
            // makes a surface darker than black or brighter than white.
            albedo.iter_mut().filter(|x| x.is_finite()).for_each(|x| *x = x.clamp(0.0, MOST_ALBEDO));
        }
        if let (Some(sign), Some(normals)) = (self.normals_of_view, pixels.0[Layer::Normal as usize].as_mut()) {
            for n in normals.as_chunks_mut::<3>().0 {
                let [x, y, z] = n.map(f64::from);
                let turned = |i: usize| x * camera.right[i] + y * camera.up[i] + sign * z * camera.forward[i];
                *n = std::array::from_fn(|i| turned(i) as f32);
            }
        }
        guides::complete(&mut pixels, &camera, self.raster);
        Ok(pixels)
    }

    /// Returns the sign of Z if normals are in the cameras' own space. The test fits planes in the frame whose camera
    /// is turned farthest from the axes. Failure: pbrt writes the camera in the world, and normals in the camera's
    /// space; with world normals, no planes were found. Rule: the space that fits four times as well is the right one.
    fn space_of_normals(&self) -> Result<Option<f64>, SequenceError> {
        let turned = |&index: &usize| (self.camera(index).forward[2].abs() * 1e6) as i64;
        let index = (0..self.frames()).min_by_key(turned).unwrap_or_default();
        let pixels = self.read(index)?;
        let (normals, depths) = (pixels.get(Layer::Normal), pixels.get(Layer::Depth).filter(|_| self.has_surfaces()));
        let (Some(normals), Some(depths)) = (normals, depths) else { return Ok(None) };
        let Some([world, away, towards]) = camera_fit::residuals(normals, depths, self.raster, &self.camera(index))
        else {
            return Ok(None);
        };
        let (best, sign) = if away <= towards { (away, -1.0) } else { (towards, 1.0) };
        Ok((world > camera_fit::RESIDUAL && best < world / 4.0).then_some(sign))
    }

    /// Returns the samples of a layer's channels, pixel by pixel, in the format's convention.
    fn samples(&self, place: &Place, frame: &Frame, camera: &Camera) -> Vec<f32> {
        let channels: Vec<Vec<f32>> =
            place.channels.iter().map(|&c| frame.window.place(&frame.image.channels[c].1, self.window, 0.0)).collect();
        let mut samples = interleave(&channels, place.meaning);
        if place.meaning == Meaning::AlongRay {
            along_axis(&mut samples, camera, self.raster);
        }
        samples
    }

    fn places(&self, path: &Path, image: &Channels) -> Result<Places, SequenceError> {
        let places = layers::find(&self.source.names, self.source.view_layer.as_deref(), image);
        let places = places.map_err(|e| wrong(path, e))?;
        let diffuse = [Layer::GradientCurrent, Layer::GradientPrevious];
        let specular = [Layer::SpecularGradientCurrent, Layer::SpecularGradientPrevious];
        for pairs in [diffuse, specular] {
            if let [Some(_), None] | [None, Some(_)] = pairs.map(|layer| places.get(layer)) {
                let [current, previous] = pairs.map(Layer::name);
                return Err(wrong(
                    path,
                    format!("{current} and {previous} only mean something together; one is missing"),
                ));
            }
        }
        Ok(places)
    }

    fn frame(&self, index: usize) -> Result<Frame, SequenceError> {
        let path = &self.files[index].path;
        let file = self.file(index)?;
        let image = file.channels();
        let places = self.places(path, &image)?;
        let (window, display, aspect) = (file.data_window(), file.display_window(), file.pixel_aspect());
        let described = described_camera::of(&file, raster(window, display, aspect));
        let of_blender = pixels::is_of_blender(&file);
        Ok(Frame { window, display, aspect, image, places, described, of_blender })
    }

    /// Reads a frame whole and compares it with the first.
    fn look_at(&mut self, index: usize, first: Option<(Window, f32)>) -> Result<Frame, SequenceError> {
        let frame = self.frame(index)?;
        let path = self.files[index].path.clone();
        let found: Vec<Layer> = Layer::ALL.into_iter().filter(|layer| frame.places.get(*layer).is_some()).collect();
        let Some((display, _)) = first else {
            let names = |layer: Layer| -> Option<(Layer, String)> {
                let channels = &frame.places.get(layer)?.channels;
                let names: Vec<&str> = channels.iter().map(|&c| frame.image.channels[c].0.as_str()).collect();
                Some((layer, listed(&names)))
            };
            self.taken = found.iter().filter_map(|&layer| names(layer)).collect();
            self.layers = found;
            self.view_layer = frame.places.view_layer.clone();
            self.other_view_layers = frame.places.others.clone();
            return Ok(frame);
        };
        let start = self.files[0].path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if frame.display.size != display.size {
            let ([w, h], [width, height]) = (frame.display.size, display.size);
            return Err(wrong(
                &path,
                format!("is {w}×{h} pixels, and {start} is {width}×{height}: all must be of one size"),
            ));
        }
        // A frame without changes needs no pairs.
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
        Ok(frame)
    }
}

/// Interleaves channels pixel by pixel; flips a second component that points up.
fn interleave(channels: &[Vec<f32>], meaning: Meaning) -> Vec<f32> {
    let count = channels.first().map_or(0, Vec::len);
    let mut samples = Vec::with_capacity(channels.len() * count);
    for i in 0..count {
        let values = channels.iter().map(|channel| channel[i]);
        match meaning {
            Meaning::Upwards => samples.extend(values.enumerate().map(|(c, v)| if c == 1 { -v } else { v })),
            Meaning::Same | Meaning::AlongRay => samples.extend(values),
        }
    }
    samples
}

/// Converts distances along the rays to depths along the view axis.
fn along_axis(distances: &mut [f32], camera: &Camera, raster: Raster) {
    for (i, value) in distances.iter_mut().enumerate() {
        let pixel = [i as u32 % raster.size[0], i as u32 / raster.size[0]];
        *value = (f64::from(*value) / camera.ray_length(pixel, raster)) as f32;
    }
}

/// Lists the names of channels; names that differ only in the last part become `albedo.R,G,B`.
fn listed(names: &[&str]) -> String {
    let split = |name: &str| name.rsplit_once('.').map(|(front, last)| (front.to_owned(), last.to_owned()));
    let parts: Option<Vec<(String, String)>> = names.iter().map(|name| split(name)).collect();
    match parts {
        Some(parts) if parts.iter().all(|(front, _)| *front == parts[0].0) => {
            let last: Vec<&str> = parts.iter().map(|(_, last)| last.as_str()).collect();
            format!("{}.{}", parts[0].0, last.join(","))
        }
        _ => names.join(","),
    }
}
