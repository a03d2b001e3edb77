// Turns a host's depth, normals and motion into the filter's own images. Numbers that cannot be used are cleaned here, before they
// reach the history.

#import asvgf::frame::inside
#import asvgf::color::is_finite
#import asvgf::packing::pack_normal
#ifdef OCTAHEDRAL_NORMALS
#import asvgf::packing::octahedral
#endif
#ifdef PACKED_NORMALS
#import asvgf::packing::unpack_octahedral
#endif
#ifndef HOST_MOTION
#import asvgf::host_motion::host_motion
#endif
#ifdef DIAGNOSTICS
#import asvgf::counts::counts
#endif

@group(0) @binding(1) var depth: texture_2d<f32>;
#ifdef PACKED_NORMALS
@group(0) @binding(2) var normal: texture_2d<u32>;
#else
@group(0) @binding(2) var normal: texture_2d<f32>;
#endif
#ifdef OBJECTS
#ifdef FLOAT_OBJECTS
@group(0) @binding(5) var instance: texture_2d<f32>;
#else
@group(0) @binding(5) var instance: texture_2d<u32>;
#endif
@group(0) @binding(6) var object_out: texture_storage_2d<r32uint, write>;
#endif
// The same formats as in visibility.wgsl.
@group(0) @binding(7) var guide_out: texture_storage_2d<rg32uint, write>;
#ifndef HOST_MOTION
@group(0) @binding(8) var motion_out: texture_storage_2d<rg32uint, write>;
#endif

// Depths of surfaces. Some renderers give their sky f32's largest number; within these limits the square of a depth is a normal
// number.
const NEAREST: f32 = 1e-18;
const FARTHEST: f32 = 1e18;

// Squared length below which a normal means that there is none.
const LEAST_SQUARED_NORMAL: f32 = 1e-12;

fn normal_at(pixel: vec2<i32>) -> vec3<f32> {
#ifdef PACKED_NORMALS
    return unpack_octahedral(textureLoad(normal, pixel, 0).x);
#else
    var n = textureLoad(normal, pixel, 0).xyz;
#ifdef MAPPED_NORMALS
    n = 2.0 * n - 1.0;
#endif
#ifdef OCTAHEDRAL_NORMALS
    n = select(vec3(0.0), octahedral(clamp(n.xy, vec2(-1.0), vec2(1.0))), is_finite(n.x) && is_finite(n.y));
#endif
    return n;
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    let z = textureLoad(depth, pixel, 0).x;
    let hit = is_finite(z) && z >= NEAREST && z <= FARTHEST;
    let n = normal_at(pixel);
    let squared = dot(n, n);
    // A normal may have any length but none: a renderer that clears its normals to zero means that there is no surface.
    let oriented = is_finite(squared) && squared > LEAST_SQUARED_NORMAL;
    let seen = hit && oriented;
    let unit = n * inverseSqrt(max(squared, LEAST_SQUARED_NORMAL));
    textureStore(guide_out, pixel, vec4(select(vec2(0u), vec2(pack_normal(unit), bitcast<u32>(z)), seen), 0u, 0u));
#ifndef HOST_MOTION
    let moved = host_motion(pixel, z);
    textureStore(motion_out, pixel, vec4(select(vec2(0u), moved.packed, seen), 0u, 0u));
#endif
#ifdef OBJECTS
#ifdef FLOAT_OBJECTS
    // The bits are only compared, never computed with.
    let object = bitcast<u32>(textureLoad(instance, pixel, 0).x);
#else
    let object = textureLoad(instance, pixel, 0).x;
#endif
    textureStore(object_out, pixel, vec4(object));
#endif
#ifdef DIAGNOSTICS
    if hit && !(oriented && moved.known) {
        atomicAdd(&counts.surfaces, 1u);
    }
#endif
}
