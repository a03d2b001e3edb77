//! Numbers about images.

/// A linear colour.
pub type Rgb = [f32; 3];

/// Relative luminance of linear Rec. 709 colour (ITU-R BT.709-6).
pub fn luminance(c: Rgb) -> f64 {
    0.2126 * f64::from(c[0]) + 0.7152 * f64::from(c[1]) + 0.0722 * f64::from(c[2])
}

/// Mean luminance.
pub fn mean(image: &[Rgb]) -> f64 {
    image.iter().map(|&c| luminance(c)).sum::<f64>() / image.len() as f64
}

/// Mean of squared differences over the squared reference; 0.01 is added, so that dark pixels do not dominate.
pub fn relative_mse(image: &[Rgb], reference: &[Rgb]) -> f64 {
    assert_eq!(image.len(), reference.len());
    let error = |(&x, &r): (&Rgb, &Rgb)| -> f64 {
        let of = |i: usize| (f64::from(x[i]) - f64::from(r[i])).powi(2) / (f64::from(r[i]).powi(2) + 0.01);
        (0..3).map(of).sum::<f64>() / 3.0
    };
    image.iter().zip(reference).map(error).sum::<f64>() / image.len() as f64
}

/// Mean of independent estimates, and its standard error.
#[derive(Clone, Copy, Debug)]
pub struct Estimate {
    pub mean: f64,
    pub error: f64,
}

impl Estimate {
    pub fn of(samples: &[f64]) -> Self {
        let n = samples.len() as f64;
        let mean = samples.iter().sum::<f64>() / n;
        let variance = samples.iter().map(|x| (x - mean).powi(2)).sum::<f64>() / (n - 1.0);
        Self { mean, error: (variance / n).sqrt() }
    }

    /// Asserts that the mean is `expected` within three standard errors and `rounding`. With new random numbers on every run, 0.3 % of
    /// sound tests would fail. `rounding` is relative and covers f16 albedo, 18-bit radiance and f32 arithmetic.
    #[track_caller]
    pub fn assert_is(self, expected: f64, rounding: f64, what: &str) {
        let allowed = 3.0 * self.error + rounding * expected.abs();
        assert!((self.mean - expected).abs() <= allowed, "{what}: {self:?}, not {expected} ± {allowed}");
    }

    /// Does the same as [`Estimate::assert_is`] where the expected number is an estimate too.
    #[track_caller]
    pub fn assert_agrees(self, other: Self, rounding: f64, what: &str) {
        let allowed = 3.0 * self.error.hypot(other.error) + rounding * other.mean.abs();
        assert!(
            (self.mean - other.mean).abs() <= allowed,
            "{what}: {self:?} and {other:?} differ by more than {allowed}"
        );
    }
}
