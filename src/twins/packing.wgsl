// Sends numbers through every format and back, for the test of the formats.

#import asvgf::packing::{pack_rgb, unpack_rgb, pack_unsigned, unpack_unsigned, pack_motion, unpack_motion, pack_normal, unpack_normal, unpack_octahedral, round_to_f16}

// (colour, 0), (unit vector, 0), (motion, depth, octahedral bits)
@group(0) @binding(0) var<storage, read> numbers: array<vec4<f32>>;
// Colour; normal; the three colour channels as 16-bit floats; octahedral; rounded to f16; motion.
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if 3u * i >= arrayLength(&numbers) {
        return;
    }
    let a = numbers[3u * i];
    let b = numbers[3u * i + 1u];
    let c = numbers[3u * i + 2u];
    results[6u * i] = vec4(unpack_rgb(pack_rgb(a.xyz)), 0.0);
    results[6u * i + 1u] = vec4(unpack_normal(pack_normal(b.xyz)), 0.0);
    results[6u * i + 2u] = vec4(
        unpack_unsigned(pack_unsigned(a.x)), unpack_unsigned(pack_unsigned(a.y)), unpack_unsigned(pack_unsigned(a.z)), 0.0);
    results[6u * i + 3u] = vec4(unpack_octahedral(bitcast<u32>(c.w)), 0.0);
    results[6u * i + 4u] = vec4(round_to_f16(a.xyz), 0.0);
    results[6u * i + 5u] = vec4(unpack_motion(pack_motion(c.xy, c.z)), 0.0);
}
