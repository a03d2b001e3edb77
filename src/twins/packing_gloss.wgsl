// Sends gloss and displacements through their formats and back, for the test of the formats.

#import asvgf::evidence::{Evidence, pack_evidence, unpack_evidence}
#import asvgf::gloss::{guide_roughness, pack_gloss, pack_reflection, roughness_code, specular_guide, unpack_gloss, unpack_reflection}
#import asvgf::packing::{pack_displacement, unpack_displacement}

// (roughness, distance, part, depth), (displacement, 0)
@group(0) @binding(0) var<storage, read> numbers: array<vec4<f32>>;
// Gloss, and 1 if there is any; roughness and depth in the guide, and the roughness and the depth of a guide without gloss; displacement;
// motion, distance and roughness of a reflection; evidence, its normal and 1 if there is any.
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
    let reflection = pack_reflection(given.xy * 100.0, given.y, bits & 0xffu);
    let shiny = specular_guide(guide, roughness_code(reflection));
    let dull = specular_guide(guide, 0u);
    results[5u * i] = vec4(gloss.roughness, gloss.hit_distance, gloss.part, select(0.0, 1.0, gloss.exists));
    results[5u * i + 1u] = vec4(guide_roughness(shiny), bitcast<f32>(shiny.y), guide_roughness(dull), bitcast<f32>(dull.y));
    let displacement = numbers[2u * i + 1u].xyz;
    results[5u * i + 2u] = vec4(unpack_displacement(pack_displacement(displacement)), 0.0);
    let shown = unpack_reflection(reflection);
    results[5u * i + 3u] = vec4(shown.motion, shown.hit_distance, shown.roughness);
    let evidence = unpack_evidence(pack_evidence(Evidence(vec2(displacement.x, given.y), 0x2aaaaaaau, given.x > 0.5)));
    let normal = f32(evidence.normal == 0x2aaaaaaau);
    results[5u * i + 4u] = vec4(evidence.sums, normal, select(0.0, 1.0, evidence.exists));
}
