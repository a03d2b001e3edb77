// Finds the samples that may be outliers: in each stratum the one that is farthest above its level, and what the other pixels show.
//
// A candidate is brighter than B/2 (outliers.wgsl). A pixel that was a candidate in the last frame stays one while it is at least
// half as bright, so that a steady highlight is seen to be steady. Its history is that of the nearest pixel at its surface's former
// place, whatever surface that shows, because a wrong one at an edge only costs a candidate too many. A pixel without a history is
// compared with the others of its stratum.
//
//   m ← max(l, 0.6·m′)                                      m′ of the stratum where its surface was
//   e ← e′ + (Σmin(l, 10⁹·level) − e′)/min(n + 1, 16)       over the candidates
//
// m fades instead of vanishing because light that few paths find shows only every few frames. e bounds each candidate, so that no
// outlier makes all other light look dark.

#import asvgf::frame::{frame, inside}
#import asvgf::color::luminance
#import asvgf::history::{history_color, history_length}
#import asvgf::history_taps::history_at
#import asvgf::outliers::{Candidate, LEAST_LEVEL, LEAST_RATIO, MOST_RATIO, bound, pack_candidate, ratio_to, unpack_memory}
#import asvgf::packing::unpack_rgb
#import asvgf::sample::sample_at
#import asvgf::strata::{is_at, pixel_at, place_from_center, stratum_of}
#ifdef MISSING_SAMPLES
#import asvgf::packing::is_sample
#endif
#ifdef STEADY
#import asvgf::history_taps::output_at
#endif
#ifdef IN_PLACE
#import asvgf::strata::is_sample_pixel
#endif
#ifdef SPECULAR_SIGNAL
#import asvgf::history_taps::reflection_at
#else
#ifndef STILL
#import asvgf::history_taps::motion_of
#endif
#endif

@group(0) @binding(1) var guide: texture_2d<u32>;
#ifdef IN_PLACE
@group(0) @binding(6) var samples: texture_2d<u32>;
#endif
@group(0) @binding(9) var memory_previous: texture_2d<u32>;
@group(0) @binding(11) var candidates_out: texture_storage_2d<rgba32uint, write>;

// Part of a candidate's luminance m that is left a frame later.
const KEPT: f32 = 0.6;

// Frames over which e, the light that candidates imply, is averaged.
const SLOW: f32 = 16.0;

// Most sightings that are counted: three bits.
const MOST_SIGHTINGS: u32 = 7u;

// Part of the light that candidates imply below which all other light is no light to compare them with.
const DARK: f32 = 1e-10;

// The pixel where a pixel's surface was.
fn origin(pixel: vec2<i32>, depth: f32) -> vec2<i32> {
#ifdef STILL
    return pixel;
#else
#ifdef SPECULAR_SIGNAL
    let moved = reflection_at(pixel).motion;
#else
    let moved = motion_of(pixel, depth).xy;
#endif
    return vec2<i32>(floor(vec2<f32>(pixel) + 0.5 + moved));
#endif
}

@compute @workgroup_size(8, 8)
fn main(@builtin(global_invocation_id) id: vec3<u32>) {
    let stratum = vec2<i32>(id.xy);
    var now = Candidate();
    // The stratum where this stratum's surface was, below 0 for none.
    var last_stratum = vec2(-1);
    var length = 0.0;
    var farthest = 0.0;
    // Place and sightings of a candidate that has no new sample in this frame.
    var carried = vec2(0u);
    var implied = 0.0;
    // Samples without a history: their largest, its place and its sightings; the sum of all others, which f32 would lose beside the
    // largest; their number.
    var rest = 0.0;
    var largest = 0.0;
    var largest_at = 0u;
    var largest_sightings = 0u;
    var fresh_count = 0.0;
    for (var k = 0u; k < 9u; k++) {
        let at = place_from_center(k);
        let pixel = pixel_at(at, stratum);
        if !inside(pixel) {
            continue;
        }
        let g = textureLoad(guide, pixel, 0).xy;
        if g.y == 0u {
            continue;
        }
#ifdef SPECULAR_SIGNAL
        if !reflection_at(pixel).exists {
            continue;
        }
#endif
        let arrived = sample_at(pixel, true);
        let before = origin(pixel, bitcast<f32>(g.y));
        let known = frame.continued != 0u && inside(before);
        let tap = clamp(before, vec2(0), vec2<i32>(frame.size) - 1);
        // The number of frames running in which it was a candidate.
        let there = stratum_of(vec2<u32>(tap));
        let last = unpack_memory(textureLoad(memory_previous, there, 0));
        let was_one = known && is_at(last.place, vec2<u32>(tap));
        // A missing sample, or a repeated path, teaches nothing of a candidate, and is no reason to forget one.
        var is_new = true;
#ifdef MISSING_SAMPLES
        is_new = is_sample(arrived);
#endif
#ifdef IN_PLACE
        is_new &= !is_sample_pixel(textureLoad(samples, stratum, 0), vec2<u32>(pixel));
#endif
        if !is_new {
            carried = select(carried, vec2(at, last.sightings), was_one);
            continue;
        }
        let l = luminance(unpack_rgb(arrived));
        let sightings = select(0u, last.sightings, was_one && 2.0 * l >= last.brightest);
        let h = history_at(tap);
        let n = select(0.0, history_length(h), known);
        now.seen += 1u;
        if known && last_stratum.x < 0 {
            last_stratum = vec2<i32>(there);
            length = n;
        }
        if n <= 0.0 {
            fresh_count += 1.0;
            largest_at = select(largest_at, at, l > largest);
            largest_sightings = select(largest_sightings, sightings, l > largest);
            rest += min(largest, l);
            largest = max(largest, l);
            continue;
        }
        var level = luminance(history_color(h));
#ifdef STEADY
        level = max(level, luminance(output_at(tap)));
#endif
        let least = max(level, LEAST_LEVEL * last.expected);
        let ratio = ratio_to(bound(least, n), l);
        let candidate = ratio > LEAST_RATIO || (sightings > 0u && sightings < MOST_SIGHTINGS && l > 0.0);
        now.expected += level;
        now.candidates += select(0u, 1u, candidate);
        implied += select(0.0, min(l, MOST_RATIO * least), candidate);
        now.ordinary += select(l, 0.0, candidate);
        now.lit += select(0u, 1u, !candidate && l > 0.0);
        if candidate && ratio > farthest {
            farthest = ratio;
            now.brightest = l;
            now.place = at;
            now.sightings = min(sightings + 1u, MOST_SIGHTINGS);
        }
    }
    let others = rest / max(fresh_count - 1.0, 1.0);
    let ratio = ratio_to(bound(others, 1.0), largest);
    let candidate = fresh_count > 1.0 && ratio > LEAST_RATIO;
    now.candidates += select(0u, 1u, candidate);
    implied += select(0.0, min(largest, MOST_RATIO * others), candidate);
    let shown = rest + select(largest, 0.0, candidate);
    now.ordinary += shown;
    now.expected += shown;
    now.lit += select(0u, u32(fresh_count) - select(0u, 1u, candidate), others > 0.0);
    if candidate && ratio > farthest {
        now.brightest = largest;
        now.place = largest_at;
        now.sightings = min(largest_sightings + 1u, MOST_SIGHTINGS);
    }
    let found = now.place != 0u;
    now.sightings = select(carried.y, now.sightings, found);
    now.place = select(carried.x, now.place, found);
    now.length = length;
    now.implied = implied;
    if last_stratum.x >= 0 {
        let last = unpack_memory(textureLoad(memory_previous, last_stratum, 0));
        now.brightest = max(now.brightest, KEPT * last.brightest);
        now.running = last.running;
        now.implied = last.implied + (implied - last.implied) / min(length + 1.0, SLOW);
        // Light far darker than what the candidates imply does not count as light.
        let dark = DARK * last.around;
        now.lit = select(0u, now.lit, now.ordinary > dark * f32(now.seen));
    }
    let kept = select(0u, now.running, carried.x != 0u);
    now.running = select(kept, min(now.running + 1u, MOST_SIGHTINGS), found);
    textureStore(candidates_out, stratum, pack_candidate(now));
}
