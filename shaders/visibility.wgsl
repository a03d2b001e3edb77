// Finds the triangle that each pixel sees, and all that follows from it: normal, depth, motion.
//
// The visibility buffer holds one u32 per pixel. Vertices come from the lookup table, for this frame and for the previous one. The
// motion is exact: the same barycentric weights on the previous frame's vertices, through the previous camera.

#import asvgf::frame::{frame, direction, project, sample_point, inside}
#import asvgf::ray::Ray
#ifdef FEW_TRIANGLES
#import asvgf::few_triangles::{prepare_traversal, closest_hit}
#else
#import asvgf::traverse::{closest_hit}
#endif
#import asvgf::surface::{Visible, visibility_id, triangle_now, triangle_before, barycentrics, at, geometric_normal, shading_normal}
#import asvgf::scene::NO_TRIANGLE
#ifdef ALPHA_BLEND
#import asvgf::texture::{cover_from, is_blended}
#endif
#import asvgf::packing::{NOWHERE, pack_motion, pack_normal}

@group(0) @binding(1) var visibility_out: texture_storage_2d<r32uint, write>;
// Packed world normal; linear depth (f32 bits), 0 if nothing was hit.
@group(0) @binding(2) var guide_out: texture_storage_2d<rg32uint, write>;
// Previous − current position in pixels (x right, y down), then the depth of the point in the previous camera.
@group(0) @binding(3) var motion_out: texture_storage_2d<rg32uint, write>;
#ifdef INSTANCED
@group(0) @binding(4) var object_out: texture_storage_2d<r32uint, write>;
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
#ifdef FEW_TRIANGLES
    prepare_traversal();
#endif
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    let ray = Ray(frame.camera.eye, direction(frame.camera, sample_point(frame.camera, vec2<f32>(id.xy))));
    var hit = closest_hit(ray);
#ifdef ALPHA_BLEND
    // Blended surfaces that let most light through are seen if there is no other: a pixel that sees none is not filtered.
    if hit.triangle == NO_TRIANGLE && is_blended {
        cover_from(0.0);
        hit = closest_hit(ray);
    }
#endif
    var id_seen = NO_TRIANGLE;
    var object = NO_TRIANGLE;
    var guide = vec2(0u);
    var motion = vec2(0u);
    if hit.triangle != NO_TRIANGLE {
        let v = Visible(hit.triangle, hit.instance);
        let now = triangle_now(v);
        let weights = barycentrics(now, ray.origin, ray.direction);
        let normal = shading_normal(v, weights, geometric_normal(now, ray.direction));
        let here = project(frame.camera, at(now, weights) - ray.origin);
        let before = project(frame.previous, at(triangle_before(v), weights) - ray.origin);
        id_seen = visibility_id(hit.triangle, hit.instance);
        object = hit.instance;
        guide = vec2(pack_normal(normal), bitcast<u32>(here.z));
        // A point that was behind the previous camera has no place in its image.
        motion = pack_motion(select(NOWHERE, before.xy - here.xy, before.z > 0.0), before.z);
    }
    textureStore(visibility_out, pixel, vec4(id_seen));
    textureStore(guide_out, pixel, vec4(guide, 0u, 0u));
    textureStore(motion_out, pixel, vec4(motion, 0u, 0u));
#ifdef INSTANCED
    textureStore(object_out, pixel, vec4(object));
#endif
}
