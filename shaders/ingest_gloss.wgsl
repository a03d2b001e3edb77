// Turns a host's roughness, specular reflectance, and distances of reflected things into the filter's own image.

#import asvgf::frame::inside
#import asvgf::color::{is_finite, luminance, sanitize}
#import asvgf::gloss::pack_gloss
#ifdef HIT_DISTANCE
#import asvgf::ray::SKY
#endif

@group(0) @binding(1) var guide: texture_2d<u32>;
#ifdef ROUGHNESS
@group(0) @binding(2) var roughness: texture_2d<f32>;
#endif
#ifdef HIT_DISTANCE
@group(0) @binding(3) var hit_distance: texture_2d<f32>;
#endif
#ifdef REFLECTANCE
@group(0) @binding(4) var reflectance: texture_2d<f32>;
#endif
#ifdef ALBEDO
@group(0) @binding(5) var albedo: texture_2d<f32>;
#endif
#ifdef OBJECTS
@group(0) @binding(7) var object: texture_2d<u32>;
#endif
// The gloss, and the number of the object.
@group(0) @binding(6) var gloss_out: texture_storage_2d<rg32uint, write>;

fn object_at(pixel: vec2<i32>) -> u32 {
#ifdef OBJECTS
    return textureLoad(object, pixel, 0).x;
#else
    return 0u;
#endif
}

// Roughness of a surface of which none is known: that of a plastic.
const UNKNOWN_ROUGHNESS: f32 = 0.35;

// Specular part of the reflectance of a surface of which none is known.
const UNKNOWN_PART: f32 = 0.5;

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let pixel = vec2<i32>(id.xy);
    var r = UNKNOWN_ROUGHNESS;
#ifdef ROUGHNESS
#ifdef ROUGHNESS_IN_ALPHA
    let given = textureLoad(roughness, pixel, 0).w;
#else
    let given = textureLoad(roughness, pixel, 0).x;
#endif
    r = select(UNKNOWN_ROUGHNESS, clamp(given, 0.0, 1.0), is_finite(given));
#endif
    var distance = 0.0;
#ifdef HIT_DISTANCE
    // 0, negative and NaN say that it is unknown; +∞ is the sky. (A comparison with NaN is false.)
    let hit = textureLoad(hit_distance, pixel, 0).x;
    distance = select(0.0, min(hit, SKY), hit > 0.0);
#endif
    var shines = true;
    var part = UNKNOWN_PART;
#ifdef REFLECTANCE
    // Failure: a pixel whose reflectance was no number in one channel shone thrice as bright, and dimmed those around. Reason: light is
    // divided by nothing there, and was filtered with light that is divided by a reflectance. Rule: such a pixel has no specular lobe.
    let reflecting = textureLoad(reflectance, pixel, 0).xyz;
    let known = is_finite(reflecting.x) && is_finite(reflecting.y) && is_finite(reflecting.z);
    let specular = luminance(sanitize(reflecting));
    shines = specular > 0.0 && known;
    part = min(specular, 1.0);
#ifdef ALBEDO
    part = specular / max(specular + luminance(sanitize(textureLoad(albedo, pixel, 0).xyz)), 1e-6);
#endif
#endif
#ifndef MIXED_GLOSS
    part = 1.0;
#endif
    let seen = textureLoad(guide, pixel, 0).y != 0u;
    let gloss = select(0u, pack_gloss(r, distance, part), shines && seen);
    textureStore(gloss_out, pixel, vec4(gloss, object_at(pixel), 0u, 0u));
}
