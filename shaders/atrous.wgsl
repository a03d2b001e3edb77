// One iteration of the edge-stopping à-trous wavelet filter (Dammertz et al. 2010) with variance-guided luminance weights (Schied
// et al. 2017):
//
//   l̂(p) = Σ h·w·l(q) / Σ h·w   over taps q that are `stride` pixels apart
//
// Taps are written out one by one and without branches. On a software adapter a loop costs 40 % more, and a branch is executed
// either way.

#import asvgf::frame::{frame, inside, scale_at}
#import asvgf::color::luminance
#import asvgf::packing::{unpack_normal, unpack_normal_511, pack_rgb, pack_tap, tap_color, tap_variance}
#ifdef SPECULAR_SIGNAL
#import asvgf::gloss::{guide_roughness, lobe_width, unpack_reflection}
#endif
#import asvgf::edge_stop::{falloff, Plane, facing, tangent_plane, plane_distance, foreshortening}

@group(0) @binding(1) var<uniform> stride: i32;
// `guide`: normal and depth. `color`: demodulated radiance and the deviation of its luminance.
#ifdef STORAGE_READS
@group(0) @binding(2) var guide: texture_storage_2d<rg32uint, read>;
@group(0) @binding(3) var color: texture_storage_2d<rg32uint, read>;
#else
@group(0) @binding(2) var guide: texture_2d<u32>;
@group(0) @binding(3) var color: texture_2d<u32>;
#endif
@group(0) @binding(5) var color_out: texture_storage_2d<rg32uint, write>;
#ifdef SPECULAR_SIGNAL
// The distance of what is reflected.
@group(0) @binding(4) var reflection: texture_2d<u32>;
#endif
#ifdef FEEDBACK
// The colour of the next frame's history.
@group(0) @binding(6) var feedback_out: texture_storage_2d<rg32uint, write>;
#endif

struct Center {
    // The tangent plane, its slopes in units of the tolerated distance.
    plane: Plane,
    // The normal over 511, to match `unpack_normal_511`.
    normal: vec3<f32>,
    // Luminance.
    own: f32,
    // Variance of the luminance; with CLASSIC_STOPS, the factor on a difference of luminances.
    variance: f32,
    // Depth gradient per stride, for the classic depth stop.
    depth_gradient: vec2<f32>,
#ifdef SPECULAR_SIGNAL
    roughness: f32,
    // Exponent of the footprint's stop at a distance of one stride.
    footprint: f32,
#endif
}

struct Sums {
    color: vec3<f32>,
    weight: f32,
    variance: f32,
#ifdef LOCAL_LINEAR_FIT
    // Σw·x, Σw·y; Σw·x², Σw·x·y, Σw·y²; Σw·x·colour, Σw·y·colour; x and y in strides.
    offset: vec2<f32>,
    spread: vec3<f32>,
    color_x: vec3<f32>,
    color_y: vec3<f32>,
#ifdef RIDGE_BY_NOISE
    // Σw²·V·x, Σw²·V·y, Σw²·V·(x² + y²)
    variance_offset: vec2<f32>,
    variance_spread: f32,
#endif
#endif
}

struct Tap {
    color: vec2<u32>,
    normal: u32,
    depth: f32,
#ifdef SPECULAR_SIGNAL
    roughness: f32,
#endif
}

fn tap_at(pixel: vec2<i32>) -> Tap {
#ifdef STORAGE_READS
    let g = textureLoad(guide, pixel).xy;
    let c = textureLoad(color, pixel).xy;
#else
    let g = textureLoad(guide, pixel, 0).xy;
    let c = textureLoad(color, pixel, 0).xy;
#endif
#ifdef SPECULAR_SIGNAL
    return Tap(c, g.x, bitcast<f32>(g.y), guide_roughness(g));
#else
    return Tap(c, g.x, bitcast<f32>(g.y));
#endif
}

// Reads a tap. Outside the image its depth is 0, so that there is no surface.
fn load(pixel: vec2<i32>, offset: vec2<i32>) -> Tap {
    let place = pixel + offset * stride;
    var tap = tap_at(place);
    tap.depth = select(0.0, tap.depth, inside(place));
    return tap;
}

#ifdef CLASSIC_STOPS
// ε of the classic depth stop, in parts of the depth: the distance that a surface seen face on (∇z = 0) is allowed.
const CLASSIC_DEPTH: f32 = 1e-3;
#endif

#ifdef SPECULAR_SIGNAL
// Difference of roughnesses at which the stop has an exponent of 1.
const ROUGHNESS_TOLERANCE: f32 = 0.05;

// Deviation of the footprint's stop, in widths of the reflection, and the least one in pixels. (Docs: below three widths the error grows
// up to fivefold.)
const FOOTPRINT: f32 = 2.0;
const LEAST_FOOTPRINT: f32 = 2.0;

// Exponent of the footprint's stop at a distance of one stride.
fn footprint(pixel: vec2<i32>, roughness: f32, depth: f32) -> f32 {
    let hit_distance = unpack_reflection(textureLoad(reflection, pixel, 0).xy).hit_distance;
    let width = FOOTPRINT * lobe_width(roughness, hit_distance, depth);
    let deviation = max(width, LEAST_FOOTPRINT) / f32(stride);
    return 0.5 / (deviation * deviation);
}

// Exponent of the stops that only specular light has: other roughness, and farther away than the lobe reaches.
fn gloss_stop(c: Center, tap: Tap, offset: vec2<i32>) -> f32 {
    let apart = (tap.roughness - c.roughness) / ROUGHNESS_TOLERANCE;
    return apart * apart + c.footprint * f32(offset.x * offset.x + offset.y * offset.y);
}
#endif

// Adds a tap, weighted by the kernel and the stops. `slant` is the exponent of the foreshortening stop in the tap's direction.
fn add_tap(sums: ptr<function, Sums>, c: Center, tap: Tap, offset: vec2<i32>, kernel: f32, slant: f32) {
    let depth = tap.depth;
    let sample = tap_color(tap.color);
    let sample_variance = tap_variance(tap.color);
    let cosine = dot(c.normal, unpack_normal_511(tap.normal));
    let difference = luminance(sample) - c.own;
#ifdef CLASSIC_STOPS
    // The stops of Schied et al. 2017 (§4.4), as Basci 2025 has them. ∇z is that of the tangent plane, exact where differences of
    // neighbours are not.
    let slope = abs(dot(c.depth_gradient, vec2<f32>(offset))) * frame.sigma_depth + CLASSIC_DEPTH * c.plane.depth;
#ifdef SPECULAR_SIGNAL
    let exponent = abs(depth - c.plane.depth) / slope + abs(difference) * c.variance + gloss_stop(c, tap, offset);
#else
    let exponent = abs(depth - c.plane.depth) / slope + abs(difference) * c.variance;
#endif
    // The cosine's base is above 0: pow(0, 0) may be anything, but σ = 0 shall stop nothing.
    let w = kernel * pow(clamp(cosine, 1e-9, 1.0), frame.sigma_normal) * exp(-exponent);
#else
    // The squared difference less the noise that both ends are known to have leaves the signal.
    let noise = c.variance + sample_variance;
    let excess = difference * difference - (c.variance + min(c.variance, sample_variance));
#ifdef SPECULAR_SIGNAL
    let exponent = slant + plane_distance(c.plane, vec2<f32>(offset), depth) + frame.sigma_normal * (1.0 - cosine)
        + max(excess, 0.0) / (frame.gloss_sigma_luminance * noise + 1e-37) + gloss_stop(c, tap, offset);
#else
    let exponent = slant + plane_distance(c.plane, vec2<f32>(offset), depth) + frame.sigma_normal * (1.0 - cosine)
        + max(excess, 0.0) / (frame.sigma_luminance * noise + 1e-37);
#endif
    let w = kernel * falloff(exponent);
#endif
    let weight = select(0.0, w, depth > 0.0);
    (*sums).color += weight * sample;
    (*sums).weight += weight;
    // Var(Σw·x / Σw) = Σw²·Var(x) / (Σw)² for independent x.
    (*sums).variance += weight * weight * sample_variance;
#ifdef LOCAL_LINEAR_FIT
    let xy = vec2<f32>(offset);
    (*sums).offset += weight * xy;
    (*sums).spread += weight * vec3(xy.x * xy.x, xy.x * xy.y, xy.y * xy.y);
    (*sums).color_x += (weight * xy.x) * sample;
    (*sums).color_y += (weight * xy.y) * sample;
#ifdef RIDGE_BY_NOISE
    let of_variance = weight * weight * sample_variance;
    (*sums).variance_offset += of_variance * xy;
    (*sums).variance_spread += of_variance * dot(xy, xy);
#endif
#endif
}

#ifdef LOCAL_LINEAR_FIT
#ifdef RIDGE_BY_NOISE
// Limits of the ridge, as factors on `frame.ridge`. Below the lower one the plane follows noise of which the taps' variances say
// nothing; above the upper one it is the mean.
const RIDGE_LEAST: f32 = 0.5;
const RIDGE_MOST: f32 = 8.0;
#endif

// Determinant of the normal equations up to which the taps lie on a line and define no plane. The ridge alone makes it ridge².
const NO_PLANE: f32 = 1e-6;

// The fitted value stays within these factors of the mean.
const FIT_LEAST: f32 = 0.5;
const FIT_MOST: f32 = 1.5;

// Value at the centre of the plane that fits the taps best (weighted least squares), with a ridge on its slopes. Failure: a
// weighted mean lags behind on a slope wherever its taps are lopsided, at borders and penumbrae. Reason: their centre of gravity is
// not the pixel. Rule: fit a plane.
fn fit(sums: Sums) -> vec3<f32> {
    let scale = 1.0 / sums.weight;
    let mean = sums.color * scale;
    let m = sums.offset * scale;
    let x = sums.color_x * scale - m.x * mean;
    let y = sums.color_y * scale - m.y * mean;
    var ridge = frame.ridge;
#ifdef RIDGE_BY_NOISE
    // The plane shall follow a slope a only where that exceeds its own noise, so the ridge grows with V(a)/|a|².
    let noise = (sums.variance_spread - 2.0 * dot(m, sums.variance_offset) + dot(m, m) * sums.variance) * scale * scale;
    let slope = vec2(luminance(x), luminance(y));
    ridge *= clamp(frame.ridge_noise * max(noise, 0.0) / (dot(slope, slope) + 1e-37), RIDGE_LEAST, RIDGE_MOST);
#endif
    let xx = sums.spread.x * scale - m.x * m.x + ridge;
    let xy = sums.spread.y * scale - m.x * m.y;
    let yy = sums.spread.z * scale - m.y * m.y + ridge;
    let determinant = xx * yy - xy * xy;
    if determinant <= NO_PLANE {
        return mean;
    }
    let value = mean - (m.x * (yy * x - xy * y) + m.y * (xx * y - xy * x)) / determinant;
    return clamp(value, FIT_LEAST * mean, FIT_MOST * mean);
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let own = tap_at(pixel);
    let depth = own.depth;
    let west = load(pixel, vec2(-1, 0));
    let east = load(pixel, vec2(1, 0));
    let north = load(pixel, vec2(0, -1));
    let south = load(pixel, vec2(0, 1));
    let north_west = load(pixel, vec2(-1, -1));
    let north_east = load(pixel, vec2(1, -1));
    let south_west = load(pixel, vec2(-1, 1));
    let south_east = load(pixel, vec2(1, 1));
    let own_color = tap_color(own.color);
    let own_variance = tap_variance(own.color);
#ifdef FIRST_ITERATION
    // 3×3 Gaussian (Schied et al. 2017, §4.4): one pixel's variance is itself a noisy estimate. Later iterations have averaged it
    // already.
    let edges = vec4(
        tap_variance(west.color), tap_variance(east.color), tap_variance(north.color), tap_variance(south.color));
    let corners = vec4(
        tap_variance(north_west.color), tap_variance(north_east.color), tap_variance(south_west.color), tap_variance(south_east.color));
    let edges_exist = vec4<f32>(vec4(west.depth, east.depth, north.depth, south.depth) > vec4(0.0));
    let corner_depths = vec4(north_west.depth, north_east.depth, south_west.depth, south_east.depth);
    let corners_exist = vec4<f32>(corner_depths > vec4(0.0));
    let variance = (4.0 * own_variance + 2.0 * dot(edges, edges_exist) + dot(corners, corners_exist))
        / (4.0 + 2.0 * dot(edges_exist, vec4(1.0)) + dot(corners_exist, vec4(1.0)));
#else
    let variance = own_variance;
#endif
    let own_luminance = luminance(own_color);
    // A filter blurs by about as much as the noise that it is told of. Below `frame.converged` that does more harm than good, so
    // the pixel stays as it is.
    let converged = variance <= frame.converged * frame.converged * own_luminance * own_luminance;
#ifndef STORAGE_READS
    // Tiles of sky, and of pixels that have converged, skip their taps. A CPU executes both sides of a branch, so it has none.
    if converged || depth <= 0.0 {
        store(pixel, own_color, sqrt(own_variance), depth > 0.0);
        return;
    }
#endif
    let normal = unpack_normal(own.normal);
    var plane = tangent_plane(vec2<f32>(pixel), normal, depth);
#ifdef CLASSIC_STOPS
    let gradient = -depth * plane.slope.yz / facing(plane);
    let slant = vec4(0.0);
#ifdef FULL_KERNEL
    let oblique = vec4(0.0);
#endif
#ifdef SPECULAR_SIGNAL
    let sigma = frame.gloss_sigma_luminance;
#else
    let sigma = frame.sigma_luminance;
#endif
    var c: Center;
    c.variance = 1.0 / (sigma * sqrt(variance) + 1e-6 * own_luminance + 1e-37);
    c.depth_gradient = gradient * f32(stride);
#else
    let slant = frame.sigma_foreshortening * vec4(
        foreshortening(plane, vec2<f32>(pixel), vec2(1.0, 0.0)),
        foreshortening(plane, vec2<f32>(pixel), vec2(0.0, 1.0)),
        foreshortening(plane, vec2<f32>(pixel), vec2(1.0, 1.0)),
        foreshortening(plane, vec2<f32>(pixel), vec2(1.0, -1.0)),
    );
#ifdef FULL_KERNEL
    let oblique = frame.sigma_foreshortening * vec4(
        foreshortening(plane, vec2<f32>(pixel), vec2(2.0, 1.0)),
        foreshortening(plane, vec2<f32>(pixel), vec2(2.0, -1.0)),
        foreshortening(plane, vec2<f32>(pixel), vec2(1.0, 2.0)),
        foreshortening(plane, vec2<f32>(pixel), vec2(1.0, -2.0)),
    );
#endif
    // Slopes per stride, in units of the tolerated distance.
    plane.slope *= vec3(1.0, vec2(f32(stride))) / (frame.sigma_depth * scale_at(frame.camera, depth));
    var c: Center;
    c.variance = variance;
    c.depth_gradient = vec2(0.0);
#endif
    c.plane = plane;
    c.normal = normal * (1.0 / 511.0);
    c.own = own_luminance;
#ifdef SPECULAR_SIGNAL
    c.roughness = own.roughness;
    c.footprint = footprint(pixel, own.roughness, depth);
#endif
    var sums: Sums;
    sums.color = own_color;
    sums.weight = 1.0;
    sums.variance = own_variance;
    // The B₃ spline (1, ⅔, ⅙)², relative to its centre.
    add_tap(&sums, c, west, vec2(-1, 0), 2.0 / 3.0, slant.x);
    add_tap(&sums, c, east, vec2(1, 0), 2.0 / 3.0, slant.x);
    add_tap(&sums, c, north, vec2(0, -1), 2.0 / 3.0, slant.y);
    add_tap(&sums, c, south, vec2(0, 1), 2.0 / 3.0, slant.y);
    add_tap(&sums, c, north_west, vec2(-1, -1), 4.0 / 9.0, slant.z);
    add_tap(&sums, c, north_east, vec2(1, -1), 4.0 / 9.0, slant.w);
    add_tap(&sums, c, south_west, vec2(-1, 1), 4.0 / 9.0, slant.w);
    add_tap(&sums, c, south_east, vec2(1, 1), 4.0 / 9.0, slant.z);
#ifndef SMALL_KERNEL
    add_far_tap(&sums, c, pixel, vec2(-2, 0), 1.0 / 6.0, slant.x);
    add_far_tap(&sums, c, pixel, vec2(2, 0), 1.0 / 6.0, slant.x);
    add_far_tap(&sums, c, pixel, vec2(0, -2), 1.0 / 6.0, slant.y);
    add_far_tap(&sums, c, pixel, vec2(0, 2), 1.0 / 6.0, slant.y);
#endif
#ifdef FULL_KERNEL
    // The diamond of 13 taps above, completed to 5×5.
    add_far_tap(&sums, c, pixel, vec2(-2, -1), 1.0 / 9.0, oblique.x);
    add_far_tap(&sums, c, pixel, vec2(-2, 1), 1.0 / 9.0, oblique.y);
    add_far_tap(&sums, c, pixel, vec2(2, -1), 1.0 / 9.0, oblique.y);
    add_far_tap(&sums, c, pixel, vec2(2, 1), 1.0 / 9.0, oblique.x);
    add_far_tap(&sums, c, pixel, vec2(-1, -2), 1.0 / 9.0, oblique.z);
    add_far_tap(&sums, c, pixel, vec2(1, -2), 1.0 / 9.0, oblique.w);
    add_far_tap(&sums, c, pixel, vec2(-1, 2), 1.0 / 9.0, oblique.w);
    add_far_tap(&sums, c, pixel, vec2(1, 2), 1.0 / 9.0, oblique.z);
    add_far_tap(&sums, c, pixel, vec2(-2, -2), 1.0 / 36.0, slant.z);
    add_far_tap(&sums, c, pixel, vec2(2, -2), 1.0 / 36.0, slant.w);
    add_far_tap(&sums, c, pixel, vec2(-2, 2), 1.0 / 36.0, slant.w);
    add_far_tap(&sums, c, pixel, vec2(2, 2), 1.0 / 36.0, slant.z);
#endif
#ifdef LOCAL_LINEAR_FIT
    let filtered = fit(sums);
#else
    let filtered = sums.color / sums.weight;
#endif
    let deviation = sqrt(sums.variance) / sums.weight;
    store(pixel, select(filtered, own_color, converged), select(deviation, sqrt(own_variance), converged), depth > 0.0);
}

// Stores a pixel. A miss takes the same way as a surface: no pixel filters with it, and its result is not kept.
fn store(pixel: vec2<i32>, color: vec3<f32>, deviation: f32, seen: bool) {
    textureStore(color_out, pixel, vec4(select(vec2(0u), pack_tap(color, deviation), seen), 0u, 0u));
#ifdef FEEDBACK
    textureStore(feedback_out, pixel, vec4(select(vec2(0u), pack_rgb(color), seen), 0u, 0u));
#endif
}

fn add_far_tap(sums: ptr<function, Sums>, c: Center, pixel: vec2<i32>, offset: vec2<i32>, kernel: f32, slant: f32) {
    add_tap(sums, c, load(pixel, offset), offset, kernel, slant);
}
