//! The table by which light samples choose a texel of the environment.
//!
//! Texels are chosen in proportion to luminance times solid angle. An alias table with an entry for each texel would take more memory
//! than an 8192 × 4096 picture itself. An entry therefore stands for a cell, a run of texels of one row. The shader goes along the run,
//! whose texels have the same solid angle, and stops at the texel where the luminances passed so far reach a random share of their
//! sum. In pictures of up to 1024 × 1024 texels a cell is a texel.

use super::alias;
use super::radiance::{pack, unpack};
use crate::scene::description::{Environment, SceneError};
use crate::scene::gpu::emission::luminance::luminance;
use crate::scene::gpu::memory::folded::Texel;
use std::f64::consts::PI;
use wgpu::Limits;

/// Maximum number of cells of a picture: 16 MiB of table. A cell has 8 texels in a picture of 4096 × 2048, and 32 in one of 8192 × 4096.
const MOST_CELLS: u32 = 1 << 20;

/// The division of a picture into cells, as shaders/shared/light.wgsl counts them. With powers of two, divisions are shifts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Cells {
    /// log₂ of the texels of a cell.
    pub run: u32,
    /// log₂ of the cells of a row. Cells beyond the right edge are empty.
    pub columns: u32,
    /// log₂ of all cells. Cells below the last row are empty.
    pub all: u32,
}

impl Cells {
    /// The finest division into at most `most` cells.
    fn of(width: u32, height: u32, most: u32) -> Self {
        let log2 = |n: u32| n.next_power_of_two().ilog2();
        let of_run = |run: u32| {
            let columns = log2(width.div_ceil(1 << run));
            Self { run, columns, all: columns + log2(height) }
        };
        let mut cells = of_run(0);
        while cells.all > log2(most) && cells.columns > 0 {
            cells = of_run(cells.run + 1);
        }
        cells
    }
}

/// The table of an environment that is not black.
#[derive(Debug)]
pub(crate) struct SkyTable {
    /// Texels per row of the environment, and rows.
    pub size: [u32; 2],
    pub cells: Cells,
    /// One entry for each cell, from [`Sums::table`].
    pub texels: Vec<Texel>,
    /// Σ luminance · solid angle.
    pub weight: f64,
}

impl SkyTable {
    /// The table of an environment, or `None` for a black one.
    ///
    /// # Errors
    /// Names the environment if it is larger than a texture of the device.
    pub fn of(environment: &Environment, limits: &Limits) -> Result<Option<Self>, SceneError> {
        let &Environment { width, height, ref radiance } = environment;
        check(width, height, limits)?;
        if radiance.iter().all(|c| *c == [0.0; 3]) {
            return Ok(None);
        }
        let mut sums = Sums::new(width, height, MOST_CELLS);
        for row in radiance.chunks(width as usize) {
            let packed: Vec<[u32; 2]> = row.iter().map(|&c| pack(c)).collect();
            sums.add_row(&packed);
        }
        let (texels, weight) = sums.table();
        Ok((weight != 0.0).then_some(Self { size: [width, height], cells: sums.cells, texels, weight }))
    }
}

fn check(width: u32, height: u32, limits: &Limits) -> Result<(), SceneError> {
    let limit = limits.max_texture_dimension_2d;
    if width <= limit && height <= limit {
        return Ok(());
    }
    let reason = format!(
        "has {width} × {height} texels, the device's max_texture_dimension_2d is {limit}: scale the picture down to at most \
         {limit} × {limit}, or raise the limit if the adapter has more"
    );
    Err(SceneError::of_scene("environment", reason))
}

/// Sums over cells, gathered row by row.
struct Sums {
    width: u32,
    height: u32,
    cells: Cells,
    /// Σ luminance of each cell.
    luminance: Vec<f64>,
    rows: usize,
}

impl Sums {
    fn new(width: u32, height: u32, most_cells: u32) -> Self {
        let cells = Cells::of(width, height, most_cells);
        Self { width, height, cells, luminance: vec![0.0; 1 << cells.all], rows: 0 }
    }

    /// Adds the next row of packed radiances: shaders see these, and their densities follow from them.
    fn add_row(&mut self, packed: &[[u32; 2]]) {
        let first = self.rows << self.cells.columns;
        for (cell, run) in self.luminance[first..].iter_mut().zip(packed.chunks(1 << self.cells.run)) {
            *cell = run.iter().map(|&texel| luminance(unpack(texel))).sum();
        }
        self.rows += 1;
    }

    /// The solid angle of a texel: 2π/width · (cos of its row's upper − cos of its lower edge).
    fn solid_angle(&self, row: usize) -> f64 {
        let edge = |row: usize| (PI * row as f64 / f64::from(self.height)).cos();
        2.0 * PI / f64::from(self.width) * (edge(row) - edge(row + 1))
    }

    /// The table's texels, and Σ luminance · solid angle. A texel holds the threshold below which its own cell is kept, the other
    /// cell, and the luminances of both.
    fn table(&self) -> (Vec<Texel>, f64) {
        let mut weights = self.luminance.clone();
        for (row, cells) in weights.chunks_mut(1 << self.cells.columns).enumerate().take(self.rows) {
            let solid_angle = self.solid_angle(row);
            cells.iter_mut().for_each(|cell| *cell *= solid_angle);
        }
        let total = |cell: usize| self.luminance[cell].min(f64::from(f32::MAX)) as f32;
        let entries = alias::table(&weights).into_iter().enumerate();
        let texel = |(own, entry): (usize, alias::Entry)| {
            let other = entry.alias as usize;
            [entry.threshold.to_bits(), entry.alias, total(own).to_bits(), total(other).to_bits()]
        };
        (entries.map(texel).collect(), weights.iter().sum())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    type Picture<'a> = &'a dyn Fn(u32, u32) -> [f32; 3];

    fn sums(width: u32, height: u32, most_cells: u32, radiance: impl Fn(u32, u32) -> [f32; 3]) -> Sums {
        let mut sums = Sums::new(width, height, most_cells);
        for y in 0..height {
            let row: Vec<_> = (0..width).map(|x| pack(radiance(x, y))).collect();
            sums.add_row(&row);
        }
        sums
    }

    /// The probability with which the table really chooses each cell.
    fn realised(table: &[Texel]) -> Vec<f64> {
        let mut p = vec![0.0; table.len()];
        for (own, &[threshold, other, ..]) in table.iter().enumerate() {
            let kept = f64::from(f32::from_bits(threshold));
            p[own] += kept / table.len() as f64;
            p[other as usize] += (1.0 - kept) / table.len() as f64;
        }
        p
    }

    #[test]
    fn each_texel_has_the_probability_of_its_light() {
        let noise = |x: u32, y: u32| {
            let n = (x * 7919 + y * 104_729) % 1009;
            [0.001 * n as f32, 0.5 + (n % 7) as f32, if n.is_multiple_of(3) { 0.0 } else { 2.0 }]
        };
        let sun = |x: u32, y: u32| if (x, y) == (41, 13) { [1e6, 9e5, 8e5] } else { noise(x, y) };
        let sun_alone = |x: u32, y: u32| if (x, y) == (3, 2) { [1e6; 3] } else { [0.0; 3] };
        let mostly_black = |x: u32, y: u32| if (x / 5 + y).is_multiple_of(4) { noise(x, y) } else { [0.0; 3] };
        let pictures: [(&str, Picture); 4] =
            [("noise", &noise), ("a sun", &sun), ("a sun alone", &sun_alone), ("mostly black", &mostly_black)];
        for (name, picture) in pictures {
            for ([width, height], most) in [
                ([1, 1], 16),
                ([8, 4], 1 << 20),
                ([64, 32], 1 << 20),
                ([64, 32], 256),
                ([65, 33], 256),
                ([100, 37], 1 << 10),
                ([333, 7], 64),
                ([5, 300], 512),
            ] {
                let what = format!("{name}, {width} × {height}, {most} cells");
                let sums = sums(width, height, most, picture);
                let (table, total) = sums.table();
                assert!(table.len() as u32 <= most.max(height.next_power_of_two()), "{what}");
                let cells = realised(&table);
                let mut sum = 0.0;
                let mut expected_sum = 0.0;
                for y in 0..height {
                    for x in 0..width {
                        let brightness = luminance(unpack(pack(picture(x, y))));
                        let expected = brightness * sums.solid_angle(y as usize);
                        expected_sum += expected;
                        let cell = ((y << sums.cells.columns) + (x >> sums.cells.run)) as usize;
                        // Both ways to a cell give the same sum.
                        let of_cell = f64::from(f32::from_bits(table[cell][2]));
                        let other = table[cell][1] as usize;
                        assert_eq!(table[cell][3], table[other][2], "{what}");
                        let found = if brightness > 0.0 { cells[cell] * brightness / of_cell } else { 0.0 };
                        assert!(
                            (found - expected / total.max(1e-300)).abs() <= 1e-6 * found,
                            "{what}: {found} for {expected} of {total} at {x}, {y}"
                        );
                        sum += found;
                    }
                }
                let black = expected_sum == 0.0;
                assert_eq!(black, total == 0.0, "{what}");
                assert!(black || (expected_sum / total - 1.0).abs() < 1e-12, "{what}: {expected_sum}, not {total}");
                assert!(black || (sum - 1.0).abs() < 1e-6, "{what}: {sum} in all");
            }
        }
    }

    #[test]
    fn cells_are_as_fine_as_the_table_allows() {
        let of = |width, height| Cells::of(width, height, MOST_CELLS);
        assert_eq!(of(1, 1), Cells { run: 0, columns: 0, all: 0 });
        assert_eq!(of(1024, 1024), Cells { run: 0, columns: 10, all: 20 });
        assert_eq!(of(1025, 1024), Cells { run: 1, columns: 10, all: 20 });
        assert_eq!(of(4096, 2048), Cells { run: 3, columns: 9, all: 20 });
        assert_eq!(of(8192, 4096), Cells { run: 5, columns: 8, all: 20 });
        assert_eq!(of(2100, 1100), Cells { run: 3, columns: 9, all: 20 });
    }

    #[test]
    fn a_picture_that_is_too_large_is_named_with_a_remedy() {
        let limits = Limits::default();
        assert!(check(8192, 4096, &limits).is_ok());
        let error = check(16_384, 8192, &limits).unwrap_err();
        assert_eq!(error.element, "environment");
        for part in ["16384 × 8192", "max_texture_dimension_2d is 8192", "scale the picture down"] {
            assert!(error.reason.contains(part), "{part}: {error}");
        }
    }
}
