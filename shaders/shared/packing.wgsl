#define_import_path asvgf::packing

// Packs three non-negative floats into 62 bits: a common 8-bit exponent and 18-bit mantissas, after the RGB9E5 format of
// EXT_texture_shared_exponent with more of both. The range is that of f32 (steps of 2⁻¹²⁶ … values of 2¹²⁶), and the largest
// channel is exact to 2⁻¹⁸. f16 would overflow at 65504, and a fed-back mean in it would stall 2⁷ times earlier.
fn pack_rgb(color: vec3<f32>) -> vec2<u32> {
    let largest = max(max(color.x, color.y), color.z);
    // The largest channel is below 2^(exponent − 127); its exponent is read from its bits.
    let exponent = clamp(i32(bitcast<u32>(largest) >> 23u) + 1, 19, 253);
    let up = bitcast<f32>(u32(254 - exponent) << 23u) * 262144.0;
    let mantissa = vec3<u32>(clamp(color * up + 0.5, vec3(0.0), vec3(262143.0)));
    return vec2(
        mantissa.x | (mantissa.y << 18u),
        (mantissa.y >> 14u) | (mantissa.z << 4u) | (u32(exponent) << 22u),
    );
}

fn unpack_rgb(bits: vec2<u32>) -> vec3<f32> {
    let down = bitcast<f32>((bits.y >> 22u) << 23u) * (1.0 / 262144.0);
    return down * vec3(
        f32(bits.x & 0x3ffffu),
        f32((bits.x >> 18u) | ((bits.y & 0xfu) << 14u)),
        f32((bits.y >> 4u) & 0x3ffffu),
    );
}

// Stands for a missing radiance: an exponent that no radiance has. Unpacked as a radiance, it is black.
const NO_SAMPLE: vec2<u32> = vec2(0u, 0x400000u);

// Marks an infinite radiance: the highest bit of the exponent, which `unpack_rgb` shifts out.
const INFINITE_SAMPLE: u32 = 0x80000000u;

fn is_missing(bits: vec2<u32>) -> bool {
    return bits.y == NO_SAMPLE.y;
}

// True if a radiance can be averaged.
fn is_sample(bits: vec2<u32>) -> bool {
    return !is_missing(bits) && bits.y < INFINITE_SAMPLE;
}

// Packs a non-negative float into 16 bits: 6 of exponent, 10 of mantissa, 2⁻³¹ … 2³³, half an ulp 2⁻¹². It is f16 whose sign bit
// belongs to the exponent, made with integers because not every driver has pack2x16float.
fn pack_unsigned(x: f32) -> u32 {
    // ×2⁻⁹⁶ moves the exponent's bias from 127 to 31; 8.5·10⁹ is just below 2³³.
    return (bitcast<u32>(clamp(x, 0.0, 8.5e9) * 1.262177e-29) + 0x1000u) >> 13u;
}

fn unpack_unsigned(bits: u32) -> f32 {
    return bitcast<f32>(bits << 13u) * 7.922816e28;
}

// Packs the data that the spatial filter carries from one iteration to the next: a colour and the standard deviation of its luminance.
fn pack_tap(color: vec3<f32>, deviation: f32) -> vec2<u32> {
    return vec2(
        pack_unsigned(color.x) | (pack_unsigned(color.y) << 16u),
        pack_unsigned(color.z) | (pack_unsigned(deviation) << 16u),
    );
}

fn tap_color(tap: vec2<u32>) -> vec3<f32> {
    return vec3(unpack_unsigned(tap.x & 0xffffu), unpack_unsigned(tap.x >> 16u), unpack_unsigned(tap.y & 0xffffu));
}

fn unpack_tap_deviation(tap: vec2<u32>) -> f32 {
    return unpack_unsigned(tap.y >> 16u);
}

fn tap_variance(tap: vec2<u32>) -> f32 {
    let deviation = unpack_tap_deviation(tap);
    return deviation * deviation;
}

// Packs a unit vector into three signed 10-bit numbers (0.06° off at worst). Unlike an octahedral map this needs no normalisation
// and no branch to unpack, and the à-trous filter unpacks 52 per pixel.
fn pack_normal(n: vec3<f32>) -> u32 {
    let q = vec3<i32>(round(clamp(n, vec3(-1.0), vec3(1.0)) * 511.0)) & vec3(0x3ff);
    return u32(q.x | (q.y << 10u) | (q.z << 20u));
}

// The packed normal times 511.
fn unpack_normal_511(bits: u32) -> vec3<f32> {
    let b = i32(bits);
    return vec3<f32>(vec3((b << 22u) >> 22u, (b << 12u) >> 22u, (b << 2u) >> 22u));
}

fn unpack_normal(bits: u32) -> vec3<f32> {
    return unpack_normal_511(bits) * (1.0 / 511.0);
}

// Unpacks a unit vector from two 16-bit numbers on the unfolded octahedron (Meyer et al. 2010, "On Floating-Point Normal Vectors").
fn unpack_octahedral(bits: u32) -> vec3<f32> {
    return octahedral(vec2(f32(bits & 0xffffu), f32(bits >> 16u)) * (2.0 / 65535.0) - 1.0);
}

// The unit vector of a point of the unfolded octahedron, −1…1.
fn octahedral(e: vec2<f32>) -> vec3<f32> {
    let z = 1.0 - abs(e.x) - abs(e.y);
    let fold = max(-z, 0.0);
    return normalize(vec3(e - select(vec2(-fold), vec2(fold), e >= vec2(0.0)), z));
}

// Motion out of every image, in pixels: that of a point that had no place in the previous image.
const NOWHERE: vec2<f32> = vec2(-1e6);

// Motions from this length on, in pixels, are stored as −4096, the least number of 21 bits with a sign in steps of 1/256. It stands
// for NOWHERE.
const FARTHEST: f32 = 4095.5;
const STORED_NOWHERE: f32 = -4096.0;

// Packs a motion in steps of 1/256 pixel (21 bits each) and the depth that the point had, an f32 without its sign and with 14 bits
// of mantissa, into 64 bits. A reprojected history is interpolated between pixels, which blurs a thousand times more than this
// rounds; no motion is exactly none.
fn pack_motion(motion: vec2<f32>, depth: f32) -> vec2<u32> {
    let near = all(abs(motion) < vec2(FARTHEST));
    let q = vec2<u32>(vec2<i32>(round(select(vec2(STORED_NOWHERE), motion, near) * 256.0))) & vec2(0x1fffffu);
    let z = (bitcast<u32>(clamp(depth, 0.0, 3e38)) + 0x100u) >> 9u;
    return vec2(q.x | (q.y << 21u), (q.y >> 11u) | (z << 10u));
}

fn unpack_motion(bits: vec2<u32>) -> vec3<f32> {
    let q = vec2<i32>(vec2(bits.x << 11u, ((bits.x >> 10u) & 0x3ff800u) | (bits.y << 22u))) >> vec2(11u);
    let motion = vec2<f32>(q) * (1.0 / 256.0);
    let depth = bitcast<f32>((bits.y >> 10u) << 9u);
    return vec3(select(motion, NOWHERE, motion.x == STORED_NOWHERE), depth);
}

// Rounds to the nearest numbers with the 10-bit mantissa of f16, for values of f16's normal range: an rgba16float texture then
// holds them exactly. (WebGPU's core has pack2x16float, but some drivers behind wgpu do not.)
fn round_to_f16(x: vec3<f32>) -> vec3<f32> {
    return bitcast<vec3<f32>>((bitcast<vec3<u32>>(x) + 0x1000u) & vec3(0xffffe000u));
}

// Least displacement that is stored, 2⁻²⁴.
const LEAST_DISPLACEMENT: f32 = 5.96e-8;

// Packs a displacement into 32 bits: three signed 9-bit mantissas with a common exponent of 5 bits (compare RGB9E5 of
// EXT_texture_shared_exponent). Components are exact to 1/255 of the largest one. Displacements below 2⁻²⁴ count as none, and
// components beyond ±2⁸ as ±2⁸.
fn pack_displacement(d: vec3<f32>) -> u32 {
    let largest = max(max(abs(d.x), abs(d.y)), abs(d.z));
    if !(largest >= LEAST_DISPLACEMENT) {
        return 0u;
    }
    // The largest component is below 2^(exponent − 23).
    let exponent = clamp(i32(bitcast<u32>(largest) >> 23u) - 126 + 23, 0, 31);
    let scale = 255.0 * exp2(f32(23 - exponent));
    let q = vec3<u32>(vec3<i32>(round(clamp(d * scale, vec3(-255.0), vec3(255.0))))) & vec3(0x1ffu);
    return q.x | (q.y << 9u) | (q.z << 18u) | (u32(exponent) << 27u);
}

fn unpack_displacement(bits: u32) -> vec3<f32> {
    let b = i32(bits);
    let q = vec3<f32>(vec3((b << 23u) >> 23u, (b << 14u) >> 23u, (b << 5u) >> 23u));
    return q * (exp2(f32(bits >> 27u) - 23.0) * (1.0 / 255.0));
}
