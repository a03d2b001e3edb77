#define_import_path asvgf::strata_taps

// The 3×3 taps of one à-trous iteration over the grid of strata, `stride` strata apart. All filters of strata have them.

#import asvgf::frame::frame
#import asvgf::strata_filter::{Site, site, tap_weight, in_grid}

@group(0) @binding(1) var<uniform> stride: i32;

#ifdef STORAGE_READS
@group(0) @binding(2) var samples: texture_storage_2d<rgba32uint, read>;

fn record_of(stratum: vec2<i32>) -> vec4<u32> {
    return textureLoad(samples, stratum);
}
#else
@group(0) @binding(2) var samples: texture_2d<u32>;

fn record_of(stratum: vec2<i32>) -> vec4<u32> {
    return textureLoad(samples, stratum, 0);
}
#endif

struct Tap {
    // The tap's stratum, moved into the grid.
    stratum: vec2<i32>,
    // The tap's weight, 0 if it does not exist.
    weight: f32,
    exists: bool,
}

fn tap_at(center: Site, stratum: vec2<i32>, offset: vec2<i32>) -> Tap {
    let place = stratum + offset * stride;
    let clamped = clamp(place, vec2(0), vec2<i32>(frame.strata) - 1);
    let other = record_of(clamped);
    let exists = in_grid(place) && other.x != 0u;
    return Tap(clamped, select(0.0, tap_weight(center, site(other, clamped), offset, stride), exists), exists);
}
