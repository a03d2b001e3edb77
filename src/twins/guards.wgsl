// Sends numbers through the guards against invalid values, for the test of the guards.

#import asvgf::color::{is_finite, sanitize}

@group(0) @binding(0) var<storage, read> numbers: array<vec4<f32>>;
// The sanitised colour, and bits 0 to 2 for the channels that are finite.
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if id.x >= arrayLength(&numbers) {
        return;
    }
    let c = numbers[id.x].xyz;
    let finite = vec3(f32(is_finite(c.x)), f32(is_finite(c.y)), f32(is_finite(c.z)));
    results[id.x] = vec4(sanitize(c), dot(finite, vec3(1.0, 2.0, 4.0)));
}
