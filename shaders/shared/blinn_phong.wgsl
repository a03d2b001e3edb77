#define_import_path asvgf::blinn_phong

#import asvgf::frame::{frame, direction, sample_point}
#import asvgf::scene::NO_TRIANGLE
#import asvgf::surface::{Visible, Triangle, visible, triangle_now, triangle_before, barycentrics, at}
#import asvgf::ggx::PI
#import asvgf::demodulation::demodulation
#import asvgf::material::{Surface, surface_at}
#import asvgf::color::luminance

// The gradient function of Basci 2025: deferred shading with the Blinn–Phong model (Blinn 1977). It casts no ray and has no noise.
// It sees every change of a light's place and strength, and is blind to what blocks it.

struct AnalyticLight {
    position: vec3<f32>,
    // 0: emitter, a cosine lobe about `axis`; 1: point; 2: directional.
    kind: u32,
    axis: vec3<f32>,
    range: f32,
    intensity: vec3<f32>,
    spot_scale: f32,
    spot_offset: f32,
    // Number of lights in the list, the same in every entry.
    count: u32,
    _pad_a: u32,
    _pad_b: u32,
}

@group(0) @binding(9) var<storage, read> analytic_lights: array<AnalyticLight>;
@group(0) @binding(10) var<storage, read> analytic_lights_previous: array<AnalyticLight>;

fn incident(light: AnalyticLight, way: vec3<f32>) -> vec3<f32> {
    if light.kind == 2u {
        return light.intensity;
    }
    let squared = max(dot(way, way), 1e-12);
    let towards = way * inverseSqrt(squared);
    if light.kind == 0u {
        return light.intensity * (abs(dot(light.axis, towards)) / squared);
    }
    let ratio = squared / (light.range * light.range);
    let cone = clamp(-dot(light.axis, towards) * light.spot_scale + light.spot_offset, 0.0, 1.0);
    return light.intensity * (clamp(1.0 - ratio * ratio, 0.0, 1.0) * cone * cone / squared);
}

// Greatest exponent: a mirror still has a highlight to compare.
const SHARPEST: f32 = 128.0;

fn shade(s: Surface, light: AnalyticLight) -> vec3<f32> {
    let way = select(light.position - s.position, -light.axis, light.kind == 2u);
    let l = normalize(way);
    let cosine = max(dot(s.normal, l), 0.0);
#ifdef SPECULAR
    // Blinn's exponent for a GGX width (Karis 2013).
    let exponent = clamp(2.0 / (s.alpha * s.alpha) - 2.0, 1.0, SHARPEST);
    let highlight = pow(max(dot(s.normal, normalize(l + s.view)), 0.0), exponent) * (exponent + 8.0) / (8.0 * PI);
    let reflected = (s.diffuse / PI + s.reflectance * highlight) / demodulation(s);
#else
    let reflected = s.diffuse / (PI * demodulation(s));
#endif
    return reflected * incident(light, way) * cosine;
}

// Demodulated luminance of the last frame's visible surface in this frame's light and in the last frame's.
fn shade_pair(id: u32, pixel: vec2<i32>) -> vec2<f32> {
    if id == NO_TRIANGLE {
        return vec2(0.0);
    }
    let v = visible(id);
    let now = triangle_now(v);
    let before = triangle_before(v);
    let eye = frame.previous.eye;
    let weights = barycentrics(before, eye, direction(frame.previous, sample_point(frame.previous, vec2<f32>(pixel))));
    let surface_now = surface_at(v, now, weights, at(now, weights) - eye);
    let surface_before = surface_at(v, before, weights, at(before, weights) - eye);
    var sum_now = vec3(0.0);
    var sum_before = vec3(0.0);
    for (var i = 0u; i < analytic_lights[0].count; i++) {
        sum_now += shade(surface_now, analytic_lights[i]);
    }
    for (var i = 0u; i < analytic_lights_previous[0].count; i++) {
        sum_before += shade(surface_before, analytic_lights_previous[i]);
    }
    return vec2(luminance(sum_now), luminance(sum_before));
}
