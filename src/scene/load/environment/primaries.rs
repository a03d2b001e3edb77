//! Conversion of colours with other primaries to Rec. 709.

use glam::{DMat3, DVec3};

/// Red, green, blue and white (D65) in the chromaticity diagram (ITU-R BT.709).
pub(super) const REC_709: [[f64; 2]; 4] = [[0.64, 0.33], [0.30, 0.60], [0.15, 0.06], [0.3127, 0.3290]];

/// The Bradford cone responses (Lam 1985), in which one white is adapted to another.
const BRADFORD: DMat3 =
    DMat3::from_cols_array(&[0.8951, -0.7502, 0.0389, 0.2664, 1.7135, -0.0685, -0.1614, 0.0367, 1.0296]);

/// True if primaries differ visibly from those of Rec. 709.
pub(super) fn differ(primaries: [[f64; 2]; 4]) -> bool {
    primaries.as_flattened().iter().zip(REC_709.as_flattened()).any(|(a, b)| (a - b).abs() > 1e-3)
}

/// X, Y and Z of a chromaticity of luminance 1.
fn tristimulus([x, y]: [f64; 2]) -> DVec3 {
    DVec3::new(x / y, 1.0, (1.0 - x - y) / y)
}

/// The map from colours of these primaries to X, Y and Z. Its columns are the primaries, scaled so that their sum is white of
/// luminance 1 (SMPTE RP 177). `None` if they span no colours.
fn to_xyz([r, g, b, white]: [[f64; 2]; 4]) -> Option<DMat3> {
    let columns = [r, g, b].map(|[x, y]| DVec3::new(x, y, 1.0 - x - y));
    let primaries = DMat3::from_cols(columns[0], columns[1], columns[2]);
    if white[1] == 0.0 || primaries.determinant().abs() < 1e-9 {
        return None;
    }
    let brightness = primaries.inverse() * tristimulus(white);
    let matrix = primaries * DMat3::from_diagonal(brightness);
    matrix.is_finite().then_some(matrix)
}

/// The map to Rec. 709, white to white. `None` if the primaries span no colours.
pub(super) fn to_rec_709(primaries: [[f64; 2]; 4]) -> Option<impl Fn([f32; 3]) -> [f32; 3]> {
    Some(applied(from_xyz(primaries[3])? * to_xyz(primaries)?))
}

/// The map from X, Y and Z with this white to Rec. 709.
pub(super) fn xyz_to_rec_709(white: [f64; 2]) -> Option<impl Fn([f32; 3]) -> [f32; 3]> {
    Some(applied(from_xyz(white)?))
}

fn from_xyz(white: [f64; 2]) -> Option<DMat3> {
    let [from, to] = [white, REC_709[3]].map(|white| BRADFORD * tristimulus(white));
    let adapted = BRADFORD.inverse() * DMat3::from_diagonal(to / from) * BRADFORD;
    let matrix = to_xyz(REC_709)?.inverse() * adapted;
    matrix.is_finite().then_some(matrix)
}

fn applied(matrix: DMat3) -> impl Fn([f32; 3]) -> [f32; 3] {
    let matrix = matrix.as_mat3();
    move |color| (matrix * glam::Vec3::from(color)).to_array()
}

/// The share of each primary in the luminance of white.
pub(super) fn luminance_weights(primaries: [[f64; 2]; 4]) -> [f32; 3] {
    to_xyz(primaries).or_else(|| to_xyz(REC_709)).map_or([1.0 / 3.0; 3], |matrix| matrix.row(1).as_vec3().to_array())
}

#[cfg(test)]
mod tests {
    use super::*;

    /// ACES primaries (SMPTE ST 2065-1), and the matrix to Rec. 709 that the Academy gives for D65 adaptation by Bradford.
    #[test]
    fn aces_becomes_what_the_academy_says() {
        let aces = [[0.7347, 0.2653], [0.0, 1.0], [0.0001, -0.0770], [0.32168, 0.33767]];
        let map = to_rec_709(aces).unwrap();
        let columns = [map([1.0, 0.0, 0.0]), map([0.0, 1.0, 0.0]), map([0.0, 0.0, 1.0])];
        let expected = [[2.5217, -0.2765, -0.0153], [-1.1341, 1.3727, -0.1530], [-0.3876, -0.0962, 1.1684]];
        for (column, expected) in columns.iter().zip(expected) {
            for (a, b) in column.iter().zip(expected) {
                assert!((a - b).abs() < 2e-3, "{columns:?}");
            }
        }
    }

    #[test]
    fn white_stays_white_and_rec_709_stays_what_it_is() {
        let p3 = [[0.68, 0.32], [0.265, 0.69], [0.15, 0.06], [0.314, 0.351]];
        for primaries in [p3, REC_709] {
            let white = to_rec_709(primaries).unwrap()([1.0; 3]);
            assert!(white.iter().all(|channel| (channel - 1.0).abs() < 1e-5), "{white:?}");
        }
        let same = to_rec_709(REC_709).unwrap()([0.2, 0.5, 0.9]);
        assert!(same.iter().zip([0.2, 0.5, 0.9]).all(|(a, b)| (a - b).abs() < 1e-5), "{same:?}");
        for (weight, expected) in luminance_weights(REC_709).into_iter().zip([0.2126, 0.7152, 0.0722]) {
            assert!((weight - expected).abs() < 1e-4);
        }
        assert!(to_rec_709([[0.3, 0.3]; 4]).is_none());
    }
}
