#define_import_path asvgf::scattering

// Scattering by a surface: the value of all lobes together for a direction, and a direction by their density.

#import asvgf::material::Surface
#import asvgf::bsdf::{Scattering, tangents}
#import asvgf::ggx::PI
#ifdef SPECULAR
#import asvgf::bsdf::{LEAST_SHARE, MOST_SHARE, seen_from}
#import asvgf::color::luminance
#import asvgf::ggx::{LEAST_COSINE, distribution, fresnel, smith, sample_visible_normal}
#endif
#ifdef CLEARCOAT
#import asvgf::clearcoat::{choice_below, coated, sample_coat}
#endif
#ifdef TRANSMISSION
#import asvgf::bsdf::{NARROW, WIDE}
#import asvgf::glass_scattering::{glass_scattering, is_glass, lambert_share, sample_glass}
#endif

#ifdef SPECULAR
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

// The light that a surface without its coat scatters from this direction towards the viewer.
fn scattering_below(s: Surface, light: vec3<f32>) -> Scattering {
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
    let sine = cross(s.normal, half_vector);
    let f = fresnel(s.reflectance, s.edge, dot(s.view, half_vector));
    let d = distribution(dot(s.normal, half_vector), dot(sine, sine), s.alpha);
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

// Samples a direction by the density of `scattering_below`: cosine-weighted, or about a visible normal of the GGX distribution.
fn sample_below(s: Surface, u: vec2<f32>, choice: f32) -> vec3<f32> {
#ifdef TRANSMISSION
    if is_glass(s) {
        return sample_glass(s, u, choice);
    }
#endif
    let t = tangents(s.normal);
    let angle = 2.0 * PI * u.x;
#ifdef SPECULAR
    if choice < specular_share(s) {
        let m = sample_visible_normal(seen_from(s.normal, t, s.view), s.alpha, u);
        let normal = t[0] * m.x + t[1] * m.y + s.normal * m.z;
        return normalize(2.0 * dot(s.view, normal) * normal - s.view);
    }
#endif
    let r = sqrt(u.y);
    let z = sqrt(max(1.0 - u.y, 0.0));
    return normalize(t[0] * (r * cos(angle)) + t[1] * (r * sin(angle)) + s.normal * z);
}

// The light that a surface scatters from this direction towards the viewer.
fn scattering(s: Surface, light: vec3<f32>) -> Scattering {
#ifdef CLEARCOAT
    return coated(s, light, scattering_below(s, light));
#else
    return scattering_below(s, light);
#endif
}

// Samples a direction by the density of `scattering`.
fn sample_direction(s: Surface, u: vec2<f32>, choice: f32) -> vec3<f32> {
#ifdef CLEARCOAT
    let below = choice_below(s, choice);
    if below < 0.0 {
        return sample_coat(s, u);
    }
    return sample_below(s, u, below);
#else
    return sample_below(s, u, choice);
#endif
}

#ifdef GLOSS
// True if a direction that was sampled with this choice is one of the specular lobe.
fn is_mirrored(s: Surface, chosen: f32, direction: vec3<f32>) -> bool {
#ifdef CLEARCOAT
    let choice = choice_below(s, chosen);
    if choice < 0.0 {
        return true;
    }
#else
    let choice = chosen;
#endif
#ifdef TRANSMISSION
    if is_glass(s) {
        return choice >= lambert_share(s) && dot(direction, s.geometric) > 0.0;
    }
#endif
    return choice < specular_share(s);
}
#endif
