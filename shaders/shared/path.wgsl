#define_import_path asvgf::path

// A path from a visible surface, through surfaces that scatter, to lights: next-event estimation and scattered rays, weighted against each
// other (Veach 1997).

#import asvgf::frame::frame
#import asvgf::random::uniform_float
#import asvgf::ray::{Ray, SKY}
#ifdef FEW_TRIANGLES
#import asvgf::few_triangles::{closest_hit, occluded}
#else
#import asvgf::traverse::{closest_hit, occluded}
#endif
#import asvgf::surface::{Visible, triangle_now, triangle_before, at}
#import asvgf::material::{Surface, surface_at}
#import asvgf::scattering::{scattering, sample_direction}
#ifdef GLOSS
#import asvgf::scattering::is_mirrored
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
#endif
#import asvgf::throughput::{Ways, ways_behind, add_light_sample}
#import asvgf::glass_shadow::{arriving_part, met_glass}
#endif
#import asvgf::scene::{NO_TRIANGLE, geometry_word, instance_numbers}
#ifdef ALPHA_BLEND
#import asvgf::texture::cover_at_random
#endif

// The pixel's rays so far, the primary one included.
var<private> rays: u32 = 1u;

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
            let density = emitter_density(index, t, hit.barycentrics, next, hit.distance);
            add(&light, from_emitter, s.emission, mis_weight(scattered.density, density));
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
