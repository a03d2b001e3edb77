// Packs histories and reads them again, or averages them over frames, for the test of their format.

#import asvgf::history::{pack_history, history_color, history_variance, history_length, rounding}
#import asvgf::random::hash

// (colour, variance), (length, α or 0 for 1/n, frames, spread of the samples). With 1/n the length counts the frames.
@group(0) @binding(0) var<storage, read> numbers: array<vec4<f32>>;
// (colour, variance), (length, 0, 0, 0)
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if 2u * i >= arrayLength(&numbers) {
        return;
    }
    let a = numbers[2u * i];
    let b = numbers[2u * i + 1u];
    var bits = pack_history(a.xyz, a.w, b.x, rounding(vec2(i, 7u), 0u));
    let frames = u32(b.z);
    for (var k = 1u; k <= frames; k++) {
        let u = f32(hash(i ^ hash(k)) >> 8u) * (1.0 / 16777216.0);
        let color = history_color(bits);
        let sample = a.xyz * (1.0 + b.w * (2.0 * u - 1.0));
        let counts = b.y == 0.0;
        let alpha = select(b.y, 1.0 / f32(k + 1u), counts);
        // The mean of the samples is exact, which keeps the colour's own error out of the deviation.
        let deviation = a.x * b.w * (2.0 * u - 1.0);
        let variance = history_variance(bits) + select(0.0, alpha * (deviation * deviation - history_variance(bits)), b.w > 0.0);
        let length = history_length(bits) + select(0.0, 1.0, counts && b.w > 0.0);
        bits = pack_history(color + alpha * (sample - color), variance, length, rounding(vec2(i, 7u), k));
    }
    results[2u * i] = vec4(history_color(bits), history_variance(bits));
    results[2u * i + 1u] = vec4(history_length(bits), 0.0, 0.0, 0.0);
}
