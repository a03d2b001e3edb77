//! Errors of images against the truth.

use crate::report::record::{Row, Settling, finite};
use crate::report::suite::TURN;
use crate::report::truth::{Moment, RELIT, Rgb};
use asvgf::metrics::{self, MetricError, Pair};
use std::thread;

/// Ghosts are searched for in pixels that changed fewer frames ago than this.
const GHOST: u32 = 8;

/// Bands around the new level of a light.
const BANDS: [f64; 2] = [0.1, 0.02];

/// Share of the pixels that one frame must relight to count as a step of the light.
const STEP: f64 = 0.5;

/// Fills in the errors of each frame, on all of the processor's cores, because FLIP takes far longer than a GPU's
/// frame.
pub fn fill(rows: &mut [Row], images: &[Vec<Rgb>], moments: &[Moment], size: [u32; 2]) -> Result<(), MetricError> {
    let cores = thread::available_parallelism().map_or(1, usize::from);
    let part = rows.len().div_ceil(cores).max(1);
    thread::scope(|scope| {
        let parts = rows.chunks_mut(part).enumerate().map(|(number, rows)| {
            let first = number * part;
            scope.spawn(move || {
                let mut frames = rows.iter_mut().enumerate();
                frames.try_for_each(|(i, row)| fill_one(row, first + i, images, moments, size))
            })
        });
        // Collects, so that all threads start before the first join.
        let parts: Vec<_> = parts.collect();
        parts.into_iter().try_for_each(|part| part.join().unwrap_or_else(|panic| std::panic::resume_unwind(panic)))
    })
}

fn fill_one(
    row: &mut Row,
    i: usize,
    images: &[Vec<Rgb>],
    moments: &[Moment],
    size: [u32; 2],
) -> Result<(), MetricError> {
    let moment = &moments[i];
    let pair = Pair::new(&images[i], &moment.reference)?.counting(&moment.counted)?;
    // Subtracts the reference's own squared error. The squared difference from the reference is the sum of the squared
    // error and the reference's own, because their noise is independent.
    let noise = Pair::new(&moment.half, &moment.reference)?.counting(&moment.counted)?;
    row.rel_mse = finite(metrics::relative_mse(&pair) - metrics::relative_mse(&noise));
    row.rmse = finite((metrics::rmse(&pair).powi(2) - metrics::rmse(&noise).powi(2)).max(0.0).sqrt());
    row.bias = finite(metrics::bias(&pair));
    let ghost = |pair| metrics::ghost_energy(pair, &moment.ages, GHOST);
    row.ghost = finite(ghost(&pair)? - ghost(&noise)?);
    if i > 0 {
        let before = Pair::new(&images[i - 1], &moments[i - 1].reference)?.counting(&moments[i - 1].counted)?;
        row.flicker = finite(metrics::flicker(&pair, &before, &moment.steady)?);
    }
    let [image, reference] = [&images[i], &moment.reference].map(|colors| metrics::encode(colors, 1.0));
    let shown = Pair::new(&image, &reference)?.counting(&moment.counted)?;
    row.psnr = finite(metrics::psnr(&shown, 1.0));
    row.ssim = finite(metrics::ssim(&shown, size)?);
    #[cfg(feature = "flip")]
    {
        row.flip = finite(metrics::flip(&shown, size, metrics::PIXELS_PER_DEGREE)?.mean);
    }
    Ok(())
}

/// Measures the lag of the change at the turn, if that is a step: most pixels are relit at once, and nothing moves
/// after.
pub fn lag(images: &[Vec<Rgb>], moments: &[Moment]) -> Result<Vec<Settling>, MetricError> {
    let Some(turn) = moments.iter().position(|moment| moment.index == TURN).filter(|&turn| turn > 0) else {
        return Ok(Vec::new());
    };
    let (old, new) = (&moments[turn - 1].reference, &moments[turn].reference);
    let relit = moments[turn].ages.iter().filter(|&&age| age == 0).count();
    let stays = moments[turn..].iter().all(|moment| moment.reference == *new);
    if (relit as f64) < STEP * new.len() as f64 || !stays {
        return Ok(Vec::new());
    }
    let settle = |band| {
        let lag = metrics::lag(old, new, &images[turn..], band, RELIT)?;
        let (median, ninth_decile) = (lag.quantile(0.5), lag.quantile(0.9));
        Ok(Settling { band, median, ninth_decile, arrived: lag.arrived() })
    };
    BANDS.into_iter().map(settle).collect()
}
