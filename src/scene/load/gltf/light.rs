//! Lights without area (KHR_lights_punctual).

use std::f32::consts::{FRAC_PI_2, PI};

use gltf::json::extensions::scene::khr_lights_punctual::{Light as LightSource, Type};
use gltf::json::validation::Checked;

use super::source::Source;
use crate::scene::description::{Light, LightKind, Scene};
use crate::scene::load::common::report::Report;

/// The lights of a file.
pub(super) fn listed<'a>(source: &'a Source<'_>) -> &'a [LightSource] {
    let extension = source.root.extensions.as_ref().and_then(|extensions| extensions.khr_lights_punctual.as_ref());
    extension.map_or(&[], |extension| &extension.lights)
}

/// Reads the lights. Returns the index in the scene of each light of the file.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene) -> Vec<Option<usize>> {
    let mut places = Vec::new();
    for (index, light) in listed(source).iter().enumerate() {
        let read = read(light, &format!("KHR_lights_punctual.lights[{index}]"), report);
        places.push(read.map(|light| {
            scene.lights.push(light);
            scene.lights.len() - 1
        }));
    }
    places
}

fn read(light: &LightSource, element: &str, report: &mut Report) -> Option<Light> {
    let kind = match light.type_ {
        Checked::Valid(Type::Directional) => LightKind::Directional,
        Checked::Valid(Type::Point) => LightKind::Point,
        Checked::Valid(Type::Spot) => {
            let cone =
                light.spot.as_ref().map_or((0.0, PI / 4.0), |spot| (spot.inner_cone_angle, spot.outer_cone_angle));
            cone_of(cone, element, report)
        }
        Checked::Invalid => {
            report.warn(
                format!("{element}.type"),
                "is none of directional, point and spot; the light is left out".to_owned(),
            );
            return None;
        }
    };
    report.warn_once(element, "photometric units are taken to be radiometric: lux as W/m², candela as W/sr");
    let intensity = light.color.map(|channel| channel * light.intensity);
    let range = light.range.unwrap_or(f32::INFINITY);
    if range.is_nan() || range <= 0.0 {
        report.warn(format!("{element}.range"), format!("{range} is not above 0; the light has no end"));
    }
    Some(Light {
        kind,
        intensity: report.clamp_radiance(intensity, || format!("{element}.intensity")),
        range: if range > 0.0 { range } else { f32::INFINITY },
    })
}

fn cone_of((inner, outer): (f32, f32), element: &str, report: &mut Report) -> LightKind {
    let wide = if outer > 0.0 { outer.min(FRAC_PI_2) } else { PI / 4.0 };
    // The fade between the two divides by their difference.
    let narrow = if inner.is_nan() { 0.0 } else { inner.clamp(0.0, wide * 0.999) };
    if (narrow, wide) != (inner, outer) {
        let reason = format!(
            "cone angles {inner} and {outer} do not keep 0 ≤ inner < outer ≤ π/2; {narrow} and {wide} are used"
        );
        report.warn(format!("{element}.spot"), reason);
    }
    LightKind::Spot { inner: narrow, outer: wide }
}
