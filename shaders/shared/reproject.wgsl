#define_import_path asvgf::reproject

#import asvgf::frame::{frame, seen_position, sample_point, inside, scale_at}
#import asvgf::packing::unpack_normal

// A point of this frame's surface as it was in the previous frame.
struct Origin {
    // Its former place, counted from this frame's eye, and its normal.
    position: vec3<f32>,
    normal: vec3<f32>,
    object: u32,
#ifdef SPECULAR_SIGNAL
    // Factor on the tolerated distances.
    reach: f32,
#endif
}

// Tolerances of `same_surface`: distance from the tangent plane and distance of the points, both in parts of the depth, and the
// cosine of the normals. Taps of one pixel are never 5 % of the depth apart on one surface; acos 0.9 is 26°.
const PLANE_TOLERANCE: f32 = 0.01;
const SQUARED_DISTANCE: f32 = 0.0025;
const SAME_NORMAL: f32 = 0.9;

// True if a tap shows the surface point, or a near neighbour of it on the same surface. The instance alone is not enough, because
// it accepts a surface that reappears from behind itself; a difference of depths fails at grazing angles, where the distance from
// the plane works. Thresholds: 1 % of the depth off the plane, 5 % of it away (beyond, taps of one pixel cannot be meant), 26°.
fn same_surface(origin: Origin, tap: vec2<i32>, guide: vec2<u32>, object: u32) -> bool {
    let depth = bitcast<f32>(guide.y);
    if depth <= 0.0 || object != origin.object {
        return false;
    }
    let normal = unpack_normal(guide.x);
    let offset = origin.position
        - seen_position(frame.previous, sample_point(frame.previous, vec2<f32>(tap)), depth);
#ifdef SPECULAR_SIGNAL
    let scale = origin.reach * scale_at(frame.previous, depth);
#else
    let scale = scale_at(frame.previous, depth);
#endif
    return abs(dot(normal, offset)) <= PLANE_TOLERANCE * scale
        && dot(offset, offset) <= SQUARED_DISTANCE * scale * scale
        && dot(normal, origin.normal) >= SAME_NORMAL;
}

fn origin_of(pixel: vec2<f32>, motion: vec3<f32>, normal: vec3<f32>, object: u32) -> Origin {
    let point = sample_point(frame.camera, pixel) + motion.xy;
    let position = seen_position(frame.previous, point, motion.z);
#ifdef SPECULAR_SIGNAL
    return Origin(position, normal, object, 1.0);
#else
    return Origin(position, normal, object);
#endif
}

#ifdef SPECULAR_SIGNAL
// Reach without limit, in depths.
const ANYWHERE: f32 = 1e9;

// The same surface anywhere on it, because a reflection may have been seen in another part of its mirror.
fn in_mirror(origin: Origin) -> Origin {
    var mirror = origin;
    mirror.reach = ANYWHERE;
    return mirror;
}
#endif
