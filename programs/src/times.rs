//! Times of passes: clocks, and the table.

use crate::gpu::Gpu;
use asvgf::wgpu::{DeviceType, Features};
use cpu_time::ProcessTime;
use std::fmt::Write as _;
use std::time::Instant;

/// Frames that do not count: the driver compiles shaders and fills caches during the first ones.
const WARM_UP: usize = 3;

/// One frame's passes and their milliseconds, in order.
pub type PassTimes = Vec<(&'static str, f64)>;

/// Clock that measures the passes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Clock {
    /// GPU timestamps, at the passes' boundaries.
    Timestamps,
    /// Processor time, if the adapter is the CPU: such an adapter runs all passes when the host waits for them, and so
    /// its timestamps are wrong.
    Processor,
    /// Wall clock, if a GPU has no timestamps.
    Wall,
}

impl Clock {
    /// Returns the clock that is honest for an adapter.
    pub fn of(gpu: &Gpu) -> Self {
        match gpu.adapter.device_type {
            DeviceType::Cpu => Self::Processor,
            _ if gpu.device.features().contains(Features::TIMESTAMP_QUERY) => Self::Timestamps,
            _ => Self::Wall,
        }
    }

    /// Returns its name in words.
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

/// Times work with a wait at its end, for adapters without timestamps.
pub enum Stopwatch {
    /// Equals the wall time on an idle machine; on a busy one, other work disturbs it less.
    Processor(ProcessTime),
    Wall(Instant),
}

impl Stopwatch {
    pub fn start(clock: Clock) -> Self {
        if clock == Clock::Processor { Self::Processor(ProcessTime::now()) } else { Self::Wall(Instant::now()) }
    }

    /// Returns milliseconds since the start.
    pub fn read(&self) -> f64 {
        let cores = || std::thread::available_parallelism().map_or(1.0, |n| n.get() as f64);
        match self {
            Self::Processor(start) => start.elapsed().as_secs_f64() * 1e3 / cores(),
            Self::Wall(start) => start.elapsed().as_secs_f64() * 1e3,
        }
    }
}

/// Tabulates the milliseconds per pass, medians over the frames; adds the speed if one frame traced this many `rays`.
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

/// Returns the median, 0 for no values.
pub fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let middle = values.len() / 2;
    match values.len() {
        0 => 0.0,
        n if n % 2 == 1 => values[middle],
        _ => 0.5 * (values[middle - 1] + values[middle]),
    }
}
