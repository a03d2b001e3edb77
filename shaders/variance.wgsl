// What the spatial filter starts from: the history's colour and how uncertain it is. While a pixel's history is short its own
// variance means little: it is estimated from the neighbours instead (Schied et al. 2017, §4.2).

#import asvgf::frame::{frame, inside}
#import asvgf::color::luminance
#import asvgf::history::{history_color, history_variance, history_length}
#import asvgf::packing::{unpack_normal, pack_tap}
#ifdef FEEDBACK
#import asvgf::packing::unpack_rgb
#endif
#import asvgf::edge_stop::{falloff, Plane, tangent_plane, plane_distance}

@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var history: texture_2d<u32>;
#ifdef FEEDBACK
@group(0) @binding(3) var feedback: texture_2d<u32>;
#endif
@group(0) @binding(4) var color_out: texture_storage_2d<rg32uint, write>;

// History length below which the variance is a spatial one.
const SHORT: f32 = 4.0;

// Falls off with the distance from the plane in 2 % of the depth, and with 64·(1 − n·n').
fn weight(plane: Plane, normal: vec3<f32>, offset: vec2<i32>, g: vec2<u32>) -> f32 {
    let depth = bitcast<f32>(g.y);
    if depth <= 0.0 {
        return 0.0;
    }
    let exponent = plane_distance(plane, vec2<f32>(offset), depth) / (0.02 * plane.depth)
        + 64.0 * (1.0 - dot(normal, unpack_normal(g.x)));
    return falloff(exponent);
}

fn mean_luminance(h: vec2<u32>) -> f32 {
#ifdef FEEDBACK
    return history_color(h).x;
#else
    return luminance(history_color(h));
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let h = textureLoad(history, pixel, 0).xy;
    // 0 where nothing was hit.
    let length = history_length(h);
    let short = length > 0.0 && length < SHORT;
    let g = textureLoad(guide, pixel, 0).xy;
    let normal = unpack_normal(g.x);
    let plane = tangent_plane(vec2<f32>(pixel), normal, bitcast<f32>(g.y));
    let center = mean_luminance(h);
    // Moments over 7×7 about the centre's mean.
    var first = 0.0;
    var second = 0.0;
    var weights = 0.0;
    // One loop, which is not unrolled: a software adapter executes a branch either way, but a loop of no invocation once.
    let taps = select(0, 49, short);
    for (var i = 0; i < taps; i++) {
        // i / 7 for i < 49.
        let row = (i * 37) >> 8u;
        let offset = vec2(i - 7 * row, row) - 3;
        let tap = pixel + offset;
        let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
        let there = weight(plane, normal, offset, textureLoad(guide, clamped, 0).xy);
        let w = select(0.0, there, inside(tap));
        let other = textureLoad(history, clamped, 0).xy;
        let d = mean_luminance(other) - center;
        first += w * d;
        second += w * (history_variance(other) + d * d);
        weights += w;
    }
    let mean = first / max(weights, 1e-6);
    // The fewer frames there are, the less the neighbours know either.
    let spatial = max(second / max(weights, 1e-6) - mean * mean, 0.0) * max(1.0, SHORT / max(length, 1.0));
#ifdef VARIANCE_OF_MEAN
    // Bessel's correction while it matters, then the variance of a mean of n.
    let own = history_variance(h) * select(1.0, length / max(length - 1.0, 0.5), length < 8.0);
    let variance = mix(spatial, own, clamp((length - 1.0) / (SHORT - 1.0), 0.0, 1.0)) / max(length, 1.0);
#else
    let variance = select(history_variance(h), spatial, short);
#endif
#ifdef FEEDBACK
    let color = unpack_rgb(textureLoad(feedback, pixel, 0).xy);
#else
    let color = history_color(h);
#endif
    textureStore(color_out, pixel, vec4(select(vec2(0u), pack_tap(color, sqrt(variance)), length > 0.0), 0u, 0u));
}
