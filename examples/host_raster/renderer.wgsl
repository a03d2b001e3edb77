// A tiny renderer: a floor, a ball and a round lamp above them, drawn without geometry. It follows asvgf's `RESHADE_WGSL`.

// Vectors to the right and upper edge of the image, and to its centre.
struct View {
    eye: vec3<f32>,
    right: vec3<f32>,
    up: vec3<f32>,
    forward: vec3<f32>,
}

struct Scene {
    view: View,
    view_before: View,
    // Centre and radius of the ball, now and in the last frame.
    ball: vec4<f32>,
    ball_before: vec4<f32>,
    // Centre and radius of the lamp, which faces down.
    lamp: vec4<f32>,
    lamp_radiance: vec4<f32>,
}

@group(0) @binding(0) var<uniform> scene: Scene;
@group(0) @binding(1) var depth_out: texture_storage_2d<r32float, write>;
@group(0) @binding(2) var normal_out: texture_storage_2d<rgba16float, write>;
@group(0) @binding(3) var motion_out: texture_storage_2d<rg32float, write>;
@group(0) @binding(4) var albedo_out: texture_storage_2d<rgba8unorm, write>;

@group(0) @binding(1) var<uniform> asvgf: AsvgfFrame;
@group(0) @binding(2) var guide: texture_2d<u32>;
@group(0) @binding(3) var repeats: texture_2d<u32>;
@group(0) @binding(4) var shifts: texture_2d<u32>;
@group(0) @binding(5) var radiance_out: texture_storage_2d<rgba16float, write>;

const FAR: f32 = 1e9;
const PI: f32 = 3.14159265;

fn floor_distance(origin: vec3<f32>, direction: vec3<f32>) -> f32 {
    let t = -origin.y / direction.y;
    return select(FAR, t, direction.y < 0.0 && t < 60.0);
}

fn ball_distance(origin: vec3<f32>, direction: vec3<f32>) -> f32 {
    let to = scene.ball.xyz - origin;
    let along = dot(to, direction) / dot(direction, direction);
    let nearest = to - along * direction;
    let inside = scene.ball.w * scene.ball.w - dot(nearest, nearest);
    if inside <= 0.0 {
        return FAR;
    }
    let t = along - sqrt(inside / dot(direction, direction));
    return select(FAR, t, t > 0.0);
}

fn albedo_at(p: vec3<f32>) -> vec3<f32> {
    if distance(p, scene.ball.xyz) < 1.01 * scene.ball.w {
        return vec3(0.85, 0.35, 0.2);
    }
    let odd = (i32(floor(p.x)) + i32(floor(p.z))) & 1;
    return select(vec3(0.75), vec3(0.25, 0.3, 0.4), odd == 1);
}

fn image_point(view: View, p: vec3<f32>, size: vec2<f32>) -> vec2<f32> {
    let d = p - view.eye;
    let z = dot(d, view.forward);
    let x = dot(d, view.right) / dot(view.right, view.right) / z;
    let y = dot(d, view.up) / dot(view.up, view.up) / z;
    return (vec2(x, -y) * 0.5 + 0.5) * size;
}

@compute @workgroup_size(8, 8)
fn draw(@builtin(global_invocation_id) id: vec3<u32>) {
    let size = textureDimensions(depth_out);
    if any(id.xy >= size) {
        return;
    }
    let view = scene.view;
    let point = (vec2<f32>(id.xy) + 0.5) / vec2<f32>(size) * 2.0 - 1.0;
    // The ray has unit length along the view direction, so that distances along it are linear depths.
    let ray = view.forward + point.x * view.right - point.y * view.up;
    let ball = ball_distance(view.eye, ray);
    let z = min(ball, floor_distance(view.eye, ray));
    if z >= FAR {
        textureStore(depth_out, id.xy, vec4(0.0));
        textureStore(normal_out, id.xy, vec4(0.0));
        textureStore(motion_out, id.xy, vec4(0.0));
        textureStore(albedo_out, id.xy, vec4(0.0));
        return;
    }
    let p = view.eye + z * ray;
    let on_ball = ball == z;
    // The point's place in the last frame: the ball does not turn here.
    let before = select(p, p - scene.ball.xyz + scene.ball_before.xyz, on_ball);
    let moved = image_point(scene.view_before, before, vec2<f32>(size)) - vec2<f32>(id.xy) - 0.5;
    textureStore(depth_out, id.xy, vec4(z));
    textureStore(normal_out, id.xy, vec4(select(vec3(0.0, 1.0, 0.0), normalize(p - scene.ball.xyz), on_ball), 0.0));
    textureStore(motion_out, id.xy, vec4(moved, 0.0, 0.0));
    textureStore(albedo_out, id.xy, vec4(albedo_at(p), 1.0));
}

fn pcg(x: u32) -> u32 {
    let state = x * 747796405u + 2891336453u;
    let word = ((state >> ((state >> 28u) + 4u)) ^ state) * 277803737u;
    return (word >> 22u) ^ word;
}

@compute @workgroup_size(8, 8)
fn shade(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= textureDimensions(guide)) {
        return;
    }
    // Adaptive filtering needs this line alone. From here on, nothing depends on the pixel.
    let s = asvgf_surface(asvgf, guide, repeats, shifts, id.xy);
    if !s.hit {
        textureStore(radiance_out, id.xy, vec4(0.3, 0.45, 0.7, 1.0));
        return;
    }
    let first = pcg(s.seed_pixel.x ^ pcg(s.seed_pixel.y ^ pcg(s.seed_frame)));
    let random = vec2(f32(first >> 8u), f32(pcg(first) >> 8u)) / 16777216.0;
    // Trace one shadow ray to a point of the lamp, and one to the sky.
    let radius = scene.lamp.w * sqrt(random.x);
    let angle = 2.0 * PI * random.y;
    let target_point = scene.lamp.xyz + radius * vec3(cos(angle), 0.0, sin(angle));
    let origin = s.position + 1e-3 * s.normal;
    let way = target_point - origin;
    let squared = dot(way, way);
    let direction = way * inverseSqrt(squared);
    let cosines = max(dot(s.normal, direction), 0.0) * max(direction.y, 0.0);
    let lit = select(0.0, 1.0, ball_distance(origin, direction) * ball_distance(origin, direction) > squared);
    let area = PI * scene.lamp.w * scene.lamp.w;
    let irradiance = scene.lamp_radiance.xyz * (lit * cosines * area / squared);
    let ambient = vec3(0.08, 0.1, 0.14) * (0.5 + 0.5 * s.normal.y);
    textureStore(radiance_out, id.xy, vec4(albedo_at(s.position) * (irradiance / PI + ambient), 1.0));
}
