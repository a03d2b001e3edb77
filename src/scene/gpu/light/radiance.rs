//! Radiances of the environment in 62 bits.

/// Packs half of a radiance as `pack_rgb` of shaders/shared/packing.wgsl does, because that format ends at 2¹²⁷ and f32 at 2¹²⁸. The
/// error is at most 2⁻¹⁸ of the largest channel, and at most 2⁻¹²⁶ below 2⁻¹⁰⁸.
pub(crate) fn pack(radiance: [f32; 3]) -> [u32; 2] {
    let largest = radiance.into_iter().fold(0.0, f32::max);
    // Half of the largest channel is below 2^(exponent − 127), and the exponent is in its bits.
    let mut exponent = (largest.to_bits() >> 23).clamp(19, 254);
    let mantissas = |exponent: u32| {
        let scale = f32::from_bits((271 - exponent) << 23);
        radiance.map(|channel| round(channel * scale))
    };
    let mut mantissa = mantissas(exponent);
    if mantissa.iter().any(|&m| m >> 18 != 0) && exponent < 254 {
        exponent += 1;
        mantissa = mantissas(exponent);
    }
    let [r, g, b] = mantissa.map(|m| m.min((1 << 18) - 1));
    [r | g << 18, g >> 14 | b << 4 | exponent << 22]
}

/// The nearest whole number, halves rounded up, of a number from 0 to 2²⁴. `f32::round` is a function call on x86-64 without SSE 4.1 and
/// takes several times as long.
fn round(x: f32) -> u32 {
    let whole = x as u32;
    whole + u32::from(x - whole as f32 >= 0.5)
}

/// The radiance that the shaders unpack.
pub(crate) fn unpack([low, high]: [u32; 2]) -> [f32; 3] {
    let step = f32::from_bits((high >> 22) << 23) * (1.0 / 131_072.0);
    [low & 0x3ffff, low >> 18 | (high & 0xf) << 14, high >> 4 & 0x3ffff].map(|mantissa| step * mantissa as f32)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_packed_radiance_is_exact_to_18_bits_of_its_largest_channel() {
        for exact in [0.0, 1.0, 0.5, 3.0, 1e6, 2.0_f32.powi(-100), 2.0_f32.powi(127)] {
            for radiance in [[exact; 3], [exact, 0.0, 0.0], [0.0, exact / 4.0, exact]] {
                assert_eq!(unpack(pack(radiance)), radiance);
            }
        }
        let mut value = 1e-30_f32;
        while value < 3e38 {
            for radiance in [[value, 0.37 * value, 0.001 * value], [0.999_999_9 * value, value, 0.0], [value; 3]] {
                let back = unpack(pack(radiance));
                for (found, exact) in back.into_iter().zip(radiance) {
                    let error = (f64::from(found) - f64::from(exact)).abs();
                    assert!(error <= f64::from(value) * 2.0_f64.powi(-18), "{found} for {exact} of {value}");
                }
            }
            value *= 1.37;
        }
        assert!(unpack(pack([f32::MAX; 3])).iter().all(|x| x.is_finite() && *x > 3.4e38));
        assert_eq!(unpack(pack([1e-44; 3])), [0.0; 3]);
    }

    #[test]
    fn rounding_is_that_of_the_standard_library() {
        for whole in (0..1_u32 << 18).step_by(61).chain([1, 2, 3, (1 << 24) - 1]) {
            let half = whole as f32 + 0.5;
            for x in [whole as f32, half.next_down(), half, half.next_up(), (whole as f32).next_up()] {
                assert_eq!(round(x), x.round() as u32, "{x}");
            }
        }
    }
}
