#define_import_path asvgf::frame

// A camera as an affine map from pixel to ray. `corner + x·du + y·dv` is the direction through the image point (x, y) in pixels (x right,
// y down, the first pixel's centre at ½, ½), with unit component along `forward`: a linear depth z puts the point at
// `eye + z·direction`. In an orthographic view all rays are parallel, and what spreads them does not grow with the depth:
// `eye + z·forward + (direction − forward)`.
struct Camera {
    // In the coordinates of the scene, which count from its centre, or in those of the host.
    eye: vec3<f32>,
    // Where in its pixel a ray goes through the image, from the centre, in pixels.
    jitter_x: f32,
    forward: vec3<f32>,
    jitter_y: f32,
    corner: vec3<f32>,
    // 1 for an orthographic view, 0 for a perspective.
    orthographic: f32,
    du: vec3<f32>,
    // 1 / |du|²
    inverse_du: f32,
    dv: vec3<f32>,
    // 1 / |dv|²
    inverse_dv: f32,
    // The eye, less that of this frame's camera.
    offset: vec3<f32>,
}

// One frame's constants. Mirrored by `FrameUniform` in src/gpu/frame.rs.
struct Frame {
    // What stays comes first: Mesa's lavapipe compiles `trace` and `temporal` anew whenever the first number of a uniform has
    // another value, which the camera's place has in each frame of a move (docs/performance.md).
    size: vec2<u32>,
    // Strata of 3×3 pixels in each direction, the last one possibly cut.
    strata: vec2<u32>,
    camera: Camera,
    previous: Camera,
    index: u32,
    seed: u32,
    // 1 where there is history to reproject, 0 after a restart.
    continued: u32,
    // Samples per pixel, and those of them that this dispatch traces.
    samples: u32,
    batch: u32,
    first_sample: u32,
    bounces: u32,
    // First bounce at which Russian roulette may end a path.
    roulette: u32,
    // Lower bound of the weight of a new frame.
    alpha: f32,
    // Upper bound of the history length.
    max_history: f32,
    // History length is multiplied by (1 − λ)^history_power.
    history_power: f32,
    // γ of the gradient's normalisation A[Δ^(γ−1)|δ|] / A[Δ^γ].
    gradient_gamma: f32,
    sigma_luminance: f32,
    sigma_depth: f32,
    sigma_normal: f32,
    // Ridge of the local linear fit.
    ridge: f32,
    ratio_limit: f32,
    ratio_chroma_limit: f32,
    ratio_prior: f32,
    ratio_shrinkage: f32,
    // Subtracted from λ.
    dead_zone: f32,
    // Pixels of each direction that share a texel of the host's λ.
    lambda_block: u32,
    // Deviation over luminance below which a pixel is left as it is.
    converged: f32,
    sigma_foreshortening: f32,
    // Times the variance of the fitted plane's slope over its square, of the ridge.
    ridge_noise: f32,
    // Most that the last output weighs in this one.
    steadiness: f32,
    // Luminance that a sample may have, in multiples of its level, see outliers.wgsl.
    outlier_limit: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

fn is_orthographic(camera: Camera) -> bool {
    return camera.orthographic != 0.0;
}

// Through the image point, as the ray goes in a perspective.
fn direction(camera: Camera, image_point: vec2<f32>) -> vec3<f32> {
    return camera.corner + image_point.x * camera.du + image_point.y * camera.dv;
}

// How the point of a pixel moves with its depth.
fn ray_direction(camera: Camera, image_point: vec2<f32>) -> vec3<f32> {
    return select(direction(camera, image_point), camera.forward, is_orthographic(camera));
}

// The length of which tolerances are parts: the depth. In an orthographic view, where the depth tells nothing of sizes, the image's width.
fn scale_at(camera: Camera, depth: f32) -> f32 {
    return select(depth, f32(frame.size.x) * inverseSqrt(camera.inverse_du), is_orthographic(camera));
}

// The image point through which a pixel is sampled.
fn sample_point(camera: Camera, pixel: vec2<f32>) -> vec2<f32> {
    return pixel + 0.5 + vec2(camera.jitter_x, camera.jitter_y);
}

// Where a pixel's surface is, from this frame's eye: the eyes' own coordinates may be so large that small distances are lost beside them.
fn seen_position(camera: Camera, image_point: vec2<f32>, depth: f32) -> vec3<f32> {
    let d = direction(camera, image_point);
    return camera.offset + select(depth * d, (d - camera.forward) + depth * camera.forward, is_orthographic(camera));
}

// (x, y) in pixels and the linear depth of a point that is given from this frame's eye; meaningless where the depth is not positive.
fn project(camera: Camera, position: vec3<f32>) -> vec3<f32> {
    let offset = position - camera.offset;
    let depth = dot(offset, camera.forward);
    let d = select(offset / depth, offset - (depth - 1.0) * camera.forward, is_orthographic(camera)) - camera.corner;
    return vec3(dot(d, camera.du) * camera.inverse_du, dot(d, camera.dv) * camera.inverse_dv, depth);
}

// Passes that store only at their own pixel or stratum do not ask this of it: WGSL drops stores outside of a texture, and a
// branch around a whole shader makes every read of a uniform slower on a software adapter (docs/performance.md).
fn inside(pixel: vec2<i32>) -> bool {
    return all(vec2<u32>(pixel) < frame.size);
}
