// Traces one path (or a few) per pixel from the visible surface, through Lambert and GGX surfaces. Next-event estimation and
// scattered rays are weighted against each other (Veach 1997). The result is demodulated; emission towards the camera is stored
// apart.
//
// The pixel that its stratum chose as gradient sample repeats a path of the last frame instead: the last frame's surface point on
// this frame's geometry, seen from the last frame's camera, with the last frame's random numbers, in this frame's light.

#import asvgf::frame::{frame, direction, sample_point, inside, Camera}
#import asvgf::random::{seed_of, uniform_float}
#import asvgf::ray::{Ray, SKY}
#ifdef FEW_TRIANGLES
#import asvgf::few_triangles::{prepare_traversal, closest_hit, occluded}
#else
#import asvgf::traverse::{closest_hit, occluded}
#endif
#import asvgf::surface::{Visible, visible, triangle_now, triangle_before, barycentrics, at}
#import asvgf::demodulation::{LEAST_DEMODULATION, demodulation}
#import asvgf::material::{Surface, surface_at}
#import asvgf::scattering::{scattering, sample_direction}
#ifdef GLOSS
#import asvgf::demodulation::{LEAST_SPECULAR, specular_demodulation}
#import asvgf::scattering::is_mirrored
#ifdef INSTANCED
#import asvgf::packing::pack_displacement
#endif
#endif
#import asvgf::light::{environment_radiance, environment_density, emitter_density}
#import asvgf::throughput::{Estimate, Throughput, add, scaled, scatter}
#ifdef LIGHTS
#import asvgf::light::sample_light
#import asvgf::throughput::add_scattered
#endif
#ifdef TRANSMISSION
#import asvgf::glass_path::{MOST_BOUNDARIES, MOST_REFRACTIONS, Body, absorbed, body_before, enter, is_refracted, origin_towards, straight_through}
#import asvgf::glass_scattering::is_glass
#ifdef SEE_THROUGH
#import asvgf::glass_scattering::{is_clear, split}
#import asvgf::packing::unpack_rgb
#endif
#import asvgf::throughput::{Ways, ways_behind, add_light_sample}
#import asvgf::glass_shadow::{arriving_part, met_glass}
#endif
#import asvgf::scene::{NO_TRIANGLE, geometry_word, instance_numbers, scene}
#import asvgf::color::{BRIGHTEST, luminance, sanitize}
#import asvgf::packing::{pack_rgb, round_to_f16}
#ifdef ALPHA_BLEND
#import asvgf::demodulation::whole_demodulation
#import asvgf::texture::{cover_at_random, cover_from, covered_at, is_blended}
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

// The pixel's rays so far, the primary one included.
var<private> rays: u32 = 1u;

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

// Limits of the probability with which a path survives Russian roulette. The lower one bounds the weight of a survivor; the upper
// one ends every path sometime.
const LEAST_SURVIVAL: f32 = 0.05;
const MOST_SURVIVAL: f32 = 0.95;

// Power heuristic with exponent 2 (Veach 1997, eq. 9.13).
fn mis_weight(chosen: f32, other: f32) -> f32 {
    let a = chosen / max(other, 1e-30);
    return 1.0 - 1.0 / (1.0 + a * a);
}

#ifdef TRANSMISSION
// Place of the camera that sees the first surface.
var<private> eye: vec3<f32>;
#endif
#ifdef SEE_THROUGH
// True if the light that comes to the pixel through clear glass without another reflection is its emission, see see_through.wgsl. Then
// it is no part of the paths' light.
var<private> sees_through: bool;

// True if a ray leaves a surface as the ray of see_through.wgsl does.
fn follows(s: Surface, next: vec3<f32>) -> bool {
    let transmits = any(split(s, max(dot(s.view, s.normal), 0.0)).transmitted > vec3(0.0));
    return is_clear(s) && transmits == (dot(next, s.geometric) < 0.0);
}
#endif

// Traces a path. With GLOSS its light is split by the lobe of the first surface: each direction is sampled once, by the density of both
// lobes together, and weighted by the value of each lobe. So neither signal needs a path of its own, and none misses a sample.
fn path(first: Surface, seed: u32) -> Estimate {
    var state = seed;
    var s = first;
    var is_first = true;
    var throughput: Throughput;
    throughput.all = vec3(1.0);
    var light: Estimate;
#ifdef TRANSMISSION
    var body: Body;
    throughput.all = absorbed(body_before(s, body), distance(s.position, eye));
    var ways = Ways(throughput, throughput);
    // Boundaries of glass that the path has met. They are no bounces, because a lamp behind a window would need four of them.
    var boundaries = 0u;
    var bounces = 1u;
#ifdef SEE_THROUGH
    var is_seen_through = sees_through;
#endif
    for (var bounce = 0u; bounce <= frame.bounces || is_glass(s); bounce += bounces) {
        let is_straight = boundaries >= MOST_REFRACTIONS && is_glass(s);
        // Behind the last bounce there may be glass before a light.
        let is_last = bounce > frame.bounces;
#ifndef SCATTERED_RAYS_ONLY
        if is_last {
            throughput = Throughput();
        }
#endif
#else
    for (var bounce = 0u; bounce <= frame.bounces; bounce++) {
#endif
        // The number of draws per bounce is always the same, so that a change of one light does not shift the others' random numbers.
        let light_choice = uniform_float(&state);
        let light_u = vec2(uniform_float(&state), uniform_float(&state));
        let lobe = uniform_float(&state);
        let direction_u = vec2(uniform_float(&state), uniform_float(&state));
        let survival = uniform_float(&state);
#ifdef ALPHA_BLEND
        cover_at_random(state);
#endif
#ifdef LIGHTS
#ifndef SCATTERED_RAYS_ONLY
        // The sample starts where the ray starts, because even that small step is much of the way to a light nearby.
        let above = s.position + s.margin * s.geometric;
        let lamp = sample_light(above, light_choice, light_u);
        let towards = scattering(s, lamp.direction);
        let reflected = towards.value * lamp.radiance;
#ifdef TRANSMISSION
        let is_lit = lamp.density > 0.0 && !is_straight;
#else
        let is_lit = lamp.density > 0.0;
#endif
        if is_lit && max(max(reflected.x, reflected.y), reflected.z) > 0.0 {
            rays += 1u;
#ifdef TRANSMISSION
            let start = origin_towards(s, lamp.direction);
#else
            let start = above;
#endif
            if !occluded(Ray(start, lamp.direction), lamp.reach) {
#ifdef LIGHT_SAMPLES_ONLY
                let weight = 1.0;
#else
                let weight = select(1.0, mis_weight(lamp.density, towards.density), lamp.has_area);
#endif
#ifdef TRANSMISSION
                let arriving = lamp.radiance * arriving_part(lamp.distance) / lamp.density;
#ifdef SEE_THROUGH
                let is_seen = is_seen_through && follows(s, lamp.direction);
#else
                let is_seen = false;
#endif
                add_light_sample(
                    &light, s, throughput, ways, towards, arriving, weight, lamp.has_area, is_seen, met_glass, is_first);
#else
                add_scattered(&light, throughput, towards, lamp.radiance * (weight / lamp.density), is_first);
#endif
            }
        }
#endif
#endif
        var next = sample_direction(s, direction_u, lobe);
        var scattered = scattering(s, next);
#ifdef TRANSMISSION
        if is_straight {
            next = -s.view;
            scattered = straight_through(s);
        }
#endif
        if scattered.density <= 0.0 {
            break;
        }
#ifdef TRANSMISSION
        let origin = origin_towards(s, next);
#else
        let origin = s.position + s.margin * s.geometric;
#endif
#ifdef SEE_THROUGH
        is_seen_through = is_seen_through && follows(s, next);
#endif
#ifdef TRANSMISSION
        ways = ways_behind(s, throughput, ways, scattered, is_first);
        bounces = 1u;
        if is_refracted(s, lobe) {
            bounces = 0u;
            boundaries += 1u;
        } else if is_last {
            break;
        }
        body = enter(body, s, next);
#endif
        throughput = scatter(throughput, scattered, is_first);
        rays += 1u;
        let hit = closest_hit(Ray(origin, next));
#ifdef GLOSS
        if is_first && is_mirrored(s, lobe, next) {
            light.hit_distance = select(hit.distance, SKY, hit.triangle == NO_TRIANGLE);
        }
#endif
        if hit.triangle == NO_TRIANGLE {
#ifdef ENVIRONMENT_LIGHT
#ifdef SEE_THROUGH
            if is_seen_through {
                break;
            }
#endif
#ifdef TRANSMISSION
            let from_sky = scaled(ways.direct, absorbed(body, SKY));
#else
            let from_sky = throughput;
#endif
#ifndef LIGHT_SAMPLES_ONLY
            let sky = environment_radiance(next);
#ifdef SCATTERED_RAYS_ONLY
            add(&light, from_sky, sky, 1.0);
#else
            add(&light, from_sky, sky, mis_weight(scattered.density, environment_density(sky)));
#endif
#else ifdef TRANSMISSION
            add(&light, from_sky, environment_radiance(next), 1.0);
#endif
#endif
            break;
        }
        let v = Visible(hit.triangle, hit.instance);
        let t = triangle_now(v);
#ifdef GLOSS
#ifdef INSTANCED
        if is_first && light.hit_distance > 0.0 {
            light.displacement = at(triangle_before(v), hit.barycentrics) - at(t, hit.barycentrics);
        }
#endif
#endif
        s = surface_at(v, t, hit.barycentrics, next);
#ifdef TRANSMISSION
        let left = absorbed(body_before(s, body), hit.distance);
        throughput = scaled(throughput, left);
        ways = Ways(scaled(ways.direct, left), scaled(ways.refracted, left));
        var from_emitter = ways.direct;
#ifdef SEE_THROUGH
        if is_seen_through {
            from_emitter = Throughput();
        }
#endif
#else
        let from_emitter = throughput;
#endif
#ifdef EMITTERS
#ifndef LIGHT_SAMPLES_ONLY
        let emitter = geometry_word(hit.triangle * 3u + 1u).w;
        if emitter > 0u {
#ifdef SCATTERED_RAYS_ONLY
            add(&light, from_emitter, s.emission, 1.0);
#else
#ifdef INSTANCED
            let index = instance_numbers(hit.instance).z + emitter - 1u;
#else
            let index = emitter - 1u;
#endif
            add(&light, from_emitter, s.emission, mis_weight(scattered.density, emitter_density(index, t, next, hit.distance)));
#endif
        }
#else ifdef TRANSMISSION
        if geometry_word(hit.triangle * 3u + 1u).w > 0u {
            add(&light, from_emitter, s.emission, 1.0);
        }
#endif
#endif
        is_first = false;
#ifdef TRANSMISSION
        if boundaries >= MOST_BOUNDARIES {
            break;
        }
        if is_last {
            continue;
        }
#endif
        if bounce >= frame.roulette {
            // Russian roulette (Arvo and Kirk 1990) by the light that the path can still carry.
            let p = clamp(max(max(throughput.all.x, throughput.all.y), throughput.all.z), LEAST_SURVIVAL, MOST_SURVIVAL);
            if survival >= p {
                break;
            }
            throughput = scaled(throughput, vec3(1.0 / p));
#ifdef TRANSMISSION
            ways.refracted = scaled(ways.refracted, vec3(1.0 / p));
#endif
        }
    }
    return light;
}

#ifdef GLOSS
// A path's specular light, and the inverse of the distance of what is reflected.
fn of_lobe(light: Estimate) -> vec4<f32> {
    return vec4(sanitize(light.specular), select(0.0, 1.0 / light.hit_distance, light.hit_distance > 0.0));
}
#endif

#ifdef ALPHA_BLEND
// Start of a path that meets blended surfaces at random.
struct Start {
    surface: Surface,
    // Light that reaches the camera from there without a reflection.
    light: vec3<f32>,
    // True if that is all of the path's light.
    ends: bool,
    // True if the ray has met a blended surface. This does not depend on the seed, because nothing is random before the first one.
    blended: bool,
}

// Finds the surface that this path of a pixel meets first. The visibility buffer has the same surface in each frame, so the history
// of a pixel is that of one surface. The pixel's light is that of all surfaces that its ray may meet, colours included.
fn start_of_path(seen: Surface, ray: Ray, seed: u32) -> Start {
    cover_at_random(seed);
    is_blended = false;
    rays += 1u;
    let hit = closest_hit(ray);
    if !is_blended {
        return Start(seen, vec3(0.0), false, false);
    }
    if hit.triangle == NO_TRIANGLE {
        return Start(seen, environment_radiance(normalize(ray.direction)), true, true);
    }
    let v = Visible(hit.triangle, hit.instance);
    let surface = surface_at(v, triangle_now(v), hit.barycentrics, ray.direction);
    return Start(surface, surface.emission, false, true);
}
#endif

#ifdef ALPHA_BLEND
// Most surfaces behind each other whose colours are told apart.
const MOST_LAYERS: u32 = 8u;

// Part of the light behind the surfaces met so far below which farther ones are not looked for.
const LEAST_UNCOVERED: f32 = 0.01;

// Step behind a surface, in parts of the distance, for the ray to the next one.
const STEP_BEHIND: f32 = 1e-5;

// The albedo of a pixel that sees blended surfaces: the mean of those along its ray, each weighted by how much of it is seen, and
// white for light that comes without a reflection, from the sky and from emitters. It is the same in each frame, whichever of the
// surfaces a path begins on.
fn blended_albedo(ray: Ray) -> vec3<f32> {
    cover_from(0.0);
    var origin = ray.origin;
    var uncovered = 1.0;
    var albedo = vec3(0.0);
    for (var layer = 0u; layer < MOST_LAYERS && uncovered > LEAST_UNCOVERED; layer++) {
        let hit = closest_hit(Ray(origin, ray.direction));
        rays += 1u;
        if hit.triangle == NO_TRIANGLE {
            break;
        }
        let v = Visible(hit.triangle, hit.instance);
        let s = surface_at(v, triangle_now(v), hit.barycentrics, ray.direction);
        let covered = covered_at(hit.triangle, hit.barycentrics);
        albedo += uncovered * covered * select(whole_demodulation(s), vec3(1.0), luminance(s.emission) > 0.0);
        uncovered *= 1.0 - covered;
        // The margin that keeps rays from meeting the surface again, on its other side.
        origin = s.position - s.margin * s.geometric + (STEP_BEHIND * hit.distance) * ray.direction;
    }
    return round_to_f16(clamp(albedo + uncovered, vec3(LEAST_DEMODULATION), vec3(1.0)));
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
#endif
#ifdef ALPHA_BLEND
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
