//! A folder with a sequence under construction.

use asvgf::image_io::{Channels, write_exr};
use asvgf_programs::denoise::look_ahead::Sink;
use asvgf_programs::film::Film;
use asvgf_programs::sequence::layers::Layer;
use asvgf_programs::sequence::{Sequence, SequenceError};
use std::error::Error;
use std::fs;
use std::path::PathBuf;
use std::sync::atomic::{AtomicU64, Ordering};

/// A folder of a test's own, which is removed at its end.
pub struct Folder(pub PathBuf);

impl Folder {
    pub fn new() -> Self {
        static COUNT: AtomicU64 = AtomicU64::new(0);
        let name = format!("asvgf-sequences-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    /// Writes three frames of a grey wall one unit away.
    pub fn with_frames() -> Self {
        let folder = Self::new();
        for frame in 0..3 {
            folder.write(frame, &wall([6, 4]));
        }
        folder
    }

    pub fn write(&self, frame: u32, image: &Channels) {
        write_exr(self.0.join(format!("frame_{frame:04}.exr")), image).unwrap();
    }

    pub fn open(&self) -> Result<Sequence, SequenceError> {
        Sequence::open(self.0.as_path(), |_| {})
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        let _ = fs::remove_dir_all(&self.0);
    }
}

/// Keeps denoised frames.
pub struct Frames<'a>(pub &'a mut Vec<Vec<[f32; 3]>>);

impl Sink for Frames<'_> {
    fn played(&mut self, _: usize, _: &mut Film<'_>) -> Result<(), Box<dyn Error>> {
        Ok(())
    }

    fn denoised(&mut self, index: usize, image: &[[f32; 3]]) -> Result<(), Box<dyn Error>> {
        assert_eq!(index, self.0.len(), "frames come in order, each once");
        self.0.push(image.to_vec());
        Ok(())
    }
}

/// Returns the least data of a frame: colour ½, a normal along +Z, depth 1.
pub fn wall([width, height]: [u32; 2]) -> Channels {
    let mut image = Channels { width, height, channels: Vec::new() };
    add(&mut image, Layer::Color, &[0.5; 3]);
    add(&mut image, Layer::Normal, &[0.0, 0.0, 1.0]);
    add(&mut image, Layer::Depth, &[1.0]);
    image
}

/// Adds a layer that is the same in all pixels.
pub fn add(image: &mut Channels, layer: Layer, value: &[f32]) {
    let area = (image.width * image.height) as usize;
    let channels = layer.channels().into_iter().zip(value).map(|(name, &x)| (name, vec![x; area]));
    image.channels.extend(channels);
}

/// Renames a channel.
pub fn rename(image: &mut Channels, from: &str, to: &str) {
    let channel = image.channels.iter_mut().find(|(name, _)| name == from).unwrap();
    channel.0 = to.into();
}

/// Returns a number for each pixel and seed, 0…1.
pub fn random(pixel: u32, seed: u32) -> f32 {
    let mut x = pixel.wrapping_mul(0x9e37_79b9) ^ seed.wrapping_mul(0x85eb_ca6b);
    for _ in 0..3 {
        x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    }
    (x >> 8) as f32 / 16_777_216.0
}
