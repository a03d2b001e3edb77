// Finds where the reflection in each glossy pixel was in the last frame. A reflection does not move with the surface that shows it: it
// moves as if it lay behind the surface.
//
//   h′ = h / (1 + 2·κ·h/cos θ)                distance of the image behind the surface, for a mirror of curvature κ (convex: κ > 0)
//   V = X + h′·d                              the image, seen in direction d through the surface point X
//
// with the distance h from X to what is reflected. (The formula of a thin mirror, 1/h′ = 1/h + 2·κ/cos θ; κ = Σ Δn·Δp/Σ Δp·Δp over
// neighbours.) A concave mirror may show a real image, before itself: h′ < 0.
//
// In the last frame, the surface point was at X′ = X + Δ_X, its normal was n′, and the reflected point was at
// P′ = X + h·(d − 2·(d·n)·n) + Δ_P. The image was at
//
//   V′ = X′ + (h′/h)·(I − 2·n′·n′ᵀ)·(P′ − X′)
//
// which is projected with the last frame's camera. (Where nothing has moved, V′ = V.)
//
// On a curved mirror the place is refined in the last frame's G-buffer: the pixel q is sought at which the normal n is the half vector
// between the reflected point P and the last camera o′, by Gauss–Newton steps on
//
//   r(q) = unit(unit(P − Y) + unit(o′ − Y)) − n(q) = 0,  P = X + h·(d − 2·(d·n)·n)
//
// where Y is the place of the surface at q.

#import asvgf::frame::{frame, inside, is_orthographic, project, ray_direction, sample_point, scale_at, seen_position}
#import asvgf::gloss::{pack_reflection, unpack_gloss}
#import asvgf::ray::SKY
#ifdef INSTANCED
#ifndef STILL
#import asvgf::packing::unpack_displacement
#endif
#endif
#import asvgf::packing::unpack_normal
#ifndef STILL
#ifdef HOST_MOTION
#import asvgf::host_motion::host_motion
#endif
#import asvgf::packing::unpack_motion
#endif
#ifdef REFLECTION_MOTION
#import asvgf::color::is_finite
#endif

#ifdef STORAGE_READS
@group(0) @binding(1) var guide: texture_storage_2d<rg32uint, read>;
@group(0) @binding(2) var gloss: texture_storage_2d<rg32uint, read>;

fn guide_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(guide, pixel).xy;
}

fn gloss_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(gloss, pixel).xy;
}
#else
@group(0) @binding(1) var guide: texture_2d<u32>;
@group(0) @binding(2) var gloss: texture_2d<u32>;

fn guide_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(guide, pixel, 0).xy;
}

fn gloss_at(pixel: vec2<i32>) -> vec2<u32> {
    return textureLoad(gloss, pixel, 0).xy;
}
#endif
#ifndef STILL
#ifndef HOST_MOTION
@group(0) @binding(3) var motion: texture_2d<u32>;
#endif
@group(0) @binding(4) var guide_previous: texture_2d<u32>;
#ifdef OBJECTS
@group(0) @binding(6) var object_previous: texture_2d<u32>;
#endif
#ifdef INSTANCED
// In w the displacement of what each path met.
@group(0) @binding(10) var specular_radiance: texture_2d<u32>;
#endif
#ifdef REFLECTION_MOTION
@group(0) @binding(7) var reflection_motion: texture_2d<f32>;
#endif
#endif
@group(0) @binding(9) var reflection_out: texture_storage_2d<rg32uint, write>;

// Cosine of normals that belong to one curved surface: acos 0.8 is 37°.
const SAME_SURFACE: f32 = 0.8;

// Distance of what is reflected where no path tells, in parts of the depth.
const UNKNOWN_DISTANCE: f32 = 0.5;

// Least part of the differences of normals, squared, that one curvature explains on a round surface. It is 1 on a ball, ½ on a cylinder and
// less where surfaces meet.
const ROUND: f32 = 0.8;

// Facts on a pixel's neighbourhood.
struct Around {
    // Harmonic mean of the distances of what is reflected: near things move most.
    hit_distance: f32,
    curvature: f32,
    // True if the surface is curved alike in all directions.
    is_round: bool,
}

fn around(pixel: vec2<i32>, depth: f32, normal: vec3<f32>, own: u32, exists: bool) -> Around {
    let here = seen_position(frame.camera, sample_point(frame.camera, vec2<f32>(pixel)), depth);
    // Normals are rounded, so neighbours must be a few hundredths of a radian apart in the image.
    let spacing = 1 + i32(frame.size.x >> 9u);
    var inverse = 0.0;
    var known = 0.0;
    var turned = 0.0;
    var apart = 0.0;
    var differences = 0.0;
    let taps = select(0, 25, exists);
    for (var i = 0; i < taps; i++) {
        // (i·13) >> 6 is i / 5 for i < 25.
        let row = (i * 13) >> 6u;
        let tap = pixel + spacing * (vec2(i - 5 * row, row) - 2);
        let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
        let g = guide_at(clamped);
        let n = unpack_normal(g.x);
        let texel = gloss_at(clamped);
        let there = unpack_gloss(texel.x);
        let same = inside(tap) && g.y != 0u && there.exists && texel.y == own && dot(n, normal) >= SAME_SURFACE;
        let p = seen_position(frame.camera, sample_point(frame.camera, vec2<f32>(clamped)), bitcast<f32>(g.y)) - here;
        turned += select(0.0, dot(n - normal, p), same);
        apart += select(0.0, dot(p, p), same);
        differences += select(0.0, dot(n - normal, n - normal), same);
        let told = same && there.hit_distance > 0.0;
        // The sky is at infinity in any unit of length. Its distance is rounded where it is stored.
        inverse += select(0.0, 1.0 / there.hit_distance, told && there.hit_distance < 0.5 * SKY);
        known += select(0.0, 1.0, told);
    }
    let mean = select(SKY, known / inverse, inverse > 0.0);
    let distance = select(UNKNOWN_DISTANCE * scale_at(frame.camera, depth), mean, known > 0.0);
    return Around(distance, select(0.0, turned / apart, apart > 0.0), turned * turned > ROUND * differences * apart);
}

#ifndef STILL
// Least absolute denominator of the thin mirror's formula on a round mirror: a concave one may show its image at infinity, or before itself.
const LEAST_FACTOR: f32 = 0.02;

// Least denominator elsewhere. Failure: a corner's reflections jumped. Reason: where two surfaces meet, their normals look like those of a
// narrow bowl, whose images are before it. Rule: only what is round all over shows images before itself.
const LEAST_FACTOR_ELSEWHERE: f32 = 0.2;

// Least cosine at which the formula is used.
const LEAST_COSINE: f32 = 0.1;

// Pixels between the surface's place and the reflection's up to which the two count as one.
const AS_GOOD_AS_ONE: f32 = 0.01;

// Pixels between the two from which on a curved mirror is searched, and curvature times distance from which on it counts as curved.
const WORTH_A_SEARCH: f32 = 0.1;
const CURVED: f32 = 1e-3;

// Steps of the search, and the longest one in pixels.
const STEPS: i32 = 3;
const LONGEST_STEP: f32 = 2.0;

// Displacement from which on a surface has moved, in parts of the depth: twice the rounding of a former depth.
const MOVED: f32 = 1e-4;

// Difference of normals from which on a surface has turned: two normals of 10 bits differ by as much from rounding alone.
const TURNED: f32 = 0.0035;

// The surface's own motion and former depth.
fn surface_motion(pixel: vec2<i32>, depth: f32) -> vec3<f32> {
#ifdef HOST_MOTION
    return unpack_motion(host_motion(pixel, depth).packed);
#else
    return unpack_motion(textureLoad(motion, pixel, 0).xy);
#endif
}

fn object_before(pixel: vec2<i32>) -> u32 {
#ifdef OBJECTS
    return textureLoad(object_previous, pixel, 0).x;
#else
    return 0u;
#endif
}

// r(q) at a pixel of the last frame, and 1 in w if the mirror is there.
fn residual(tap: vec2<i32>, reflected: vec3<f32>, own: u32) -> vec4<f32> {
    let clamped = clamp(tap, vec2(0), vec2<i32>(frame.size) - 1);
    let g = textureLoad(guide_previous, clamped, 0).xy;
    let there = object_before(clamped);
    let c = frame.previous;
    let place = seen_position(c, sample_point(c, vec2<f32>(clamped)), bitcast<f32>(g.y));
    let to_eye = select(c.offset - place, -c.forward, is_orthographic(c));
    let half_vector = normalize(reflected - place) + normalize(to_eye);
    let exists = inside(tap) && g.y != 0u && there == own;
    return vec4(normalize(half_vector) - unpack_normal(g.x), select(0.0, 1.0, exists));
}

// The place at which the last frame's mirror shows a point, near a first guess: pixels, from the first pixel's centre.
fn search(start: vec2<f32>, reflected: vec3<f32>, own: u32, steps: i32) -> vec2<f32> {
    var q = start;
    var left = steps;
    while left > 0 {
        left -= 1;
        let base = vec2<i32>(floor(q));
        let f = q - vec2<f32>(base);
        let a = residual(base, reflected, own);
        let b = residual(base + vec2(1, 0), reflected, own);
        let c = residual(base + vec2(0, 1), reflected, own);
        let d = residual(base + vec2(1, 1), reflected, own);
        // Value and slopes of the bilinear surface through the four.
        let r = mix(mix(a, b, f.x), mix(c, d, f.x), f.y).xyz;
        let x = mix(b - a, d - c, f.y).xyz;
        let y = mix(c - a, d - b, f.x).xyz;
        let xx = dot(x, x);
        let xy = dot(x, y);
        let yy = dot(y, y);
        let determinant = xx * yy - xy * xy;
        if a.w * b.w * c.w * d.w == 0.0 || determinant < 1e-14 {
            break;
        }
        let step = -vec2(yy * dot(x, r) - xy * dot(y, r), xx * dot(y, r) - xy * dot(x, r)) / determinant;
        q += step * min(1.0, LONGEST_STEP / max(length(step), 1e-9));
    }
    return q;
}

// The normal that a surface had at its former place, in pixels of the last frame: the mean of the four around, if the surface has moved.
// Three of the four are a mean of another place, so at a border the surface counts as not turned. The mean of four that are s apart is off
// by about s² where the surface is curved, so the turn must be larger.
fn former_normal(place: vec2<f32>, normal: vec3<f32>, own: u32, has_moved: bool) -> vec3<f32> {
    let base = vec2<i32>(floor(place));
    let f = place - vec2<f32>(base);
    var sum = vec3(0.0);
    var all_four = has_moved;
    var low = vec3(1.0);
    var high = vec3(-1.0);
    let taps = select(0, 4, has_moved);
    for (var i = 0; i < taps; i++) {
        let offset = vec2(i & 1, i >> 1u);
        let tap = clamp(base + offset, vec2(0), vec2<i32>(frame.size) - 1);
        let g = textureLoad(guide_previous, tap, 0).xy;
        let n = unpack_normal(g.x);
        let same = inside(base + offset) && g.y != 0u && object_before(tap) == own && dot(n, normal) >= SAME_SURFACE;
        let w = mix(vec2(1.0) - f, f, vec2<f32>(offset));
        sum += w.x * w.y * n;
        all_four &= same;
        low = min(low, n);
        high = max(high, n);
    }
    let mean = normalize(select(normal, sum, all_four));
    let spread = distance(low, high);
    return select(normal, mean, distance(mean, normal) > TURNED + spread * spread);
}

// The motion of the reflection, in pixels.
fn reflection_motion_of(pixel: vec2<i32>, depth: f32, normal: vec3<f32>, object: u32, near: Around) -> vec2<f32> {
    let moved = surface_motion(pixel, depth);
    let point = sample_point(frame.camera, vec2<f32>(pixel));
    let here = seen_position(frame.camera, point, depth);
    let d = normalize(ray_direction(frame.camera, point));
    let cosine = abs(dot(d, normal));
    let h = near.hit_distance;
    let nominal = 1.0 + 2.0 * near.curvature * h / max(cosine, LEAST_COSINE);
    let concave = select(max(nominal, LEAST_FACTOR), min(nominal, -LEAST_FACTOR), nominal < 0.0);
    let factor = select(max(nominal, LEAST_FACTOR_ELSEWHERE), concave, near.is_round);
    let was = seen_position(frame.previous, point + moved.xy, moved.z);
    // Failure: reflections on curved mirrors were off by the change of the jitter. Reason: a motion counts without either frame's jitter,
    // but the last frame's G-buffer was sampled with its own. Rule: places in that G-buffer are off by the difference.
    let jitter = vec2(frame.previous.jitter_x - frame.camera.jitter_x, frame.previous.jitter_y - frame.camera.jitter_y);
    let has_moved = distance(was, here) > MOVED * scale_at(frame.camera, depth);
    let turned = former_normal(vec2<f32>(pixel) + moved.xy - jitter, normal, object, has_moved);
#ifdef INSTANCED
    let own = unpack_displacement(textureLoad(specular_radiance, pixel, 0).w);
#else
    let own = vec3(0.0);
#endif
    // Failure: the reflection in a mirror that slid along itself was sought where the mirror had been, although it rests, and one in a
    // mirror that turned was sought at half its way. Reason: an image does not move with the mirror. Rule: the reflected point is mirrored
    // anew, by the mirror of the last frame.
    let reflected = here + h * (d - 2.0 * dot(d, normal) * normal) + own;
    let seen = reflected - was;
    let image = was + (seen - 2.0 * dot(seen, turned) * turned) / factor;
    let before = project(frame.previous, image);
    // The image may lie behind the eye, on the other side of the same line.
    let side = dot(here + d * (h / factor), frame.camera.forward);
    let visible = is_orthographic(frame.camera) || before.z * side > 0.0;
    var shift = before.xy - point;
    let is_curved = abs(near.curvature) * h > CURVED;
    let steps = select(0, STEPS, visible && is_curved && distance(shift, moved.xy) > WORTH_A_SEARCH);
    let start = vec2<f32>(pixel) + shift - jitter;
    shift += search(start, reflected, object, steps) - start;
#ifdef REFLECTION_MOTION
    let given = textureLoad(reflection_motion, pixel, 0).xy;
    shift = select(shift, given, is_finite(given.x) && is_finite(given.y));
#endif
    // Beside a still surface's own motion, rounding counts for nothing.
    let apart = distance(shift, moved.xy);
    return select(shift, moved.xy, !visible || !(apart > AS_GOOD_AS_ONE));
}
#endif

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    let g = guide_at(pixel);
    let own = gloss_at(pixel);
    let code = own.x & 0xffu;
    let exists = code != 0u && g.y != 0u && inside(pixel);
    let depth = bitcast<f32>(g.y);
    let normal = normalize(unpack_normal(g.x));
    let near = around(pixel, depth, normal, own.y, exists);
#ifdef STILL
    let shift = vec2(0.0);
#else
    let shift = reflection_motion_of(pixel, depth, normal, own.y, near);
#endif
    let packed = pack_reflection(shift, near.hit_distance, code);
    textureStore(reflection_out, pixel, vec4(select(vec2(0u), packed, exists), 0u, 0u));
}
