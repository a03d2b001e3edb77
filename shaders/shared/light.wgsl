#define_import_path asvgf::light

#import asvgf::scene::{scene, load_light, Light}
#ifdef ENVIRONMENT_LIGHT
#import asvgf::scene::{environment, environment_table}
#import asvgf::packing::unpack_rgb
#import asvgf::random::hash
#endif
#import asvgf::surface::{Visible, Triangle, triangle_now, at, rounding_error}
#import asvgf::color::luminance
#import asvgf::ggx::PI
#import asvgf::material::surface_at
#ifdef ALPHA_MASK
#import asvgf::texture::emitting_part
#endif
#ifdef EMITTER_PIECES
#import asvgf::emitter_pieces::{sample_piece, piece_density}
#endif

// Light kinds, as in src/scene/gpu/light/record.rs.
const EMITTER: u32 = 0u;
const POINT: u32 = 1u;
const DIRECTIONAL: u32 = 2u;
const ENVIRONMENT: u32 = 3u;

// Part of the way to a light that has to be free: all but a part in 10⁴, so that the light does not shadow itself.
const FREE_PART: f32 = 0.9999;

// Stands for the distance of a light at infinity.
const AT_INFINITY: f32 = 1e30;

// A sampled way from a surface to a light.
struct LightSample {
    // Unit direction towards the light.
    direction: vec3<f32>,
    // Distance of the light.
    distance: f32,
    // Distance that a ray may go without meeting the light itself.
    reach: f32,
    // Radiance (or intensity over squared distance) that arrives.
    radiance: vec3<f32>,
    // Solid-angle density, the choice of the light included; for a light without area, the probability of the choice alone.
    density: f32,
    // True if a scattered ray could have found this light.
    has_area: bool,
}

// Chooses a light. The choice depends on `u` and the table alone, and the table on nominal, not momentary, intensities. So a light
// that is switched leaves every other light's random numbers, and with them its gradient, as they were.
fn choose_light(u: f32) -> u32 {
    let scaled = u * f32(scene.light_count);
    let entry = min(u32(scaled), scene.light_count - 1u);
    let light = load_light(entry);
    return select(light.alias_index, entry, scaled - f32(entry) < light.threshold);
}

#ifdef ENVIRONMENT_LIGHT
fn environment_texel(direction: vec3<f32>) -> vec2<u32> {
    let u = 0.5 + atan2(direction.z, direction.x) / (2.0 * PI);
    let v = acos(clamp(direction.y, -1.0, 1.0)) / PI;
    let x = min(u32(clamp(u, 0.0, 1.0) * f32(scene.environment_width)), scene.environment_width - 1u);
    let y = min(u32(v * f32(scene.environment_height)), scene.environment_height - 1u);
    return vec2(x, y);
}

// Half of the radiance is packed, because that format ends at half of the largest f32.
fn texel_radiance(texel: vec2<u32>) -> vec3<f32> {
    return 2.0 * unpack_rgb(textureLoad(environment, texel, 0).xy);
}
#endif

fn environment_radiance(direction: vec3<f32>) -> vec3<f32> {
#ifdef ENVIRONMENT_LIGHT
    return texel_radiance(environment_texel(direction));
#else
    return vec3(0.0);
#endif
}

fn environment_density(radiance: vec3<f32>) -> f32 {
    return luminance(radiance) * scene.environment_density;
}

// Density with which `sample_light` finds a point of an emitter if all points are alike: choice · distance² / (area · cosine).
fn even_density(light: Light, t: Triangle, direction: vec3<f32>, distance: f32) -> f32 {
    let area_normal = 0.5 * cross(t.b - t.a, t.c - t.a);
    return light.pmf * distance * distance / max(abs(dot(area_normal, direction)), 1e-30);
}

// Density with which `sample_light` finds this point of an emitter.
fn emitter_density(index: u32, t: Triangle, weights: vec2<f32>, direction: vec3<f32>, distance: f32) -> f32 {
    let light = load_light(index);
    let even = even_density(light, t, direction, distance);
#ifdef EMITTER_PIECES
    return even * piece_density(light, weights);
#else
    return even;
#endif
}

#ifdef LIGHTS
fn sample_light(position: vec3<f32>, choice: f32, u: vec2<f32>) -> LightSample {
    let index = choose_light(choice);
    let light = load_light(index);
    var s: LightSample;
#ifdef EMITTERS
    if light.kind == EMITTER {
        let v = Visible(light.triangle, light.instance);
        let t = triangle_now(v);
#ifdef EMITTER_PIECES
        let piece = sample_piece(light, u);
        let weights = piece.weights;
#else
        // Uniform over the triangle.
        let r = sqrt(u.x);
        let weights = vec2(r * (1.0 - u.y), r * u.y);
#endif
        let way = at(t, weights) - position;
        let squared = max(dot(way, way), 1e-30);
        s.distance = sqrt(squared);
        s.direction = way / s.distance;
        let surface = surface_at(v, t, weights, s.direction);
        s.radiance = surface.emission;
#ifdef ALPHA_MASK
        s.radiance *= emitting_part(light.triangle, weights);
#endif
        // A part in 10⁴ alone is less than the error of the light's plane, if that is far from the scene's centre and near to what
        // it lights.
        let cosine = abs(dot(surface.geometric, s.direction));
        s.reach = s.distance * FREE_PART - dot(abs(surface.geometric), rounding_error(t, v)) / max(cosine, 1e-6);
        s.density = even_density(light, t, s.direction, s.distance);
#ifdef EMITTER_PIECES
        s.density *= piece.density;
#endif
        s.has_area = true;
        return s;
    }
#endif
#ifdef ENVIRONMENT_LIGHT
    if light.kind == ENVIRONMENT {
        // Alias table over cells, then along the cell's texels, then uniform in solid angle within the texel. The choice of one of
        // a million cells, and the thresholds of the dark ones below the last of them, would use up the 24 bits of one number: a
        // hash of both numbers gives 32 more.
        let more = hash(bitcast<u32>(u.x) ^ hash(bitcast<u32>(u.y)));
        let number = u32(u.x * 16777216.0);
        let bits = scene.environment_cells & 255u;
        let column_bits = scene.environment_cells >> 8u;
        let entry = number >> (24u - bits);
        let within = f32((number << (8u + bits)) | (more >> (24u - bits))) * (1.0 / 4294967296.0);
        let choice = textureLoad(environment_table, vec2(entry & 4095u, entry >> 12u), 0);
        let threshold = bitcast<f32>(choice.x);
        let kept = within < threshold;
        let cell = select(choice.y, entry, kept);
        let row = cell >> column_bits;
        let first = (cell & ((1u << column_bits) - 1u)) << scene.environment_run;
        let last = min(first + (1u << scene.environment_run), scene.environment_width) - 1u;
        var share = bitcast<f32>(select(choice.w, choice.z, kept)) * (f32(hash(more)) * (1.0 / 4294967296.0));
        var column = first;
        loop {
            s.radiance = texel_radiance(vec2(column, row));
            let brightness = luminance(s.radiance);
            if share < brightness || column >= last {
                break;
            }
            share -= brightness;
            column += 1u;
        }
        // The rest of the number is as good as a new one.
        let rest = select((within - threshold) / max(1.0 - threshold, 1e-9), within / max(threshold, 1e-9), kept);
        let x = f32(column) + clamp(rest, 0.0, 0.999999);
        let low = cos(PI * f32(row) / f32(scene.environment_height));
        let high = cos(PI * f32(row + 1u) / f32(scene.environment_height));
        let y = mix(low, high, u.y);
        let azimuth = (x / f32(scene.environment_width) - 0.5) * 2.0 * PI;
        let radius = sqrt(max(1.0 - y * y, 0.0));
        s.direction = vec3(radius * cos(azimuth), y, radius * sin(azimuth));
        s.distance = AT_INFINITY;
        s.reach = s.distance;
        s.density = environment_density(s.radiance);
        s.has_area = true;
        return s;
    }
#endif
#ifdef PUNCTUAL_LIGHTS
    // KHR_lights_punctual: inverse square with a smooth end at the range, times the cone's falloff.
    s.has_area = false;
    s.density = light.pmf;
    if light.kind == DIRECTIONAL {
        s.direction = -light.axis;
        s.distance = AT_INFINITY;
        s.reach = s.distance;
        s.radiance = light.intensity;
        return s;
    }
    let way = light.position - position;
    let squared = max(dot(way, way), 1e-30);
    s.distance = sqrt(squared);
    s.direction = way / s.distance;
    s.reach = s.distance * FREE_PART;
    let ratio = s.distance / light.range;
    let fade = clamp(1.0 - ratio * ratio * ratio * ratio, 0.0, 1.0);
    let cone = clamp(-dot(light.axis, s.direction) * light.spot_scale + light.spot_offset, 0.0, 1.0);
    s.radiance = light.intensity * (fade * cone * cone / squared);
#endif
    return s;
}
#endif
