//! Pieces of a triangle: 4^level equal triangles on a grid of its barycentric weights.
//!
//! A grid of n rows has n(n + 1)/2 upright pieces and n(n − 1)/2 pieces that are turned over. The upright ones are the cells (x, y) with
//! x + y < n of a square of n × n cells. A point reflection in the middle of the square takes the others to the rest of its cells. So
//! the number x·n + y leads to a piece, and a point to its number, without a search. shaders/shared/emitter_pieces.wgsl does the same.

/// Number of pieces.
pub(super) fn count(level: u32) -> usize {
    1 << (2 * level)
}

/// The piece at a point, given by its weights of the second and of the third corner.
fn piece_at(level: u32, weights: [f64; 2]) -> usize {
    let last = (1_usize << level) - 1;
    let place = weights.map(|weight| weight * (last + 1) as f64);
    let cell = place.map(|x| (x as usize).min(last));
    let upright = place[0] - cell[0] as f64 + place[1] - cell[1] as f64 <= 1.0;
    let [x, y] = if upright { cell } else { cell.map(|x| last - x) };
    x << level | y
}

/// The weights of a point of a piece, given by its weights within the piece.
fn point(level: u32, piece: usize, within: [f64; 2]) -> [f64; 2] {
    let rows = 1_usize << level;
    let cell = [piece >> level, piece & (rows - 1)];
    let place = [0, 1].map(|axis| (cell[axis] as f64 + within[axis]) / rows as f64);
    if cell[0] + cell[1] < rows { place } else { place.map(|x| 1.0 - x) }
}

/// The weights of the corners of a piece.
pub(super) fn corners(level: u32, piece: usize) -> [[f64; 2]; 3] {
    [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(|within| point(level, piece, within))
}

/// The weights of the middle of a piece.
pub(super) fn middle(level: u32, piece: usize) -> [f64; 2] {
    point(level, piece, [1.0 / 3.0; 2])
}

/// For each piece, the piece of the next coarser level that holds it.
pub(super) fn parents(level: u32) -> Vec<usize> {
    (0..count(level)).map(|piece| piece_at(level - 1, middle(level, piece))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn area([a, b, c]: [[f64; 2]; 3]) -> f64 {
        0.5 * ((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]))
    }

    #[test]
    fn a_number_leads_to_a_piece_and_each_of_its_points_to_the_number() {
        for level in 0..7 {
            for piece in 0..count(level) {
                for within in [[1.0 / 3.0; 2], [0.01, 0.01], [0.98, 0.01], [0.01, 0.98]] {
                    let weights = point(level, piece, within);
                    assert_eq!(piece_at(level, weights), piece, "{weights:?} of level {level}");
                    assert!(weights.iter().all(|w| *w > 0.0) && weights[0] + weights[1] < 1.0);
                }
                assert!((area(corners(level, piece)) * count(level) as f64 - 0.5).abs() < 1e-9);
            }
        }
    }

    #[test]
    fn a_corner_of_the_triangle_is_in_a_piece() {
        for level in 0..7 {
            for weights in [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [0.5, 0.5], [1.0, 1e-9]] {
                assert!(piece_at(level, weights) < count(level));
            }
        }
    }

    #[test]
    fn four_pieces_make_one_of_the_next_level() {
        for level in 1..7 {
            let parents = parents(level);
            for parent in 0..count(level - 1) {
                assert_eq!(parents.iter().filter(|&&p| p == parent).count(), 4);
            }
        }
    }
}
