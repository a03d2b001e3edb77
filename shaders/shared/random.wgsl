#define_import_path asvgf::random

// Every random number is a pure function of (pixel, frame, sample, draw). So a later frame can reproduce this frame's path exactly,
// on which the temporal gradient depends, and no seed image is stored.

// PCG-RXS-M-XS 32 (O'Neill 2014), used as a hash, as Jarzynski and Olano recommend ("Hash Functions for GPU Rendering", JCGT 9(3),
// 2020).
fn hash(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

fn seed_of(pixel: vec2<u32>, frame: u32, sample: u32, seed: u32) -> u32 {
    return hash(pixel.x ^ hash(pixel.y ^ hash(frame ^ hash(sample ^ hash(seed)))));
}

// Uniform in [0, 1), 24 bits.
fn uniform_float(state: ptr<function, u32>) -> f32 {
    *state = *state * 747796405u + 2891336453u;
    let word = ((*state >> ((*state >> 28u) + 4u)) ^ *state) * 277803737u;
    return f32(((word >> 22u) ^ word) >> 8u) * (1.0 / 16777216.0);
}
