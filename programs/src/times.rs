//! Times of passes: how they are taken, and the table of them.

use crate::gpu::Gpu;
use asvgf::wgpu::{DeviceType, Features};
use cpu_time::ProcessTime;
use std::fmt::Write as _;
use std::time::Instant;

/// Frames that are not counted: shaders are compiled and caches filled during the first ones.
const WARM_UP: usize = 3;

/// One frame's passes and their milliseconds, in order.
pub type PassTimes = Vec<(&'static str, f64)>;

/// How the times of passes were taken.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// By the GPU, at the passes' boundaries.
    Timestamps,
    /// By the processor, where it is the adapter: such adapters run all passes when they are waited for, and so stamp them
    /// wrongly.
    Processor,
    /// By the clock on the wall, where a GPU has no timestamps.
    Wall,
}

impl Clock {
    /// The honest clock for an adapter.
    pub fn of(gpu: &Gpu) -> Self {
        match gpu.adapter.device_type {
            DeviceType::Cpu => Self::Processor,
            _ if gpu.device.features().contains(Features::TIMESTAMP_QUERY) => Self::Timestamps,
            _ => Self::Wall,
        }
    }

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Timestamps => "GPU timestamps at the passes' boundaries",
            Self::Processor => {
                "processor time of all threads over the cores, each pass waited for by itself: this adapter is the CPU"
            }
            Self::Wall => "the wall clock, each pass waited for by itself: this adapter has no timestamps",
        }
    }
}

/// Times work that is waited for, where there are no timestamps.
pub enum Stopwatch {
    /// On an idle machine the time on the wall, and on a busy one disturbed less.
    Processor(ProcessTime),
    Wall(Instant),
}

impl Stopwatch {
    pub fn start(clock: Clock) -> Self {
        if clock == Clock::Processor { Self::Processor(ProcessTime::now()) } else { Self::Wall(Instant::now()) }
    }

    /// Milliseconds since the start.
    pub fn read(&self) -> f64 {
        let cores = || std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
        match self {
            Self::Processor(start) => start.elapsed().as_secs_f64() * 1e3 / cores(),
            Self::Wall(start) => start.elapsed().as_secs_f64() * 1e3,
        }
    }
}

/// Milliseconds per pass, medians over the frames; and the speed that goes with the `rays` of one frame, where some were traced.
pub fn table(frames: &[PassTimes], rays: Option<f64>, [width, height]: [u32; 2], gpu: &Gpu) -> String {
    let skipped = WARM_UP.min(frames.len().saturating_sub(1));
    let counted = &frames[skipped..];
    let Some(first) = counted.first() else { return String::new() };
    let mut names: Vec<&str> = Vec::new();
    for (name, _) in first {
        if !names.contains(name) {
            names.push(name);
        }
    }
    let sum = |frame: &PassTimes, wanted: &[&str]| {
        frame.iter().filter(|(name, _)| wanted.contains(name)).map(|(_, ms)| ms).sum::<f64>()
    };
    let typical = |wanted: &[&str]| median(counted.iter().map(|frame| sum(frame, wanted)).collect());
    let total = typical(&names);
    let mut out = format!("\n{:<24}{:>10}{:>9}\n", "pass", "ms", "share");
    for name in &names {
        let dispatches = first.iter().filter(|(other, _)| other == name).count();
        let label = if dispatches > 1 { format!("{name} × {dispatches}") } else { (*name).to_owned() };
        let ms = typical(&[name]);
        let _ = writeln!(out, "{label:<24}{ms:>10.3}{:>7.1} %", 100.0 * ms / total.max(1e-9));
    }
    let _ = writeln!(out, "{:<24}{total:>10.3}", "all");
    let _ = writeln!(out, "Medians of {} frames of {width}×{height} after {skipped} to warm up.", counted.len());
    let _ = writeln!(out, "Measured by {}.", Clock::of(gpu).name());
    let traced = typical(&["visibility", "trace"]) * 1e-3;
    if let Some(rays) = rays.filter(|_| traced > 0.0) {
        let (million, speed) = (rays * 1e-6, rays * 1e-6 / traced);
        let _ = writeln!(
            out,
            "{speed:.2} million rays/s in visibility and trace: the last frame's {million:.2} million were counted, shadow rays \
             included."
        );
    }
    let adapter = &gpu.adapter;
    let _ = writeln!(out, "{} ({:?}), {} {}", adapter.name, adapter.backend, adapter.driver, adapter.driver_info);
    out
}

/// 0 of nothing.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}
