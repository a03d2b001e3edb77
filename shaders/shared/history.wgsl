#define_import_path asvgf::history

// What a pixel keeps from frame to frame, in 64 bits:
//   colour: 13 bits of mantissa for each channel with a common exponent of 8 bits
//   variance of a sample's luminance: 5 bits of exponent, relative to the colour's, and 4 of mantissa; that of a
//     deviation of 2⁻⁹ … 2⁵ of the colour. A greater one raises the exponent, as such noise hides far more than the
//     colour's last bits.
//   history length: 4 bits of exponent, 4 of mantissa; 1 … 61 440, and exact up to 32. 0 says that nothing was hit.
//
// Rounded to the nearest, a running average of n frames would stop moving when it is n·2⁻¹⁴ off. So each number is
// rounded up as often as what is cut off is large: what is stored is right on average, and a number that needs no
// rounding stays what it is.

#import asvgf::random::hash
#ifndef TEMPORAL_ONLY
#import asvgf::packing::{tap_color, unpack_rgb}
#endif

// Numbers to round with, one for each of the three fields, uniform in 32 bits. From frame to frame they follow the
// additive recurrence of three dimensions (Roberts 2018, "The Unreasonable Effectiveness of Quasirandom Sequences"):
// rounding errors cancel sooner than those of independent numbers do.
fn rounding(pixel: vec2<u32>, index: u32) -> vec3<u32> {
    let start = hash(pixel.x ^ hash(pixel.y));
    return vec3(start, start << 11u, start << 22u) + index * vec3(3518319155u, 2882110345u, 2360945575u);
}

// What is taken from the bits of a variance so that its exponent becomes relative to the colour's: 1 … 30 then, where
// the variance counts. In integers, as a product of floats may leave the range of f32 on its way.
fn variance_offset(exponent: u32) -> i32 {
    return min(2 * i32(exponent) - 147, 255) * 0x800000;
}

fn pack_history(color: vec3<f32>, variance: f32, length: f32, random: vec3<u32>) -> vec2<u32> {
    let largest = max(max(color.x, color.y), color.z);
    let square = bitcast<u32>(min(variance, 1e37));
    // What is below f32's normal numbers is nothing.
    let varies = square >= 0x800000u;
    // The largest channel is below 2^(exponent − 127), also when it is rounded up: its last step counts to the next.
    let of_color = ((bitcast<u32>(largest) + 0x7ffu) >> 23u) + 1u;
    // So that the variance is below 2¹¹ times the square of that.
    let of_variance = select(0u, (square >> 24u) + 59u, varies);
    // 2⁻¹²⁶ is the least step of a normal number.
    let exponent = clamp(max(of_color, of_variance), 14u, 253u);
    let up = bitcast<f32>((254u - exponent) << 23u);
    // Not the sum with a random part, cut off: f32 would round that too. A 4000th of a step too much in each frame is
    // 0.1 % in a history of 32 768.
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
    // Without an exponent there is nothing.
    return bitcast<f32>(u32(select(0, square, min(relative, square) >= 0x800000)));
}

fn history_length(bits: vec2<u32>) -> f32 {
    let code = bits.y >> 24u;
    return select(0.0, bitcast<f32>(((code - 1u) << 19u) + 0x3f800000u), code > 0u);
}

// The filtered colour, in the format of the image in which the last pass of the filter left it.
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
