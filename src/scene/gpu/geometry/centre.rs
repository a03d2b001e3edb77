//! The origin of coordinates on the GPU.
//!
//! Shaders compute in f32, whose steps are 1/32 m at 500 km. Neither a surface nor the start of a ray could be placed to a millimetre
//! there, so a scene on the GPU is stored relative to a centre near its middle. The difference is taken in f64, where it is exact for
//! coordinates that came as f32, and rounded once.

use crate::scene::description::WorldMatrix;
use glam::{DMat4, DVec3, Mat4};

/// The centre of a box between two corners: its middle, rounded to a multiple of a power of two that is two to four times the longest
/// side. A box that contains the origin therefore has its centre at the origin, and copies of a scene that are whole multiples apart
/// have the same coordinates.
pub(crate) fn centre([low, high]: [DVec3; 2]) -> DVec3 {
    let side = (high - low).max_element();
    let step = if side > 0.0 { (2.0 * side).log2().ceil().exp2() } else { 1.0 };
    // `round` would round halves away from the origin, and so differently on its two sides.
    let centre = ((0.5 * (low + high)) / step + 0.5).floor() * step;
    // Beyond the range of numbers, the origin is as good as any other place.
    if centre.is_finite() { centre } else { DVec3::ZERO }
}

/// The corners of the box around some points, or `None` without points.
pub(crate) fn bounds(points: impl IntoIterator<Item = DVec3>) -> Option<[DVec3; 2]> {
    points.into_iter().map(|p| [p; 2]).reduce(|[low, high], [a, b]| [low.min(a), high.max(b)])
}

/// A placement from a space with the origin `from` into one with the origin `to`.
pub(crate) fn relative(world: &WorldMatrix, from: DVec3, to: DVec3) -> Mat4 {
    let world = DMat4::from_cols_array_2d(world);
    (DMat4::from_translation(-to) * world * DMat4::from_translation(from)).as_mat4()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_contains_the_origin_counts_from_it() {
        for [low, high] in [[0.0, 10.0], [-3.0, 0.0], [-1.0, 1.0], [-1e-3, 5e5], [0.0, 0.0]] {
            assert_eq!(centre([DVec3::splat(low), DVec3::splat(high)]), DVec3::ZERO, "{low}…{high}");
        }
    }

    #[test]
    fn copies_that_are_far_apart_get_the_same_numbers() {
        let corners = [DVec3::new(-1.0, 0.0, -1.0), DVec3::new(1.0, 1.0, 1.0)];
        for offset in [8192.0, -32768.0, 524_288.0, -524_288.0] {
            let offset = DVec3::new(offset, 0.0, -offset);
            assert_eq!(centre(corners.map(|c| c + offset)), centre(corners) + offset);
        }
    }

    #[test]
    fn it_is_no_farther_from_the_middle_than_twice_the_longest_side() {
        for size in [1e-6, 0.3, 1.0, 7.0, 1e5] {
            for place in [0.1, 3.7, -900.0, 1e9] {
                let corners = [DVec3::splat(place), DVec3::new(place + size, place, place + 0.1 * size)];
                let middle = 0.5 * (corners[0] + corners[1]);
                assert!((centre(corners) - middle).abs().max_element() <= 2.0 * size, "{size} at {place}");
            }
        }
    }

    #[test]
    fn nothing_finite_is_lost_to_what_is_not() {
        assert_eq!(centre([DVec3::splat(f64::NEG_INFINITY), DVec3::splat(f64::INFINITY)]), DVec3::ZERO);
        assert_eq!(centre([DVec3::splat(f64::NAN), DVec3::ONE]), DVec3::ZERO);
    }

    #[test]
    fn a_small_offset_beside_a_large_one_is_kept() {
        let offset = DVec3::new(524_288.0, 0.0, -524_288.0);
        let world = DMat4::from_translation(offset + DVec3::new(1e-3, 0.25, 0.0)).to_cols_array_2d();
        assert_eq!(relative(&world, DVec3::ZERO, offset).w_axis.to_array(), [1e-3_f64 as f32, 0.25, 0.0, 1.0]);
        // A node brings a mesh back whose own vertices are far.
        let back = DMat4::from_translation(-offset).to_cols_array_2d();
        assert_eq!(relative(&back, offset, DVec3::ZERO), Mat4::IDENTITY);
    }
}
