#define_import_path asvgf::ggx

// Microfacets with the GGX distribution, shared by what mirrors and what refracts.

const PI: f32 = 3.14159265358979;

// Least n·v, so that quotients by it stay finite.
const LEAST_COSINE: f32 = 1e-4;

// GGX normal distribution (Walter et al. 2007, eq. 33).
fn distribution(cosine: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = cosine * cosine * (a2 - 1.0) + 1.0;
    return a2 / (PI * d * d);
}

// Smith's Λ for GGX (Heitz 2014, eq. 72).
fn smith(cosine: f32, alpha: f32) -> f32 {
    let c2 = cosine * cosine;
    return 0.5 * (sqrt(1.0 + alpha * alpha * max(1.0 - c2, 0.0) / max(c2, 1e-12)) - 1.0);
}

// Samples a normal by the density of those that a viewer sees, in the space in which the surface's normal is z: spherical caps (Dupuy
// and Benyoub 2023).
fn sample_visible_normal(view: vec3<f32>, alpha: f32, u: vec2<f32>) -> vec3<f32> {
    let angle = 2.0 * PI * u.x;
    let stretched = normalize(vec3(view.xy * alpha, view.z));
    let z = (1.0 - u.y) * (1.0 + stretched.z) - stretched.z;
    let r = sqrt(clamp(1.0 - z * z, 0.0, 1.0));
    let h = vec3(r * cos(angle), r * sin(angle), z) + stretched;
    return normalize(vec3(h.xy * alpha, h.z));
}
