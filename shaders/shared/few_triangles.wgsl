#define_import_path asvgf::few_triangles

#import asvgf::scene::NO_TRIANGLE
#import asvgf::ray::{Ray, Hit, MISS, OVER_EDGE}

// Rays through a scene of a few dozen triangles: each triangle is tested, and there is no tree. This is for adapters that run eight
// or more invocations in lockstep on a CPU. Down a tree they wait for each other; here they never part, and a triangle's numbers
// are loaded once for all of them. The tests are written out and not looped, because only a constant index is known to be the same
// for all.

// A triangle's plane and the linear maps from it to barycentric weights (compare Baldwin and Weber 2016, "Fast Ray-Triangle
// Intersections by Coordinate Transformation"): for a point p of the plane, u = to_u·(p − corner) and v = to_v·(p − corner).
struct Facet {
    // corner.xyz, normal.x
    a: vec4<f32>,
    // normal.yz, to_u.xy
    b: vec4<f32>,
    // to_u.z, to_v.xyz
    c: vec4<f32>,
}

// TRIANGLE_COUNT is a multiple of 8; unused facets have the normal 0 and are never hit.
@group(1) @binding(8) var<uniform> facets: array<Facet, #{TRIANGLE_COUNT}>;
#ifdef INSTANCED
// Row of the lookup table and instance of each facet.
@group(1) @binding(9) var<uniform> facet_owners: array<vec4<u32>, #{TRIANGLE_COUNT}>;
#endif

// Each invocation's own copy of the facets: inside a branch or a loop, a uniform is read lane by lane.
var<private> kept: array<Facet, #{TRIANGLE_COUNT}>;

fn keep_eight(i: u32) {
    kept[i] = facets[i];
    kept[i + 1u] = facets[i + 1u];
    kept[i + 2u] = facets[i + 2u];
    kept[i + 3u] = facets[i + 3u];
    kept[i + 4u] = facets[i + 4u];
    kept[i + 5u] = facets[i + 5u];
    kept[i + 6u] = facets[i + 6u];
    kept[i + 7u] = facets[i + 7u];
}

// Copies the facets. To be called once, before any branch.
fn prepare_traversal() {
    keep_eight(0u);
#if TRIANGLE_COUNT > 8
    keep_eight(8u);
#endif
#if TRIANGLE_COUNT > 16
    keep_eight(16u);
#endif
#if TRIANGLE_COUNT > 24
    keep_eight(24u);
#endif
#if TRIANGLE_COUNT > 32
    keep_eight(32u);
#endif
#if TRIANGLE_COUNT > 40
    keep_eight(40u);
#endif
#if TRIANGLE_COUNT > 48
    keep_eight(48u);
#endif
#if TRIANGLE_COUNT > 56
    keep_eight(56u);
#endif
}

// The nearest hit of a ray so far.
struct Nearest {
    distance: f32,
    facet: u32,
    weights: vec2<f32>,
}

struct Meeting {
    distance: f32,
    weights: vec2<f32>,
    inside: bool,
}

// Finds where a ray meets a facet.
fn meet(facet: Facet, origin: vec3<f32>, direction: vec3<f32>, limit: f32) -> Meeting {
    let normal = vec3(facet.a.w, facet.b.xy);
    let from_corner = origin - facet.a.xyz;
    let slope = dot(normal, direction);
    let t = -dot(normal, from_corner) / slope;
    let p = from_corner + t * direction;
    let u = dot(vec3(facet.b.zw, facet.c.x), p);
    let v = dot(facet.c.yzw, p);
    // A slope of 0, where t is not a number, is excluded by itself. `&` is used because `&&` would branch.
    let inside = (slope != 0.0) & (u >= -OVER_EDGE) & (v >= -OVER_EDGE) & (u + v <= 1.0 + OVER_EDGE) & (t > 0.0) & (t < limit);
    return Meeting(t, vec2(u, v), inside);
}

fn test(nearest: ptr<function, Nearest>, origin: vec3<f32>, direction: vec3<f32>, i: u32) {
    let m = meet(kept[i], origin, direction, (*nearest).distance);
    (*nearest).distance = select((*nearest).distance, m.distance, m.inside);
    (*nearest).facet = select((*nearest).facet, i, m.inside);
    (*nearest).weights = select((*nearest).weights, m.weights, m.inside);
}

fn test_eight(nearest: ptr<function, Nearest>, origin: vec3<f32>, direction: vec3<f32>, i: u32) {
    test(nearest, origin, direction, i);
    test(nearest, origin, direction, i + 1u);
    test(nearest, origin, direction, i + 2u);
    test(nearest, origin, direction, i + 3u);
    test(nearest, origin, direction, i + 4u);
    test(nearest, origin, direction, i + 5u);
    test(nearest, origin, direction, i + 6u);
    test(nearest, origin, direction, i + 7u);
}

// Tests against a limit that stays, instead of finding the nearest hit and comparing it: with nothing to remember, tracing is 6 %
// faster.
fn blocked_by_eight(origin: vec3<f32>, direction: vec3<f32>, limit: f32, i: u32) -> bool {
    return meet(kept[i], origin, direction, limit).inside
        | meet(kept[i + 1u], origin, direction, limit).inside
        | meet(kept[i + 2u], origin, direction, limit).inside
        | meet(kept[i + 3u], origin, direction, limit).inside
        | meet(kept[i + 4u], origin, direction, limit).inside
        | meet(kept[i + 5u], origin, direction, limit).inside
        | meet(kept[i + 6u], origin, direction, limit).inside
        | meet(kept[i + 7u], origin, direction, limit).inside;
}

fn closest_hit(ray: Ray) -> Hit {
    var nearest = Nearest(MISS, NO_TRIANGLE, vec2(0.0));
    test_eight(&nearest, ray.origin, ray.direction, 0u);
#if TRIANGLE_COUNT > 8
    test_eight(&nearest, ray.origin, ray.direction, 8u);
#endif
#if TRIANGLE_COUNT > 16
    test_eight(&nearest, ray.origin, ray.direction, 16u);
#endif
#if TRIANGLE_COUNT > 24
    test_eight(&nearest, ray.origin, ray.direction, 24u);
#endif
#if TRIANGLE_COUNT > 32
    test_eight(&nearest, ray.origin, ray.direction, 32u);
#endif
#if TRIANGLE_COUNT > 40
    test_eight(&nearest, ray.origin, ray.direction, 40u);
#endif
#if TRIANGLE_COUNT > 48
    test_eight(&nearest, ray.origin, ray.direction, 48u);
#endif
#if TRIANGLE_COUNT > 56
    test_eight(&nearest, ray.origin, ray.direction, 56u);
#endif
    var hit = Hit(nearest.distance, nearest.facet, 0u, nearest.weights);
#ifdef INSTANCED
    if nearest.facet != NO_TRIANGLE {
        let owner = facet_owners[nearest.facet];
        hit.triangle = owner.x;
        hit.instance = owner.y;
    }
#endif
    return hit;
}

// True if something lies on the open segment from the origin to `limit`.
fn occluded(ray: Ray, limit: f32) -> bool {
    var blocked = blocked_by_eight(ray.origin, ray.direction, limit, 0u);
#if TRIANGLE_COUNT > 8
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 8u);
#endif
#if TRIANGLE_COUNT > 16
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 16u);
#endif
#if TRIANGLE_COUNT > 24
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 24u);
#endif
#if TRIANGLE_COUNT > 32
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 32u);
#endif
#if TRIANGLE_COUNT > 40
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 40u);
#endif
#if TRIANGLE_COUNT > 48
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 48u);
#endif
#if TRIANGLE_COUNT > 56
    blocked |= blocked_by_eight(ray.origin, ray.direction, limit, 56u);
#endif
    return blocked;
}
