// Chooses in each stratum the pixel whose path repeats one of the last frame (Schied et al. 2018, §4.1).
//
// The surface is found by back-projection through the exact motion, and the last frame's visibility sample then gives the exact
// surface point. So neither atomics are needed, nor does a sub-pixel shift remain.
//
// The choice rotates over the stratum's nine pixels. A random pixel is unbiased where the brightest is not, and a pixel that
// repeated a path in the last frame has no path of its own to repeat.

#import asvgf::frame::{frame, inside}
#import asvgf::random::hash
#import asvgf::packing::{unpack_motion, unpack_normal}
#import asvgf::reproject::{origin_of, same_surface}
#import asvgf::strata::{is_sample_pixel, sample_pixel, stratum_of}

@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var guide_previous: texture_2d<u32>;
@group(0) @binding(3) var motion: texture_2d<u32>;
#ifdef OBJECTS
@group(0) @binding(4) var object: texture_2d<u32>;
@group(0) @binding(5) var object_previous: texture_2d<u32>;
#endif
@group(0) @binding(6) var samples_previous: texture_2d<u32>;
@group(0) @binding(7) var samples_out: texture_storage_2d<rgba32uint, write>;

// Candidates that are tried per stratum. A fourth one finds something in fewer than 1 % of the strata of a moving image.
const CANDIDATES = 3u;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var record = vec4(0u);
    if frame.continued != 0u {
        // Steps of 4 visit all nine places before they repeat one, because 4 and 9 have no common divisor.
        let first = (hash(id.x ^ hash(id.y ^ hash(frame.seed))) % 9u + 4u * (frame.index % 9u)) % 9u;
        for (var k = 0u; k < CANDIDATES; k++) {
            let place = first + k - select(0u, 9u, first + k >= 9u);
            let pixel = sample_pixel(vec4(place + 1u), stratum);
            if !inside(pixel) {
                continue;
            }
            let g = textureLoad(guide, pixel, 0).xy;
            let depth = bitcast<f32>(g.y);
            if depth <= 0.0 {
                continue;
            }
            let m = unpack_motion(textureLoad(motion, pixel, 0).xy);
            let previous = vec2<i32>(floor(vec2<f32>(pixel) + 0.5 + m.xy));
            if !inside(previous) {
                continue;
            }
#ifdef OBJECTS
            let here = textureLoad(object, pixel, 0).x;
            let there = textureLoad(object_previous, previous, 0).x;
#else
            let here = 0u;
            let there = 0u;
#endif
            let origin = origin_of(vec2<f32>(pixel), m, unpack_normal(g.x), here);
            if !same_surface(origin, previous, textureLoad(guide_previous, previous, 0).xy, there) {
                continue;
            }
            if is_sample_pixel(textureLoad(samples_previous, stratum_of(vec2<u32>(previous)), 0), vec2<u32>(previous)) {
                continue;
            }
            record = vec4(place + 1u, u32(previous.x) | (u32(previous.y) << 16u), g);
            break;
        }
    }
    textureStore(samples_out, stratum, record);
}
