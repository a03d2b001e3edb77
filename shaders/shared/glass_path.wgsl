#define_import_path asvgf::glass_path

// Paths through bodies of glass: how far they are refracted, and what bodies absorb of them.

#import asvgf::bsdf::Scattering
#import asvgf::glass_scattering::{is_glass, lambert_share}
#import asvgf::material::Surface
#ifdef CLEARCOAT
#import asvgf::clearcoat::choice_below
#endif

// Boundaries of glass at which a path may be refracted or mirrored. At further ones it goes straight, so that light which is caught
// inside a body is not lost.
const MOST_REFRACTIONS: u32 = 24u;

// Boundaries of glass that a path may meet.
const MOST_BOUNDARIES: u32 = 96u;

// A density that stands for that of a single direction.
const SINGLE_DIRECTION: f32 = 1e12;

// The body that a path is in. Of bodies in each other, it is the one that was entered last; each refracts as against air.
struct Body {
    // Absorption per unit of length.
    absorption: vec3<f32>,
}

// True if a path that was sampled with this choice left a surface of glass by another lobe than Lambert's.
fn is_refracted(s: Surface, choice: f32) -> bool {
#ifdef CLEARCOAT
    return is_glass(s) && choice_below(s, choice) >= lambert_share(s);
#else
    return is_glass(s) && choice >= lambert_share(s);
#endif
}

// The body in which a path goes on from a surface.
fn enter(body: Body, s: Surface, direction: vec3<f32>) -> Body {
    if !is_glass(s) || s.thin {
        return body;
    }
    let passes = dot(direction, s.geometric) < 0.0;
    if passes != s.inside {
        return Body(s.absorption);
    }
    if passes {
        return Body(vec3(0.0));
    }
    return body;
}

// The body in which a path has met a surface. A path that meets the inner side of a body was in that body, wherever the camera stood.
fn body_before(s: Surface, body: Body) -> Body {
    return Body(select(body.absorption, s.absorption, is_glass(s) && s.inside));
}

// The part of light that a body leaves over a length (Beer and Lambert).
fn absorbed(body: Body, length: f32) -> vec3<f32> {
    return exp(-body.absorption * length);
}

// Point at which a ray starts that leaves a surface in this direction.
fn origin_towards(s: Surface, direction: vec3<f32>) -> vec3<f32> {
    return s.position + select(-s.margin, s.margin, dot(direction, s.geometric) > 0.0) * s.geometric;
}

// The light of a ray that goes straight through glass.
fn straight_through(s: Surface) -> Scattering {
    var result: Scattering;
    result.value = s.transmitted * SINGLE_DIRECTION;
    result.narrow = result.value;
    result.density = SINGLE_DIRECTION;
    return result;
}
