#define_import_path asvgf::normal_map

// Normals from images (glTF 2.0, §3.9.3), in the space of tangent, bitangent and interpolated normal:
//
//   n = x·t + y·b + z·n₀,   b = w·n₀ × t,   (x, y, z) = texel·2 − 1,  x and y times the map's scale
//
// Light is scattered about this normal. The filter's G-buffer has the interpolated one, because its stops would part the slopes of a
// relief, and its planes would not be those of the surface (docs/filter.md).

#import asvgf::scene::{scene, attributes, Material, TextureUse, load_normal_map, object_to_world, transform_vector, instance_numbers, NORMAL_MAPPED}
#import asvgf::surface::{Visible, interpolated_normal, shading_normal}
#import asvgf::texture::sample_texture
#import asvgf::packing::octahedral

// Words of the attributes before the tangents: three normals, which every scene with normal maps has.
const TANGENTS: u32 = 3u;

// Unpacks a unit tangent: 16 and 15 bits on the unfolded octahedron. Bit 31 is set if w is −1.
fn unpack_tangent(bits: u32) -> vec3<f32> {
    return octahedral(vec2(f32(bits & 0xffffu) * (2.0 / 65535.0), f32((bits >> 16u) & 0x7fffu) * (2.0 / 32767.0)) - 1.0);
}

// Tangent at a point, of any length, and w.
fn tangent_at(v: Visible, weights: vec2<f32>, first: u32) -> vec4<f32> {
    let a = unpack_tangent(attributes[first]);
    let b = unpack_tangent(attributes[first + 1u]);
    let c = unpack_tangent(attributes[first + 2u]);
    let t = a + weights.x * (b - a) + weights.y * (c - a);
    // The corners of a triangle have one w, because a triangle of the image is mirrored or not.
    let w = select(1.0, -1.0, (attributes[first] >> 31u) != 0u);
#ifdef INSTANCED
    // A placement that mirrors turns the cross product over.
    let mirrored = (instance_numbers(v.instance).w & 1u) != 0u;
    return vec4(transform_vector(object_to_world(v.instance), t), select(w, -w, mirrored));
#else
    return vec4(t, w);
#endif
}

// Squared length up to which a vector has no direction.
const NO_DIRECTION: f32 = 1e-20;

// The normal of the material's image, on the side from which light is seen; the interpolated normal if there is none.
fn mapped_normal(v: Visible, m: Material, weights: vec2<f32>, geometric: vec3<f32>) -> vec3<f32> {
    if (m.flags & NORMAL_MAPPED) == 0u {
        return shading_normal(v, weights, geometric);
    }
    let map = load_normal_map(m);
    return normal_from(map.texture, map.scale, v, weights, geometric);
}

// The normal of an image; the interpolated normal if there is no tangent.
fn normal_from(image: TextureUse, scale: f32, v: Visible, weights: vec2<f32>, geometric: vec3<f32>) -> vec3<f32> {
    let shading = shading_normal(v, weights, geometric);
    let first = v.row * scene.attribute_stride + TANGENTS;
    if attributes[first] == 0u {
        return shading;
    }
    let tangent = tangent_at(v, weights, first);
    let squared = dot(tangent.xyz, tangent.xyz);
    if squared <= NO_DIRECTION {
        return shading;
    }
    // The image belongs to the front. Seen from the back, the whole relief is turned over, as glTF does with the normal.
    let side = select(1.0, -1.0, dot(interpolated_normal(v, weights), shading) < 0.0);
    let normal = side * shading;
    let t = tangent.xyz * inverseSqrt(squared);
    let texel = sample_texture(image, v.row, weights, false).xyz * 2.0 - 1.0;
    let flat = texel.xy * scale;
    // No texel points into the surface.
    let mapped = flat.x * t + flat.y * tangent.w * cross(normal, t) + max(texel.z, 0.0) * normal;
    let length = dot(mapped, mapped);
    return select(side * mapped * inverseSqrt(length), shading, length <= NO_DIRECTION);
}
