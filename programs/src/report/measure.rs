//! Runs a method on a sequence: returns its images, and its times.

use crate::film::Film;
use crate::gpu::Gpu;
use crate::report::methods::Method;
use crate::report::record::{Row, Run, finite};
use crate::report::score;
use crate::report::suite::Suite;
use crate::report::summary::median;
use crate::report::truth::{Rgb, Truth, move_to, optional};
use crate::times::PassTimes;
use crate::tracing;
use asvgf::View;
use std::error::Error;
use std::time::{Duration, Instant};

/// Frames whose times do not count, because the driver compiles shaders and fills caches.
const WARM_UP: usize = 3;

/// Result of a method on a sequence.
pub struct Output {
    pub run: Run,
    pub images: Vec<Vec<Rgb>>,
}

/// Runs a method. Errors come from the first run, times from as many repeats as fit into `share`.
pub fn run(
    gpu: &Gpu,
    suite: &Suite,
    truth: &mut Truth,
    (sequence, method): (&str, &Method),
    key: String,
    share: Option<Duration>,
) -> Result<Output, Box<dyn Error>> {
    let start = Instant::now();
    let mut film = Film::new(gpu, suite.size, method.settings.clone())?;
    let (mut images, mut rows, mut repeats) = (Vec::new(), Vec::new(), Vec::new());
    let mut all = Vec::new();
    // The first run warms up as well.
    for repeat in 0..=suite.repeats {
        let begun = Instant::now();
        film.denoiser.reset();
        let mut times: Vec<PassTimes> = Vec::new();
        for i in 0..truth.moments.len() {
            move_to(gpu, &mut truth.scene, &truth.moments[i].pose)?;
            let moment = &truth.moments[i];
            times.push(tracing::render(&mut film, &truth.scene, moment.camera, moment.index)?);
            if repeat == 0 {
                images.push(gpu.read_colors(&film.target));
                let lambda = average(optional(&mut film, View::Lambda)?, &moment.counted);
                let history = average(optional(&mut film, View::HistoryLength)?, &moment.counted);
                let (sequence, method, frame) = (sequence.into(), method.name.clone(), moment.index);
                rows.push(Row { sequence, method, frame, lambda, history, ..Default::default() });
            }
        }
        all.push(times);
        if share.is_some_and(|share| start.elapsed() + begun.elapsed() > share) {
            break;
        }
    }
    // The times of the first run count only if there are no others.
    let counted = if all.len() > 1 { &all[1..] } else { &all[..] };
    for (i, row) in rows.iter_mut().enumerate() {
        row.ms = median(counted.iter().map(|times| times[i].iter().map(|(_, ms)| ms).sum()).collect());
    }
    for times in counted {
        let frames = times.iter().skip(WARM_UP.min(times.len() - 1));
        repeats.extend(frames.map(|frame| frame.iter().map(|&(name, ms)| (name.to_owned(), ms)).collect()));
    }
    score::fill(&mut rows, &images, &truth.moments, suite.size)?;
    let lag = score::lag(&images, &truth.moments)?;
    Ok(Output { run: Run { key, rows, lag, repeats: all.len() as u32 - 1, times: repeats }, images })
}

/// Returns the mean over the counted pixels of an image that may not exist.
fn average(numbers: Option<Vec<Rgb>>, counted: &[bool]) -> Option<f64> {
    let numbers = numbers?;
    let values = numbers.iter().zip(counted).filter(|(_, counted)| **counted);
    let (sum, count) = values.fold((0.0, 0_u32), |(sum, count), (number, _)| (sum + f64::from(number[0]), count + 1));
    finite(sum / f64::from(count))
}
