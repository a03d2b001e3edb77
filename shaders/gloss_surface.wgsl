// Finds the roughness and the specular reflectance of the visible surfaces, and puts the roughness beside the distances that the paths
// have found.

#import asvgf::frame::{frame, direction, sample_point, inside}
#import asvgf::gloss::pack_gloss
#import asvgf::demodulation::{seen_roughness, specular_demodulation}
#import asvgf::material::surface_at
#import asvgf::scene::NO_TRIANGLE
#import asvgf::surface::{visible, triangle_now, barycentrics, at}

@group(0) @binding(1) var visibility: texture_2d<u32>;
// In z the distance of what is reflected.
@group(0) @binding(2) var specular_radiance: texture_2d<u32>;
@group(0) @binding(3) var specular_albedo_out: texture_storage_2d<rgba16float, write>;
#ifdef OBJECTS
@group(0) @binding(5) var object: texture_2d<u32>;
#endif
// The gloss, and the number of the object.
@group(0) @binding(4) var gloss_out: texture_storage_2d<rg32uint, write>;

fn object_at(pixel: vec2<i32>) -> u32 {
#ifdef OBJECTS
    return textureLoad(object, pixel, 0).x;
#else
    return 0u;
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    if !inside(pixel) {
        return;
    }
    let seen = textureLoad(visibility, pixel, 0).x;
    var reflectance = vec3(0.0);
    var gloss = 0u;
    if seen != NO_TRIANGLE {
        let v = visible(seen);
        let t = triangle_now(v);
        let ray = direction(frame.camera, sample_point(frame.camera, vec2<f32>(id.xy)));
        let weights = barycentrics(t, frame.camera.eye, ray);
        let s = surface_at(v, t, weights, at(t, weights) - frame.camera.eye);
        reflectance = specular_demodulation(s);
        let hit_distance = bitcast<f32>(textureLoad(specular_radiance, pixel, 0).z);
        gloss = select(0u, pack_gloss(seen_roughness(s), hit_distance, 1.0), any(reflectance > vec3(0.0)));
    }
    textureStore(specular_albedo_out, pixel, vec4(reflectance, 0.0));
    textureStore(gloss_out, pixel, vec4(gloss, object_at(pixel), 0u, 0u));
}
