//! Times of passes on adapters without honest timestamps: each is submitted and waited for by itself.

use crate::state::Source;
use asvgf::Pass;
use eframe::egui_wgpu::RenderState;
use std::time::Instant;
use wgpu::{CommandEncoder, PollType};

/// Takes the time of one frame's passes. It stops the program at each, and is only used where the user asks for it.
pub struct Stopwatch {
    gpu: RenderState,
    /// Whose passes.
    pub source: Source,
    start: Instant,
    /// Name and milliseconds of each pass, in order.
    pub times: Vec<(&'static str, f64)>,
}

impl Stopwatch {
    pub fn start(gpu: &RenderState, source: Source) -> Self {
        Self { gpu: gpu.clone(), source, start: Instant::now(), times: Vec::new() }
    }

    /// Submits what was recorded since the last stop, and waits for it.
    pub fn stop(&mut self, pass: &Pass, encoder: &mut CommandEncoder) {
        let next = self.gpu.device.create_command_encoder(&Default::default());
        self.gpu.queue.submit([std::mem::replace(encoder, next).finish()]);
        // A device that was lost is reported by its own callback.
        let _ = self.gpu.device.poll(PollType::wait_indefinitely());
        self.times.push((pass.name(), self.start.elapsed().as_secs_f64() * 1e3));
        self.start = Instant::now();
    }
}
