//! The grid on which the boxes of a tree lie.

/// A grid of 2¹⁶ steps a side over a tree. Boxes on the grid take half the memory, so that a node is two texture fetches instead of
/// four. They are larger than the true boxes by two steps at most (compare Ylitie et al. 2017, who quantise each node).
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct Quantization {
    /// Position of 0.
    pub base: [f32; 3],
    /// Length of a step.
    pub step: [f32; 3],
}

impl Quantization {
    pub fn over([low, high]: [[f32; 3]; 2]) -> Self {
        let mut grid = Self::default();
        for axis in 0..3 {
            // A step is at least a few ulp of the coordinates, so that rounding stays within one step.
            let ulps = 5e-7 * low[axis].abs().max(high[axis].abs());
            grid.step[axis] = ((high[axis] - low[axis]) / 65500.0).max(ulps).max(1e-30);
            grid.base[axis] = low[axis] - 4.0 * grid.step[axis];
        }
        grid
    }

    /// The words of a box. It is rounded outwards, and by one step more because the shader rounds too.
    pub fn quantize(&self, low: [f32; 3], high: [f32; 3]) -> [u32; 3] {
        let place = |x: f32, axis: usize| (f64::from(x) - f64::from(self.base[axis])) / f64::from(self.step[axis]);
        let down = |axis: usize| (place(low[axis], axis).floor() - 1.0).clamp(0.0, 65535.0) as u32;
        let up = |axis: usize| (place(high[axis], axis).ceil() + 1.0).clamp(0.0, 65535.0) as u32;
        [down(0) | down(1) << 16, down(2) | up(0) << 16, up(1) | up(2) << 16]
    }
}
