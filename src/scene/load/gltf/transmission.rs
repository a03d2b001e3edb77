//! Glass: KHR_materials_transmission and KHR_materials_volume.

use gltf::json::Material as MaterialSource;
use gltf::json::extensions::material::Volume;

use super::image::Images;
use crate::scene::description::{Alpha, Interior, Material};
use crate::scene::load::common::report::Report;

/// Least colour that a volume leaves at its attenuation distance, because black would be an infinite absorption.
const LEAST_COLOR: f32 = 1e-6;

/// Adds transmission to a material. `index` is its index of refraction.
pub(super) fn apply(
    source: &MaterialSource,
    material: Material,
    index: f32,
    element: &str,
    images: &mut Images<'_>,
    report: &mut Report,
) -> Material {
    let Some(extensions) = source.extensions.as_ref() else { return material };
    let Some(extension) = extensions.transmission.as_ref() else {
        if extensions.volume.is_some() {
            let reason = "has no effect without KHR_materials_transmission";
            report.warn(format!("{element}.KHR_materials_volume"), reason);
        }
        return material;
    };
    let user = format!("{element}.KHR_materials_transmission");
    let made = Material {
        transmission: report.clamp_unit(extension.transmission_factor.0, || format!("{user}.transmissionFactor")),
        transmission_texture: images.texture(
            &extension.transmission_texture,
            &format!("{user}.transmissionTexture"),
            report,
        ),
        interior: interior(extensions.volume.as_ref(), index, element, report),
        ..material
    };
    if made.is_skin() && made.alpha == Alpha::Blend {
        let reason = "BLEND is not read beside KHR_materials_volume; the body is drawn whole";
        report.warn(format!("{element}.alphaMode"), reason);
    }
    made
}

/// The inside of a volume that absorbs −ln(colour)/distance per unit of length, or a pane for a thickness of 0.
fn interior(volume: Option<&Volume>, index: f32, element: &str, report: &mut Report) -> Interior {
    let pane = Interior { index, absorption: None };
    let Some(volume) = volume else { return pane };
    let user = format!("{element}.KHR_materials_volume");
    // The path tracer measures thickness itself. Whether there is any is all that counts.
    let thickness = volume.thickness_factor.0;
    if thickness == 0.0 {
        return pane;
    }
    if thickness.is_nan() || thickness < 0.0 {
        report.warn(format!("{user}.thicknessFactor"), format!("{thickness} is not at least 0; 0 is used"));
        return pane;
    }
    let distance = volume.attenuation_distance.0;
    if distance.is_nan() || distance <= 0.0 {
        let reason = format!("{distance} is not above 0; the volume absorbs nothing");
        report.warn(format!("{user}.attenuationDistance"), reason);
        return Interior { index, absorption: Some([0.0; 3]) };
    }
    let color = volume.attenuation_color.0;
    let color = color.map(|channel| report.clamp_unit(channel, || format!("{user}.attenuationColor")).max(LEAST_COLOR));
    Interior::absorbing(index, color, distance)
}
