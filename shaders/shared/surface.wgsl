#define_import_path asvgf::surface

#import asvgf::scene::{scene, geometry_word, attributes, transform_point, transform_normal, object_to_world, world_to_object, previous_object_to_world, corners_previous, instance_corners, instance_numbers, instance_error, NO_TRIANGLE}
#import asvgf::packing::unpack_octahedral

// A triangle of the scene as the visibility buffer names it.
struct Visible {
    // Row of the visibility lookup table.
    row: u32,
    // The instance that it belongs to.
    instance: u32,
}

// The triangle of a number of the visibility buffer, which numbers the triangles of all instances in one sequence.
fn visible(id: u32) -> Visible {
#ifdef INSTANCED
    // Binary search for the last instance whose first number is not above `id`.
    var low = 0u;
    var high = scene.instance_count;
    for (var i = 0u; i < 32u && high - low > 1u; i++) {
        let middle = (low + high) / 2u;
        if instance_numbers(middle).y <= id {
            low = middle;
        } else {
            high = middle;
        }
    }
    let numbers = instance_numbers(low);
    return Visible(id - numbers.y + (numbers.w >> 1u), low);
#else
    return Visible(id, 0u);
#endif
}

fn visibility_id(row: u32, instance: u32) -> u32 {
#ifdef INSTANCED
    let numbers = instance_numbers(instance);
    return row - (numbers.w >> 1u) + numbers.y;
#else
    return row;
#endif
}

struct Triangle {
    a: vec3<f32>,
    b: vec3<f32>,
    c: vec3<f32>,
}

fn stored_triangle(row: u32) -> Triangle {
    return Triangle(
        bitcast<vec3<f32>>(geometry_word(row * 3u).xyz),
        bitcast<vec3<f32>>(geometry_word(row * 3u + 1u).xyz),
        bitcast<vec3<f32>>(geometry_word(row * 3u + 2u).xyz),
    );
}

#ifdef INSTANCED
// The same in the previous frame.
fn stored_triangle_before(v: Visible) -> Triangle {
#ifdef DEFORMING
    let corners = instance_corners(v.instance);
    if corners != 0u {
        let first = 9u * (corners - 1u + v.row - (instance_numbers(v.instance).w >> 1u));
        return Triangle(corner_before(first), corner_before(first + 3u), corner_before(first + 6u));
    }
#endif
    return stored_triangle(v.row);
}
#endif

#ifdef DEFORMING
fn corner_before(first: u32) -> vec3<f32> {
    return vec3(corners_previous[first], corners_previous[first + 1u], corners_previous[first + 2u]);
}
#endif

// World-space vertices in this frame, from the lookup table.
fn triangle_now(v: Visible) -> Triangle {
    let t = stored_triangle(v.row);
#ifdef INSTANCED
    let m = object_to_world(v.instance);
    return Triangle(transform_point(m, t.a), transform_point(m, t.b), transform_point(m, t.c));
#else
    return t;
#endif
}

// World-space vertices in the previous frame.
fn triangle_before(v: Visible) -> Triangle {
#ifdef INSTANCED
    let t = stored_triangle_before(v);
    let m = previous_object_to_world(v.instance);
    return Triangle(transform_point(m, t.a), transform_point(m, t.b), transform_point(m, t.c));
#else
    return triangle_now(v);
#endif
}

// Barycentric weights of `b` and `c` at the point where a ray meets the triangle's plane, as ratios of areas: that of the triangle
// between the point and the opposite edge over the whole.
fn barycentrics(t: Triangle, origin: vec3<f32>, direction: vec3<f32>) -> vec2<f32> {
    let normal = cross(t.b - t.a, t.c - t.a);
    let squared_area = dot(normal, normal);
    let slope = dot(normal, direction);
    if squared_area <= 0.0 || slope == 0.0 {
        return vec2(0.0);
    }
    let p = origin + direction * (dot(normal, t.a - origin) / slope);
    let weight_b = dot(cross(t.a - t.c, p - t.c), normal) / squared_area;
    let weight_c = dot(cross(t.b - t.a, p - t.a), normal) / squared_area;
    // The ray did hit this triangle, so a weight is outside of 0…1 by rounding alone.
    let b = clamp(weight_b, 0.0, 1.0);
    return vec2(b, clamp(weight_c, 0.0, 1.0 - b));
}

fn at(t: Triangle, weights: vec2<f32>) -> vec3<f32> {
    return t.a + weights.x * (t.b - t.a) + weights.y * (t.c - t.a);
}

// Unit normal of the side from which `direction` arrives. For a degenerate triangle it opposes the direction.
fn geometric_normal(t: Triangle, direction: vec3<f32>) -> vec3<f32> {
    let n = cross(t.b - t.a, t.c - t.a);
    let squared = dot(n, n);
    if squared <= 0.0 {
        return -normalize(direction);
    }
    let unit = n * inverseSqrt(squared);
    return select(unit, -unit, dot(unit, direction) > 0.0);
}

// True if a ray in this direction meets the front face (counter-clockwise in the mesh's own orientation).
fn is_front(t: Triangle, v: Visible, direction: vec3<f32>) -> bool {
    var front = dot(cross(t.b - t.a, t.c - t.a), direction) < 0.0;
#ifdef INSTANCED
    // A mirroring placement turns the winding over.
    if (instance_numbers(v.instance).w & 1u) != 0u {
        front = !front;
    }
#endif
    return front;
}

#ifdef SHADING_NORMALS
// Interpolated normal of the front, of any length; 0 if the mesh has no normals.
fn interpolated_normal(v: Visible, weights: vec2<f32>) -> vec3<f32> {
    let first = v.row * scene.attribute_stride;
    if attributes[first] == 0u {
        return vec3(0.0);
    }
    let a = unpack_octahedral(attributes[first]);
    let b = unpack_octahedral(attributes[first + 1u]);
    let c = unpack_octahedral(attributes[first + 2u]);
    var n = a + weights.x * (b - a) + weights.y * (c - a);
#ifdef INSTANCED
    n = transform_normal(world_to_object(v.instance), n);
#endif
    return n;
}
#endif

// Interpolated normal, on the side of `geometric`; `geometric` itself if the mesh has no normals.
fn shading_normal(v: Visible, weights: vec2<f32>, geometric: vec3<f32>) -> vec3<f32> {
#ifdef SHADING_NORMALS
    var n = interpolated_normal(v, weights);
    let squared = dot(n, n);
    if squared <= 1e-12 {
        return geometric;
    }
    n *= inverseSqrt(squared);
    return select(n, -n, dot(n, geometric) < 0.0);
#else
    return geometric;
#endif
}

// Relative error of a coordinate: 2⁻²¹, eight half steps of f32. Two would do for all that was tried, but for copies of a surface
// that lie 10⁻⁷ beside it.
const ROUNDING: f32 = 4.76837158203125e-7;

// Bound on the error of a triangle's points, and of intersections with it, along each axis: some steps of the largest coordinate
// that goes into them. It bounds the errors of the formulas from the triangle alone (compare Pharr, Jakob and Humphreys,
// "Physically Based Rendering", 4th ed. 2023, ch. 6.8).
fn rounding_error(t: Triangle, v: Visible) -> vec3<f32> {
    let error = ROUNDING * max(max(abs(t.a), abs(t.b)), abs(t.c));
#ifdef INSTANCED
    // The ray is rounded once more on its way into the instance's space.
    return error + instance_error(v.instance);
#else
    return error;
#endif
}

// Square of the greatest factor by which needles enlarge an error: 16².
const MOST_THINNESS_SQUARED: f32 = 256.0;

// Distance from its triangle along the normal at which a ray has to start, so that rounding does not let it meet the triangle's
// plane. An error counts by how far the normal points along its axis: a floor at height 0 has none, however wide it is.
fn plane_margin(t: Triangle, normal: vec3<f32>, error: vec3<f32>) -> f32 {
    let edge_b = t.b - t.a;
    let edge_c = t.c - t.a;
    let area_normal = cross(edge_b, edge_c);
    // 1/sin of the angle at `a`: products of edges that nearly cancel lose that many steps. At most 16, for needles.
    let squared = dot(edge_b, edge_b) * dot(edge_c, edge_c) / max(dot(area_normal, area_normal), 1e-37);
    let thinness = sqrt(clamp(squared, 1.0, MOST_THINNESS_SQUARED));
    return dot(abs(normal), error) * thinness;
}

// Least distance of a point from an edge, in parts of the triangle's height, and the greatest: a quarter leaves room for a point.
const LEAST_INSET: f32 = 2e-7;
const MOST_INSET: f32 = 0.25;

// Moves weights inside a triangle by the error of its points. Failure: light left a closed room. Reason: a ray that meets an edge
// within rounding may be beyond the neighbour's plane. Rule: the point lies inside by the error, and by a fifth of a millionth of
// the triangle's size at least.
fn within_edges(t: Triangle, weights: vec2<f32>, error: vec3<f32>) -> vec2<f32> {
    let edge_b = t.b - t.a;
    let edge_c = t.c - t.a;
    let area_normal = cross(edge_b, edge_c);
    // A corner's weight falls from 1 to 0 over its height, which is the doubled area over the opposite edge.
    let per_error = vec3(distance(t.b, t.c), length(edge_c), length(edge_b)) * inverseSqrt(max(dot(area_normal, area_normal), 1e-37));
    let least = clamp(per_error * max(max(error.x, error.y), error.z), vec3(LEAST_INSET), vec3(MOST_INSET));
    let inner = max(weights, least.yz);
    return inner * min(1.0, (1.0 - least.x) / (inner.x + inner.y));
}
