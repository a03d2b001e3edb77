#define_import_path asvgf::throughput

// The light that a path has found, and the part of further light that would reach the viewer.

#import asvgf::bsdf::Scattering
#ifdef TRANSMISSION
#import asvgf::glass_scattering::is_glass
#import asvgf::material::Surface
#endif

// One path's estimate of the radiance that the first surface sends towards the viewer.
struct Estimate {
    // All of it, or what the diffuse lobe reflects.
    diffuse: vec3<f32>,
#ifdef GLOSS
    // What the specular lobe reflects.
    specular: vec3<f32>,
    // Distance to what the path met along the specular lobe; 0 if it left by the diffuse one.
    hit_distance: f32,
#ifdef INSTANCED
    // Displacement of that since the last frame.
    displacement: vec3<f32>,
#endif
#endif
}

struct Throughput {
    all: vec3<f32>,
#ifdef GLOSS
    // The part that left the first surface by its specular lobe.
    specular: vec3<f32>,
#endif
}

fn scaled(throughput: Throughput, factor: vec3<f32>) -> Throughput {
    var result = throughput;
    result.all *= factor;
#ifdef GLOSS
    result.specular *= factor;
#endif
    return result;
}

// The throughput behind a surface that scatters a path.
fn scatter(throughput: Throughput, scattered: Scattering, is_first: bool) -> Throughput {
    var result: Throughput;
    result.all = throughput.all * (scattered.value / scattered.density);
#ifdef GLOSS
    result.specular = select(
        throughput.specular * scattered.value / scattered.density, throughput.all * (scattered.specular / scattered.density), is_first);
#endif
    return result;
}

// Adds light that arrives at the end of a path.
fn add(light: ptr<function, Estimate>, throughput: Throughput, arriving: vec3<f32>, weight: f32) {
#ifdef GLOSS
    (*light).specular += throughput.specular * arriving * weight;
    (*light).diffuse += (throughput.all - throughput.specular) * arriving * weight;
#else
    (*light).diffuse += throughput.all * arriving * weight;
#endif
}

// Adds light that arrives at a surface, and that the surface scatters along the path.
fn add_scattered(light: ptr<function, Estimate>, throughput: Throughput, towards: Scattering, arriving: vec3<f32>, is_first: bool) {
    let all = towards.value * arriving;
#ifdef GLOSS
    // The direct light of the first surface is split by the lobes' values in this direction.
    let part = select(throughput.specular * all, throughput.all * (towards.specular * arriving), is_first);
    (*light).specular += part;
    (*light).diffuse += throughput.all * all - part;
#else
    (*light).diffuse += throughput.all * all;
#endif
}

#ifdef TRANSMISSION
// Light behind glass. A light sample goes straight through glass, a scattered ray is refracted, so the two cannot be weighted against each
// other. Each counts for some of the lobes alone:
//
//   surface            light sample through glass    scattered ray through glass
//   opaque, wide       yes                           no
//   opaque, narrow     no                            yes
//   glass, camera      no                            yes
//
// So a floor under glass has no caustics, and a mirror shows glass as the camera sees it. Lights without area are found by light samples
// alone, and count for all lobes. `Sampling::Lights` counts light samples for all lobes of opaque surfaces, and `Sampling::Scattered`
// counts scattered rays for all lobes, caustics included.
struct Ways {
    // Throughput if the path meets light next.
    direct: Throughput,
    // Throughput if it meets light behind glass.
    refracted: Throughput,
}

// The part of wide lobes.
fn matte(scattered: Scattering) -> Scattering {
    var result = scattered;
    result.value -= scattered.narrow;
#ifdef GLOSS
    result.specular -= min(scattered.specular, scattered.narrow);
#endif
    return result;
}

// The part of narrow lobes.
fn narrow(scattered: Scattering) -> Scattering {
    var result = scattered;
    result.value = scattered.narrow;
#ifdef GLOSS
    // The specular lobe is narrow as a whole or in part; what glass transmits is narrow and no part of it.
    result.specular = min(scattered.specular, scattered.narrow);
#endif
    return result;
}

fn sum(a: Throughput, b: Throughput) -> Throughput {
    var result = a;
    result.all += b.all;
#ifdef GLOSS
    result.specular += b.specular;
#endif
    return result;
}

// The ways to light behind a surface.
fn ways_behind(s: Surface, throughput: Throughput, before: Ways, scattered: Scattering, is_first: bool) -> Ways {
#ifdef SCATTERED_RAYS_ONLY
    let all = scatter(throughput, scattered, is_first);
    return Ways(all, all);
#else
    if is_glass(s) {
        let refracted = scatter(before.refracted, narrow(scattered), is_first);
#ifdef LIGHT_SAMPLES_ONLY
        return Ways(refracted, refracted);
#else
        return Ways(sum(refracted, scatter(throughput, matte(scattered), is_first)), refracted);
#endif
    }
#ifdef LIGHT_SAMPLES_ONLY
    return Ways();
#else
    return Ways(scatter(throughput, scattered, is_first), scatter(throughput, narrow(scattered), is_first));
#endif
#endif
}

// Adds a light sample with its weight against scattered rays, and the part of it that glass lets through. `is_seen` tells that the narrow
// lobes show the light to the camera, as emission.
fn add_light_sample(
    light: ptr<function, Estimate>, s: Surface, throughput: Throughput, ways: Ways, towards: Scattering,
    arriving: vec3<f32>, weight: f32, has_area: bool, is_seen: bool, met_glass: bool, is_first: bool
) {
    let part = select(weight, 1.0, met_glass);
    add_scattered(light, throughput, matte(towards), arriving * part, is_first);
    let glass = is_glass(s);
#ifdef LIGHT_SAMPLES_ONLY
    let is_found_otherwise = has_area && (glass || is_seen);
#else
    let is_found_otherwise = has_area && (met_glass || is_seen);
#endif
    if !is_found_otherwise {
        if glass {
            add_scattered(light, ways.refracted, narrow(towards), arriving * part, is_first);
        } else {
            add_scattered(light, throughput, narrow(towards), arriving * part, is_first);
        }
    }
}
#endif
