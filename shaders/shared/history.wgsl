#define_import_path asvgf::history

// History length (15-bit mantissa: exact beyond 30 000 frames) and λ (8 bits, rounded up so that 0 means exactly 0).
fn pack_length_lambda(length: f32, lambda: f32) -> u32 {
    return (bitcast<u32>(length) & 0xffffff00u) | u32(ceil(clamp(lambda, 0.0, 1.0) * 255.0));
}

fn unpack_length(bits: u32) -> f32 {
    return bitcast<f32>(bits & 0xffffff00u);
}

fn unpack_lambda(bits: u32) -> f32 {
    return f32(bits & 0xffu) * (1.0 / 255.0);
}
