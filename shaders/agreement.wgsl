// Compares, in each stratum, the new samples with the two histories that a reflection may have: at the reflection's former place (V) and
// at the surface's (S), see specular_history.wgsl. Both are read at the nearest pixel, because nine pixels together make up for that.

#import asvgf::frame::{frame, inside}
#import asvgf::color::luminance
#import asvgf::history_taps::{TapSum, add_tap, motion_of, mean_of, origin_at, reflection_at}
#import asvgf::packing::{unpack_normal, unpack_rgb}
#import asvgf::reproject::{SAME_NORMAL, in_mirror}
#import asvgf::sample::sample_at
#import asvgf::evidence::{Evidence, pack_evidence}
#import asvgf::strata::{pixel_at, place_from_center}
#ifdef MISSING_SAMPLES
#import asvgf::packing::is_sample
#endif

@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(9) var agreement_out: texture_storage_2d<rg32uint, write>;

// Variance that a comparison allows beside the samples' own: 1 % of the squares, and a little for darkness.
const ALLOWED: f32 = 0.01;
const DARK: f32 = 1e-5;

// Pixels between the two places below which they are one.
const APART: f32 = 0.1;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var sums = vec2(0.0);
    var reference = 0u;
    var normal = vec3(0.0);
    var exists = false;
    let first = select(0u, 9u, frame.continued == 0u);
    for (var k = first; k < 9u; k++) {
        let pixel = pixel_at(place_from_center(k), stratum);
        if !inside(pixel) {
            continue;
        }
        let g = textureLoad(guide, pixel, 0).xy;
        let depth = bitcast<f32>(g.y);
        if depth <= 0.0 {
            continue;
        }
        let n = unpack_normal(g.x);
        if exists && dot(normal, n) < SAME_NORMAL {
            continue;
        }
        let moved = motion_of(pixel, depth);
        let reflection = reflection_at(pixel);
        if !reflection.exists || distance(moved.xy, reflection.motion) < APART {
            continue;
        }
        let arrived = sample_at(pixel, true);
#ifdef MISSING_SAMPLES
        if !is_sample(arrived) {
            continue;
        }
#endif
        let origin = origin_at(pixel, moved, n);
        var surface = TapSum();
        add_tap(&surface, origin, vec2<i32>(floor(vec2<f32>(pixel) + moved.xy + 0.5)), 1.0);
        var reflected = TapSum();
        add_tap(&reflected, in_mirror(origin), vec2<i32>(floor(vec2<f32>(pixel) + reflection.motion + 0.5)), 1.0);
        let s = mean_of(surface);
        let v = mean_of(reflected);
        if s.weight <= 0.0 || v.weight <= 0.0 {
            continue;
        }
        if !exists {
            exists = true;
            reference = g.x;
            normal = n;
        }
        let a = v.mean;
        let b = s.mean;
        let e = luminance(unpack_rgb(arrived));
        let variance = 0.5 * (v.variance + s.variance) + ALLOWED * (a * a + b * b) + DARK;
        let difference = (a - b) / variance;
        sums += vec2(difference * (e - 0.5 * (a + b)), difference * (a - b));
    }
    textureStore(agreement_out, stratum, vec4(pack_evidence(Evidence(sums, reference, exists)), 0u, 0u));
}
