#define_import_path asvgf::host_motion

// A host's motion, cleaned before it reaches the history. ingest_surface.wgsl stores it or, with HOST_MOTION, temporal.wgsl reads
// it from here.

#import asvgf::frame::{frame, project, sample_point, seen_position}
#import asvgf::color::is_finite
#import asvgf::packing::{NOWHERE, pack_motion}

@group(0) @binding(23) var motion: texture_2d<f32>;
#ifdef PREVIOUS_DEPTH
@group(0) @binding(24) var previous_depth: texture_2d<f32>;
#endif

struct HostMotion {
    // See `pack_motion`.
    packed: vec2<u32>,
    // True if the host knows where the point was.
    known: bool,
}

fn host_motion(pixel: vec2<i32>, depth: f32) -> HostMotion {
    let m = textureLoad(motion, pixel, 0).xy;
    var known = is_finite(m.x) && is_finite(m.y);
#ifdef PREVIOUS_DEPTH
    let before = textureLoad(previous_depth, pixel, 0).x;
    known &= is_finite(before);
#else
    // Without a depth, the point is taken to rest: the camera's motion alone changes its depth.
    let point = sample_point(frame.camera, vec2<f32>(pixel));
    let before = project(frame.previous, seen_position(frame.camera, point, depth)).z;
#endif
    let placed = known && before > 0.0;
    return HostMotion(pack_motion(select(NOWHERE, m, placed), select(0.0, before, placed)), known);
}
