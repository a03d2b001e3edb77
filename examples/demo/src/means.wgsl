// Sums each row of an image, because the CPU need not see all pixels.

@group(0) @binding(0) var image: texture_2d<f32>;
@group(0) @binding(1) var first: texture_2d<f32>;
@group(0) @binding(2) var second: texture_2d<f32>;
@group(0) @binding(3) var<storage, read_write> rows: array<f32>;

var<workgroup> parts: array<f32, 64>;

// The sum of the parts of 64 invocations, valid in the first.
fn together(lane: u32, part: f32) -> f32 {
    parts[lane] = part;
    for (var reach = 32u; reach > 0u; reach >>= 1u) {
        workgroupBarrier();
        if lane < reach {
            parts[lane] += parts[lane + reach];
        }
    }
    return parts[0];
}

// Sums the red channel.
@compute @workgroup_size(64)
fn mean(@builtin(workgroup_id) row: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    var sum = 0.0;
    for (var x = lane; x < textureDimensions(image).x; x += 64u) {
        sum += textureLoad(image, vec2(x, row.x), 0).x;
    }
    let all = together(lane, sum);
    if lane == 0u {
        rows[row.x] = all;
    }
}

// Sums the squared error. Only two noisy images of the truth are known, and the square of a difference would include their
// variance. Their noise is independent, so the product of both differences is the squared error on average, however noisy they are.
@compute @workgroup_size(64)
fn squared_error(@builtin(workgroup_id) row: vec3<u32>, @builtin(local_invocation_index) lane: u32) {
    var sum = 0.0;
    for (var x = lane; x < textureDimensions(image).x; x += 64u) {
        let pixel = vec2(x, row.x);
        let value = textureLoad(image, pixel, 0).xyz;
        let product = (value - textureLoad(first, pixel, 0).xyz) * (value - textureLoad(second, pixel, 0).xyz);
        sum += (product.x + product.y + product.z) / 3.0;
    }
    let all = together(lane, sum);
    if lane == 0u {
        rows[row.x] = all;
    }
}
