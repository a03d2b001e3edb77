#define_import_path asvgf::texture

#import asvgf::scene::{scene, image_word, attributes, load_material, geometry_word, TextureUse}

// Images lie in one buffer or texture, because not every GPU has arrays of differently sized textures.

fn texture_coordinates(row: u32, barycentrics: vec2<f32>, uv_set: u32) -> vec2<f32> {
    let first = row * scene.attribute_stride + select(scene.uv_first, scene.uv_second, uv_set != 0u);
    let a = vec2(bitcast<f32>(attributes[first]), bitcast<f32>(attributes[first + 1u]));
    let b = vec2(bitcast<f32>(attributes[first + 2u]), bitcast<f32>(attributes[first + 3u]));
    let c = vec2(bitcast<f32>(attributes[first + 4u]), bitcast<f32>(attributes[first + 5u]));
    return a + barycentrics.x * (b - a) + barycentrics.y * (c - a);
}

fn wrap(i: i32, size: i32, mode: u32) -> i32 {
    if mode == 2u {
        return clamp(i, 0, size - 1);
    }
    let period = select(size, 2 * size, mode == 1u);
    let folded = i - period * i32(floor(f32(i) / f32(period)));
    let inside = clamp(folded, 0, period - 1);
    return select(inside, period - 1 - inside, inside >= size);
}

// IEC 61966-2-1.
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

// Whether an alpha mask cuts this point of a triangle away.
fn is_hole(row: u32, barycentrics: vec2<f32>) -> bool {
    let material = load_material(geometry_word(row * 3u).w);
    if material.cutoff <= 0.0 {
        return false;
    }
    var opacity = material.base_color.w;
#ifdef TEXTURES
    let image = material.base_color_texture;
    if exists(image) {
        opacity *= sample_texture(image, row, barycentrics, false).w;
    }
#endif
    return opacity < material.cutoff;
}
