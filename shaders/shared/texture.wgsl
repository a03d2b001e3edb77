#define_import_path asvgf::texture

#import asvgf::scene::{scene, image_word, attributes, load_material, geometry_word, TextureUse, Material, CULLED, BLENDED}
#ifdef ALPHA_BLEND
#import asvgf::random::hash
#endif

// Images lie in one buffer or texture, because not every GPU has arrays of differently sized textures.

fn texture_coordinates(row: u32, barycentrics: vec2<f32>, uv_set: u32) -> vec2<f32> {
    let first = row * scene.attribute_stride + select(scene.uv_first, scene.uv_second, uv_set != 0u);
    let a = vec2(bitcast<f32>(attributes[first]), bitcast<f32>(attributes[first + 1u]));
    let b = vec2(bitcast<f32>(attributes[first + 2u]), bitcast<f32>(attributes[first + 3u]));
    let c = vec2(bitcast<f32>(attributes[first + 4u]), bitcast<f32>(attributes[first + 5u]));
    return a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
}

// Texel coordinate after wrapping: 0 repeats, 1 mirrors, 2 clamps.
fn wrap(i: i32, size: i32, mode: u32) -> i32 {
    if mode == 2u {
        return clamp(i, 0, size - 1);
    }
    let period = select(size, 2 * size, mode == 1u);
    let folded = i - period * i32(floor(f32(i) / f32(period)));
    let inside = clamp(folded, 0, period - 1);
    return select(inside, period - 1 - inside, inside >= size);
}

// sRGB transfer function (IEC 61966-2-1).
fn srgb_to_linear(c: vec3<f32>) -> vec3<f32> {
    return select(pow((c + 0.055) / 1.055, vec3(2.4)), c / 12.92, c <= vec3(0.04045));
}

fn texel(image: TextureUse, x: i32, y: i32, srgb: bool) -> vec4<f32> {
    let u = wrap(x, i32(image.width), image.mode & 3u);
    let v = wrap(y, i32(image.height), (image.mode >> 2u) & 3u);
    let c = unpack4x8unorm(image_word(image.first + u32(v) * image.width + u32(u)));
    if srgb {
        return vec4(srgb_to_linear(c.xyz), c.w);
    }
    return c;
}

// Bilinear (or nearest) interpolation, in linear light.
fn sample_texture(image: TextureUse, row: u32, barycentrics: vec2<f32>, srgb: bool) -> vec4<f32> {
    let raw = texture_coordinates(row, barycentrics, (image.mode >> 5u) & 1u);
    let uv = vec2(dot(image.row_u.xy, raw) + image.row_u.z, dot(image.row_v.xy, raw) + image.row_v.z);
    // Beyond 2²² texels a float has no fraction left to interpolate with.
    let position = clamp(uv * vec2(f32(image.width), f32(image.height)), vec2(-4194304.0), vec2(4194304.0));
    if (image.mode & 16u) != 0u {
        let p = vec2<i32>(floor(position));
        return texel(image, p.x, p.y, srgb);
    }
    let corner = floor(position - 0.5);
    let f = position - 0.5 - corner;
    let p = vec2<i32>(corner);
    let top = mix(texel(image, p.x, p.y, srgb), texel(image, p.x + 1, p.y, srgb), f.x);
    let bottom = mix(texel(image, p.x, p.y + 1, srgb), texel(image, p.x + 1, p.y + 1, srgb), f.x);
    return mix(top, bottom, f.y);
}

fn exists(image: TextureUse) -> bool {
    return (image.mode & 0x80000000u) != 0u;
}

#ifdef VERTEX_COLORS
// Colour and opacity, interpolated between the vertices.
fn vertex_color(row: u32, barycentrics: vec2<f32>) -> vec4<f32> {
    let first = row * scene.attribute_stride + scene.color_first;
    let a = corner_color(first);
    let b = corner_color(first + 2u);
    let c = corner_color(first + 4u);
    return a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
}

fn corner_color(first: u32) -> vec4<f32> {
    return vec4(unpack2x16unorm(attributes[first]), unpack2x16unorm(attributes[first + 1u]));
}
#endif

#ifdef ALPHA_BLEND
// Opacity from which a blended surface stops a ray. Below 0 the threshold is a random number for each surface that the ray meets,
// so that a surface covers as much as its opacity on average.
var<private> coverage: f32 = 0.5;
// Seed of these numbers. A ray that is repeated with its seed meets the same surfaces.
var<private> coverage_seed: u32 = 0u;
// True once a ray has met a surface that lets a part of the light through, neither all of it nor nothing.
var<private> is_blended: bool = false;

// Makes the rays that follow meet blended surfaces at random.
fn cover_at_random(seed: u32) {
    coverage = -1.0;
    // A constant (2³² over the golden ratio) parts these numbers from the path's own.
    coverage_seed = hash(seed ^ 0x9e3779b9u);
}

// Makes the rays that follow meet all blended surfaces of at least this opacity.
fn cover_from(opacity: f32) {
    coverage = opacity;
}

// Barycentric weight below which a point is so near to an edge that a ray may meet both triangles there.
const AT_EDGE: f32 = 4e-6;

// True if a point near an edge counts as the neighbour's. Failure: a ray through a common edge was covered twice. Reason: it may
// meet both triangles. Rule: the triangle along whose winding the edge ascends has it; the other, with the same two corners, goes
// along it downwards.
fn belongs_to_neighbour(row: u32, barycentrics: vec2<f32>) -> bool {
    let near = vec3(1.0 - barycentrics.x - barycentrics.y, barycentrics) < vec3(AT_EDGE);
    if !any(near) {
        return false;
    }
    let a = bitcast<vec3<f32>>(geometry_word(row * 3u).xyz);
    let b = bitcast<vec3<f32>>(geometry_word(row * 3u + 1u).xyz);
    let c = bitcast<vec3<f32>>(geometry_word(row * 3u + 2u).xyz);
    return any(near & vec3(descends(b, c), descends(c, a), descends(a, b)));
}

fn descends(a: vec3<f32>, b: vec3<f32>) -> bool {
    return b.x < a.x || (b.x == a.x && (b.y < a.y || (b.y == a.y && b.z < a.z)));
}

fn passes_through(opacity: f32, row: u32, instance: u32, barycentrics: vec2<f32>) -> bool {
    if opacity <= 0.0 || opacity >= 1.0 {
        return opacity <= 0.0;
    }
    if belongs_to_neighbour(row, barycentrics) {
        return true;
    }
    is_blended = true;
    let number = f32(hash(coverage_seed ^ hash(row ^ hash(instance))) >> 8u) * (1.0 / 16777216.0);
    return opacity <= select(coverage, number, coverage < 0.0);
}
#endif

// Opacity of a material at a point of a triangle.
fn opacity_at(material: Material, row: u32, barycentrics: vec2<f32>) -> f32 {
    var opacity = material.base_color.w;
#ifdef VERTEX_COLORS
    opacity *= vertex_color(row, barycentrics).w;
#endif
#ifdef TEXTURES
    let image = material.base_color_texture;
    if exists(image) {
        opacity *= sample_texture(image, row, barycentrics, false).w;
    }
#endif
    return opacity;
}

#ifdef ALPHA_BLEND
// Opacity of a surface at a point that a ray has met: the part that it covers of what lies behind.
fn covered_at(row: u32, barycentrics: vec2<f32>) -> f32 {
    let material = load_material(geometry_word(row * 3u).w);
    if (material.flags & BLENDED) == 0u {
        return 1.0;
    }
    return clamp(opacity_at(material, row, barycentrics), 0.0, 1.0);
}
#endif

#ifdef ALPHA_MASK
// Part of a triangle's light samples at a point that rays would find too: 0 in a hole, and the opacity of a blended surface.
fn emitting_part(row: u32, barycentrics: vec2<f32>) -> f32 {
    let material = load_material(geometry_word(row * 3u).w);
    if material.cutoff <= 0.0 {
        return 1.0;
    }
    let opacity = opacity_at(material, row, barycentrics);
#ifdef ALPHA_BLEND
    if (material.flags & BLENDED) != 0u {
        return clamp(opacity, 0.0, 1.0);
    }
#endif
    return select(1.0, 0.0, opacity < material.cutoff);
}
#endif

// True if a ray goes through this point of a triangle, which it meets from the back or from the front: because of the opacity, or
// because the material has no back faces.
fn is_hole(row: u32, instance: u32, barycentrics: vec2<f32>, back: bool) -> bool {
    let material = load_material(geometry_word(row * 3u).w);
    if back && (material.flags & CULLED) != 0u {
        return true;
    }
    if material.cutoff <= 0.0 {
        return false;
    }
    let opacity = opacity_at(material, row, barycentrics);
#ifdef ALPHA_BLEND
    if (material.flags & BLENDED) != 0u {
        return passes_through(opacity, row, instance, barycentrics);
    }
#endif
    return opacity < material.cutoff;
}
