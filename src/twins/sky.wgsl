// Draws light samples, for the test of the environment.

#import asvgf::light::sample_light

// Three random numbers.
@group(0) @binding(0) var<storage, read> numbers: array<vec4<f32>>;
// Direction and density; radiance.
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if i >= arrayLength(&numbers) {
        return;
    }
    let n = numbers[i];
    let s = sample_light(vec3(0.0), n.x, n.yz);
    results[2u * i] = vec4(s.direction, s.density);
    results[2u * i + 1u] = vec4(s.radiance, 0.0);
}
