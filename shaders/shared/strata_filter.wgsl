#define_import_path asvgf::strata_filter

#import asvgf::frame::{frame, seen_position, sample_point, scale_at}
#import asvgf::packing::unpack_normal
#import asvgf::edge_stop::falloff
#import asvgf::strata::sample_pixel

// The surface point of a stratum's sample, from its record.
struct Site {
    position: vec3<f32>,
    normal: vec3<f32>,
    depth: f32,
}

fn site(record: vec4<u32>, stratum: vec2<i32>) -> Site {
    let depth = bitcast<f32>(record.w);
    let point = sample_point(frame.camera, vec2<f32>(sample_pixel(record, stratum)));
    return Site(seen_position(frame.camera, point, depth), unpack_normal(record.z), depth);
}

// Factor on 1 − n·n′: e^(−32·(1 − n·n′)) is about (n·n′)³². It is the default of `FilterSettings::sigma_normal` too.
const NORMAL_SHARPNESS: f32 = 32.0;

// Exponent of the geometric weight between strata, and between a pixel and a stratum: the distance from the plane in units of
// `reach`, and the angle of the normals.
fn geometric_exponent(normal: vec3<f32>, offset: vec3<f32>, other_normal: vec3<f32>, reach: f32) -> f32 {
    return abs(dot(normal, offset)) / reach + NORMAL_SHARPNESS * (1.0 - dot(normal, other_normal));
}

// Tolerated distance from the tangent plane, in parts of the depth.
const PLANE: f32 = 0.02;

// A tent on 3×3 taps: 4 at the centre, 2 beside it, 1 at the corners.
fn tent(offset: vec2<i32>) -> f32 {
    return f32((2 - abs(offset.x)) * (2 - abs(offset.y)));
}

// Weight of one tap of the à-trous filter on the strata grid: the tent times the geometric weight.
fn tap_weight(center: Site, other: Site, offset: vec2<i32>, stride: i32) -> f32 {
    let exponent = geometric_exponent(
        center.normal,
        other.position - center.position,
        other.normal,
        PLANE * scale_at(frame.camera, center.depth) * f32(stride),
    );
    return tent(offset) * falloff(exponent);
}

fn in_grid(stratum: vec2<i32>) -> bool {
    return all(vec2<u32>(stratum) < frame.strata);
}
