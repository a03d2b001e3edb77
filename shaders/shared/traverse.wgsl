#define_import_path asvgf::traverse

#import asvgf::scene::{scene, geometry_word, NO_TRIANGLE}
#import asvgf::ray::{Ray, Hit, MISS, OVER_EDGE}
#ifdef INSTANCED
#import asvgf::scene::{world_to_object, transform_point, transform_vector, instance_numbers, instance_grid}
#endif
#ifdef ALPHA_MASK
#import asvgf::texture::is_hole
#endif
#ifdef TRANSMISSION
#import asvgf::surface::Visible
#import asvgf::glass_shadow::{begin_shadow, goes_through}
#endif

// Möller and Trumbore 1997. Returns distance, u, v; the distance is `MISS` if there is no hit in (0, limit).
fn intersect(origin: vec3<f32>, direction: vec3<f32>, a: vec3<f32>, edge_b: vec3<f32>, edge_c: vec3<f32>, limit: f32) -> vec3<f32> {
    let p = cross(direction, edge_c);
    let determinant = dot(edge_b, p);
    let inverse = 1.0 / determinant;
    let s = origin - a;
    let u = dot(s, p) * inverse;
    let q = cross(s, edge_b);
    let v = dot(direction, q) * inverse;
    let t = dot(edge_c, q) * inverse;
    // A degenerate triangle has determinant 0: no comparison relies on the infinities that follow.
    let hit = determinant != 0.0 && min(u, v) >= -OVER_EDGE && u + v <= 1.0 + OVER_EDGE && t > 0.0 && t < limit;
    return vec3(select(MISS, t, hit), u, v);
}

// 2⁻⁸⁰, below any component of a direction that a ray of use can resolve.
const TINY: f32 = 8.3e-25;

// 1/d. A component of zero would make 0·∞ in the slab test, so it counts as ±2⁻⁸⁰.
fn safe_inverse(d: vec3<f32>) -> vec3<f32> {
    let tiny = vec3(TINY);
    return 1.0 / select(d, select(tiny, -tiny, d < vec3(0.0)), abs(d) < tiny);
}

// A ray's map from the grid of one tree's boxes to distances: a plane at place q of the grid is at distance q·step + base.
struct Slabs {
    base: vec3<f32>,
    step: vec3<f32>,
}

fn slabs(origin: vec3<f32>, direction: vec3<f32>, grid_base: vec3<f32>, grid_step: vec3<f32>) -> Slabs {
    let inverse = safe_inverse(direction);
    return Slabs((grid_base - origin) * inverse, grid_step * inverse);
}

// Entry distance into a child's box (slab method, Kay and Kajiya 1986), or `MISS`. The boxes are rounded outwards.
fn enter_box(s: Slabs, child: vec4<u32>, limit: f32) -> f32 {
    let low = vec3<f32>(vec3(child.x & 0xffffu, child.x >> 16u, child.y & 0xffffu));
    let high = vec3<f32>(vec3(child.y >> 16u, child.z & 0xffffu, child.z >> 16u));
    let a = low * s.step + s.base;
    let b = high * s.step + s.base;
    let near = min(a, b);
    let far = max(a, b);
    let t_near = max(max(near.x, near.y), max(near.z, 0.0));
    let t_far = min(min(far.x, far.y), min(far.z, limit));
    return select(MISS, t_near, t_near <= t_far);
}

fn intersect_triangle(origin: vec3<f32>, direction: vec3<f32>, triangle: u32, limit: f32) -> vec3<f32> {
    let a = bitcast<vec3<f32>>(geometry_word(triangle * 3u).xyz);
    let edge_b = bitcast<vec3<f32>>(geometry_word(triangle * 3u + 1u).xyz) - a;
    let edge_c = bitcast<vec3<f32>>(geometry_word(triangle * 3u + 2u).xyz) - a;
    return intersect(origin, direction, a, edge_b, edge_c, limit);
}

#ifdef ALPHA_MASK
// True if a ray meets the back of a triangle, in the space of its mesh, where a placement that mirrors does not matter.
fn meets_back(row: u32, direction: vec3<f32>) -> bool {
    let a = bitcast<vec3<f32>>(geometry_word(row * 3u).xyz);
    let edge_b = bitcast<vec3<f32>>(geometry_word(row * 3u + 1u).xyz) - a;
    let edge_c = bitcast<vec3<f32>>(geometry_word(row * 3u + 2u).xyz) - a;
    return dot(cross(edge_b, edge_c), direction) > 0.0;
}
#endif

// References, as src/scene/gpu/tree/build.rs makes them: the number of an inner node, or a leaf made of LEAF, its count and its first row.
const LEAF: u32 = 0x80000000u;
const COUNT_SHIFT: u32 = 27u;
const FIRST_MASK: u32 = 0x07ffffffu;
// A leaf of no triangles lies at the bottom of the stack.
const NOTHING: u32 = 0x80000000u;
// With INSTANCED, the leaves of the top level are instances, and the ray goes on in object space. Another leaf of no triangles
// marks on the stack where world space resumes.
const TOP_LEVEL: u32 = 0x87ffffffu;

// One loop for both kinds of query: down the tree to the nearest leaf, then its triangles, then the next node from the stack (Aila
// and Laine 2009, "while-while"). A node holds the boxes and references of both children.
fn traverse(ray: Ray, limit: f32, any_hit: bool) -> Hit {
    var hit = Hit(limit, NO_TRIANGLE, 0u, vec2(0.0));
    var stack: array<u32, #{STACK_SIZE}>;
    stack[0] = NOTHING;
    var depth = 1u;
    var current = scene.root;
    var origin = ray.origin;
    var direction = ray.direction;
    var boxes = slabs(origin, direction, scene.grid_base, scene.grid_step);
#ifdef INSTANCED
    var instance = NO_TRIANGLE;
#endif
    loop {
        while current < LEAF {
            let left_child = geometry_word(current * 2u);
            let right_child = geometry_word(current * 2u + 1u);
            let left = enter_box(boxes, left_child, hit.distance);
            let right = enter_box(boxes, right_child, hit.distance);
            let swap = right < left;
            let near = select(left_child.w, right_child.w, swap);
            let far = select(right_child.w, left_child.w, swap);
            // The stack's top is always written, and only kept if the farther child is to be visited too.
            let popped = stack[depth - 1u];
            let both = max(left, right) < MISS;
            let neither = min(left, right) >= MISS;
            stack[depth] = far;
            depth = depth + select(0u, 1u, both) - select(0u, 1u, neither);
            current = select(near, popped, neither);
        }
        if current == NOTHING {
            break;
        }
#ifdef INSTANCED
        if current == TOP_LEVEL {
            instance = NO_TRIANGLE;
            origin = ray.origin;
            direction = ray.direction;
            boxes = slabs(origin, direction, scene.grid_base, scene.grid_step);
        } else if instance == NO_TRIANGLE {
            instance = current & FIRST_MASK;
            let placement = world_to_object(instance);
            // The direction is not normalised, so that distances stay those of world space.
            origin = transform_point(placement, ray.origin);
            direction = transform_vector(placement, ray.direction);
            let grid = instance_grid(instance);
            boxes = slabs(origin, direction, grid[0], grid[1]);
            stack[depth] = TOP_LEVEL;
            depth += 1u;
            current = instance_numbers(instance).x;
            continue;
        }
#endif
        let first = current & FIRST_MASK;
        let end = first + ((current >> COUNT_SHIFT) & 15u);
        for (var row = first; row < end; row++) {
            let t = intersect_triangle(origin, direction, row, hit.distance);
            var closer = t.x < hit.distance;
#ifdef ALPHA_MASK
            if closer {
#ifdef INSTANCED
                closer = !is_hole(row, instance, t.yz, meets_back(row, direction));
#else
                closer = !is_hole(row, 0u, t.yz, meets_back(row, direction));
#endif
            }
#endif
#ifdef TRANSMISSION
            // Light for matte surfaces goes straight through glass.
            if closer && any_hit {
#ifdef INSTANCED
                closer = !goes_through(Visible(row, instance), t.yz, t.x, ray.direction);
#else
                closer = !goes_through(Visible(row, 0u), t.yz, t.x, ray.direction);
#endif
            }
#endif
            if closer {
                hit.distance = t.x;
                hit.triangle = row;
#ifdef INSTANCED
                hit.instance = instance;
#endif
                hit.barycentrics = t.yz;
            }
        }
        if any_hit && hit.triangle != NO_TRIANGLE {
            break;
        }
        depth -= 1u;
        current = stack[depth];
    }
    return hit;
}

fn closest_hit(ray: Ray) -> Hit {
    return traverse(ray, MISS, false);
}

// True if something lies on the open segment from the origin to `limit`.
fn occluded(ray: Ray, limit: f32) -> bool {
#ifdef TRANSMISSION
    begin_shadow();
#endif
    return traverse(ray, limit, true).triangle != NO_TRIANGLE;
}
