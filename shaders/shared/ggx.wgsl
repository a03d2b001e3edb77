#define_import_path asvgf::ggx

// Microfacets with the GGX distribution, shared by what mirrors and what refracts.

const PI: f32 = 3.14159265358979;

// Least n·v, so that quotients by it stay finite.
const LEAST_COSINE: f32 = 1e-4;

// GGX normal distribution (Walter et al. 2007, eq. 33) of a normal at this angle. Failure: the lobes of two mirrors above each other had
// densities 6 % apart, because 1 − cos² loses its digits where the angle is about α = 10⁻³. Rule: the squared sine comes from a cross
// product or from two coordinates.
fn distribution(cosine: f32, sine_squared: f32, alpha: f32) -> f32 {
    let a2 = alpha * alpha;
    let d = cosine * cosine * a2 + sine_squared;
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

// Part of the normal reflectance, 1/50, at which the grazing reflectance is full: without the one there is not the other either.
const GRAZING: f32 = 50.0;

// Schlick 1994.
fn fresnel(f0: vec3<f32>, edge: f32, cosine: f32) -> vec3<f32> {
    let grazing = min(GRAZING * max(max(f0.x, f0.y), f0.z), edge);
    let k = clamp(1.0 - cosine, 0.0, 1.0);
    let k2 = k * k;
    return f0 + (vec3(grazing) - f0) * (k2 * k2 * k);
}

// A microfacet that leads light to the viewer: the density of the direction that it leads to, and the cosine v·h.
struct Facet {
    density: f32,
    cosine: f32,
}

const NO_FACET = Facet(0.0, 1.0);

// The least squared length of a vector that has a direction.
const NO_DIRECTION: f32 = 1e-20;

// D_v: density of the normals that the viewer sees.
fn visible_normals(view: vec3<f32>, half_vector: vec3<f32>, cosine: f32, alpha: f32) -> f32 {
    return distribution(half_vector.z, dot(half_vector.xy, half_vector.xy), alpha) * cosine / (view.z * (1.0 + smith(view.z, alpha)));
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

fn other_side(direction: vec3<f32>) -> vec3<f32> {
    return vec3(direction.xy, -direction.z);
}
