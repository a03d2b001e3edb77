//! Denoises frames with both the frames before and the frames after them.
//!
//! A frame of an animation has a future. A sequence played backwards gives each frame a second history, of later
//! frames: even the first frames then have a history, and after a change of the light the future knows the new light.
//! `blend_in_time.rs` decides the weights of the two. Real time has no future: this is for files alone.

use crate::denoise::antialias::{Antialias, Held};
use crate::denoise::blend_in_time::{Estimate, blend};
use crate::denoise::replay::{Exposed, Played, Player};
use crate::film::Film;
use crate::sequence::Sequence;
use crate::sequence::motion::{self, Matches};
use crate::times::PassTimes;
use asvgf::{FilterSettings, Gradient, Settings};
use std::error::Error;

/// Findings of denoising a sequence. Frames are given by their numbers.
#[derive(Default)]
pub struct Denoised {
    /// Times of each frame of the forward run.
    pub times: Vec<PassTimes>,
    /// First frame that was denoised by itself, because it had the noise of the one before.
    pub repeated: Option<i64>,
    /// Frames that the program found to begin another shot.
    pub cuts: Vec<i64>,
    /// Complaint about the motion, if it seems wrong.
    pub complaint: Option<String>,
}

/// Bytes of memory that the results of a run backwards may take.
const MEMORY: usize = 512 << 20;

/// Fewest and most frames of one stretch that is played backwards.
const STRETCH: [usize; 2] = [4, 64];

/// Number of frames beyond the end of a stretch that give its last frame a history.
const BEYOND: usize = 12;

/// Results of the run backwards.
struct Behind {
    /// The first frame of the stretch, and its results.
    first: usize,
    seen: Vec<Option<Estimate>>,
}

/// Receiver of frames.
pub trait Sink {
    /// Called after a frame was played, with its place: the film holds its images, of its past alone.
    fn played(&mut self, index: usize, film: &mut Film<'_>) -> Result<(), Box<dyn Error>>;

    /// Called after a frame was denoised.
    fn denoised(&mut self, index: usize, image: &[[f32; 3]]) -> Result<(), Box<dyn Error>>;
}

/// Settings of the view into the future.
#[derive(Clone, Debug)]
pub struct Ahead {
    /// Settings of the run backwards.
    pub settings: Settings,
    /// True if edges are those of whole pixels.
    pub smooth_edges: bool,
}

/// Denoises a sequence. With settings for a run backwards, frames also use later frames.
pub fn denoise(
    film: &mut Film<'_>,
    ahead: Option<&Ahead>,
    sequence: &Sequence,
    sink: &mut dyn Sink,
) -> Result<Denoised, Box<dyn Error>> {
    let gpu = film.gpu;
    let mut denoised = Denoised::default();
    let mut readings: Vec<Matches> = Vec::new();
    let mut behind = match ahead.filter(|_| sequence.frames() > 1) {
        Some(ahead) => Some((Film::new(gpu, sequence.size, ahead.settings.clone())?, None::<Behind>)),
        None => None,
    };
    let smooth = behind.is_some() && ahead.is_some_and(|ahead| ahead.smooth_edges);
    let mut antialias = smooth.then(|| Antialias::new(sequence.size));
    let mut player = Player::new(film, sequence, false);
    for index in 0..sequence.frames() {
        if let Some((film, kept)) = &mut behind
            && kept.as_ref().is_none_or(|kept| index >= kept.first + kept.seen.len())
        {
            *kept = Some(backwards(film, sequence, index)?);
        }
        let pixels = sequence.read(index)?;
        let continues = index > 0 && sequence.breaks[index].is_none();
        let exposed = player.play(&Played { index, pixels: &pixels, continues })?;
        let number = sequence.files[index].number;
        if exposed.cut {
            denoised.cuts.push(number);
        }
        if exposed.repeated {
            denoised.repeated.get_or_insert(number);
        }
        add(&mut readings, &exposed);
        sink.played(index, player.film())?;
        let Exposed { estimate: mut now, shown, motion, begins, times, .. } = exposed;
        denoised.times.push(times);
        let later = behind.as_mut().and_then(|(_, kept)| {
            let kept = kept.as_mut()?;
            kept.seen.get_mut(index - kept.first)?.take()
        });
        if let Some(later) = later {
            blend(&mut now, &later, &pixels, sequence.size);
        }
        let Some(antialias) = &mut antialias else {
            sink.denoised(index, &now.image)?;
            continue;
        };
        let finished = antialias.push(Held { index, image: now.image, pixels: shown, motion, begins });
        finished.into_iter().try_for_each(|(index, image)| sink.denoised(index, &image))?;
    }
    let rest = antialias.map(|mut antialias| antialias.finish()).unwrap_or_default();
    rest.into_iter().try_for_each(|(index, image)| sink.denoised(index, &image))?;
    denoised.complaint = motion::complaint(&readings);
    Ok(denoised)
}

/// Returns the settings of a run backwards: repeated paths and λ compare a frame with its past, and know nothing of its
/// future.
pub fn settings(forwards: &Settings) -> Settings {
    let gradient = match forwards.filter.gradient {
        Gradient::Off => Gradient::Off,
        _ => Gradient::Statistics,
    };
    Settings { filter: FilterSettings { gradient, ..forwards.filter.clone() }, ..forwards.clone() }
}

/// Plays the stretch from a frame on backwards, and begins some frames beyond its end.
fn backwards(film: &mut Film<'_>, sequence: &Sequence, first: usize) -> Result<Behind, Box<dyn Error>> {
    let frames = sequence.frames();
    let bytes = (sequence.size[0] * sequence.size[1]) as usize * size_of::<[f32; 4]>();
    let stretch = (MEMORY / bytes.max(1)).clamp(STRETCH[0], STRETCH[1]).min(frames - first);
    let breaks = |index: usize| sequence.breaks.get(index).is_some_and(Option::is_some);
    let end = (first + stretch..(first + stretch + BEYOND).min(frames)).find(|&index| breaks(index));
    let end = end.unwrap_or((first + stretch + BEYOND).min(frames));
    let mut seen: Vec<Option<Estimate>> = Vec::new();
    seen.resize_with(stretch, || None);
    film.denoiser.reset();
    let mut player = Player::new(film, sequence, true);
    for index in (first..end).rev() {
        let pixels = sequence.read(index)?;
        let continues = index + 1 < end && !breaks(index + 1);
        let exposed = player.play(&Played { index, pixels: &pixels, continues })?;
        if index < first + stretch {
            seen[index - first] = Some(exposed.estimate);
        }
    }
    Ok(Behind { first, seen })
}

fn add(sums: &mut Vec<Matches>, exposed: &Exposed) {
    if sums.is_empty() {
        sums.clone_from(&exposed.readings);
        return;
    }
    sums.iter_mut().zip(&exposed.readings).for_each(|(sum, reading)| sum.add(*reading));
}
