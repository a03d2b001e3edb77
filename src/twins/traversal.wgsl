// Sends rays through a scene, for the test of the traversal.

#import asvgf::ray::Ray
#ifdef FEW_TRIANGLES
#import asvgf::few_triangles::{prepare_traversal, closest_hit, occluded}
#else
#import asvgf::traverse::{closest_hit, occluded}
#endif
#import asvgf::surface::{Visible, triangle_now}
#import asvgf::scene::NO_TRIANGLE

// (origin, limit of the any-hit query), (direction, unused)
@group(0) @binding(0) var<storage, read> rays: array<vec4<f32>>;
// (distance or −1, occluded?, weights), (sum of the corners of the triangle in world space, unused)
@group(0) @binding(1) var<storage, read_write> answers: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
#ifdef FEW_TRIANGLES
    prepare_traversal();
#endif
    let i = 2u * id.x;
    if i >= arrayLength(&rays) {
        return;
    }
    let ray = Ray(rays[i].xyz, rays[i + 1u].xyz);
    let shadow = select(0.0, 1.0, occluded(ray, rays[i].w));
    let hit = closest_hit(ray);
    if hit.triangle == NO_TRIANGLE {
        answers[i] = vec4(-1.0, shadow, 0.0, 0.0);
        answers[i + 1u] = vec4(0.0);
        return;
    }
    let t = triangle_now(Visible(hit.triangle, hit.instance));
    answers[i] = vec4(hit.distance, shadow, hit.barycentrics);
    answers[i + 1u] = vec4(t.a + t.b + t.c, 0.0);
}
