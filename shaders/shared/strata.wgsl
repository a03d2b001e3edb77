#define_import_path asvgf::strata

// The gradient is sampled once per stratum of 3×3 pixels. A stratum's record, in one rgba32uint texel:
//   x: place of the sample pixel in the stratum, 1…9 row by row, or 0 where the stratum has no sample
//   y: the previous frame's pixel that saw the same surface, x | y << 16
//   z, w: packed normal and depth bits of the sample pixel

const SIZE: i32 = 3;

fn place_in_stratum(pixel: vec2<u32>) -> u32 {
    return (pixel.y % 3u) * 3u + pixel.x % 3u + 1u;
}

fn is_sample_pixel(record: vec4<u32>, pixel: vec2<u32>) -> bool {
    return record.x == place_in_stratum(pixel);
}

fn sample_pixel(record: vec4<u32>, stratum: vec2<i32>) -> vec2<i32> {
    let place = i32(record.x) - 1;
    return stratum * SIZE + vec2(place % SIZE, place / SIZE);
}

fn previous_pixel(record: vec4<u32>) -> vec2<i32> {
    return vec2<i32>(vec2(record.y & 0xffffu, record.y >> 16u));
}
