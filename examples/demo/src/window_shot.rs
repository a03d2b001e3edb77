//! A screenshot of the whole window, after a number of frames.

use crate::app::Demo;
use asvgf::image_io;
use eframe::egui::{ColorImage, Context, Ui, ViewportCommand};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex};

/// The reason for which the file could not be written.
pub type Failure = Arc<Mutex<Option<String>>>;

/// The file to write, and the number of frames before it.
pub struct WindowShot {
    path: PathBuf,
    frames: u32,
    failure: Failure,
}

impl WindowShot {
    pub fn new(path: PathBuf, frames: u32) -> Self {
        Self { path, frames, failure: Failure::default() }
    }

    /// The place that receives a failure.
    pub fn failure(&self) -> Failure {
        Arc::clone(&self.failure)
    }

    /// Makes a demo that ends when its window was written.
    pub fn of(self, demo: Demo) -> Shooting {
        Shooting { demo, shot: Some(self) }
    }
}

/// A demo whose window is written to a file.
pub struct Shooting {
    demo: Demo,
    shot: Option<WindowShot>,
}

impl eframe::App for Shooting {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.demo.show(ui);
        if let Some(WindowShot { path, failure, .. }) = self.shot.take_if(|shot| self.demo.frames() >= shot.frames) {
            let context = ui.ctx().clone();
            ui.ctx().request_screenshot(move |image| write(&context, &image, &path, &failure));
        }
        ui.ctx().request_repaint();
    }
}

fn write(context: &Context, image: &ColorImage, path: &Path, failure: &Failure) {
    let [width, height] = image.size.map(|side| side as u32);
    let pixels: Vec<[u8; 4]> = image.pixels.iter().map(|pixel| pixel.to_array()).collect();
    if let (Err(error), Ok(mut failure)) = (image_io::write_png(path, width, height, &pixels), failure.lock()) {
        *failure = Some(error.to_string());
    }
    context.send_viewport_cmd(ViewportCommand::Close);
}
