#define_import_path asvgf::frame

// A camera as an affine map from image point to ray. `corner + x·du + y·dv` is the direction through the image point (x, y) in
// pixels (x right, y down, the first pixel's centre at ½, ½), with unit component along `forward`, so that a linear depth z puts
// the point at `eye + z·direction`. In an orthographic view all rays are parallel, and their offsets do not grow with the depth:
// `eye + z·forward + (direction − forward)`.
struct Camera {
    // In the scene's coordinates, which count from its centre, or in the host's.
    eye: vec3<f32>,
    // Offset of a pixel's ray from the pixel's centre, in pixels.
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
    // The eye less that of this frame's camera.
    offset: vec3<f32>,
}

// One frame's constants. Mirrored by `FrameUniform` in src/gpu/frame.rs.
struct Frame {
    // Numbers that stay the same from frame to frame come first. Mesa's lavapipe compiles `trace` and `temporal` anew whenever the
    // first number of a uniform has changed, and the camera's place changes in each frame of a move (docs/performance.md).
    size: vec2<u32>,
    // Strata of 3×3 pixels in each direction; the last one may be cut.
    strata: vec2<u32>,
    camera: Camera,
    previous: Camera,
    index: u32,
    seed: u32,
    // 1 if there is a history to reproject, 0 after a restart.
    continued: u32,
    // Samples per pixel.
    samples: u32,
    // Samples that this dispatch traces, and the number of the first.
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
    // Ridge on the slopes of the local linear fit.
    ridge: f32,
    // Independent pairs that a filtered pair is worth.
    effective_pairs: f32,
    // Dead zone: subtracted from λ.
    dead_zone: f32,
    // Pixels per texel of the host's λ, in each direction.
    lambda_block: u32,
    // Ratio of deviation to luminance below which the spatial filter leaves a pixel as it is.
    converged: f32,
    sigma_foreshortening: f32,
    // Ridge per variance of the fitted slope over its square.
    ridge_noise: f32,
    // Greatest weight of the last output in this one.
    steadiness: f32,
    // Greatest luminance of a sample in multiples of its level, see outliers.wgsl.
    outlier_limit: f32,
    // The exponent and the stop of the specular signal.
    gloss_history_power: f32,
    gloss_sigma_luminance: f32,
    // Greatest luminance of accumulated specular light, as a multiple of that around.
    gloss_clamp: f32,
    // See `FilterSettings::gloss_parallax`.
    gloss_parallax: f32,
}

@group(0) @binding(0) var<uniform> frame: Frame;

fn is_orthographic(camera: Camera) -> bool {
    return camera.orthographic != 0.0;
}

// Direction of the perspective ray through an image point, with unit component along `forward`.
fn direction(camera: Camera, image_point: vec2<f32>) -> vec3<f32> {
    return camera.corner + image_point.x * camera.du + image_point.y * camera.dv;
}

// Change of a pixel's point per depth.
fn ray_direction(camera: Camera, image_point: vec2<f32>) -> vec3<f32> {
    return select(direction(camera, image_point), camera.forward, is_orthographic(camera));
}

// The length that tolerances are parts of: the depth. In an orthographic view the depth tells nothing of sizes, so it is the
// image's width.
fn scale_at(camera: Camera, depth: f32) -> f32 {
    return select(depth, f32(frame.size.x) * inverseSqrt(camera.inverse_du), is_orthographic(camera));
}

// The image point through which a pixel is sampled.
fn sample_point(camera: Camera, pixel: vec2<f32>) -> vec2<f32> {
    return pixel + 0.5 + vec2(camera.jitter_x, camera.jitter_y);
}

// Place of a pixel's surface, counted from this frame's eye: the eyes' own coordinates may be so large that small distances are
// lost beside them.
fn seen_position(camera: Camera, image_point: vec2<f32>, depth: f32) -> vec3<f32> {
    let d = direction(camera, image_point);
    return camera.offset + select(depth * d, (d - camera.forward) + depth * camera.forward, is_orthographic(camera));
}

// Projects a point, given from this frame's eye, to (x, y) in pixels and its linear depth. Meaningless unless the depth is positive.
fn project(camera: Camera, position: vec3<f32>) -> vec3<f32> {
    let offset = position - camera.offset;
    let depth = dot(offset, camera.forward);
    let d = select(offset / depth, offset - (depth - 1.0) * camera.forward, is_orthographic(camera)) - camera.corner;
    return vec3(dot(d, camera.du) * camera.inverse_du, dot(d, camera.dv) * camera.inverse_dv, depth);
}

// True for a pixel of the image. Passes that store only at their own pixel or stratum do without this test: WGSL drops stores
// outside of a texture, and a branch around a whole shader makes every read of a uniform slower on a software adapter
// (docs/performance.md).
fn inside(pixel: vec2<i32>) -> bool {
    return all(vec2<u32>(pixel) < frame.size);
}
