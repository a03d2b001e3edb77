#define_import_path asvgf::glass_scattering

// Scattering by a surface of glass, see glass.wgsl, with Lambert's lobe for the part that does not go through.

#import asvgf::material::Surface
#import asvgf::bsdf::{LEAST_SHARE, MOST_SHARE, NARROW, Scattering, seen_from, tangents, to_world}
#import asvgf::color::luminance
#import asvgf::ggx::{PI, sample_visible_normal}
#import asvgf::glass::{grazing_part, facets, leave}

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
#ifdef CLEARCOAT
    return (1.0 - s.coat) * split(outside, cosine).transmitted;
#else
    return split(outside, cosine).transmitted;
#endif
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

fn glass_scattering(s: Surface, light: vec3<f32>) -> Scattering {
    let t = tangents(s.normal);
    let l = vec3(dot(light, t[0]), dot(light, t[1]), dot(light, s.normal));
    let above = l.z > 0.0;
    // Both normals must agree on the side.
    if above != (dot(s.geometric, light) > 0.0) {
        return Scattering();
    }
    let both = facets(seen_from(s.normal, t, s.view), l, s.alpha, s.ratio, s.thin);
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
        return to_world(s.normal, t, s.geometric, vec3(r * cos(2.0 * PI * u.x), r * sin(2.0 * PI * u.x), sqrt(max(1.0 - u.y, 0.0))));
    }
    let v = seen_from(s.normal, t, s.view);
    let m = sample_visible_normal(v, s.alpha, u);
    let rest = (choice - share) / (1.0 - share);
    return to_world(s.normal, t, s.geometric, leave(v, m, s.ratio, rest < split(s, dot(v, m)).mirrors, s.thin));
}

// The direction in which a smooth boundary of glass leads a ray: through it, or back.
fn lead(s: Surface, mirrors: bool) -> vec3<f32> {
    let t = tangents(s.normal);
    return to_world(s.normal, t, s.geometric, leave(seen_from(s.normal, t, s.view), vec3(0.0, 0.0, 1.0), s.ratio, mirrors, s.thin));
}
