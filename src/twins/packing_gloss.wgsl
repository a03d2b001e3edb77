// Sends gloss and displacements through their formats and back, for the test of the formats.

#import asvgf::gloss::{guide_roughness, pack_gloss, specular_guide, unpack_gloss}
#import asvgf::packing::{pack_displacement, unpack_displacement}

// (roughness, distance, part, depth), (displacement, 0)
@group(0) @binding(0) var<storage, read> numbers: array<vec4<f32>>;
// Gloss, and 1 if there is any; roughness and depth in the guide, and the roughness and the depth of a guide without gloss; displacement.
@group(0) @binding(1) var<storage, read_write> results: array<vec4<f32>>;

@compute @workgroup_size(64)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let i = id.x;
    if 2u * i >= arrayLength(&numbers) {
        return;
    }
    let given = numbers[2u * i];
    let bits = pack_gloss(given.x, given.y, given.z);
    let gloss = unpack_gloss(bits);
    let guide = vec2(0x12345u, bitcast<u32>(given.w));
    let shiny = specular_guide(guide, bits);
    let dull = specular_guide(guide, 0u);
    results[3u * i] = vec4(gloss.roughness, gloss.hit_distance, gloss.part, select(0.0, 1.0, gloss.exists));
    results[3u * i + 1u] = vec4(guide_roughness(shiny), bitcast<f32>(shiny.y), guide_roughness(dull), bitcast<f32>(dull.y));
    results[3u * i + 2u] = vec4(unpack_displacement(pack_displacement(numbers[2u * i + 1u].xyz)), 0.0);
}
