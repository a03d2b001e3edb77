#define_import_path asvgf::material

// The surfaces that light meets.

#import asvgf::scene::{load_material, geometry_word, TWO_SIDED_EMITTER, UNLIT}
#import asvgf::surface::{Visible, Triangle, at, within_edges, geometric_normal, shading_normal, is_front, rounding_error, plane_margin}
#ifdef SPECULAR
#import asvgf::bent_normal::reflecting_normal
#endif
#ifdef TRANSMISSION
#import asvgf::scene::{TRANSMITTING, load_glass}
#endif
#ifdef CLEARCOAT
#import asvgf::scene::{COATED, load_coat}
#import asvgf::ggx::fresnel
#endif
#ifdef TEXTURES
#import asvgf::texture::{sample_texture, exists}
#endif
#ifdef VERTEX_COLORS
#import asvgf::texture::vertex_color
#endif
#ifdef NORMAL_MAPS
#import asvgf::normal_map::mapped_normal
#ifdef SPECULAR
#import asvgf::scene::NORMAL_MAPPED
#endif
#ifdef CLEARCOAT
#import asvgf::normal_map::normal_from
#endif
#endif

// A point that light meets, with all that its scattering depends on.
struct Surface {
    position: vec3<f32>,
    // Distance from the surface along `geometric` at which a ray may start.
    margin: f32,
    geometric: vec3<f32>,
    normal: vec3<f32>,
    // Unit vector against the ray that met the point.
    view: vec3<f32>,
    diffuse: vec3<f32>,
    emission: vec3<f32>,
#ifdef SPECULAR
    // Reflectance at normal incidence.
    reflectance: vec3<f32>,
    // Reflectance at grazing incidence.
    edge: f32,
    // GGX width α, the square of the perceptual roughness.
    alpha: f32,
#endif
#ifdef TRANSMISSION
    // Colour of the light that goes through, of what is not mirrored; 0 if the surface is opaque.
    transmitted: vec3<f32>,
    // Index of refraction on the viewer's side over that on the other side.
    ratio: f32,
    // True for a pane without thickness.
    thin: bool,
    // True if the viewer is inside the body whose skin this is.
    inside: bool,
    // Absorption of this body per unit of length.
    absorption: vec3<f32>,
#endif
#ifdef CLEARCOAT
    // Part of the light that the clear coat mirrors, 0…1. The rest of this surface gets what the coat leaves.
    coat: f32,
    // GGX width of the coat.
    coat_alpha: f32,
    coat_normal: vec3<f32>,
#endif
}

// Least GGX width: below it a lobe is narrower than a float resolves.
const LEAST_WIDTH: f32 = 1e-3;

#ifdef CLEARCOAT
// Reflectance of a clear coat at normal incidence: its index of refraction is 1.5.
const COAT_REFLECTANCE: f32 = 0.04;
#endif

fn surface_at(v: Visible, t: Triangle, weights: vec2<f32>, ray_direction: vec3<f32>) -> Surface {
    let m = load_material(geometry_word(v.row * 3u).w);
    var base = m.base_color.xyz;
    var emission = m.emissive;
    var metallic = m.metallic;
    var roughness = m.roughness;
    var specular = m.specular;
    var edge = m.specular_edge;
#ifdef VERTEX_COLORS
    base *= vertex_color(v.row, weights).xyz;
#endif
#ifdef TEXTURES
    let base_texture = m.base_color_texture;
    if exists(base_texture) {
        base *= sample_texture(base_texture, v.row, weights, true).xyz;
    }
    let emissive_texture = m.emissive_texture;
    if exists(emissive_texture) {
        emission *= sample_texture(emissive_texture, v.row, weights, true).xyz;
    }
#ifdef SPECULAR
    let metallic_roughness_texture = m.metallic_roughness_texture;
    if exists(metallic_roughness_texture) {
        let texel = sample_texture(metallic_roughness_texture, v.row, weights, false);
        roughness *= texel.y;
        metallic *= texel.z;
    }
    let specular_color_texture = m.specular_color_texture;
    if exists(specular_color_texture) {
        specular *= sample_texture(specular_color_texture, v.row, weights, true).xyz;
    }
    let specular_texture = m.specular_texture;
    if exists(specular_texture) {
        let weight = sample_texture(specular_texture, v.row, weights, false).w;
        specular *= weight;
        edge *= weight;
    }
#endif
#endif
    let flags = m.flags;
    let front = is_front(t, v, ray_direction);
    if (flags & TWO_SIDED_EMITTER) == 0u && !front {
        emission = vec3(0.0);
    }
    if (flags & UNLIT) != 0u {
        emission = base;
        base = vec3(0.0);
    }
    var s: Surface;
    let error = rounding_error(t, v);
    s.position = at(t, within_edges(t, weights, error));
    s.geometric = geometric_normal(t, ray_direction);
    s.margin = plane_margin(t, s.geometric, error);
#ifdef NORMAL_MAPS
    s.normal = mapped_normal(v, m, weights, s.geometric);
#else
    s.normal = shading_normal(v, weights, s.geometric);
#endif
    s.view = -normalize(ray_direction);
    s.emission = emission;
#ifdef SPECULAR
    s.diffuse = base * (1.0 - metallic);
    let lit = select(1.0, 0.0, (flags & UNLIT) != 0u);
    s.reflectance = mix(specular, base, metallic) * lit;
    s.edge = mix(edge, 1.0, metallic) * lit;
    s.alpha = max(roughness * roughness, LEAST_WIDTH);
#ifdef TRANSMISSION
    s.ratio = 1.0;
    if (flags & TRANSMITTING) != 0u {
        let glass = load_glass(m);
        var transmission = glass.transmission;
#ifdef TEXTURES
        let texture = glass.texture;
        if exists(texture) {
            transmission *= sample_texture(texture, v.row, weights, false).x;
        }
#endif
        s.transmitted = s.diffuse * transmission;
        s.diffuse *= 1.0 - transmission;
        s.thin = glass.solid == 0u;
        s.inside = !s.thin && !front;
        s.ratio = select(1.0 / glass.index, glass.index, s.inside);
        s.absorption = glass.absorption;
        s.normal = reflecting_normal(s.normal, s.geometric, s.view);
    }
#endif
#ifdef NORMAL_MAPS
    if (flags & NORMAL_MAPPED) != 0u && any(s.reflectance > vec3(0.0)) {
        s.normal = reflecting_normal(s.normal, s.geometric, s.view);
    }
#endif
#ifdef CLEARCOAT
    // From inside a body, its coat lies behind the boundary.
#ifdef TRANSMISSION
    let is_coated = (flags & (COATED | UNLIT)) == COATED && !s.inside;
#else
    let is_coated = (flags & (COATED | UNLIT)) == COATED;
#endif
    if is_coated {
        let coat = load_coat(m);
        var weight = coat.weight;
        var coat_roughness = coat.roughness;
        s.coat_normal = shading_normal(v, weights, s.geometric);
#ifdef TEXTURES
        let weight_texture = coat.weight_texture;
        if exists(weight_texture) {
            weight *= sample_texture(weight_texture, v.row, weights, false).x;
        }
        let roughness_texture = coat.roughness_texture;
        if exists(roughness_texture) {
            coat_roughness *= sample_texture(roughness_texture, v.row, weights, false).y;
        }
#ifdef NORMAL_MAPS
        let normal_texture = coat.normal_texture;
        if exists(normal_texture) {
            s.coat_normal = normal_from(normal_texture, coat.normal_scale, v, weights, s.geometric);
        }
#endif
#endif
        s.coat_normal = reflecting_normal(s.coat_normal, s.geometric, s.view);
        s.coat_alpha = max(coat_roughness * coat_roughness, LEAST_WIDTH);
        s.coat = weight * fresnel(vec3(COAT_REFLECTANCE), 1.0, dot(s.coat_normal, s.view)).x;
        s.emission *= 1.0 - s.coat;
    }
#endif
#else
    s.diffuse = base;
#endif
    return s;
}
