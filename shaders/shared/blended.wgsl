#define_import_path asvgf::blended

// Pixels that see surfaces of which each ray meets some.

#import asvgf::color::luminance
#import asvgf::demodulation::{LEAST_DEMODULATION, whole_demodulation}
#import asvgf::light::environment_radiance
#import asvgf::material::{Surface, surface_at}
#import asvgf::packing::round_to_f16
#import asvgf::path::rays
#import asvgf::ray::Ray
#ifdef FEW_TRIANGLES
#import asvgf::few_triangles::closest_hit
#else
#import asvgf::traverse::closest_hit
#endif
#import asvgf::scene::NO_TRIANGLE
#import asvgf::surface::{Visible, triangle_now}
#import asvgf::texture::{cover_at_random, cover_from, covered_at, is_blended}

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
