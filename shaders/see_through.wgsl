// Finds the surface that a pixel sees through clear glass, and gives the filter its normal, depth and motion instead of those of the
// glass. Failure: what lies behind a window was blurred, and smeared where the camera moved. Reason: the filter compared normals and
// depths of the pane, and followed the pane's motion. Rule: the ray is refracted at each boundary (mirrored beyond the critical angle) up
// to the first surface that is no clear glass. That surface counts at the length of the ray as if it lay straight ahead (compare
// "primary surface replacement", Zhdan 2021, "ReBLUR: A Hierarchical Recurrent Denoiser", Ray Tracing Gems II, ch. 49):
//
//   V  = eye + L·d,    V′ = V + P′ − P
//
// with the length L of the ray, the direction d of the pixel, and the places P and P′ of the surface point now and in the last
// frame. Behind a flat pane V is the point itself. Behind lenses it is not, and a moving camera shortens the history there.
//
// The light of the other signal, which the first surface mirrors, belongs to the first surface, so images of that are kept beside.

#import asvgf::frame::{frame, direction, project, sample_point, inside}
#import asvgf::ray::{Ray, SKY}
#import asvgf::traverse::closest_hit
#import asvgf::surface::{Visible, visible, triangle_now, triangle_before, barycentrics, at, geometric_normal, shading_normal}
#import asvgf::demodulation::{LEAST_DEMODULATION, demodulation, whole_demodulation}
#import asvgf::glass_scattering::{is_clear, lead, split}
#import asvgf::material::surface_at
#import asvgf::glass_path::{Body, absorbed, body_before, enter, origin_towards}
#ifdef ENVIRONMENT_LIGHT
#import asvgf::light::environment_radiance
#endif
#import asvgf::scene::NO_TRIANGLE
#import asvgf::color::sanitize
#import asvgf::packing::{NOWHERE, pack_motion, pack_normal, pack_rgb}

@group(0) @binding(1) var visibility: texture_2d<u32>;
// Normal, depth and motion of the first surface.
@group(0) @binding(2) var first_guide: texture_2d<u32>;
@group(0) @binding(3) var first_motion: texture_2d<u32>;
// The same of the surface that is seen.
@group(0) @binding(4) var guide_out: texture_storage_2d<rg32uint, write>;
@group(0) @binding(5) var motion_out: texture_storage_2d<rg32uint, write>;
// Albedo of what is seen through glass, 0 if nothing is; light that comes through the glass without another reflection.
@group(0) @binding(6) var seen_out: texture_storage_2d<rgba32uint, write>;
#ifdef INSTANCED
@group(0) @binding(7) var first_object: texture_2d<u32>;
@group(0) @binding(8) var object_out: texture_storage_2d<r32uint, write>;
#endif

// Boundaries behind each other through which the filter sees.
const MOST_LAYERS: u32 = 8u;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    var guide = textureLoad(first_guide, pixel, 0).xy;
    var motion = textureLoad(first_motion, pixel, 0).xy;
#ifdef INSTANCED
    var object = textureLoad(first_object, pixel, 0).x;
#endif
    var albedo = vec3(0.0);
    var emission = vec3(0.0);
    let first = textureLoad(visibility, pixel, 0).x;
    if first != NO_TRIANGLE {
        let ray = direction(frame.camera, sample_point(frame.camera, vec2<f32>(id.xy)));
        var v = visible(first);
        var t = triangle_now(v);
        var weights = barycentrics(t, frame.camera.eye, ray);
        var towards = at(t, weights) - frame.camera.eye;
        var s = surface_at(v, t, weights, towards);
        // Parts of the light that is mirrored inside the glass belong to no surface behind it. A dark one must not divide them.
        let around = demodulation(s);
        let mirrored = s.reflectance;
        var length = length(towards);
        var tint = absorbed(body_before(s, Body()), length);
        var body: Body;
        var layers = 0u;
        while is_clear(s) && layers < MOST_LAYERS {
            let part = split(s, max(dot(s.view, s.normal), 0.0));
            let transmits = any(part.transmitted > vec3(0.0));
            let next = lead(s, !transmits);
            tint *= select(part.mirrored, part.transmitted, transmits);
#ifdef CLEARCOAT
            tint *= 1.0 - s.coat;
#endif
            body = enter(body, s, next);
            let hit = closest_hit(Ray(origin_towards(s, next), next));
            if hit.triangle == NO_TRIANGLE {
#ifdef ENVIRONMENT_LIGHT
                emission += tint * absorbed(body, SKY) * environment_radiance(next);
#endif
                albedo = around;
                break;
            }
            layers += 1u;
            v = Visible(hit.triangle, hit.instance);
            t = triangle_now(v);
            weights = hit.barycentrics;
            towards = next;
            s = surface_at(v, t, weights, next);
            length += hit.distance;
            tint *= absorbed(body_before(s, body), hit.distance);
            emission += tint * s.emission;
        }
        if layers > 0u && !is_clear(s) {
            albedo = clamp(tint * whole_demodulation(s) + mirrored, vec3(LEAST_DEMODULATION), vec3(1.0));
            let place = normalize(ray) * length;
            let here = project(frame.camera, place);
            let before = project(frame.previous, place + (at(triangle_before(v), weights) - at(t, weights)));
            let normal = shading_normal(v, weights, geometric_normal(t, towards));
            guide = vec2(pack_normal(normal), bitcast<u32>(here.z));
            motion = pack_motion(select(NOWHERE, before.xy - here.xy, before.z > 0.0), before.z);
#ifdef INSTANCED
            object = v.instance;
#endif
        }
        if all(albedo <= vec3(0.0)) {
            emission = vec3(0.0);
        }
    }
    textureStore(guide_out, pixel, vec4(guide, 0u, 0u));
    textureStore(motion_out, pixel, vec4(motion, 0u, 0u));
#ifdef INSTANCED
    textureStore(object_out, pixel, vec4(object));
#endif
    textureStore(seen_out, pixel, vec4(pack_rgb(albedo), pack_rgb(sanitize(emission))));
}
