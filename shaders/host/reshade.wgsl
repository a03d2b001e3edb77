// For a host's own shaders: tells which surface to shade in a pixel, and with which random numbers. Bind `asvgf::Reshade`'s buffer
// as a uniform AsvgfFrame and its textures as texture_2d<u32>, seed from (seed_pixel, seed_frame), and shade the surface that
// `asvgf_surface` returns.

struct AsvgfCamera {
    eye: vec3<f32>,
    jitter_x: f32,
    forward: vec3<f32>,
    jitter_y: f32,
    // Direction through the image point (0, 0), of unit length along `forward`, and its change per pixel.
    corner: vec3<f32>,
    // 1 for an orthographic view, 0 for a perspective.
    orthographic: f32,
    du: vec3<f32>,
    inverse_du: f32,
    dv: vec3<f32>,
    inverse_dv: f32,
    // The eye less that of this frame's camera.
    offset: vec3<f32>,
}

// The first members of the frame's constants.
struct AsvgfFrame {
    size: vec2<u32>,
    strata: vec2<u32>,
    camera: AsvgfCamera,
    previous: AsvgfCamera,
    index: u32,
}

struct AsvgfSurface {
    // True if the pixel sees a surface. If not, nothing else here counts.
    hit: bool,
    // Seed the random numbers from these two alone, in every pixel.
    seed_pixel: vec2<u32>,
    seed_frame: u32,
    // True if this repeats a path of the last frame. `seed_pixel` is then the pixel that saw the surface, for hosts that keep the
    // last frame's G-buffer: the surface's albedo and roughness are there.
    repeats: bool,
    // Place of the surface in this frame, in world space.
    position: vec3<f32>,
    // Its normal, to 10 bits a component.
    normal: vec3<f32>,
    // The eye that sees it.
    eye: vec3<f32>,
}

fn asvgf_surface(
    frame: AsvgfFrame,
    guide: texture_2d<u32>,
    repeats: texture_2d<u32>,
    shifts: texture_2d<u32>,
    pixel: vec2<u32>,
) -> AsvgfSurface {
    // Packed normal and depth, of this pixel or of the one whose path is repeated.
    var seen = textureLoad(guide, pixel, 0).xy;
    let stratum = pixel / 3u;
    let within = pixel - 3u * stratum;
    let repeat = textureLoad(repeats, stratum, 0);
    let again = repeat.x == within.y * 3u + within.x + 1u;
    var from_pixel = pixel;
    var shift = vec3(0.0);
    var camera = frame.camera;
    if again {
        from_pixel = vec2(repeat.y & 0xffffu, repeat.y >> 16u);
        seen = repeat.zw;
        shift = bitcast<vec3<f32>>(textureLoad(shifts, stratum, 0).xyz);
        camera = frame.previous;
    }
    // One formula for both, so that a surface at rest is shaded at the same point to the last bit.
    let z = bitcast<f32>(seen.y);
    let point = vec2<f32>(from_pixel) + 0.5 + vec2(camera.jitter_x, camera.jitter_y);
    let spread = camera.corner + point.x * camera.du + point.y * camera.dv;
    // In an orthographic view rays are parallel, and each has an origin of its own.
    let origin = camera.eye + camera.orthographic * (spread - camera.forward);
    let position = select(
        camera.eye + z * spread,
        camera.eye + (spread - camera.forward) + z * camera.forward,
        camera.orthographic != 0.0,
    );
    let bits = i32(seen.x);
    let n = vec3<f32>(vec3((bits << 22u) >> 22u, (bits << 12u) >> 22u, (bits << 2u) >> 22u));
    return AsvgfSurface(
        seen.y != 0u,
        from_pixel,
        frame.index - u32(again),
        again,
        position + shift,
        n * inverseSqrt(max(dot(n, n), 1.0)),
        origin,
    );
}
