//! Lines and powers through points, by least squares.

/// Fits a line to points: returns its slope and its height at 0; `None` if there is no such line.
pub fn line(points: &[(f64, f64)]) -> Option<(f64, f64)> {
    let n = points.len() as f64;
    let (x, y) = points.iter().fold((0.0, 0.0), |(x, y), point| (x + point.0 / n, y + point.1 / n));
    let (xx, xy) = points.iter().fold((0.0, 0.0), |(xx, xy), p| (xx + (p.0 - x).powi(2), xy + (p.0 - x) * (p.1 - y)));
    (points.len() >= 2 && xx > 0.0).then(|| (xy / xx, y - xy / xx * x))
}

/// The power law factor · xᵉˣᵖᵒⁿᵉⁿᵗ.
#[derive(Clone, Copy, Debug)]
pub struct Power {
    pub exponent: f64,
    pub factor: f64,
}

impl Power {
    /// Fits a power law to positive numbers, with relative errors: a line on logarithmic axes.
    pub fn through(points: &[(f64, f64)]) -> Option<Self> {
        let logarithms: Vec<_> = points.iter().map(|&(x, y)| (x.ln(), y.ln())).collect();
        let (exponent, height) = line(&logarithms)?;
        Some(Self { exponent, factor: height.exp() }).filter(|power| power.exponent.is_finite())
    }

    pub fn at(&self, x: f64) -> f64 {
        self.factor * x.powf(self.exponent)
    }
}
