#define_import_path asvgf::strata

// The gradient is sampled once per stratum of 3×3 pixels. A stratum's record, in one rgba32uint texel:
//   x: place of the sample pixel in the stratum, 1…9 row by row, or 0 where the stratum has no sample
//   y: the previous frame's pixel that saw the same surface, x | y << 16
//   z, w: packed normal and depth bits of the sample pixel

const SIZE: i32 = 3;

// The stratum that a pixel belongs to: x / 3 for x < 98 304, by multiplication, as a software adapter divides integers one by
// one, at 300 cycles for eight.
fn stratum_of(pixel: vec2<u32>) -> vec2<u32> {
    return (pixel * 43691u) >> vec2(17u);
}

// Whether a pixel is at a place, 1…9, of its stratum.
fn is_at(place: u32, pixel: vec2<u32>) -> bool {
    let within = pixel - 3u * stratum_of(pixel);
    return place == within.y * 3u + within.x + 1u;
}

fn pixel_at(place: u32, stratum: vec2<i32>) -> vec2<i32> {
    // (place − 1) / 3 for a place of 1…9.
    let row = ((place - 1u) * 11u) >> 5u;
    return stratum * SIZE + vec2<i32>(vec2(place - 1u - 3u * row, row));
}

// The places in the order in which a pixel is looked for that stands for its stratum, k = 0…8: the centre first.
fn place_from_center(k: u32) -> u32 {
    return select(k + 5u, k - 4u, k > 4u);
}

fn is_sample_pixel(record: vec4<u32>, pixel: vec2<u32>) -> bool {
    return is_at(record.x, pixel);
}

fn sample_pixel(record: vec4<u32>, stratum: vec2<i32>) -> vec2<i32> {
    return pixel_at(record.x, stratum);
}

// Where the two radiances of the stratum's path are: in the images of two frames, or in those of the host's pairs.
fn place_now(record: vec4<u32>, stratum: vec2<i32>) -> vec2<i32> {
#ifdef PAIRS
    return stratum;
#else
    return sample_pixel(record, stratum);
#endif
}

fn place_before(record: vec4<u32>, stratum: vec2<i32>) -> vec2<i32> {
#ifdef PAIRS
    return stratum;
#else
    return previous_pixel(record);
#endif
}

fn previous_pixel(record: vec4<u32>) -> vec2<i32> {
    return vec2<i32>(vec2(record.y & 0xffffu, record.y >> 16u));
}
