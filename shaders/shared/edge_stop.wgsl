#define_import_path asvgf::edge_stop

#import asvgf::frame::{frame, is_orthographic, ray_direction, sample_point}

// (1 − x/8)⁸ for an exponent 0 ≤ x < 8, else 0: e⁻ˣ to 6 % while it matters (x < 1), ending where e⁻ˣ is 1/3000. On adapters
// that have no instruction for e⁻ˣ, twelve of those are a quarter of the spatial filter's time.
fn falloff(x: f32) -> f32 {
    let a = max(1.0 - 0.125 * x, 0.0);
    let b = a * a;
    let c = b * b;
    return c * c;
}

// A pixel's tangent plane seen from the camera: n·(x − x_p) for a point x at depth z under pixel p + offset is
// (slope.x + offset·slope.yz)·z − slope.x·z_p, as a ray's direction is affine in the pixel. In an orthographic view it is
// slope.x·z + offset·slope.yz − slope.x·z_p.
struct Plane {
    slope: vec3<f32>,
    depth: f32,
}

fn tangent_plane(pixel: vec2<f32>, normal: vec3<f32>, depth: f32) -> Plane {
    let c = frame.camera;
    let d = ray_direction(c, sample_point(c, pixel));
    return Plane(vec3(dot(normal, d), dot(normal, c.du), dot(normal, c.dv)), depth);
}

// Distance of the other pixel's point from the plane: unlike a difference of depths it is 0 on the whole plane, at
// whatever angle that is seen.
fn plane_distance(plane: Plane, offset: vec2<f32>, depth: f32) -> f32 {
    let across = offset.x * plane.slope.y + offset.y * plane.slope.z;
    let reached = select((plane.slope.x + across) * depth, plane.slope.x * depth + across, is_orthographic(frame.camera));
    return abs(reached - plane.slope.x * plane.depth);
}

// How much farther a step over the image leads on the plane than on one that is seen face on: |z·Δd + Δz·d| / (z·|Δd|) − 1 with
// the direction d. On a floor that runs to the horizon a pixel's neighbours above and below may be metres away.
fn foreshortening(plane: Plane, pixel: vec2<f32>, offset: vec2<f32>) -> f32 {
    let c = frame.camera;
    let across = offset.x * c.du + offset.y * c.dv;
    // Δz/z; a plane that is seen edge on keeps a side.
    let deeper = -dot(offset, plane.slope.yz) / select(plane.slope.x, -1e-4, abs(plane.slope.x) < 1e-4);
    let along = across + deeper * ray_direction(c, sample_point(c, pixel));
    return max(sqrt(dot(along, along) / dot(across, across)) - 1.0, 0.0);
}
