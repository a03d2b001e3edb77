#define_import_path asvgf::glass

// The boundary of a transparent dielectric: microfacets that mirror or refract (Walter et al. 2007, "Microfacet Models for Refraction
// through Rough Surfaces"). Directions are in the space in which the surface's normal is z, towards the viewer; `ratio` is the index of
// refraction on the viewer's side over that on the other side. The two sides of a thin pane have the same index, and light that goes
// through one is mirrored to its other side.
//
// Failure: a rough slab in a white furnace was dark. Reason: single scattering loses what is masked on its way out, and what leaves on
// the wrong side of the surface. Rule: value · cosine is the density itself with which a direction is found from the viewer, with
// the density of visible normals D_v (Heitz 2018, eq. 3):
//
//   mirrored   D_v(h)/(4 v·h),                                h ∝ v + l
//   refracted  D_v(h)·|l·h|/(ratio·v·h + l·h)²,               h ∝ ±(ratio·v + l)   (Walter et al. 2007, eq. 17)
//
// and a direction on the wrong side counts as its mirror image on the right one. So a microfacet's light is mirrored or refracted
// completely, at any roughness and any index.

#import asvgf::ggx::{distribution, smith}

// A microfacet that leads light to the viewer: the density of the direction that it leads to, and the cosine v·h.
struct Facet {
    density: f32,
    cosine: f32,
}

const NO_FACET = Facet(0.0, 1.0);

// The least squared length of a vector that has a direction.
const NO_DIRECTION: f32 = 1e-20;

// Fresnel's reflectance of a dielectric for unpolarised light.
fn dielectric(cosine: f32, ratio: f32) -> f32 {
    let squared = 1.0 - ratio * ratio * (1.0 - cosine * cosine);
    if squared <= 0.0 {
        return 1.0;
    }
    let refracted = sqrt(squared);
    let perpendicular = (ratio * cosine - refracted) / (ratio * cosine + refracted);
    let parallel = (cosine - ratio * refracted) / (cosine + ratio * refracted);
    return 0.5 * (perpendicular * perpendicular + parallel * parallel);
}

// Part of the way from the reflectance at normal incidence to that at grazing incidence, 0…1.
fn grazing_part(cosine: f32, ratio: f32) -> f32 {
    let root = (1.0 - ratio) / (1.0 + ratio);
    let normal = root * root;
    return clamp((dielectric(cosine, ratio) - normal) / (1.0 - normal), 0.0, 1.0);
}

// D_v: density of the normals that the viewer sees.
fn visible_normals(view: vec3<f32>, half_vector: vec3<f32>, cosine: f32, alpha: f32) -> f32 {
    return distribution(half_vector.z, alpha) * cosine / (view.z * (1.0 + smith(view.z, alpha)));
}

fn mirroring_facet(view: vec3<f32>, light: vec3<f32>, alpha: f32) -> Facet {
    let sum = view + light;
    let squared = dot(sum, sum);
    if squared <= NO_DIRECTION || sum.z <= 0.0 {
        return NO_FACET;
    }
    let half_vector = sum * inverseSqrt(squared);
    let cosine = dot(view, half_vector);
    if cosine <= 0.0 {
        return NO_FACET;
    }
    return Facet(visible_normals(view, half_vector, cosine, alpha) / (4.0 * cosine), cosine);
}

fn refracting_facet(view: vec3<f32>, light: vec3<f32>, alpha: f32, ratio: f32) -> Facet {
    let sum = ratio * view + light;
    let squared = dot(sum, sum);
    if squared <= NO_DIRECTION {
        return NO_FACET;
    }
    let half_vector = sum * select(-inverseSqrt(squared), inverseSqrt(squared), sum.z >= 0.0);
    let cosine = dot(view, half_vector);
    let behind = dot(light, half_vector);
    if cosine <= 0.0 || behind >= 0.0 {
        return NO_FACET;
    }
    let root = ratio * cosine + behind;
    return Facet(visible_normals(view, half_vector, cosine, alpha) * -behind / max(root * root, 1e-30), cosine);
}

fn other_side(direction: vec3<f32>) -> vec3<f32> {
    return vec3(direction.xy, -direction.z);
}

// The two facets that lead light from this direction to the viewer: directly, and by way of the wrong side.
fn facets(view: vec3<f32>, light: vec3<f32>, alpha: f32, ratio: f32, thin: bool) -> array<Facet, 2> {
    let mirrored = other_side(light);
    if light.z > 0.0 || thin {
        return array(mirroring_facet(view, light, alpha), mirroring_facet(view, mirrored, alpha));
    }
    return array(refracting_facet(view, light, alpha, ratio), refracting_facet(view, mirrored, alpha, ratio));
}

// The direction to which a microfacet leads, on the side where it belongs.
fn leave(view: vec3<f32>, half_vector: vec3<f32>, ratio: f32, mirrors: bool, thin: bool) -> vec3<f32> {
    let cosine = dot(view, half_vector);
    if mirrors || thin {
        let direction = 2.0 * cosine * half_vector - view;
        return vec3(direction.xy, select(-abs(direction.z), abs(direction.z), mirrors));
    }
    let refracted = sqrt(max(1.0 - ratio * ratio * (1.0 - cosine * cosine), 0.0));
    let direction = (ratio * cosine - refracted) * half_vector - ratio * view;
    return vec3(direction.xy, -abs(direction.z));
}
