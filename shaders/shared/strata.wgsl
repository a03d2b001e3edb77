#define_import_path asvgf::strata

// The gradient is sampled once per stratum, a square of 3×3 pixels. A stratum's record is one rgba32uint texel:
//   x: place of the sample pixel in the stratum, 1…9 row by row, or 0 if the stratum has no sample
//   y: the previous frame's pixel that saw the same surface, x | y << 16
//   z, w: packed normal and depth bits of the sample pixel

const SIZE: i32 = 3;

// The stratum of a pixel. (x·43691) >> 17 is x / 3 for x < 98 304: a software adapter divides integers one by one, which takes 300
// cycles for eight.
fn stratum_of(pixel: vec2<u32>) -> vec2<u32> {
    return (pixel * 43691u) >> vec2(17u);
}

// True if a pixel is at a place, 1…9, of its stratum.
fn is_at(place: u32, pixel: vec2<u32>) -> bool {
    let within = pixel - 3u * stratum_of(pixel);
    return place == within.y * 3u + within.x + 1u;
}

fn pixel_at(place: u32, stratum: vec2<i32>) -> vec2<i32> {
    // (k·11) >> 5 is k / 3 for k < 9.
    let row = ((place - 1u) * 11u) >> 5u;
    return stratum * SIZE + vec2<i32>(vec2(place - 1u - 3u * row, row));
}

// The places in the order of the search for a pixel that stands for its stratum, k = 0…8: the centre first.
fn place_from_center(k: u32) -> u32 {
    return select(k + 5u, k - 4u, k > 4u);
}

fn is_sample_pixel(record: vec4<u32>, pixel: vec2<u32>) -> bool {
    return is_at(record.x, pixel);
}

fn sample_pixel(record: vec4<u32>, stratum: vec2<i32>) -> vec2<i32> {
    return pixel_at(record.x, stratum);
}

// Places of the two radiances of a stratum's path: in the images of two frames or, with PAIRS, in those of the host's pairs.
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
