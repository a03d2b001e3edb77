#define_import_path asvgf::edge_stop

#import asvgf::frame::{frame, is_orthographic, ray_direction, sample_point}

// Falls off like e⁻ˣ: (1 − x/8)⁸ for an exponent 0 ≤ x < 8, and 0 beyond, where e⁻ˣ is below 1/3000. It differs from e⁻ˣ by at most
// 6 % where it matters (x < 1). Some adapters have no instruction for e⁻ˣ; twelve of them took a quarter of the spatial filter's
// time there.
fn falloff(x: f32) -> f32 {
    let a = max(1.0 - 0.125 * x, 0.0);
    let b = a * a;
    let c = b * b;
    return c * c;
}

// A pixel's tangent plane seen from the camera. A ray's direction d is affine in the pixel, so for a point x at depth z under pixel
// p + offset
//
//   n·(x − x_p) = (slope.x + offset·slope.yz)·z − slope.x·z_p                   (perspective)
//   n·(x − x_p) = slope.x·z + offset·slope.yz − slope.x·z_p                     (orthographic)
struct Plane {
    slope: vec3<f32>,
    depth: f32,
}

fn tangent_plane(pixel: vec2<f32>, normal: vec3<f32>, depth: f32) -> Plane {
    let c = frame.camera;
    let d = ray_direction(c, sample_point(c, pixel));
    return Plane(vec3(dot(normal, d), dot(normal, c.du), dot(normal, c.dv)), depth);
}

// Distance of another pixel's point from the plane. A difference of depths would grow with the viewing angle; this is 0 on the
// whole plane.
fn plane_distance(plane: Plane, offset: vec2<f32>, depth: f32) -> f32 {
    let across = offset.x * plane.slope.y + offset.y * plane.slope.z;
    let reached = select((plane.slope.x + across) * depth, plane.slope.x * depth + across, is_orthographic(frame.camera));
    return abs(reached - plane.slope.x * plane.depth);
}

// |n·d| below which a plane counts as seen edge on. It then takes the negative of this value, so that quotients stay finite.
const EDGE_ON: f32 = 1e-4;

// `slope.x`, which is what depths on the plane are divided by, kept away from 0.
fn facing(plane: Plane) -> f32 {
    return select(plane.slope.x, -EDGE_ON, abs(plane.slope.x) < EDGE_ON);
}

// Foreshortening r − 1: how much farther a step over the image leads on the plane than on one that is seen face on,
// r = |z·Δd + Δz·d| / (z·|Δd|) with the ray's direction d. On a floor that runs to the horizon, a pixel's neighbours above and below may be
// metres away.
fn foreshortening(plane: Plane, pixel: vec2<f32>, offset: vec2<f32>) -> f32 {
    let c = frame.camera;
    let across = offset.x * c.du + offset.y * c.dv;
    // Δz/z.
    let deeper = -dot(offset, plane.slope.yz) / facing(plane);
    let along = across + deeper * ray_direction(c, sample_point(c, pixel));
    return max(sqrt(dot(along, along) / dot(across, across)) - 1.0, 0.0);
}
