//! The division of an emitting triangle into pieces, so that paths find the bright spots of its image.

use super::grid;

/// A triangle that is best divided into 4^level equal pieces.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Division {
    /// log₂ of the number of rows, above 0.
    pub level: u32,
    /// Relative variance of light samples that the division saves.
    pub saved: f64,
    /// Texture coordinates of the corners.
    pub uvs: [[f32; 2]; 3],
}

impl Division {
    /// log₂ of the most rows: 4096 pieces.
    pub const MOST_LEVEL: u32 = 6;

    /// Number of pieces.
    pub fn pieces(&self) -> usize {
        grid::count(self.level)
    }
}

/// Second moment of light samples over their squared mean up to which pieces are not divided further: a tenth of variance is left.
const EVEN: f64 = 1.1;

/// Part of the probability that is shared out evenly among the pieces that are not black, because points may have missed light.
const SHARED: f64 = 0.1;

/// The light of a triangle's pieces at every level.
pub(super) struct Pieces {
    /// Sums of light and of its squares over the points of each piece, from one piece to the finest level.
    levels: Vec<[Vec<f64>; 2]>,
}

impl Pieces {
    /// The pieces of a triangle with this light at 4^points points. `parents` are those of each level from 1 on.
    pub fn of(points: u32, light: Vec<f64>, parents: &[Vec<usize>]) -> Self {
        let squares = light.iter().map(|x| x * x).collect();
        let mut levels = vec![[light, squares]];
        for level in (1..=points).rev() {
            let mut sums = [0, 1].map(|_| vec![0.0; grid::count(level - 1)]);
            for (sums, finer) in sums.iter_mut().zip(&levels[levels.len() - 1]) {
                parents[level as usize - 1].iter().zip(finer).for_each(|(&parent, light)| sums[parent] += light);
            }
            levels.push(sums);
        }
        levels.reverse();
        Self { levels }
    }

    /// Sum of the light of all points.
    fn total(&self) -> f64 {
        self.levels[0][0][0]
    }

    /// Second moment of light samples over their squared mean. If a piece is chosen by its mean m and a point of it evenly, the moment of
    /// the emission over the density is M · mean of s/m, with the mean M of the triangle and the mean square s of each piece. For pieces
    /// of even light it is M².
    fn moment(&self, level: usize) -> f64 {
        let [light, squares] = &self.levels[level];
        let points = self.levels[self.levels.len() - 1][0].len() as f64;
        let lit = light.iter().zip(squares).filter(|(light, _)| **light > 0.0);
        lit.map(|(light, squares)| squares / light).sum::<f64>() * points / light.len() as f64 / self.total()
    }

    /// The least level at which the pieces are even, and the relative variance that it saves. `None` if the triangle is even.
    pub fn best(&self) -> Option<(u32, f64)> {
        let most = (self.levels.len() - 1).min(Division::MOST_LEVEL as usize);
        let level = (0..most).find(|&level| self.total() <= 0.0 || self.moment(level) <= EVEN).unwrap_or(most);
        (level > 0).then(|| (level as u32, self.moment(0) - self.moment(level)))
    }

    /// Probability of each piece of a level. `is_black` tells of a piece that it emits nothing, for certain.
    pub fn probabilities(&self, level: u32, is_black: impl Fn(usize) -> bool) -> Vec<f64> {
        let light = &self.levels[level as usize][0];
        let lit: Vec<bool> = (0..light.len()).map(|piece| light[piece] > 0.0 || !is_black(piece)).collect();
        let share = SHARED / lit.iter().filter(|&&lit| lit).count() as f64;
        let probability =
            |(light, &lit): (&f64, &bool)| (1.0 - SHARED) * light / self.total() + if lit { share } else { 0.0 };
        light.iter().zip(&lit).map(probability).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn pieces(points: u32, light: Vec<f64>) -> Pieces {
        Pieces::of(points, light, &(1..=7).map(grid::parents).collect::<Vec<_>>())
    }

    #[test]
    fn even_light_is_left_whole() {
        assert_eq!(pieces(4, vec![0.3; 256]).best(), None);
        assert_eq!(pieces(4, vec![0.0; 256]).best(), None);
        let slope = (0..256).map(|piece| 1.0 + grid::middle(4, piece)[0]).collect();
        assert_eq!(pieces(4, slope).best(), None);
    }

    #[test]
    fn a_spot_has_most_of_the_probability_and_black_pieces_have_none() {
        for points in [3, 6, 7] {
            let mut light = vec![0.0; grid::count(points)];
            let spot = light.len() / 3;
            light[spot] = 5.0;
            let pieces = pieces(points, light);
            let (level, saved) = pieces.best().unwrap();
            assert_eq!(level, points.min(Division::MOST_LEVEL));
            let probabilities = pieces.probabilities(level, |piece| piece % 2 == 0);
            assert_eq!(probabilities.len(), grid::count(level));
            assert!((probabilities.iter().sum::<f64>() - 1.0).abs() < 1e-9);
            let (brightest, most) = probabilities.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1)).unwrap();
            assert!(*most > 0.9 && saved > 0.5 * probabilities.len() as f64, "{most}, {saved}");
            for (piece, probability) in probabilities.iter().enumerate().filter(|(piece, _)| *piece != brightest) {
                assert_eq!(*probability > 0.0, piece % 2 != 0);
            }
        }
    }

    #[test]
    fn a_large_spot_needs_few_pieces() {
        let half = (0..1024).map(|piece| if grid::middle(5, piece)[0] < 0.5 { 1.0 } else { 0.0 }).collect();
        let (level, saved) = pieces(5, half).best().unwrap();
        // Half of a triangle beside an edge is three quarters of it.
        assert!(level == 1 && (saved - 1.0 / 3.0).abs() < 1e-9, "{level}, {saved}");
    }
}
