#define_import_path asvgf::bsdf

// Means that all lobes of a surface share.

#ifdef SPECULAR
#import asvgf::ggx::LEAST_COSINE
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
#endif

#ifdef SPECULAR
// Limits of the probability with which one of two lobes is sampled.
const LEAST_SHARE: f32 = 0.1;
const MOST_SHARE: f32 = 0.9;
#endif

// Tangents of a unit normal (Duff et al. 2017).
fn tangents(n: vec3<f32>) -> mat2x3<f32> {
    let sign = select(-1.0, 1.0, n.z >= 0.0);
    let a = -1.0 / (sign + n.z);
    let b = n.x * n.y * a;
    return mat2x3(vec3(1.0 + sign * n.x * n.x * a, sign * b, -sign * n.x), vec3(b, sign + n.y * n.y * a, -n.y));
}

#ifdef SPECULAR
// The viewer in the space of a shading normal with these tangents.
fn seen_from(normal: vec3<f32>, t: mat2x3<f32>, view: vec3<f32>) -> vec3<f32> {
    return vec3(dot(view, t[0]), dot(view, t[1]), max(dot(view, normal), LEAST_COSINE));
}

// A direction in the space of a shading normal with these tangents. What this normal leads to the wrong side of the true surface is
// mirrored by that surface.
fn to_world(normal: vec3<f32>, t: mat2x3<f32>, geometric: vec3<f32>, local: vec3<f32>) -> vec3<f32> {
    let direction = normalize(t[0] * local.x + t[1] * local.y + normal * local.z);
    let side = dot(direction, geometric);
    return select(direction, direction - 2.0 * side * geometric, (side > 0.0) != (local.z > 0.0));
}
#endif
