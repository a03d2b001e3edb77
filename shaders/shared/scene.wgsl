#define_import_path asvgf::scene

// The scene as src/scene/gpu/assembly.rs lays it out: the visibility lookup table of triangle vertices, the BVH that obvhs builds,
// placements, surfaces and lights.

struct Scene {
    // Texel of `geometry` at which the instances' records begin.
    instances: u32,
    instance_count: u32,
    light_count: u32,
    // Light index of the environment, or 0xffffffff.
    environment_light: u32,
    environment_width: u32,
    environment_height: u32,
    // log₂ of the texels of a cell of `environment_table`.
    environment_run: u32,
    // log₂ of the number of cells and, 8 bits up, of the cells of a row.
    environment_cells: u32,
    // Words per triangle in `attributes`.
    attribute_stride: u32,
    // Offsets of the two sets of texture coordinates in them.
    uv_first: u32,
    uv_second: u32,
    // Solid-angle density of sampling a direction through the environment light, per unit of its luminance there.
    environment_density: f32,
    // Grid of the boxes of the one tree, or of the top level.
    grid_base: vec3<f32>,
    // Node at which rays start: the root of the one tree, or of the top level.
    root: u32,
    grid_step: vec3<f32>,
    // Offset of the vertex colours in `attributes`.
    color_first: u32,
}

@group(1) @binding(0) var<uniform> scene: Scene;
// The visibility lookup table (three texels per triangle, a vertex and one word each: material, emitter number + 1, unused); with
// INSTANCED, the top level and the instances' records; trees. It is a row of texels folded into a texture, because texture fetches
// of four words were faster than buffer reads on every adapter that was tried.
#ifdef STORAGE_READS
@group(1) @binding(1) var geometry: texture_storage_2d<rgba32uint, read>;
#else
@group(1) @binding(1) var geometry: texture_2d<u32>;
#endif
#ifdef INSTANCED
// Placements of the instances in the last frame, three rows of an affine map each.
@group(1) @binding(2) var<storage, read> placements_previous: array<vec4<f32>>;
#endif
#ifdef DEFORMING
// Corners of the triangles that change their shape, as they were in the last frame: nine numbers each.
@group(1) @binding(4) var<storage, read> corners_previous: array<f32>;
#endif
// Per triangle: three octahedral normals (0: none), with NORMAL_MAPS three tangents (0: none), then three (u, v) per set of texture
// coordinates, then three colours of four 16-bit numbers.
@group(1) @binding(3) var<storage, read> attributes: array<u32>;
// Materials and lights, the structs below texel by texel. Tables of the pieces of emitters follow the lights.
@group(1) @binding(5) var materials: texture_2d<u32>;
@group(1) @binding(6) var lights: texture_2d<u32>;
// RGBA8 texels of all images, folded into layers as in src/scene/gpu/surface/places.rs if a buffer cannot hold them.
#ifdef FOLDED_IMAGES
@group(1) @binding(7) var images: texture_2d_array<u32>;
#else
@group(1) @binding(7) var<storage, read> images: array<u32>;
#endif
// Radiances, packed as in src/scene/gpu/light/radiance.rs.
@group(1) @binding(10) var environment: texture_2d<u32>;
// Alias table over the cells of the environment: threshold, the other cell, luminance of this cell and of the other.
@group(1) @binding(11) var environment_table: texture_2d<u32>;

struct TextureUse {
    // First texel in `images`.
    first: u32,
    width: u32,
    height: u32,
    // Bits 0–1 and 2–3: wrap of u and of v (0 repeat, 1 mirror, 2 clamp). Bit 4: nearest. Bit 5: second set of coordinates. Bit 31:
    // there is a texture.
    mode: u32,
    row_u: vec4<f32>,
    row_v: vec4<f32>,
}

struct Material {
    base_color: vec4<f32>,
    emissive: vec3<f32>,
    // Bit 0: emits from both faces. Bit 1: unlit. Bit 2: has no back faces. Bit 3: blended, covers as much as its opacity. Bit 4: has a
    // normal map. Bit 5: transmits light. Bit 6: has a clear coat.
    flags: u32,
    metallic: f32,
    roughness: f32,
    // Opacity below which a point does not exist; 0 keeps all.
    cutoff: f32,
    // Reflectance of the dielectric coat at grazing incidence.
    specular_edge: f32,
    // Reflectance of the dielectric coat at normal incidence.
    specular: vec3<f32>,
    // Texel of `materials` at which the parts begin that few materials have: a normal map, then a glass, then a clear coat.
    extension: u32,
    base_color_texture: TextureUse,
    metallic_roughness_texture: TextureUse,
    emissive_texture: TextureUse,
    // Its alpha multiplies `specular` and `specular_edge`.
    specular_texture: TextureUse,
    // It multiplies `specular`.
    specular_color_texture: TextureUse,
}

const TWO_SIDED_EMITTER: u32 = 1u;
const UNLIT: u32 = 2u;
const CULLED: u32 = 4u;
const BLENDED: u32 = 8u;
const NORMAL_MAPPED: u32 = 16u;
const TRANSMITTING: u32 = 32u;
const COATED: u32 = 64u;

#ifdef NORMAL_MAPS
struct NormalMap {
    texture: TextureUse,
    // Factor on the first two coordinates.
    scale: f32,
}
#endif

// Texels of a normal map, and of a glass.
const NORMAL_MAP_TEXELS: u32 = 4u;
const GLASS_TEXELS: u32 = 5u;

#ifdef TRANSMISSION
struct Glass {
    // Its red channel multiplies `transmission`.
    texture: TextureUse,
    // Absorption per unit of length.
    absorption: vec3<f32>,
    // Part of the light, of what is not mirrored, that goes through.
    transmission: f32,
    // Index of refraction over that of air.
    index: f32,
    // 1 for the skin of a body, 0 for a pane without thickness.
    solid: u32,
}
#endif

#ifdef CLEARCOAT
struct Coat {
    // Its red channel multiplies `weight`.
    weight_texture: TextureUse,
    // Its green channel multiplies `roughness`.
    roughness_texture: TextureUse,
    normal_texture: TextureUse,
    // Part of the surface that is coated.
    weight: f32,
    // Perceptual roughness.
    roughness: f32,
    // Factor on the first two coordinates of normals.
    normal_scale: f32,
}
#endif

struct Light {
    // Kind, see light.wgsl.
    kind: u32,
    // Alias table over all lights (Walker 1974, Vose 1991): keep this entry below `threshold`, else take `alias_index`.
    alias_index: u32,
    threshold: f32,
    // Probability of choosing this light.
    pmf: f32,
    position: vec3<f32>,
    // Triangle of an emitter (u32 bits).
    triangle: u32,
    axis: vec3<f32>,
    // Instance of an emitter (u32 bits).
    instance: u32,
    intensity: vec3<f32>,
    range: f32,
    // Scale and offset of the spot's angular falloff.
    spot_scale: f32,
    spot_offset: f32,
    // Of an emitter that is divided: the texel of `lights` at which the table of its pieces begins, and log₂ of the number of their
    // rows.
    pieces: u32,
    level: u32,
}

const NO_TRIANGLE: u32 = 0xffffffffu;

// Texel i of a folded texture, whose rows hold 4096 as in src/scene/gpu/memory/folded.rs.
fn geometry_word(i: u32) -> vec4<u32> {
#ifdef STORAGE_READS
    return textureLoad(geometry, vec2(i & 4095u, i >> 12u));
#else
    return textureLoad(geometry, vec2(i & 4095u, i >> 12u), 0);
#endif
}

fn material_word(i: u32) -> vec4<u32> {
    return textureLoad(materials, vec2(i & 4095u, i >> 12u), 0);
}

fn light_word(i: u32) -> vec4<u32> {
    return textureLoad(lights, vec2(i & 4095u, i >> 12u), 0);
}

fn image_word(i: u32) -> u32 {
#ifdef FOLDED_IMAGES
    return textureLoad(images, vec2(i & 4095u, (i >> 12u) & 1023u), i >> 22u, 0).x;
#else
    return images[i];
#endif
}

fn texture_use(first: u32) -> TextureUse {
    let image = material_word(first);
    let row_u = bitcast<vec4<f32>>(material_word(first + 1u));
    return TextureUse(image.x, image.y, image.z, image.w, row_u, bitcast<vec4<f32>>(material_word(first + 2u)));
}

// Loads a material. Parts that the shader does not use are not fetched, because the compiler drops them.
fn load_material(i: u32) -> Material {
    let first = i * 19u;
    let emission = material_word(first + 1u);
    let numbers = bitcast<vec4<f32>>(material_word(first + 2u));
    return Material(
        bitcast<vec4<f32>>(material_word(first)),
        bitcast<vec3<f32>>(emission.xyz), emission.w,
        numbers.x, numbers.y, numbers.z, numbers.w,
        bitcast<vec3<f32>>(material_word(first + 3u).xyz), material_word(first + 3u).w,
        texture_use(first + 4u), texture_use(first + 7u), texture_use(first + 10u), texture_use(first + 13u),
        texture_use(first + 16u),
    );
}

#ifdef NORMAL_MAPS
// The normal map of a material that has one.
fn load_normal_map(m: Material) -> NormalMap {
    return NormalMap(texture_use(m.extension), bitcast<f32>(material_word(m.extension + 3u).x));
}
#endif

#ifdef TRANSMISSION
// The glass of a material that transmits light.
fn load_glass(m: Material) -> Glass {
    let first = m.extension + select(0u, NORMAL_MAP_TEXELS, (m.flags & NORMAL_MAPPED) != 0u);
    let numbers = bitcast<vec4<f32>>(material_word(first + 3u));
    let body = material_word(first + 4u);
    return Glass(texture_use(first), numbers.xyz, numbers.w, bitcast<f32>(body.x), body.y);
}
#endif

#ifdef CLEARCOAT
// The coat of a material that has one.
fn load_coat(m: Material) -> Coat {
    let glass = m.extension + select(0u, NORMAL_MAP_TEXELS, (m.flags & NORMAL_MAPPED) != 0u);
    let first = glass + select(0u, GLASS_TEXELS, (m.flags & TRANSMITTING) != 0u);
    let numbers = bitcast<vec4<f32>>(material_word(first + 9u));
    return Coat(texture_use(first), texture_use(first + 3u), texture_use(first + 6u), numbers.x, numbers.y, numbers.z);
}
#endif

fn load_light(i: u32) -> Light {
    let first = i * 5u;
    let choice = light_word(first);
    let place = light_word(first + 1u);
    let axis = light_word(first + 2u);
    let strength = bitcast<vec4<f32>>(light_word(first + 3u));
    let last = light_word(first + 4u);
    return Light(
        choice.x, choice.y, bitcast<f32>(choice.z), bitcast<f32>(choice.w),
        bitcast<vec3<f32>>(place.xyz), place.w,
        bitcast<vec3<f32>>(axis.xyz), axis.w,
        strength.xyz, strength.w,
        bitcast<f32>(last.x), bitcast<f32>(last.y), last.z, last.w,
    );
}

// An affine map as three rows.
struct Placement {
    x: vec4<f32>,
    y: vec4<f32>,
    z: vec4<f32>,
}

fn transform_point(m: Placement, p: vec3<f32>) -> vec3<f32> {
    return vec3(dot(m.x.xyz, p) + m.x.w, dot(m.y.xyz, p) + m.y.w, dot(m.z.xyz, p) + m.z.w);
}

fn transform_vector(m: Placement, v: vec3<f32>) -> vec3<f32> {
    return vec3(dot(m.x.xyz, v), dot(m.y.xyz, v), dot(m.z.xyz, v));
}

// Applies the transpose to a covector: a normal goes from object to world by the inverse's transpose.
fn transform_normal(inverse: Placement, n: vec3<f32>) -> vec3<f32> {
    return inverse.x.xyz * n.x + inverse.y.xyz * n.y + inverse.z.xyz * n.z;
}

fn instance_record(instance: u32, part: u32) -> Placement {
    let first = scene.instances + instance * 10u + part * 3u;
    return Placement(
        bitcast<vec4<f32>>(geometry_word(first)),
        bitcast<vec4<f32>>(geometry_word(first + 1u)),
        bitcast<vec4<f32>>(geometry_word(first + 2u)),
    );
}

fn object_to_world(instance: u32) -> Placement {
    return instance_record(instance, 0u);
}

fn world_to_object(instance: u32) -> Placement {
    return instance_record(instance, 1u);
}

#ifdef INSTANCED
fn previous_object_to_world(instance: u32) -> Placement {
    let first = instance * 3u;
    return Placement(placements_previous[first], placements_previous[first + 1u], placements_previous[first + 2u]);
}
#endif

// Grid of the boxes of the instance's tree: its origin and its step.
fn instance_grid(instance: u32) -> mat2x3<f32> {
    let first = scene.instances + instance * 10u + 6u;
    return mat2x3(bitcast<vec3<f32>>(geometry_word(first).xyz), bitcast<vec3<f32>>(geometry_word(first + 1u).xyz));
}

// Root node of the mesh's tree; the instance's first number in the visibility buffer; its first light; its mesh's first row of the
// lookup table, doubled, plus 1 if the placement mirrors.
fn instance_numbers(instance: u32) -> vec4<u32> {
    return geometry_word(scene.instances + instance * 10u + 8u);
}

// Bound on the error by which rounding shifts a point along each axis of the world on its way into the instance's space.
fn instance_error(instance: u32) -> vec3<f32> {
    return bitcast<vec3<f32>>(geometry_word(scene.instances + instance * 10u + 9u).xyz);
}

#ifdef DEFORMING
// Number of the instance's first triangle among those of `corners_previous`, plus 1; 0 if its shape stays.
fn instance_corners(instance: u32) -> u32 {
    return geometry_word(scene.instances + instance * 10u + 9u).w;
}
#endif
