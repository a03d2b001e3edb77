#define_import_path asvgf::evidence

// The evidence of a stratum for the former place of its reflection, see specular_history.wgsl, in 64 bits:
//   t: a sign and 15 bits, `pack_unsigned` without the last one; s: 16 bits
//   normal that the evidence is for: 30 bits, see `pack_normal`; the last bit is 1 if the stratum compared anything

#import asvgf::packing::{pack_unsigned, unpack_unsigned}

struct Evidence {
    // t and s.
    sums: vec2<f32>,
    normal: u32,
    // True if the stratum compared anything.
    exists: bool,
}

fn pack_evidence(evidence: Evidence) -> vec2<u32> {
    let t = min(pack_unsigned(abs(evidence.sums.x)) + 1u, 0xffffu) >> 1u;
    let sign = bitcast<u32>(evidence.sums.x) >> 31u;
    return vec2(
        t | (sign << 15u) | (pack_unsigned(evidence.sums.y) << 16u),
        evidence.normal | (select(0u, 1u, evidence.exists) << 31u),
    );
}

fn unpack_evidence(bits: vec2<u32>) -> Evidence {
    let t = unpack_unsigned((bits.x & 0x7fffu) << 1u);
    let signed_t = select(t, -t, (bits.x & 0x8000u) != 0u);
    return Evidence(vec2(signed_t, unpack_unsigned(bits.x >> 16u)), bits.y & 0x3fffffffu, bits.y >= 0x80000000u);
}
