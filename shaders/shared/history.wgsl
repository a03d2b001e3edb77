#define_import_path asvgf::history

// The history of a pixel, in 64 bits:
//   colour: 13 bits of mantissa for each channel with a common exponent of 8 bits
//   variance of a sample's luminance: 5 bits of exponent, relative to the colour's, and 4 of mantissa. They hold deviations of 2⁻⁹ … 2⁵ of the
//     colour. A greater one raises the exponent, because such noise hides far more than the colour's last bits.
//   history length: 4 bits of exponent, 4 of mantissa; 1 … 61 440, and exact up to 32. 0 says that nothing was hit.
//
// Failure: a running mean of n frames stopped moving when it was n·2⁻¹⁴ off. Reason: it was rounded to the nearest. Rule: each
// number is rounded up with a probability equal to the part that is cut off. So the stored numbers are right on average, and one
// that needs no rounding stays as it is.

#import asvgf::random::hash
#ifndef TEMPORAL_ONLY
#import asvgf::packing::{tap_color, unpack_rgb}
#endif

// Random numbers for the rounding of the three fields, uniform in 32 bits. From frame to frame they follow the additive recurrence
// of three dimensions (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"): rounding errors cancel sooner than
// those of independent numbers.
fn rounding(pixel: vec2<u32>, index: u32) -> vec3<u32> {
    let start = hash(pixel.x ^ hash(pixel.y));
    return vec3(start, start << 11u, start << 22u) + index * vec3(3518319155u, 2882110345u, 2360945575u);
}

// Offset that makes the exponent of a variance's bits relative to the colour's: 1 … 30 where the variance counts. It is subtracted
// from integers, because a product of floats may leave the range of f32 on its way.
fn variance_offset(exponent: u32) -> i32 {
    return min(2 * i32(exponent) - 147, 255) * 0x800000;
}

fn pack_history(color: vec3<f32>, variance: f32, length: f32, random: vec3<u32>) -> vec2<u32> {
    let largest = max(max(color.x, color.y), color.z);
    let square = bitcast<u32>(min(variance, 1e37));
    // A variance below f32's normal numbers counts as 0.
    let varies = square >= 0x800000u;
    // The largest channel is below 2^(exponent − 127), also when it is rounded up: its last step counts as the next power of two.
    let of_color = ((bitcast<u32>(largest) + 0x7ffu) >> 23u) + 1u;
    // The exponent for which the variance is below 2¹¹ times the square of the colour's scale.
    let of_variance = select(0u, (square >> 24u) + 59u, varies);
    // 2⁻¹²⁶ is the least step of a normal number.
    let exponent = clamp(max(of_color, of_variance), 14u, 253u);
    let up = bitcast<f32>((254u - exponent) << 23u);
    // Rounds up if the random part is at least 1 less the part that is cut off. The sum of both, cut off, would not do, because f32
    // rounds that too: a 4000th of a step too much in each frame is 0.1 % in a history of 32 768.
    let exact = clamp(color * (up * 8192.0), vec3(0.0), vec3(8191.0));
    let whole = floor(exact);
    let part = f32(random.x >> 8u) * (1.0 / 16777216.0);
    let mantissa = vec3<u32>(whole) + vec3<u32>(vec3(part) >= 1.0 - (exact - whole));
    let relative = select(0u, u32(max(i32(square) - variance_offset(exponent), 0)), varies);
    let packed_variance = (relative + (random.y >> 13u)) >> 19u;
    let packed_length = ((bitcast<u32>(max(length, 1.0)) - 0x3f800000u + (random.z >> 13u)) >> 19u) + 1u;
    return vec2(
        mantissa.x | (mantissa.y << 13u) | (mantissa.z << 26u),
        (mantissa.z >> 6u) | (exponent << 7u) | (packed_variance << 15u)
            | (select(0u, min(packed_length, 255u), length > 0.0) << 24u),
    );
}

fn history_color(bits: vec2<u32>) -> vec3<f32> {
    let down = bitcast<f32>(((bits.y >> 7u) & 0xffu) << 23u) * (1.0 / 8192.0);
    let blue = (bits.x >> 26u) | ((bits.y & 0x7fu) << 6u);
    return down * vec3(f32(bits.x & 0x1fffu), f32((bits.x >> 13u) & 0x1fffu), f32(blue));
}

fn history_variance(bits: vec2<u32>) -> f32 {
    let relative = i32(((bits.y >> 15u) & 0x1ffu) << 19u);
    let square = relative + variance_offset((bits.y >> 7u) & 0xffu);
    // 0 if the relative exponent is 0.
    return bitcast<f32>(u32(select(0, square, min(relative, square) >= 0x800000)));
}

// Variance of a sample from the mean squared deviation of n: Bessel's correction n/(n − 1) while it matters, below 8/7 from n = 8 on.
fn unbiased(variance: f32, n: f32) -> f32 {
    return variance * select(1.0, n / max(n - 1.0, 0.5), n < 8.0);
}

fn history_length(bits: vec2<u32>) -> f32 {
    let code = bits.y >> 24u;
    return select(0.0, bitcast<f32>(((code - 1u) << 19u) + 0x3f800000u), code > 0u);
}

// The filtered colour, from the format in which the filter's last pass stores it.
fn filtered_color(texel: vec2<u32>) -> vec3<f32> {
#ifdef TEMPORAL_ONLY
    return history_color(texel);
#else
#ifdef STEADY
    return unpack_rgb(texel);
#else
    return tap_color(texel);
#endif
#endif
}
