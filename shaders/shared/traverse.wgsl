#define_import_path asvgf::traverse

#import asvgf::scene::{nodes, triangles, instances, scene, world_to_object, transform_point, transform_vector, instance_numbers}
#ifdef ALPHA_MASK
#import asvgf::texture::is_hole
#endif

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

struct Hit {
    distance: f32,
    // Row of the visibility lookup table (`NO_TRIANGLE` if nothing was hit), and whose it is.
    triangle: u32,
    instance: u32,
    // Barycentric weights of the second and the third vertex.
    barycentrics: vec2<f32>,
}

// A direction component of zero would make 0·∞ in the slab test; 2⁻⁸⁰ is below anything that a ray of use can resolve.
fn safe_inverse(d: vec3<f32>) -> vec3<f32> {
    let tiny = vec3(8.3e-25);
    return 1.0 / select(d, select(tiny, -tiny, d < vec3(0.0)), abs(d) < tiny);
}

// Entry distance into a box (slab method, Kay and Kajiya 1986), or a huge number where it is missed.
fn enter_box(origin: vec3<f32>, inverse: vec3<f32>, low: vec3<f32>, high: vec3<f32>, limit: f32) -> f32 {
    let a = (low - origin) * inverse;
    let b = (high - origin) * inverse;
    let near = min(a, b);
    let far = max(a, b);
    let t0 = max(max(near.x, near.y), max(near.z, 0.0));
    // Widened by 3 ulp so that rounding never loses a hit on the box's own face (Ize 2013).
    let t1 = min(min(far.x, far.y), min(far.z, limit)) * 1.0000004;
    return select(MISS, t0, t0 <= t1);
}

const MISS: f32 = 3.0e38;

// Möller and Trumbore 1997. Returns distance, u, v; a distance of `MISS` where there is no hit in (0, limit).
fn intersect_triangle(origin: vec3<f32>, direction: vec3<f32>, triangle: u32, limit: f32) -> vec3<f32> {
    let v0 = triangles[triangle * 3u].xyz;
    let e1 = triangles[triangle * 3u + 1u].xyz - v0;
    let e2 = triangles[triangle * 3u + 2u].xyz - v0;
    let p = cross(direction, e2);
    let determinant = dot(e1, p);
    let inverse = 1.0 / determinant;
    let s = origin - v0;
    let u = dot(s, p) * inverse;
    let q = cross(s, e1);
    let v = dot(direction, q) * inverse;
    let t = dot(e2, q) * inverse;
    // A degenerate triangle has determinant 0: no comparison with the infinities that follow is relied on.
    let hit = determinant != 0.0 && u >= 0.0 && v >= 0.0 && u + v <= 1.0 && t > 0.0 && t < limit;
    return vec3(select(MISS, t, hit), u, v);
}

// Both kinds of query are one loop over a stack of nodes. A node holds the boxes of its two children
// (Aila and Laine 2009): (low, reference), (high, count) for each; a count of 0 is an inner node.
//
// With INSTANCED, the top-level tree's leaves are references with `INSTANCE_BIT` set: the ray goes on in that instance's
// object space, and `TOP_LEVEL` on the stack marks where world space resumes.
const TOP_LEVEL: u32 = 0xffffffffu;

fn traverse(ray: Ray, limit: f32, any_hit: bool) -> Hit {
    var hit = Hit(limit, 0xffffffffu, 0u, vec2(0.0));
    var stack: array<u32, #{STACK_SIZE}>;
    var depth = 0u;
    var node = 0u;
    var origin = ray.origin;
    var direction = ray.direction;
    var inverse = safe_inverse(direction);
#ifdef INSTANCED
    var instance = TOP_LEVEL;
#else
    let instance = 0u;
#endif
    loop {
#ifdef INSTANCED
        var left_low: vec4<f32>;
        var left_high: vec4<f32>;
        var right_low: vec4<f32>;
        var right_high: vec4<f32>;
        if instance == TOP_LEVEL {
            left_low = instances[node * 4u];
            left_high = instances[node * 4u + 1u];
            right_low = instances[node * 4u + 2u];
            right_high = instances[node * 4u + 3u];
        } else {
            left_low = nodes[node * 4u];
            left_high = nodes[node * 4u + 1u];
            right_low = nodes[node * 4u + 2u];
            right_high = nodes[node * 4u + 3u];
        }
#else
        let left_low = nodes[node * 4u];
        let left_high = nodes[node * 4u + 1u];
        let right_low = nodes[node * 4u + 2u];
        let right_high = nodes[node * 4u + 3u];
#endif
        var near = enter_box(origin, inverse, left_low.xyz, left_high.xyz, hit.distance);
        var far = enter_box(origin, inverse, right_low.xyz, right_high.xyz, hit.distance);
        var near_reference = bitcast<u32>(left_low.w);
        var near_count = bitcast<u32>(left_high.w);
        var far_reference = bitcast<u32>(right_low.w);
        var far_count = bitcast<u32>(right_high.w);
        if far < near {
            let t = near; near = far; far = t;
            let r = near_reference; near_reference = far_reference; far_reference = r;
            let c = near_count; near_count = far_count; far_count = c;
        }
        // Leaves are tested at once, nearest first; inner nodes are visited, the farther one later.
        var next = NOTHING;
        for (var side = 0; side < 2; side++) {
            let entry = select(far, near, side == 0);
            if entry >= hit.distance {
                continue;
            }
            let reference = select(far_reference, near_reference, side == 0);
            let count = select(far_count, near_count, side == 0);
            if count == 0u {
                if next == NOTHING {
                    next = reference;
                } else {
                    stack[depth] = reference;
                    depth += 1u;
                }
                continue;
            }
            for (var i = 0u; i < count; i++) {
                let t = intersect_triangle(origin, direction, reference + i, hit.distance);
                if t.x < hit.distance {
#ifdef ALPHA_MASK
                    if is_hole(reference + i, t.yz) {
                        continue;
                    }
#endif
                    hit = Hit(t.x, reference + i, instance, t.yz);
                    if any_hit {
                        return hit;
                    }
                }
            }
        }
        if next == NOTHING {
            if depth == 0u {
                break;
            }
            depth -= 1u;
            next = stack[depth];
#ifdef INSTANCED
            if next == TOP_LEVEL {
                instance = TOP_LEVEL;
                origin = ray.origin;
                direction = ray.direction;
                inverse = safe_inverse(direction);
                if depth == 0u {
                    break;
                }
                depth -= 1u;
                next = stack[depth];
            }
#endif
        }
#ifdef INSTANCED
        if (next & INSTANCE_BIT) != 0u {
            instance = next & ~INSTANCE_BIT;
            let placement = world_to_object(instance);
            // Not normalised: distances stay those of world space.
            origin = transform_point(placement, ray.origin);
            direction = transform_vector(placement, ray.direction);
            inverse = safe_inverse(direction);
            stack[depth] = TOP_LEVEL;
            depth += 1u;
            next = instance_numbers(instance).x;
        }
#endif
        node = next;
    }
    return hit;
}

// Never a node: inner nodes are numbered from 0.
const NOTHING: u32 = 0x7fffffffu;
const INSTANCE_BIT: u32 = 0x80000000u;

fn closest_hit(ray: Ray) -> Hit {
    return traverse(ray, MISS, false);
}

// Whether something lies on the open segment from the origin to `limit`.
fn occluded(ray: Ray, limit: f32) -> bool {
    return traverse(ray, limit, true).triangle != 0xffffffffu;
}
