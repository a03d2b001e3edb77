#define_import_path asvgf::bent_normal

// Least n·g by which is divided.
const LEAST_COSINE: f32 = 1e-3;

// Squared length up to which a vector has no direction.
const NO_DIRECTION: f32 = 1e-20;

// A normal that mirrors the viewer to directions above the surface. Failure: parts of glossy relief were black, because about a normal
// that is turned far from the viewer the lobe lies below the geometric surface, where no light may go. Reason: the relief's other slope,
// which would face the viewer, is not there. Rule: if the mirrored direction r is below the surface, it is lifted along the normal to
// the surface, and the normal is the half vector to what results (Keller et al. 2017, "The Iray Light Transport Simulation and Rendering
// System", appendix A.3):
//
//   r′ = unit(r − n·(r·g)/(n·g)),   n′ = unit(v + r′)
fn reflecting_normal(n: vec3<f32>, g: vec3<f32>, view: vec3<f32>) -> vec3<f32> {
    let mirrored = 2.0 * dot(n, view) * n - view;
    let above = dot(mirrored, g);
    if above >= 0.0 {
        return n;
    }
    let lifted = normalize(mirrored - n * (above / max(dot(n, g), LEAST_COSINE)));
    let between = view + lifted;
    let squared = dot(between, between);
    return select(between * inverseSqrt(squared), g, squared <= NO_DIRECTION);
}
