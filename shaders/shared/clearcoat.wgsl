#define_import_path asvgf::clearcoat

// A clear coat over a surface (KHR_materials_clearcoat, `fresnel_coat`). It mirrors the part c of the light, and leaves the rest to the surface
// below it, emission included:
//
//   f = (1 − c)·f_below + c·f_coat,   c = weight · Schlick(0.04, n_c·v)
//
// c depends on the viewer alone. A microfacet's light that would end below the surface is mirrored to the upper side, as in glass.wgsl, so
// f_coat · cosine is the density itself with which a direction is found. A white surface under a coat stays white in a white furnace.

#import asvgf::material::Surface
#import asvgf::bsdf::{LEAST_SHARE, MOST_SHARE, Scattering, seen_from, tangents, to_world}
#ifdef TRANSMISSION
#import asvgf::bsdf::{NARROW, WIDE}
#endif
#import asvgf::color::luminance
#import asvgf::ggx::{mirroring_facet, other_side, sample_visible_normal}

// Probability with which the coat's lobe is sampled.
fn coat_share(s: Surface) -> f32 {
    if s.coat <= 0.0 {
        return 0.0;
    }
#ifdef TRANSMISSION
    let below = (1.0 - s.coat) * luminance(s.diffuse + s.transmitted + s.reflectance);
#else
    let below = (1.0 - s.coat) * luminance(s.diffuse + s.reflectance);
#endif
    return clamp(s.coat / (s.coat + below), LEAST_SHARE, MOST_SHARE);
}

// The random number that is left for the lobes below the coat, negative if it chooses the coat.
fn choice_below(s: Surface, choice: f32) -> f32 {
    let share = coat_share(s);
    return (choice - share) / (1.0 - share);
}

// Solid-angle density of `sample_coat`.
fn coat_density(s: Surface, light: vec3<f32>) -> f32 {
    let t = tangents(s.coat_normal);
    let l = vec3(dot(light, t[0]), dot(light, t[1]), dot(light, s.coat_normal));
    if l.z <= 0.0 || dot(s.geometric, light) <= 0.0 {
        return 0.0;
    }
    let v = seen_from(s.coat_normal, t, s.view);
    return mirroring_facet(v, l, s.coat_alpha).density + mirroring_facet(v, other_side(l), s.coat_alpha).density;
}

// Samples a direction into which the coat mirrors light.
fn sample_coat(s: Surface, u: vec2<f32>) -> vec3<f32> {
    let t = tangents(s.coat_normal);
    let v = seen_from(s.coat_normal, t, s.view);
    let m = sample_visible_normal(v, s.coat_alpha, u);
    let mirrored = 2.0 * dot(v, m) * m - v;
    return to_world(s.coat_normal, t, s.geometric, vec3(mirrored.xy, abs(mirrored.z)));
}

// Scattering by a surface and its coat.
fn coated(s: Surface, light: vec3<f32>, below: Scattering) -> Scattering {
    if s.coat <= 0.0 {
        return below;
    }
    let density = coat_density(s, light);
    let mirrored = s.coat * density;
    var result: Scattering;
    result.value = (1.0 - s.coat) * below.value + mirrored;
    result.density = mix(below.density, density, coat_share(s));
#ifdef GLOSS
    result.specular = (1.0 - s.coat) * below.specular + mirrored;
#endif
#ifdef TRANSMISSION
    result.narrow = (1.0 - s.coat) * below.narrow + mirrored * (1.0 - smoothstep(NARROW, WIDE, s.coat_alpha));
#endif
    return result;
}
