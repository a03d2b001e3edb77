//! Animations of emission and of lights, which KHR_animation_pointer leads to.
//!
//! A channel of the scene is a factor on the nominal emission or intensity, from which the probability of a light follows. The nominal
//! value is the greatest of all keys and of the file's own value, channel by channel. So a lamp that is dark at rest is a lamp.

use std::collections::HashMap;

use gltf::json::accessor::Type;
use gltf::json::{Index, Material};

use super::animation::{MAX_VALUES, read};
use super::pointer::{EXTENSION, PointerChannel, number_of, pattern, steps};
use super::source::{Source, lookup};
use super::{light, material};
use crate::scene::description::{Channel, Interpolation, Scene, Target};
use crate::scene::load::common::report::{Fault, Report};

/// Animation and channel of the curves of each target.
type Curves = HashMap<Target, Vec<[usize; 2]>>;

/// Reads the channels of emission and of lights into animations that were read before. `lights` are the indices in the scene of the
/// lights of the file.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene, lights: &[Option<usize>]) {
    let mut curves = Curves::new();
    let channels = scene.animations.iter().flat_map(|animation| &animation.channels);
    let mut values: usize = channels.map(|channel| channel.values.len()).sum();
    for channel in &source.pointers {
        match read_channel(source, channel, lights, report) {
            Ok(None) => {}
            Ok(Some(read)) => {
                let Some(animation) = scene.animations.get_mut(channel.animation) else { continue };
                let places = curves.entry(read.target).or_default();
                // The channels are in the order of the animations.
                if places.last().is_some_and(|[earlier, _]| *earlier == channel.animation) {
                    report.warn(&channel.element, "an earlier channel has the same target; this one is left out");
                } else if values + read.values.len() > MAX_VALUES {
                    let reason = format!("the file has more than {MAX_VALUES} animated values; it is left out");
                    report.warn_once(&channel.element, reason);
                } else {
                    places.push([channel.animation, animation.channels.len()]);
                    values += read.values.len();
                    animation.channels.push(read);
                }
            }
            Err(fault) => report.replace(fault, "the channel is left out"),
        }
    }
    for (index, material) in source.root.materials.iter().enumerate() {
        let targets = [Target::EmissionColor(index), Target::Emission(index)];
        if let Some(emissive) = nominal(scene, &curves, targets, emission_of(material)) {
            scene.materials[index].emissive =
                report.clamp_radiance(emissive, || format!("materials[{index}].emissiveFactor"));
        }
    }
    for (number, description) in light::listed(source).iter().enumerate() {
        let Some(&Some(index)) = lights.get(number) else { continue };
        let targets = [Target::IntensityColor(index), Target::Intensity(index)];
        let own = [description.color, [description.intensity; 3]];
        if let Some(intensity) = nominal(scene, &curves, targets, own) {
            scene.lights[index].intensity =
                report.clamp_radiance(intensity, || format!("KHR_lights_punctual.lights[{number}].intensity"));
        }
    }
}

/// Colour and strength of a material's emission, as the file gives them.
fn emission_of(material: &Material) -> [[f32; 3]; 2] {
    let (factor, strength) = material::emission(material);
    [factor, [strength; 3]]
}

/// Reads a channel, whose values are those of the property. `None` if the property belongs to a light that is not drawn.
fn read_channel(
    source: &Source<'_>,
    channel: &PointerChannel,
    lights: &[Option<usize>],
    report: &mut Report,
) -> Result<Option<Channel>, Fault> {
    let PointerChannel { animation, element, sampler, pointer } = channel;
    let user = format!("{element}.target");
    let material = |step: &str| -> Result<usize, Fault> {
        let index = index_of(step, &user, pointer)?;
        source.get(Index::<Material>::new(index), &user)?;
        Ok(index as usize)
    };
    let light = |step: &str| -> Result<Option<usize>, Fault> {
        let index = index_of(step, &user, pointer)?;
        lookup(light::listed(source), Index::new(index), &user)?;
        Ok(lights.get(index as usize).copied().flatten())
    };
    let (target, shape) = match steps(pointer)[..] {
        ["materials", index, "emissiveFactor"] => (Some(Target::EmissionColor(material(index)?)), Type::Vec3),
        ["materials", index, "extensions", "KHR_materials_emissive_strength", "emissiveStrength"] => {
            (Some(Target::Emission(material(index)?)), Type::Scalar)
        }
        ["extensions", "KHR_lights_punctual", "lights", index, "color"] => {
            (light(index)?.map(Target::IntensityColor), Type::Vec3)
        }
        ["extensions", "KHR_lights_punctual", "lights", index, "intensity"] => {
            (light(index)?.map(Target::Intensity), Type::Scalar)
        }
        _ => {
            report.warn_once(user, format!("{EXTENSION} of {} is not read; it stays as it is", pattern(pointer)));
            return Ok(None);
        }
    };
    let Some(target) = target else { return Ok(None) };
    let samplers = source.root.animations.get(*animation).map_or(&[][..], |animation| &animation.samplers);
    let found =
        lookup(samplers, Index::new(u32::try_from(*sampler).unwrap_or(u32::MAX)), &format!("{element}.sampler"))?;
    let name = format!("animations[{animation}].samplers[{sampler}]");
    Ok(read(source, found, &[target], shape, &name, report)?.pop())
}

fn index_of(step: &str, user: &str, pointer: &str) -> Result<u32, Fault> {
    let index = number_of(step).and_then(|index| u32::try_from(index).ok());
    index.ok_or_else(|| Fault::new(user, format!("{pointer}: {step:?} is not an index")))
}

/// Makes the curves of two targets, a colour and a strength, factors on their nominal values, whose product is returned. `own` are the
/// values at rest. `None` if neither is animated.
fn nominal(scene: &mut Scene, curves: &Curves, targets: [Target; 2], own: [[f32; 3]; 2]) -> Option<[f32; 3]> {
    let places = targets.map(|target| curves.get(&target).map_or(&[][..], Vec::as_slice));
    if places.iter().all(|places| places.is_empty()) {
        return None;
    }
    let mut product = [1.0; 3];
    for ((target, places), own) in targets.into_iter().zip(places).zip(own) {
        let is_color = matches!(target, Target::EmissionColor(_) | Target::IntensityColor(_));
        let own = own.map(|x| if x.is_finite() { x.max(0.0) } else { 0.0 });
        let mut nominal = own;
        for &[animation, channel] in places {
            for [r, g, b, _] in keys(&scene.animations[animation].channels[channel]) {
                let key = if is_color { [r, g, b] } else { [r; 3] };
                nominal.iter_mut().zip(key).for_each(|(nominal, x)| *nominal = nominal.max(x));
            }
        }
        let resting = [0, 1, 2].map(|c| factor(own[c], nominal[c]));
        if resting != [1.0; 3] {
            scene.resting_factors.push((target, resting));
        }
        for &[animation, channel] in places {
            let [r, g, b] = nominal;
            let values = &mut scene.animations[animation].channels[channel].values;
            values.iter_mut().for_each(|v| *v = [factor(v[0], r), factor(v[1], g), factor(v[2], b), 0.0]);
        }
        product = [0, 1, 2].map(|c| product[c] * nominal[c]);
    }
    Some(product)
}

/// The values of a channel's keys, without tangents.
fn keys(channel: &Channel) -> impl Iterator<Item = [f32; 4]> {
    let (first, step) = if channel.interpolation == Interpolation::CubicSpline { (1, 3) } else { (0, 1) };
    channel.values.iter().copied().skip(first).step_by(step)
}

/// A value as a factor on its nominal value, finite.
fn factor(value: f32, nominal: f32) -> f32 {
    if nominal > 0.0 { (value / nominal).clamp(f32::MIN, f32::MAX) } else { 0.0 }
}
