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

#import asvgf::ggx::{NO_DIRECTION, NO_FACET, Facet, mirroring_facet, other_side, visible_normals}

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
