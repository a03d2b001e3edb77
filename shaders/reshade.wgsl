// Writes the data that a host needs to repeat one path of the last frame per stratum. shaders/host/reshade.wgsl, which becomes part
// of the host's shader, reads it:
//   repeats: place of the pixel that repeats, 1…9 (0: none) · last frame's pixel, x | y << 16 · that pixel's packed normal · its depth
//   shifts: displacement of the surface since the last frame, in world space
//
// Displacements come from the host's own numbers, to their last bit. The filter's copies are rounded, and a surface that is shaded
// beside itself may shadow itself.

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

// Displacement in parts of the depth, squared, up to which a surface rests: 10⁻⁵ is about a hundredth of a pixel, and far above the
// rounding of f32.
const RESTING_SQUARED: f32 = 1e-10;

// Tolerances for motion and depth in f16, which rounds both to 2⁻¹¹: in pixels, and in parts of the number.
const F16_PIXELS: f32 = 0.002;
const F16_PART: f32 = 0.001;

// Distance from the surface, in parts of the depth, up to which the last frame's point still lies on it.
const ON_SURFACE: f32 = 1e-4;

// True if a surface rests. Failure: a surface at rest had a gradient. Reason: the host's motion is rounded, so the point was shaded
// a little beside itself. Rule: a point that rests is shaded at the same place to the last bit. `moved` is the displacement by the
// host's motion, `seen` the place where the last frame saw the surface.
fn rests(now: vec3<f32>, moved: vec3<f32>, seen: vec3<f32>, point: vec2<f32>, m: vec3<f32>, normal: vec3<f32>) -> bool {
    let before = project(frame.previous, now);
    if dot(moved, moved) <= RESTING_SQUARED * before.z * before.z {
        return true;
    }
    // The rounding of f16 may hide a real move towards the eye. Hence the third test: the point that was seen is still on the surface.
    let shift = abs(m.xy - (before.xy - point));
    return all(shift <= F16_PIXELS + abs(m.xy) * F16_PART)
        && abs(m.z - before.z) <= F16_PART * before.z
        && abs(dot(normal, now - seen)) <= ON_SURFACE * before.z;
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    if any(id.xy >= frame.strata) {
        return;
    }
    let stratum = vec2<i32>(id.xy);
    let record = textureLoad(samples, stratum, 0);
    var repeat = vec4(0u);
    var shift = vec3(0.0);
    if record.x != 0u {
        let pixel = sample_pixel(record, stratum);
        let depth = bitcast<f32>(record.w);
        let point = sample_point(frame.camera, vec2<f32>(pixel));
        // The displacement of the neighbour's surface is that of the pixel's own: exactly if the surface is shifted, and to a part
        // of a pixel's width if it turns.
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
        repeat = vec4(record.xy, before);
    }
    textureStore(repeats_out, stratum, repeat);
    textureStore(shifts_out, stratum, vec4(bitcast<vec3<u32>>(shift), 0u));
}
