//! Other denoisers, given by files of their frames.

use crate::report::command::Baseline;
use crate::report::record::{Row, Run};
use crate::report::score;
use crate::report::truth::{Moment, Rgb, read_colors};
use std::error::Error;
use std::fs;

/// Scores a denoiser's frames of a sequence; `None` if there are none. Adds the passes that traced its frames,
/// `traced`, with their milliseconds.
pub fn run(
    baseline: &Baseline,
    sequence: &str,
    moments: &[Moment],
    size: [u32; 2],
    traced: &[(String, f64)],
) -> Result<Option<Run>, Box<dyn Error>> {
    let folder = baseline.folder.join(sequence);
    if !folder.is_dir() {
        return Ok(None);
    }
    let file = |moment: &Moment| folder.join(format!("denoised_{:04}.exr", moment.index));
    let images = moments.iter().map(|moment| read_colors(&file(moment), size));
    let images: Vec<Vec<Rgb>> = images.collect::<Result<_, _>>()?;
    let times = times(&folder.join("times.txt"), moments.len())?;
    let tracing: f64 = traced.iter().map(|(_, ms)| ms).sum();
    let row = |(i, moment): (usize, &Moment)| Row {
        sequence: sequence.into(),
        method: baseline.name.clone(),
        frame: moment.index,
        ms: times.get(i).map(|ms| tracing + ms),
        ..Row::default()
    };
    let mut rows: Vec<Row> = moments.iter().enumerate().map(row).collect();
    score::fill(&mut rows, &images, moments, size)?;
    let lag = score::lag(&images, moments)?;
    let frame = |ms| traced.iter().cloned().chain([("baseline".into(), ms)]).collect();
    let times = times.into_iter().map(frame).collect();
    Ok(Some(Run { key: String::new(), rows, lag, repeats: 1, times }))
}

/// Reads milliseconds, one line for each frame; none if there is no such file.
fn times(path: &std::path::Path, frames: usize) -> Result<Vec<f64>, Box<dyn Error>> {
    let Ok(text) = fs::read_to_string(path) else { return Ok(Vec::new()) };
    let times: Result<Vec<f64>, _> = text.split_whitespace().map(str::parse).collect();
    match times {
        Ok(times) if times.len() == frames => Ok(times),
        _ => Err(format!("{}: must hold {frames} numbers, the milliseconds of each frame", path.display()).into()),
    }
}
