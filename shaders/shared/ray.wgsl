#define_import_path asvgf::ray

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

struct Hit {
    distance: f32,
    // Row of the visibility lookup table (`NO_TRIANGLE` if nothing was hit), and the instance that it belongs to.
    triangle: u32,
    instance: u32,
    // Barycentric weights of the second and the third vertex.
    barycentrics: vec2<f32>,
}

// Stands for the distance of a miss.
const MISS: f32 = 3.0e38;

// Distance of the sky where a distance is stored.
const SKY: f32 = 8e9;

// Triangles reach a millionth over their edges, so that no ray falls between two that share one.
const OVER_EDGE: f32 = 1e-6;
