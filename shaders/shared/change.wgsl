#define_import_path asvgf::change

// The change of the light on a pixel's surface, from the gradient of the strata around it.

#import asvgf::frame::{frame, sample_point, seen_position, scale_at}
#import asvgf::edge_stop::falloff
#import asvgf::strata_filter::{PLANE, geometric_exponent, in_grid, site}

@group(0) @binding(20) var samples: texture_2d<u32>;
@group(0) @binding(21) var gradient: texture_2d<u32>;
#ifdef HISTORY_RATIO
@group(0) @binding(22) var ratio: texture_2d<u32>;
#endif

struct Change {
    ratio: vec4<f32>,
    lambda: f32,
}

// Weighted sums over strata.
struct StratumSum {
    // ρ − 1, so that a ratio of exactly 1 stays so.
    ratio: vec4<f32>,
    weight: f32,
    // Numerator and denominator of λ, on the pixel's surface.
    gradient: vec2<f32>,
#ifdef ACROSS_SURFACES
    // The same on any surface.
    around: vec2<f32>,
#endif
}

// Least weight of each factor of the bilinear tent: in the search of 4×4 strata, those outside of the tent count this much.
const LEAST_TENT: f32 = 0.05;

fn add_stratum(
    sum: ptr<function, StratumSum>,
    stratum: vec2<i32>,
    grid: vec2<f32>,
    here: vec3<f32>,
    normal: vec3<f32>,
    depth: f32,
) {
    let clamped = clamp(stratum, vec2(0), vec2<i32>(frame.strata) - 1);
    let record = textureLoad(samples, clamped, 0);
    let s = site(record, clamped);
    let exponent = geometric_exponent(normal, s.position - here, s.normal, PLANE * scale_at(frame.camera, depth));
    let tent = max(vec2(LEAST_TENT), 1.0 - abs(grid - vec2<f32>(stratum)));
    let near = select(0.0, tent.x * tent.y, in_grid(stratum) && record.x != 0u);
    let w = near * falloff(exponent);
    let g = bitcast<vec4<f32>>(textureLoad(gradient, clamped, 0));
    (*sum).gradient += w * g.xy;
#ifdef ACROSS_SURFACES
    (*sum).around += near * g.zw;
#endif
    (*sum).weight += w;
#ifdef HISTORY_RATIO
    (*sum).ratio += w * (bitcast<vec4<f32>>(textureLoad(ratio, clamped, 0)) - 1.0);
#endif
}

// Strata of the search, 4×4, and the sum of weights up to which the nearest four strata show nothing of the pixel's surface.
const SEARCH: i32 = 16;
const LEAST_WEIGHT: f32 = 1e-4;

// λ and ρ from the strata around a pixel on its surface: the nearest four (bilinear), or the 4×4 if none of the four is on it.
//
// With ACROSS_SURFACES, λ is at least a + a³, where a is λ from all paths around, on whatever surface. Failure: on a thin pillar, a
// change of indirect light stayed for a whole history. Reason: the pillar has few paths of its own, and these missed it, because
// one path in twenty, say, finds such light. Rule: paths on other surfaces count too.
fn change_at(pixel: vec2<i32>, normal: vec3<f32>, depth: f32, seen: bool) -> Change {
    let here = seen_position(frame.camera, sample_point(frame.camera, vec2<f32>(pixel)), depth);
    let grid = (vec2<f32>(pixel) + 0.5) / 3.0 - 0.5;
    let base = vec2<i32>(floor(grid));
    var sum = StratumSum();
    for (var i = 0; i < 4; i++) {
        add_stratum(&sum, base + vec2(i & 1, i >> 1u), grid, here, normal, depth);
    }
    // A loop of length 0 elsewhere, and not a branch, because a software adapter executes a branch either way.
    let searched = select(0, SEARCH, seen && sum.weight <= LEAST_WEIGHT);
    if searched > 0 {
        sum = StratumSum();
    }
    for (var i = 0; i < searched; i++) {
        add_stratum(&sum, base + vec2(i & 3, i >> 2u) - 1, grid, here, normal, depth);
    }
    let scale = select(0.0, 1.0 / sum.weight, sum.weight > 0.0);
    var lambda = abs(sum.gradient.x) / max(sum.gradient.y, 1e-37);
#ifdef ACROSS_SURFACES
    let around = abs(sum.around.x) / max(sum.around.y, 1e-37);
    // a + a³: the mean over paths that saw the change and paths that could not is too low, the more so the greater it is. The cube
    // makes up for it.
    lambda = max(lambda, around + around * around * around);
#endif
    // λ exceeds 1 by no ulp, because (1 − λ)^k would then be NaN.
    return Change(1.0 + sum.ratio * scale, clamp(lambda - frame.dead_zone, 0.0, 1.0));
}
