#define_import_path asvgf::ray

struct Ray {
    origin: vec3<f32>,
    direction: vec3<f32>,
}

struct Hit {
    distance: f32,
    // Row of the visibility lookup table (`NO_TRIANGLE` if nothing was hit), and whose it is.
    triangle: u32,
    instance: u32,
    // Barycentric weights of the second and the third vertex.
    barycentrics: vec2<f32>,
}

// A distance that means a miss.
const MISS: f32 = 3.0e38;
