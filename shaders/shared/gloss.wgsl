#define_import_path asvgf::gloss

// The gloss of a pixel's surface in 32 bits, 0 where no specular lobe reflects:
//   roughness: 8 bits, 1 … 255 for 0 … 1
//   distance from the surface to what its path met along the lobe: 16 bits, see `pack_unsigned`; 0 if that is unknown
//   specular part of the reflectance: 8 bits
//
// A glossy pixel's reflection in 64 bits, 0 where no specular lobe reflects:
//   motion, see `pack_motion`: 42 bits
//   roughness: 8 bits, as above
//   distance from the surface to what it shows: 14 bits, `pack_unsigned` without the last two

#import asvgf::frame::{frame, is_orthographic}
#import asvgf::packing::{pack_motion, pack_unsigned, unpack_motion, unpack_unsigned}

struct Gloss {
    // Perceptual roughness r; the GGX width is α = r².
    roughness: f32,
    // Distance to what the path met, 0 if that is unknown.
    hit_distance: f32,
    // Specular part of the reflectance, 0…1.
    part: f32,
    // True if there is a specular lobe.
    exists: bool,
}

// Greatest code of a roughness.
const ROUGH: f32 = 254.0;

fn pack_gloss(roughness: f32, hit_distance: f32, part: f32) -> u32 {
    let code = 1u + u32(clamp(roughness, 0.0, 1.0) * ROUGH + 0.5);
    return code | (pack_unsigned(hit_distance) << 8u) | (u32(clamp(part, 0.0, 1.0) * 255.0 + 0.5) << 24u);
}

fn unpack_gloss(bits: u32) -> Gloss {
    let code = bits & 0xffu;
    return Gloss(
        roughness_of(code),
        unpack_unsigned((bits >> 8u) & 0xffffu),
        f32(bits >> 24u) * (1.0 / 255.0),
        code != 0u,
    );
}

struct Reflection {
    // Its former place less its place, in pixels.
    motion: vec2<f32>,
    // Perceptual roughness of the surface that shows it.
    roughness: f32,
    // Distance from the surface to what it shows.
    hit_distance: f32,
    // True if there is a specular lobe.
    exists: bool,
}

// Packs a reflection on a surface with this code of a roughness.
fn pack_reflection(motion: vec2<f32>, hit_distance: f32, code: u32) -> vec2<u32> {
    let moved = pack_motion(motion, 0.0);
    // No less than the format's least number, 2⁻³⁰: the distance is known.
    let distance = clamp((pack_unsigned(hit_distance) + 2u) >> 2u, 0x100u, 0x3fffu);
    return vec2(moved.x, moved.y | (code << 10u) | (distance << 18u));
}

fn unpack_reflection(bits: vec2<u32>) -> Reflection {
    let code = roughness_code(bits);
    return Reflection(unpack_motion(bits).xy, roughness_of(code), unpack_unsigned((bits.y >> 18u) << 2u), code != 0u);
}

// The code of the roughness in a packed reflection.
fn roughness_code(reflection: vec2<u32>) -> u32 {
    return (reflection.y >> 10u) & 0xffu;
}

// The roughness of its code; 0 for a surface without a lobe.
fn roughness_of(code: u32) -> f32 {
    return f32(max(code, 1u) - 1u) * (1.0 / ROUGH);
}

// The guide of the specular signal: the surface's, whose depth ends with the code of the roughness, and 0 where there is no lobe. The
// depth loses less than 2⁻¹⁵ of itself.
fn specular_guide(guide: vec2<u32>, code: u32) -> vec2<u32> {
    return select(vec2(0u), vec2(guide.x, (guide.y & 0xffffff00u) | code), code != 0u && guide.y != 0u);
}

// The roughness in a guide of the specular signal.
fn guide_roughness(guide: vec2<u32>) -> f32 {
    return roughness_of(guide.y & 0xffu);
}

// Width of a point's reflection, in pixels: f·α·h/(z + h) with the focal length f in pixels, the surface's depth z and the distance h of what
// it reflects, as far as half of the GGX lobe's light reaches (tan θ = α). An orthographic view shows all distances alike: f·α·h.
fn lobe_width(roughness: f32, hit_distance: f32, depth: f32) -> f32 {
    let c = frame.camera;
    // The quotient of h first: h may be as good as infinite.
    let apparent = select(1.0 / (depth / max(hit_distance, 1e-30) + 1.0), min(hit_distance, 1e9), is_orthographic(c));
    return sqrt(c.inverse_du) * roughness * roughness * apparent;
}
