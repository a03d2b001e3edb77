//! Pictures of the surroundings, and warnings about their texels.

use crate::scene::description::Environment;

/// The radiance that replaces infinity: the largest 16-bit float, which most files with infinite suns were meant to hold.
const BRIGHTEST: f32 = 65504.0;

/// A picture, and warnings about parts that could not be honoured.
pub(super) type Picture = (Environment, Vec<String>);

/// Makes all radiances finite, channel by channel, and in the `last` pass also at least 0. Radiances that are still to be converted
/// may be negative. Returns the warnings.
pub(super) fn clean(radiance: &mut [[f32; 3]], last: bool) -> Vec<String> {
    let mut changed = [0; 3];
    for channel in radiance.as_flattened_mut() {
        let (kind, cleaned) = match *channel {
            x if x.is_nan() => (0, 0.0),
            f32::INFINITY => (2, BRIGHTEST),
            x if x < 0.0 && (last || x.is_infinite()) => (1, 0.0),
            _ => continue,
        };
        changed[kind] += 1;
        *channel = cleaned;
    }
    let kinds = ["no number; they are 0", "negative; they are 0", "infinite; they are 65504"];
    let said = changed.into_iter().zip(kinds).filter(|&(count, _)| count > 0);
    said.map(|(count, kind)| format!("{count} channels of texels are {kind}")).collect()
}

/// A warning about a picture with the shape of another kind of environment map.
pub(super) fn odd_shape(width: u32, height: u32) -> Option<String> {
    /// Smaller pictures are made by hand, in any shape.
    const SMALLEST: u32 = 16;
    let kind = match (width, height) {
        _ if width.min(height) < SMALLEST => return None,
        _ if width == height => "a light probe",
        _ if 4 * width == 3 * height || 3 * width == 4 * height => "the cross of a cube map",
        _ if 6 * width == height || width == 6 * height => "the strip of a cube map",
        _ => return None,
    };
    Some(format!("{width} × {height} texels are the shape of {kind}; the picture is read as equirectangular"))
}
