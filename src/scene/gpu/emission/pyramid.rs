//! An image in linear light at every size down to one texel, each texel the mean of its part of the image.

use crate::scene::description::{Image, Texture, Wrap, linear_from_srgb};

/// The sizes of an image. Texels of the largest are those of the image itself.
pub(super) struct Pyramid<'a> {
    image: &'a Image,
    /// Linear light of each byte.
    linear: [f32; 256],
    smaller: Vec<Level>,
}

struct Level {
    size: [usize; 2],
    texels: Vec<[f32; 3]>,
}

impl<'a> Pyramid<'a> {
    pub fn of(image: &'a Image) -> Self {
        let linear = std::array::from_fn(|byte| linear_from_srgb(byte as f32 / 255.0));
        let mut pyramid = Self { image, linear, smaller: Vec::new() };
        while pyramid.size(pyramid.smallest()) != [1, 1] {
            pyramid.smaller.push(pyramid.halved());
        }
        pyramid
    }

    /// Number of the size of one texel.
    pub fn smallest(&self) -> usize {
        self.smaller.len()
    }

    /// Width and height of a size.
    pub fn size(&self, level: usize) -> [usize; 2] {
        match level.checked_sub(1) {
            None => [self.image.width as usize, self.image.height as usize],
            Some(smaller) => self.smaller[smaller].size,
        }
    }

    fn texel(&self, level: usize, [x, y]: [usize; 2]) -> [f32; 3] {
        let index = y * self.size(level)[0] + x;
        match level.checked_sub(1) {
            None => {
                let [r, g, b, _] = self.image.texels[index];
                [r, g, b].map(|byte| self.linear[usize::from(byte)])
            }
            Some(smaller) => self.smaller[smaller].texels[index],
        }
    }

    /// The smallest size so far, halved. Texels of an odd size are divided between their two parts.
    fn halved(&self) -> Level {
        let level = self.smallest();
        let from = self.size(level);
        let size = from.map(|length| (length / 2).max(1));
        let parts = [0, 1].map(|axis| parts(from[axis], size[axis]));
        let mut texels = Vec::with_capacity(size[0] * size[1]);
        for rows in &parts[1] {
            for columns in &parts[0] {
                let mut mean = [0.0; 3];
                for &(y, height) in rows {
                    for &(x, width) in columns {
                        let texel = self.texel(level, [x, y]);
                        mean.iter_mut().zip(texel).for_each(|(mean, texel)| *mean += width * height * texel);
                    }
                }
                texels.push(mean);
            }
        }
        Level { size, texels }
    }

    /// The colour at (u, v), interpolated between the texels of a size as shaders/shared/texture.wgsl does between those of the image.
    pub fn at(&self, level: usize, texture: &Texture, place: [f64; 2]) -> [f32; 3] {
        let size = self.size(level);
        let place = [0, 1].map(|axis| place[axis] * size[axis] as f64);
        let fetch = |x: f64, y: f64| {
            let cell = [wrap(x, size[0], texture.wrap[0]), wrap(y, size[1], texture.wrap[1])];
            self.texel(level, cell)
        };
        if level == 0 && texture.nearest {
            return fetch(place[0], place[1]);
        }
        let corner = place.map(|x| (x - 0.5).floor());
        let f = [0, 1].map(|axis| (place[axis] - 0.5 - corner[axis]) as f32);
        let [a, b, c, d] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]]
            .map(|[right, down]: [f64; 2]| fetch(corner[0] + right, corner[1] + down));
        std::array::from_fn(|i| {
            let (top, bottom) = (a[i] + f[0] * (b[i] - a[i]), c[i] + f[0] * (d[i] - c[i]));
            top + f[1] * (bottom - top)
        })
    }

    /// True if the image is black within a rectangle of (u, v). False may be wrong, because coarse texels reach beyond the rectangle.
    pub fn is_black(&self, texture: &Texture, [low, high]: [[f64; 2]; 2]) -> bool {
        /// Most texels that are looked at along each axis.
        const MOST: f64 = 8.0;
        /// Coordinate in texels at which shaders end.
        const FARTHEST: f64 = 4_194_304.0;
        // Interpolation reaches a texel farther, and f32 rounds coordinates.
        let margin =
            |axis: usize| 1.0 / self.size(0)[axis] as f64 + 1e-6 * low[axis].abs().max(high[axis].abs()).max(1.0);
        let (low, high) = ([0, 1].map(|axis| low[axis] - margin(axis)), [0, 1].map(|axis| high[axis] + margin(axis)));
        let span = |level: usize, axis: usize| (high[axis] - low[axis]) * self.size(level)[axis] as f64;
        let is_exact = |axis: usize| low[axis].abs().max(high[axis].abs()) * self.size(0)[axis] as f64 <= FARTHEST;
        let fits = |&level: &usize| (0..2).all(|axis| span(level, axis) <= MOST && is_exact(axis));
        let Some(level) = (0..self.smallest()).find(fits) else {
            return self.texel(self.smallest(), [0, 0]) == [0.0; 3];
        };
        let size = self.size(level);
        let cells = |axis: usize| {
            let ends = [low, high].map(|end| (end[axis] * size[axis] as f64).floor());
            let steps = 0..=(ends[1] - ends[0]) as usize;
            steps.map(move |step| wrap(ends[0] + step as f64, size[axis], texture.wrap[axis]))
        };
        cells(1).all(|y| cells(0).all(|x| self.texel(level, [x, y]) == [0.0; 3]))
    }
}

/// For each of `to` equal parts of a row of `from` texels, the texels in it with their weights, whose sum is 1.
fn parts(from: usize, to: usize) -> Vec<Vec<(usize, f32)>> {
    let step = from as f64 / to as f64;
    let part = |number: usize| {
        let (low, high) = (number as f64 * step, (number + 1) as f64 * step);
        let texels = low as usize..(high.ceil() as usize).min(from);
        let weight = |x: usize| (high.min((x + 1) as f64) - low.max(x as f64)) / step;
        texels.map(|x| (x, weight(x) as f32)).collect()
    };
    (0..to).map(part).collect()
}

/// The texel at a coordinate after wrapping.
fn wrap(place: f64, size: usize, mode: Wrap) -> usize {
    let length = size as f64;
    let cell = place.floor();
    let inside = match mode {
        Wrap::Repeat => cell.rem_euclid(length),
        Wrap::Mirror => {
            let folded = cell.rem_euclid(2.0 * length);
            folded.min(2.0 * length - 1.0 - folded)
        }
        Wrap::Clamp => cell,
    };
    inside.clamp(0.0, length - 1.0) as usize
}

#[cfg(test)]
mod tests {
    use super::*;

    fn image(width: u32, height: u32, color: impl Fn(u32, u32) -> [u8; 4]) -> Image {
        let texels = (0..height).flat_map(|y| (0..width).map(move |x| (x, y))).map(|(x, y)| color(x, y)).collect();
        Image { width, height, texels, ..Default::default() }
    }

    #[test]
    fn every_size_has_the_mean_of_the_image() {
        for [width, height] in [[1, 1], [8, 8], [7, 5], [1, 13], [33, 2]] {
            let image = image(width, height, |x, y| [(x * 37 % 256) as u8, (y * 91 % 256) as u8, 255, 0]);
            let pyramid = Pyramid::of(&image);
            let mean = |level: usize| {
                let [width, height] = pyramid.size(level);
                let cells = (0..height).flat_map(|y| (0..width).map(move |x| [x, y]));
                let sum = cells.fold([0.0; 3], |sum: [f64; 3], cell| {
                    let texel = pyramid.texel(level, cell);
                    std::array::from_fn(|i| sum[i] + f64::from(texel[i]))
                });
                sum.map(|channel| channel / (width * height) as f64)
            };
            let exact = mean(0);
            for level in 1..=pyramid.smallest() {
                for (mean, exact) in mean(level).into_iter().zip(exact) {
                    assert!((mean - exact).abs() < 1e-6, "{width} × {height}, {level}: {mean}, not {exact}");
                }
            }
        }
    }

    #[test]
    fn black_is_certain_and_found_where_it_is_wide() {
        let image = image(64, 64, |x, y| if (x, y) == (20, 9) { [0, 0, 1, 255] } else { [0, 0, 0, 255] });
        let (pyramid, texture) = (Pyramid::of(&image), Texture::new(0));
        let at = |x: f64, y: f64| [x / 64.0, y / 64.0];
        assert!(!pyramid.is_black(&texture, [at(20.2, 9.2), at(20.8, 9.8)]));
        assert!(!pyramid.is_black(&texture, [at(0.0, 0.0), at(64.0, 64.0)]));
        assert!(!pyramid.is_black(&texture, [at(-44.0, 9.0), at(-43.0, 10.0)]), "repeated");
        assert!(!pyramid.is_black(&texture, [at(21.2, 9.2), at(24.0, 9.8)]), "interpolation reaches this far");
        assert!(pyramid.is_black(&texture, [at(0.0, 0.0), at(14.5, 64.0)]));
        assert!(pyramid.is_black(&texture, [at(33.5, 0.0), at(62.0, 64.0)]));
        let clamped = Texture { wrap: [Wrap::Clamp; 2], ..texture };
        assert!(pyramid.is_black(&clamped, [at(-44.0, 9.0), at(-43.0, 10.0)]));
    }
}
