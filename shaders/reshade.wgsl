// What a host needs to repeat one path of the last frame per stratum. shaders/host/reshade.wgsl, which becomes part of
// the host's shader, reads it:
//   repeats: place of the pixel that repeats, 1…9 (0: none) · last frame's pixel, x | y << 16 · that pixel's packed
//     normal · its depth
//   shifts: how far the surface has moved since, in world space
//
// The host's own numbers tell that, to their last bit: what the filter keeps of them is rounded, and a surface shaded beside
// itself may shadow itself.

#import asvgf::frame::{frame, project, sample_point, seen_position}
#import asvgf::packing::unpack_normal
#import asvgf::strata::{previous_pixel, sample_pixel}

@group(0) @binding(1) var samples: texture_2d<u32>;
@group(0) @binding(2) var guide_previous: texture_2d<u32>;
@group(0) @binding(3) var motion: texture_2d<f32>;
@group(0) @binding(4) var repeats_out: texture_storage_2d<rgba32uint, write>;
@group(0) @binding(5) var shifts_out: texture_storage_2d<rgba32uint, write>;
#ifdef PREVIOUS_DEPTH
@group(0) @binding(6) var previous_depth: texture_2d<f32>;
#endif

// Whether a surface rests: a point that does shall be shaded at the same place to the last bit, so that its gradient is exactly 0,
// though the host's motion is rounded. `moved` is how far that says it moved, `seen` where the last frame saw it.
fn rests(now: vec3<f32>, moved: vec3<f32>, seen: vec3<f32>, point: vec2<f32>, m: vec3<f32>, normal: vec3<f32>) -> bool {
    let before = project(frame.previous, now);
    // A hundredth of a pixel: what f32 rounds is far below.
    if dot(moved, moved) <= 1e-10 * before.z * before.z {
        return true;
    }
    // What f16 rounds: 2⁻¹¹ of motion and depth. That may hide a real move towards the eye, hence the third test: the point that
    // was seen is still on the surface.
    let shift = abs(m.xy - (before.xy - point));
    return all(shift <= 0.002 + abs(m.xy) * 0.001)
        && abs(m.z - before.z) <= 0.001 * before.z
        && abs(dot(normal, now - seen)) <= 1e-4 * before.z;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.strata) {
        return;
    }
    let stratum = vec2<i32>(id.xy);
    let record = textureLoad(samples, stratum, 0);
    var which = vec4(0u);
    var shift = vec3(0.0);
    if record.x != 0u {
        let pixel = sample_pixel(record, stratum);
        let depth = bitcast<f32>(record.w);
        let point = sample_point(frame.camera, vec2<f32>(pixel));
        // The pixel's own surface tells how far its neighbour's has moved: exactly where it is shifted, and to a part of a pixel's
        // width where it turns.
        let now = seen_position(frame.camera, point, depth);
#ifdef PREVIOUS_DEPTH
        let z = textureLoad(previous_depth, pixel, 0).x;
#else
        let z = project(frame.previous, now).z;
#endif
        let m = vec3(textureLoad(motion, pixel, 0).xy, z);
        let moved = now - seen_position(frame.previous, point + m.xy, m.z);
        let q = previous_pixel(record);
        let before = textureLoad(guide_previous, q, 0).xy;
        let seen = seen_position(frame.previous, sample_point(frame.previous, vec2<f32>(q)), bitcast<f32>(before.y));
        shift = select(moved, vec3(0.0), rests(now, moved, seen, point, m, unpack_normal(record.z)));
        which = vec4(record.xy, before);
    }
    textureStore(repeats_out, stratum, which);
    textureStore(shifts_out, stratum, vec4(bitcast<vec3<u32>>(shift), 0u));
}
