// Traces one path (or a few) per pixel from the visible surface, see shared/path.wgsl. The result is demodulated; emission towards the
// camera is stored apart.
//
// The pixel that its stratum chose as gradient sample repeats a path of the last frame instead: the last frame's surface point on
// this frame's geometry, seen from the last frame's camera, with the last frame's random numbers, in this frame's light.

#import asvgf::frame::{frame, direction, sample_point, inside, Camera}
#import asvgf::random::seed_of
#import asvgf::path::{path, rays}
#ifdef FEW_TRIANGLES
#import asvgf::few_triangles::prepare_traversal
#endif
#import asvgf::surface::{visible, triangle_now, triangle_before, barycentrics, at}
#import asvgf::material::{Surface, surface_at}
#import asvgf::demodulation::demodulation
#import asvgf::light::environment_radiance
#import asvgf::throughput::Estimate
#ifdef GLOSS
#import asvgf::ray::SKY
#import asvgf::demodulation::{LEAST_SPECULAR, specular_demodulation}
#ifdef INSTANCED
#import asvgf::packing::pack_displacement
#endif
#endif
#ifdef TRANSMISSION
#import asvgf::path::eye
#ifdef SEE_THROUGH
#import asvgf::path::sees_through
#import asvgf::packing::{round_to_f16, unpack_rgb}
#endif
#endif
#import asvgf::scene::NO_TRIANGLE
#import asvgf::color::{BRIGHTEST, sanitize}
#import asvgf::packing::pack_rgb
#ifdef ALPHA_BLEND
#import asvgf::blended::{blended_albedo, start_of_path}
#import asvgf::ray::Ray
#endif
#ifdef RESHADE
#import asvgf::strata::{is_sample_pixel, previous_pixel, stratum_of}
#endif

@group(0) @binding(1) var visibility: texture_2d<u32>;
#ifdef SEE_THROUGH
// Albedo of what is seen through glass, 0 if nothing is; light that comes through the glass without another reflection.
@group(0) @binding(12) var seen: texture_2d<u32>;
#ifdef RESHADE
@group(0) @binding(13) var seen_previous: texture_2d<u32>;
#endif
#endif
#ifdef RESHADE
@group(0) @binding(2) var visibility_previous: texture_2d<u32>;
@group(0) @binding(3) var samples: texture_2d<u32>;
#endif
#ifdef LATER_PATHS
@group(0) @binding(9) var paths_out: texture_storage_2d<rgba32float, write>;
#ifdef GLOSS
@group(0) @binding(11) var specular_paths_out: texture_storage_2d<rgba32float, write>;
#endif
#else
#ifdef GLOSS
// Demodulated specular radiance; distance and displacement of what is reflected.
@group(0) @binding(7) var specular_radiance_out: texture_storage_2d<rgba32uint, write>;
#endif
@group(0) @binding(4) var radiance_out: texture_storage_2d<rg32uint, write>;
// The albedo, and the number of rays that the pixel cost.
@group(0) @binding(5) var albedo_out: texture_storage_2d<rgba16float, write>;
#ifdef DIRECT_EMISSION
@group(0) @binding(6) var emission_out: texture_storage_2d<rg32uint, write>;
#endif
#endif

// Sum over the paths of earlier dispatches, and the pixel's rays.
#ifdef EARLIER_PATHS
@group(0) @binding(8) var paths_before: texture_2d<f32>;
#ifdef GLOSS
// The same of specular light, and the sum of the inverse distances of what is reflected.
@group(0) @binding(10) var specular_paths_before: texture_2d<f32>;
#endif
#endif

// Most rays that are counted: the largest number of f16.
const MOST_RAYS: f32 = 65504.0;

// The surface that a pixel saw, at its triangle's place now and seen from the camera that saw it.
fn visible_surface(id: u32, camera: Camera, pixel: vec2<f32>, before: bool) -> Surface {
    let v = visible(id);
    let now = triangle_now(v);
    let ray = direction(camera, sample_point(camera, pixel));
#ifdef INSTANCED
    var then = now;
    if before {
        then = triangle_before(v);
    }
    let weights = barycentrics(then, camera.eye, ray);
#else
    let weights = barycentrics(now, camera.eye, ray);
#endif
    return surface_at(v, now, weights, at(now, weights) - camera.eye);
}

#ifdef GLOSS
// A path's specular light, and the inverse of the distance of what is reflected.
fn of_lobe(light: Estimate) -> vec4<f32> {
    return vec4(sanitize(light.specular), select(0.0, 1.0 / light.hit_distance, light.hit_distance > 0.0));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
#ifdef FEW_TRIANGLES
    prepare_traversal();
#endif
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    let first = textureLoad(visibility, pixel, 0).x;
    if first == NO_TRIANGLE {
#ifdef LATER_PATHS
        textureStore(paths_out, pixel, vec4(0.0));
#ifdef GLOSS
        textureStore(specular_paths_out, pixel, vec4(0.0));
#endif
#else
#ifdef GLOSS
        textureStore(specular_radiance_out, pixel, vec4(0u));
#endif
        textureStore(radiance_out, pixel, vec4(0u));
        textureStore(albedo_out, pixel, vec4(0.0, 0.0, 0.0, 1.0));
#ifdef DIRECT_EMISSION
        let sky = environment_radiance(normalize(direction(frame.camera, sample_point(frame.camera, vec2<f32>(id.xy)))));
        textureStore(emission_out, pixel, vec4(pack_rgb(sanitize(sky)), 0u, 0u));
#endif
#endif
        return;
    }
    var s = visible_surface(first, frame.camera, vec2<f32>(id.xy), false);
#ifdef TRANSMISSION
    eye = frame.camera.eye;
#endif
#ifdef ALPHA_BLEND
    var ray = Ray(frame.camera.eye, direction(frame.camera, sample_point(frame.camera, vec2<f32>(id.xy))));
    var blended = start_of_path(s, ray, 0u).blended;
#endif
#ifdef SEE_THROUGH
    var behind = textureLoad(seen, pixel, 0);
    sees_through = any(unpack_rgb(behind.xy) > vec3(0.0));
#ifdef ALPHA_BLEND
    sees_through = sees_through && !blended;
#endif
#endif
#ifndef LATER_PATHS
    var albedo = demodulation(s);
    var emission = s.emission;
#ifdef SEE_THROUGH
    if sees_through {
        albedo = round_to_f16(unpack_rgb(behind.xy));
        emission += unpack_rgb(behind.zw);
    }
#endif
#ifdef ALPHA_BLEND
    // The light of blended surfaces comes from several of them, emission included.
    if blended {
        albedo = blended_albedo(ray);
        emission = vec3(0.0);
    }
#endif
#ifdef DIRECT_EMISSION
    textureStore(emission_out, pixel, vec4(pack_rgb(sanitize(emission)), 0u, 0u));
#endif
#endif
    var seed_pixel = id.xy;
    var seed_frame = frame.index;
#ifdef RESHADE
    let record = textureLoad(samples, stratum_of(id.xy), 0);
    let is_repeated = is_sample_pixel(record, id.xy);
    if is_repeated {
        let q = previous_pixel(record);
        let then = textureLoad(visibility_previous, q, 0).x;
        s = visible_surface(then, frame.previous, vec2<f32>(q), true);
#ifdef ALPHA_BLEND
        ray = Ray(frame.previous.eye, direction(frame.previous, sample_point(frame.previous, vec2<f32>(q))));
        blended = start_of_path(s, ray, 0u).blended;
#endif
#ifdef TRANSMISSION
        eye = frame.previous.eye;
#endif
#ifdef SEE_THROUGH
        behind = textureLoad(seen_previous, q, 0);
        sees_through = any(unpack_rgb(behind.xy) > vec3(0.0));
#ifdef ALPHA_BLEND
        sees_through = sees_through && !blended;
#endif
#endif
        seed_pixel = vec2<u32>(q);
        seed_frame = frame.index - 1u;
    }
#endif
    var sum = vec3(0.0);
#ifdef EARLIER_PATHS
    let before = textureLoad(paths_before, pixel, 0);
    sum = before.xyz;
    rays = u32(before.w);
#endif
#ifdef GLOSS
    // Specular light, and the sum of the inverse distances: the harmonic mean counts near things most, because they move most.
    var specular = vec4(0.0);
    // Displacement of what the last path met.
    var displacement = 0u;
#ifdef EARLIER_PATHS
    specular = textureLoad(specular_paths_before, pixel, 0);
#endif
#endif
#ifndef LATER_PATHS
    var modulation = albedo;
#ifdef GLOSS
    var specular_modulation = specular_demodulation(s);
#ifdef ALPHA_BLEND
    // The light of blended surfaces counts as diffuse.
    if blended {
        specular_modulation = vec3(0.0);
    }
#endif
#endif
#ifdef RESHADE
    if is_repeated {
        modulation = demodulation(s);
#ifdef SEE_THROUGH
        if sees_through {
            modulation = round_to_f16(unpack_rgb(behind.xy));
        }
#endif
#ifdef ALPHA_BLEND
        if blended {
            modulation = blended_albedo(ray);
        }
#endif
    }
#endif
#endif
    for (var i = 0u; i < frame.batch; i++) {
        let seed = seed_of(seed_pixel, seed_frame, frame.first_sample + i, frame.seed);
#ifdef ALPHA_BLEND
        let start = start_of_path(s, ray, seed);
        sum += sanitize(start.light);
        if !start.ends {
            let light = path(start.surface, seed);
            sum += sanitize(light.diffuse);
#ifdef GLOSS
            if start.blended {
                sum += sanitize(light.specular);
            } else {
                specular += of_lobe(light);
#ifdef INSTANCED
                displacement = select(displacement, pack_displacement(light.displacement), light.hit_distance > 0.0);
#endif
            }
#endif
        }
#else
        let light = path(s, seed);
        sum += sanitize(light.diffuse);
#ifdef GLOSS
        specular += of_lobe(light);
#ifdef INSTANCED
        displacement = select(displacement, pack_displacement(light.displacement), light.hit_distance > 0.0);
#endif
#endif
#endif
    }
#ifdef LATER_PATHS
    textureStore(paths_out, pixel, vec4(sum, f32(rays)));
#ifdef GLOSS
    textureStore(specular_paths_out, pixel, specular);
#endif
#else
#ifdef GLOSS
    let reflected = specular.xyz / (f32(frame.samples) * max(specular_modulation, vec3(LEAST_SPECULAR)));
    let packed = pack_rgb(min(reflected, vec3(BRIGHTEST)));
    let hit_distance = select(0.0, f32(frame.samples) / specular.w, specular.w > 0.0);
    textureStore(specular_radiance_out, pixel, vec4(packed, bitcast<u32>(min(hit_distance, SKY)), displacement));
#endif
    textureStore(albedo_out, pixel, vec4(albedo, min(f32(rays), MOST_RAYS)));
    let demodulated = sum / (f32(frame.samples) * modulation);
    textureStore(radiance_out, pixel, vec4(pack_rgb(min(demodulated, vec3(BRIGHTEST))), 0u, 0u));
#endif
}
