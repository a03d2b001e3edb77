#define_import_path asvgf::material

#import asvgf::scene::{load_material, geometry_word, TWO_SIDED_EMITTER, UNLIT}
#import asvgf::surface::{Visible, Triangle, at, within_edges, geometric_normal, shading_normal, is_front, rounding_error, plane_margin}
#import asvgf::color::luminance
#import asvgf::packing::round_to_f16
#import asvgf::ggx::PI
#ifdef SPECULAR
#import asvgf::ggx::{LEAST_COSINE, distribution, smith, sample_visible_normal}
#endif
#ifdef SPECULAR
#import asvgf::bent_normal::reflecting_normal
#endif
#ifdef TRANSMISSION
#import asvgf::scene::{TRANSMITTING, load_glass}
#import asvgf::glass::{grazing_part, facets, leave}
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
}

// Least GGX width: below it a lobe is narrower than a float resolves.
const LEAST_WIDTH: f32 = 1e-3;

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
#else
    s.diffuse = base;
#endif
    return s;
}

// Least reflectance that divides, so that the quotient stays bounded.
const LEAST_DEMODULATION: f32 = 1e-3;

// The demodulation: the filtered radiance is divided by the surface's reflectance, and multiplied by it again at the end. It is
// rounded as the f16 texture in between stores it. With GLOSS, specular light is divided by a reflectance of its own.
fn demodulation(s: Surface) -> vec3<f32> {
#ifdef GLOSS
#ifdef TRANSMISSION
    return rounded_reflectance(s.diffuse + s.transmitted);
#else
    return rounded_reflectance(s.diffuse);
#endif
#else
    return whole_demodulation(s);
#endif
}

// The same for light of both lobes.
fn whole_demodulation(s: Surface) -> vec3<f32> {
#ifdef TRANSMISSION
    return rounded_reflectance(s.diffuse + s.transmitted + s.reflectance);
#else ifdef SPECULAR
    return rounded_reflectance(s.diffuse + s.reflectance);
#else
    return rounded_reflectance(s.diffuse);
#endif
}

fn rounded_reflectance(reflectance: vec3<f32>) -> vec3<f32> {
    return round_to_f16(clamp(reflectance, vec3(LEAST_DEMODULATION), vec3(1.0)));
}

#ifdef GLOSS
// Least specular reflectance that divides.
const LEAST_SPECULAR: f32 = 0.02;

// Reflectance of the specular lobe for light from all around, as Karis approximates it ("Physically Based Shading on Mobile", 2014, after
// Lazarov). It only has to be smooth and of the right size, because light is divided and multiplied by it.
fn specular_demodulation(s: Surface) -> vec3<f32> {
    if all(s.reflectance <= vec3(0.0)) {
        return vec3(0.0);
    }
    let cosine = clamp(dot(s.normal, s.view), 0.0, 1.0);
    let r = sqrt(s.alpha) * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    let scale = vec2(-1.04, 1.04) * a + r.zw;
    let grazing = min(GRAZING * max(max(s.reflectance.x, s.reflectance.y), s.reflectance.z), s.edge);
    let reflectance = s.reflectance * scale.x + vec3(grazing * max(scale.y, 0.0));
    return round_to_f16(clamp(reflectance, vec3(LEAST_SPECULAR), vec3(1.0)));
}
#endif

#ifdef SPECULAR
// Part of the normal reflectance, 1/50, at which the grazing reflectance is full: without the one there is not the other either.
const GRAZING: f32 = 50.0;

// Schlick 1994.
fn fresnel(f0: vec3<f32>, edge: f32, cosine: f32) -> vec3<f32> {
    let grazing = min(GRAZING * max(max(f0.x, f0.y), f0.z), edge);
    let k = clamp(1.0 - cosine, 0.0, 1.0);
    let k2 = k * k;
    return f0 + (vec3(grazing) - f0) * (k2 * k2 * k);
}

// Limits of the probability with which the specular lobe is sampled, where both lobes exist.
const LEAST_SHARE: f32 = 0.1;
const MOST_SHARE: f32 = 0.9;

// Probability with which the specular lobe is sampled.
fn specular_share(s: Surface) -> f32 {
    let specular = luminance(fresnel(s.reflectance, s.edge, max(dot(s.normal, s.view), 0.0)));
    let diffuse = luminance(s.diffuse);
    if specular <= 0.0 {
        return 0.0;
    }
    if diffuse <= 0.0 {
        return 1.0;
    }
    return clamp(specular / (specular + diffuse), LEAST_SHARE, MOST_SHARE);
}
#endif

struct Scattering {
    // BSDF times cosine.
    value: vec3<f32>,
    // Solid-angle density with which `sample_direction` returns this direction.
    density: f32,
#ifdef GLOSS
    // The specular lobe's part of the value.
    specular: vec3<f32>,
#endif
#ifdef TRANSMISSION
    // Part of the value by which lights behind glass are found with scattered rays, see throughput.wgsl: that of narrow lobes.
    narrow: vec3<f32>,
#endif
}

#ifdef TRANSMISSION
// GGX widths up to which a lobe is narrow, and from which it is as wide as Lambert's for the search of lights behind glass. In between
// it is partly one and partly the other.
const NARROW: f32 = 0.04;
const WIDE: f32 = 0.25;

// The mirrored and the transmitted part of the light at a microfacet of glass, and the probability with which a path is mirrored.
struct Split {
    mirrored: vec3<f32>,
    transmitted: vec3<f32>,
    mirrors: f32,
}

fn split(s: Surface, cosine: f32) -> Split {
    let mirrored = mix(s.reflectance, vec3(s.edge), grazing_part(cosine, s.ratio));
    let transmitted = (1.0 - max(max(mirrored.x, mirrored.y), mirrored.z)) * s.transmitted;
    let all = luminance(mirrored + transmitted);
    return Split(mirrored, transmitted, select(1.0, luminance(mirrored) / all, all > 0.0));
}

// The part of the light that goes straight through one boundary. The ray that is refracted meets both boundaries of a slab at angles that
// mirror the same, so the outer angle counts at both.
fn straight_part(s: Surface, cosine: f32) -> vec3<f32> {
    var outside = s;
    outside.ratio = min(s.ratio, 1.0 / s.ratio);
    return split(outside, cosine).transmitted;
}

fn is_glass(s: Surface) -> bool {
    return any(s.transmitted > vec3(0.0));
}

// True if a surface shows what lies behind it.
fn is_clear(s: Surface) -> bool {
    return s.alpha <= NARROW && luminance(s.transmitted) > luminance(s.diffuse);
}

// Probability with which Lambert's lobe of a surface is sampled that transmits, too.
fn lambert_share(s: Surface) -> f32 {
    let diffuse = luminance(s.diffuse);
    let others = luminance(s.reflectance + s.transmitted);
    return select(clamp(diffuse / (diffuse + others), LEAST_SHARE, MOST_SHARE), 0.0, diffuse <= 0.0);
}

// The viewer in the space of the surface's normal.
fn local_view(s: Surface, t: mat2x3<f32>) -> vec3<f32> {
    return vec3(dot(s.view, t[0]), dot(s.view, t[1]), max(dot(s.view, s.normal), LEAST_COSINE));
}

fn glass_scattering(s: Surface, light: vec3<f32>) -> Scattering {
    let t = tangents(s.normal);
    let l = vec3(dot(light, t[0]), dot(light, t[1]), dot(light, s.normal));
    let above = l.z > 0.0;
    // Both normals must agree on the side.
    if above != (dot(s.geometric, light) > 0.0) {
        return Scattering();
    }
    let both = facets(local_view(s, t), l, s.alpha, s.ratio, s.thin);
    var mirrored = vec3(0.0);
    var transmitted = vec3(0.0);
    var density = 0.0;
    for (var i = 0u; i < 2u; i++) {
        let part = split(s, both[i].cosine);
        mirrored += part.mirrored * both[i].density;
        transmitted += part.transmitted * both[i].density;
        density += select(1.0 - part.mirrors, part.mirrors, above) * both[i].density;
    }
    let share = lambert_share(s);
    var result: Scattering;
    result.narrow = select(transmitted, mirrored, above);
    result.value = result.narrow;
    result.density = (1.0 - share) * density;
    if above {
        let half_vector = normalize(s.view + light);
        let left = 1.0 - split(s, max(dot(s.view, half_vector), 0.0)).mirrored;
        result.value += s.diffuse * left * (l.z / PI);
        result.density += share * l.z / PI;
#ifdef GLOSS
        result.specular = mirrored;
#endif
    }
    return result;
}

// Samples a direction by the density of `glass_scattering`.
fn sample_glass(s: Surface, u: vec2<f32>, choice: f32) -> vec3<f32> {
    let t = tangents(s.normal);
    let share = lambert_share(s);
    if choice < share {
        let r = sqrt(u.y);
        return to_world(s, t, vec3(r * cos(2.0 * PI * u.x), r * sin(2.0 * PI * u.x), sqrt(max(1.0 - u.y, 0.0))));
    }
    let v = local_view(s, t);
    let m = sample_visible_normal(v, s.alpha, u);
    let rest = (choice - share) / (1.0 - share);
    return to_world(s, t, leave(v, m, s.ratio, rest < split(s, dot(v, m)).mirrors, s.thin));
}

// A direction in the space of the surface's normal. What the interpolated normal leads to the wrong side of the true surface is mirrored
// by that surface.
fn to_world(s: Surface, t: mat2x3<f32>, local: vec3<f32>) -> vec3<f32> {
    let direction = normalize(t[0] * local.x + t[1] * local.y + s.normal * local.z);
    let side = dot(direction, s.geometric);
    return select(direction, direction - 2.0 * side * s.geometric, (side > 0.0) != (local.z > 0.0));
}

// The direction in which a smooth boundary of glass leads a ray: through it, or back.
fn lead(s: Surface, mirrors: bool) -> vec3<f32> {
    let t = tangents(s.normal);
    return to_world(s, t, leave(local_view(s, t), vec3(0.0, 0.0, 1.0), s.ratio, mirrors, s.thin));
}
#endif

#ifdef GLOSS
// True if a direction that was sampled with this choice is one of the specular lobe.
fn is_mirrored(s: Surface, choice: f32, direction: vec3<f32>) -> bool {
#ifdef TRANSMISSION
    if is_glass(s) {
        return choice >= lambert_share(s) && dot(direction, s.geometric) > 0.0;
    }
#endif
    return choice < specular_share(s);
}
#endif

fn scattering(s: Surface, light: vec3<f32>) -> Scattering {
#ifdef TRANSMISSION
    if is_glass(s) {
        return glass_scattering(s, light);
    }
#endif
    let cosine = dot(s.normal, light);
    // Light must arrive above the true surface and above the interpolated one.
    if cosine <= 0.0 || dot(s.geometric, light) <= 0.0 {
        return Scattering();
    }
#ifdef SPECULAR
    let share = specular_share(s);
    let half_vector = normalize(s.view + light);
    let nv = max(dot(s.normal, s.view), LEAST_COSINE);
    let nh = clamp(dot(s.normal, half_vector), 0.0, 1.0);
    let f = fresnel(s.reflectance, s.edge, dot(s.view, half_vector));
    let d = distribution(nh, s.alpha);
    let lambda_view = smith(nv, s.alpha);
    // f·D·G₂ / (4 n·v n·l), with the cosine n·l already cancelled.
    let specular = f * d / (4.0 * nv * (1.0 + lambda_view + smith(cosine, s.alpha)));
    let value = s.diffuse * (1.0 - f) * (cosine / PI) + specular;
    // Density of visible normals (Heitz 2018, eq. 3) times the Jacobian 1 / (4 v·h).
    let visible = d / (4.0 * nv * (1.0 + lambda_view));
#ifdef TRANSMISSION
    var result = Scattering();
    result.value = value;
    result.density = mix(cosine / PI, visible, share);
    result.narrow = specular * (1.0 - smoothstep(NARROW, WIDE, s.alpha));
#ifdef GLOSS
    result.specular = specular;
#endif
    return result;
#else ifdef GLOSS
    return Scattering(value, mix(cosine / PI, visible, share), specular);
#else
    return Scattering(value, mix(cosine / PI, visible, share));
#endif
#else
    return Scattering(s.diffuse * (cosine / PI), cosine / PI);
#endif
}

// Tangents of a unit normal (Duff et al. 2017).
fn tangents(n: vec3<f32>) -> mat2x3<f32> {
    let sign = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    return mat2x3(vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), vec3(b, sign + n.y * n.y * a, -n.y));
}

// Samples a direction by the density of `scattering`: cosine-weighted, or about a visible normal of the GGX distribution.
fn sample_direction(s: Surface, u: vec2<f32>, choice: f32) -> vec3<f32> {
#ifdef TRANSMISSION
    if is_glass(s) {
        return sample_glass(s, u, choice);
    }
#endif
    let t = tangents(s.normal);
    let angle = 2.0 * PI * u.x;
#ifdef SPECULAR
    if choice < specular_share(s) {
        let v = vec3(dot(s.view, t[0]), dot(s.view, t[1]), max(dot(s.view, s.normal), LEAST_COSINE));
        let m = sample_visible_normal(v, s.alpha, u);
        let normal = t[0] * m.x + t[1] * m.y + s.normal * m.z;
        return normalize(2.0 * dot(s.view, normal) * normal - s.view);
    }
#endif
    let r = sqrt(u.y);
    let z = sqrt(max(1.0 - u.y, 0.0));
    return normalize(t[0] * (r * cos(angle)) + t[1] * (r * sin(angle)) + s.normal * z);
}
