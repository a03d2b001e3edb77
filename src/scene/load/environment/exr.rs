//! Environment maps in EXR files.

use std::path::Path;

use super::picture::{Picture, clean};
use super::primaries::{REC_709, differ, luminance_weights, to_rec_709};
use crate::image_io::{Channels, ExrFile, MAX_SIDE};
use crate::scene::description::Environment;

pub(super) fn read(path: &Path) -> Result<Picture, String> {
    let file = ExrFile::read(path).map_err(|error| error.reason)?;
    if file.is_cube_map() {
        return Err("is a cube map; only equirectangular pictures are read".into());
    }
    let mut warnings = Vec::new();
    let primaries = file.chromaticities().map(|pairs| pairs.map(|pair| pair.map(f64::from)));
    let channels = file.channels();
    let mut colors = colors(&channels, primaries.unwrap_or(REC_709), &mut warnings)?;
    drop(channels);
    if let Some(primaries) = primaries.filter(|&primaries| differ(primaries)) {
        // A matrix would spread one channel that is infinite or NaN to all three.
        warnings.extend(clean(&mut colors, false));
        match to_rec_709(primaries) {
            Some(matrix) => colors.iter_mut().for_each(|color| *color = matrix(*color)),
            None => {
                warnings.push(format!("the chromaticities {primaries:?} span no colours; they are taken for Rec. 709"));
            }
        }
    }
    // The display window is the picture. Directions outside the data window are black.
    let (data, display) = (file.data_window(), file.display_window());
    if display.size.iter().any(|&side| side as usize > MAX_SIDE) {
        let [width, height] = display.size;
        return Err(format!("its display window has {width} × {height} texels; at most {MAX_SIDE} a side are read"));
    }
    let channel = |index: usize| colors.iter().map(|color| color[index]).collect::<Vec<_>>();
    if data != display {
        let placed = [0, 1, 2].map(|index| data.place(&channel(index), display, 0.0));
        let [r, g, b] = &placed;
        colors = r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]).collect();
    }
    let [width, height] = display.size;
    Ok((Environment { width, height, radiance: colors }, warnings))
}

/// Colours, or luminance and chroma, or luminance alone.
fn colors(channels: &Channels, primaries: [[f64; 2]; 4], warnings: &mut Vec<String>) -> Result<Vec<[f32; 3]>, String> {
    let find = |name: &str| channels.channels.iter().find(|(known, _)| known == name).map(|(_, samples)| samples);
    let zip = |[r, g, b]: [&Vec<f32>; 3]| r.iter().zip(g).zip(b).map(|((&r, &g), &b)| [r, g, b]).collect();
    if let (Some(r), Some(g), Some(b)) = (find("R"), find("G"), find("B")) {
        return Ok(zip([r, g, b]));
    }
    // (R − Y)/Y and (B − Y)/Y (OpenEXR, "Luminance/Chroma Images").
    if let (Some(y), Some(ry), Some(by)) = (find("Y"), find("RY"), find("BY")) {
        let weights = luminance_weights(primaries);
        let color = |[y, ry, by]: [f32; 3]| {
            let (r, b) = ((ry + 1.0) * y, (by + 1.0) * y);
            [r, (y - weights[0] * r - weights[2] * b) / weights[1], b]
        };
        return Ok(zip([y, ry, by]).into_iter().map(color).collect());
    }
    if let Some(y) = find("Y") {
        return Ok(zip([y; 3]));
    }
    // The layer that is most likely the picture, by names of any case.
    let lower = |suffix: char, name: &str| name.to_lowercase().strip_suffix(suffix).map(str::to_owned);
    let mut layers: Vec<(&str, String)> = channels
        .channels
        .iter()
        .filter_map(|(name, _)| Some((name.as_str(), lower('r', name)?)))
        .filter(|(_, layer)| layer.is_empty() || layer.ends_with('.'))
        .collect();
    layers.sort_by_key(|(_, layer)| !["combined.", "beauty.", "rgba."].iter().any(|picture| layer.ends_with(picture)));
    for (name, layer) in layers {
        let of = |suffix: char| {
            let found = channels.channels.iter().find(|(name, _)| lower(suffix, name).as_ref() == Some(&layer));
            found.map(|(_, samples)| samples)
        };
        if let (Some(r), Some(g), Some(b)) = (of('r'), of('g'), of('b')) {
            warnings.push(format!("there are no channels R, G and B; {name} and its neighbours are read"));
            return Ok(zip([r, g, b]));
        }
    }
    Err("has no channels R, G and B, and no Y".into())
}
