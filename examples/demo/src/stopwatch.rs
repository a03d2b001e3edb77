//! Times of passes on adapters without honest timestamps: each pass is submitted and waited for separately.

use crate::state::Source;
use asvgf::Pass;
use eframe::egui_wgpu::RenderState;
use std::time::Instant;
use wgpu::{CommandEncoder, PollType};

/// Measures the passes of one frame. It makes the program wait at each pass, so it is used only on the user's request.
pub struct Stopwatch {
    gpu: RenderState,
    /// The source whose passes are measured.
    pub source: Source,
    start: Instant,
    /// Name and milliseconds of each pass, in order.
    pub times: Vec<(&'static str, f64)>,
}

impl Stopwatch {
    pub fn start(gpu: &RenderState, source: Source) -> Self {
        Self { gpu: gpu.clone(), source, start: Instant::now(), times: Vec::new() }
    }

    /// Submits the commands since the last stop, and waits for them.
    pub fn stop(&mut self, pass: &Pass, encoder: &mut CommandEncoder) {
        let next = self.gpu.device.create_command_encoder(&Default::default());
        self.gpu.queue.submit([std::mem::replace(encoder, next).finish()]);
        // The callback of a lost device reports the loss.
        let _ = self.gpu.device.poll(PollType::wait_indefinitely());
        self.times.push((pass.name(), self.start.elapsed().as_secs_f64() * 1e3));
        self.start = Instant::now();
    }
}
