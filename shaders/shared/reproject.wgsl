#define_import_path asvgf::reproject

#import asvgf::frame::{frame, seen_position, sample_point, inside, scale_at}
#import asvgf::packing::unpack_normal

// A point of this frame as it was in the previous frame.
struct Origin {
    // Where it was, from this frame's eye, and its normal.
    position: vec3<f32>,
    normal: vec3<f32>,
    object: u32,
}

// Cosine from which on two normals are those of one surface: 26°.
const SAME_NORMAL: f32 = 0.9;

// The same surface point, or a near neighbour of it on the same surface? The instance alone would accept a surface that
// reappears from behind itself; the plane distance works at grazing angles, where a difference of depths does not.
// Thresholds: 1 % of the depth off the plane, 5 % of it away (beyond, taps of one pixel cannot be meant), 26°.
fn same_surface(origin: Origin, tap: vec2<i32>, guide: vec2<u32>, object: u32) -> bool {
    let depth = bitcast<f32>(guide.y);
    if depth <= 0.0 || object != origin.object {
        return false;
    }
    let normal = unpack_normal(guide.x);
    let offset = origin.position
        - seen_position(frame.previous, sample_point(frame.previous, vec2<f32>(tap)), depth);
    let scale = scale_at(frame.previous, depth);
    return abs(dot(normal, offset)) <= 0.01 * scale
        && dot(offset, offset) <= 0.0025 * scale * scale
        && dot(normal, origin.normal) >= SAME_NORMAL;
}

fn origin_of(pixel: vec2<f32>, motion: vec3<f32>, normal: vec3<f32>, object: u32) -> Origin {
    let point = sample_point(frame.camera, pixel) + motion.xy;
    return Origin(seen_position(frame.previous, point, motion.z), normal, object);
}
