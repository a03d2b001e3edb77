#define_import_path asvgf::demodulation

// The reflectances by which light is divided before it is filtered.

#import asvgf::material::Surface
#import asvgf::packing::round_to_f16
#ifdef GLOSS
#import asvgf::ggx::GRAZING
#ifdef CLEARCOAT
#import asvgf::color::luminance
#endif
#endif

// Least reflectance that divides, so that the quotient stays bounded.
const LEAST_DEMODULATION: f32 = 1e-3;

// The demodulation: the filtered radiance is divided by the surface's reflectance, and multiplied by it again at the end. It is
// rounded as the f16 texture in between stores it. With GLOSS, specular light is divided by a reflectance of its own.
fn demodulation(s: Surface) -> vec3<f32> {
#ifdef GLOSS
#ifdef CLEARCOAT
    return rounded_reflectance((1.0 - s.coat) * diffuse_reflectance(s));
#else
    return rounded_reflectance(diffuse_reflectance(s));
#endif
#else
    return whole_demodulation(s);
#endif
}

// The same for light of both lobes.
fn whole_demodulation(s: Surface) -> vec3<f32> {
#ifdef CLEARCOAT
    return rounded_reflectance((1.0 - s.coat) * (diffuse_reflectance(s) + s.reflectance) + s.coat);
#else ifdef SPECULAR
    return rounded_reflectance(diffuse_reflectance(s) + s.reflectance);
#else
    return rounded_reflectance(s.diffuse);
#endif
}

#ifdef SPECULAR
// Reflectance of all but the specular lobes. What goes through counts, too.
fn diffuse_reflectance(s: Surface) -> vec3<f32> {
#ifdef TRANSMISSION
    return s.diffuse + s.transmitted;
#else
    return s.diffuse;
#endif
}
#endif

fn rounded_reflectance(reflectance: vec3<f32>) -> vec3<f32> {
    return round_to_f16(clamp(reflectance, vec3(LEAST_DEMODULATION), vec3(1.0)));
}

#ifdef GLOSS
// Least specular reflectance that divides.
const LEAST_SPECULAR: f32 = 0.02;

// Reflectance of the specular lobe for light from all around, as Karis approximates it ("Physically Based Shading on Mobile", 2014, after
// Lazarov). It only has to be smooth and of the right size, because light is divided and multiplied by it.
fn specular_demodulation(s: Surface) -> vec3<f32> {
#ifdef CLEARCOAT
    if all(s.reflectance <= vec3(0.0)) && s.coat <= 0.0 {
        return vec3(0.0);
    }
#else
    if all(s.reflectance <= vec3(0.0)) {
        return vec3(0.0);
    }
#endif
    let cosine = clamp(dot(s.normal, s.view), 0.0, 1.0);
    let r = sqrt(s.alpha) * vec4(-1.0, -0.0275, -0.572, 0.022) + vec4(1.0, 0.0425, 1.04, -0.04);
    let a = min(r.x * r.x, exp2(-9.28 * cosine)) * r.x + r.y;
    let scale = vec2(-1.04, 1.04) * a + r.zw;
    let grazing = min(GRAZING * max(max(s.reflectance.x, s.reflectance.y), s.reflectance.z), s.edge);
#ifdef CLEARCOAT
    let below = s.reflectance * scale.x + vec3(grazing * max(scale.y, 0.0));
    let reflectance = (1.0 - s.coat) * below + s.coat;
#else
    let reflectance = s.reflectance * scale.x + vec3(grazing * max(scale.y, 0.0));
#endif
    return round_to_f16(clamp(reflectance, vec3(LEAST_SPECULAR), vec3(1.0)));
}

#ifdef CLEARCOAT
// Parts of the mirrored light at which a coat begins to tell the width of the reflection, and from which it tells it alone.
const FAINT_COAT: f32 = 0.05;
const PLAIN_COAT: f32 = 0.25;
#endif

// Perceptual roughness of the reflections that the surface shows. A coat shows sharper ones than the surface below it does, and a blur of the
// lower lobe's width would smear them.
fn seen_roughness(s: Surface) -> f32 {
#ifdef CLEARCOAT
    let below = (1.0 - s.coat) * luminance(s.reflectance);
    let part = s.coat / max(s.coat + below, LEAST_DEMODULATION);
    return mix(sqrt(s.alpha), sqrt(s.coat_alpha), smoothstep(FAINT_COAT, PLAIN_COAT, part));
#else
    return sqrt(s.alpha);
#endif
}
#endif
