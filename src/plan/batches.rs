//! The number of dispatches that trace a frame's paths.
//!
//! Most systems end a dispatch that takes seconds as hung, and its paths are lost. lavapipe of Mesa 22.3 ends all loops of an
//! invocation after 65 535 rounds in total, and the picture goes dark without a message. So a dispatch traces only as many paths as
//! are expected to stay well below both limits.

use super::SceneContents;
use crate::settings::TracerSettings;

/// Expected rounds of all loops for a pixel's paths in one dispatch, at most: an eighth of lavapipe's limit, because the paths of some
/// pixels take several times as long as those of others.
const MOST_ROUNDS: u32 = 8192;

/// Rounds of a ray for each level of the trees. With this number, a dispatch traces 17 paths over `pillars`; light was lost there
/// from somewhere between 64 and 256 paths on (docs/performance.md).
const ROUNDS_PER_LEVEL: u32 = 4;

/// Expected bounces of a path, at most, once Russian roulette has begun, which ends at least 1 in 20 paths at each bounce.
const ROULETTE_REACH: u32 = 20;

/// Expected boundaries of glass on a path, at most. They are no bounces.
const BOUNDARIES: u32 = 8;

/// A frame's paths, divided among dispatches.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Batches {
    samples: u32,
    /// Paths per pixel of each dispatch; the last may have fewer.
    each: u32,
}

impl Batches {
    /// The smallest safe number of dispatches.
    pub fn of(contents: &SceneContents, tracer: &TracerSettings) -> Self {
        let rounds_per_ray = if contents.few_triangles { 1 } else { 1 + ROUNDS_PER_LEVEL * contents.levels };
        // Each surface sends one ray towards a light and one onwards.
        let glass = if contents.transmission { BOUNDARIES } else { 0 };
        let surfaces = 1 + glass + tracer.bounces.min(tracer.roulette.saturating_add(ROULETTE_REACH));
        let rounds_per_surface = contents.environment_run.saturating_add(2 * rounds_per_ray);
        // If surfaces blend, each path begins with a ray from the camera.
        let begins = if contents.alpha_blend { rounds_per_ray } else { 0 };
        let rounds = surfaces.saturating_mul(rounds_per_surface).saturating_add(begins);
        let most = (MOST_ROUNDS / rounds.max(1)).max(1);
        let dispatches = tracer.samples.div_ceil(most).max(1);
        Self { samples: tracer.samples, each: tracer.samples.div_ceil(dispatches).max(1) }
    }

    /// The number of dispatches.
    pub fn count(self) -> u32 {
        self.samples.div_ceil(self.each).max(1)
    }

    /// For each dispatch, the number of paths that it traces, and the index of its first path.
    pub fn all(self) -> Vec<[u32; 2]> {
        let firsts = (0..self.count()).map(|dispatch| dispatch * self.each);
        firsts.map(|first| [self.each.min(self.samples - first), first]).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn batches(samples: u32, bounces: u32, levels: u32) -> Batches {
        let tracer = TracerSettings { samples, bounces, ..Default::default() };
        Batches::of(&SceneContents { levels, ..Default::default() }, &tracer)
    }

    #[test]
    fn every_path_is_in_one_batch() {
        for samples in [1, 2, 7, 64, 100, 1023, 65_536] {
            for (bounces, levels) in [(0, 0), (3, 16), (1024, 64)] {
                let batches = batches(samples, bounces, levels);
                let mut next = 0;
                for [count, first] in batches.all() {
                    assert_eq!(first, next, "{samples} {bounces} {levels}");
                    assert!(count > 0);
                    next += count;
                }
                assert_eq!(next, samples, "{bounces} {levels}");
            }
        }
    }

    #[test]
    fn a_dispatch_takes_fewer_paths_the_longer_they_are() {
        assert_eq!(batches(1, 1024, 64).count(), 1, "a path is not divided");
        assert_eq!(batches(16, 3, 20).count(), 2);
        assert!(batches(1024, 3, 12).count() < batches(1024, 3, 28).count());
        assert!(batches(1024, 0, 12).count() < batches(1024, 8, 12).count());
        let of_run = |environment_run| {
            Batches::of(
                &SceneContents { few_triangles: true, environment_run, ..Default::default() },
                &TracerSettings { samples: 1024, ..Default::default() },
            )
        };
        assert!(of_run(32).count() > of_run(1).count(), "texels of a cell are rounds too");
        let with_glass = |transmission| {
            let contents = SceneContents { levels: 12, transmission, ..Default::default() };
            Batches::of(&contents, &TracerSettings { samples: 1024, ..Default::default() })
        };
        assert!(with_glass(true).count() > with_glass(false).count(), "boundaries of glass are rounds too");
        // Roulette ends paths long before this many bounces.
        assert_eq!(batches(1024, 100, 12), batches(1024, 1024, 12));
    }
}
