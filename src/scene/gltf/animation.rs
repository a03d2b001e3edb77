//! Animations of nodes.

use std::collections::HashSet;

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::animation::{self as json, Property, Sampler};
use gltf::json::validation::Checked;

use super::accessor::{Elements, REAL};
use super::node::Places;
use super::source::{Source, lookup};
use crate::scene::description::{Animation, Channel, Interpolation, Scene, Target};
use crate::scene::load::report::{Fault, Report};

/// Most values that the channels of one file may have together. Channels may share accessors, so that the size of the
/// file alone does not bound them.
const MAX_VALUES: usize = 1 << 25;

/// Reads all animations, which keep their indices. Channels of nodes that are not in the scene are left out.
pub(super) fn read_all(
    source: &Source<'_>,
    report: &mut Report,
    scene: &mut Scene,
    places: &Places,
) -> Result<(), Fault> {
    let mut values = 0;
    for (index, animation) in source.root.animations.iter().enumerate() {
        let mut channels = Vec::new();
        let mut targets = HashSet::new();
        for (number, channel) in animation.channels.iter().enumerate() {
            let element = format!("animations[{index}].channels[{number}]");
            source.get(channel.target.node, &format!("{element}.target.node"))?;
            let sampler = lookup(&animation.samplers, channel.sampler, &format!("{element}.sampler"))?;
            let Some(&node) = places.get(&channel.target.node.value()) else { continue };
            let (target, shape) = match channel.target.path {
                Checked::Valid(Property::Translation) => (Target::Translation(node), Type::Vec3),
                Checked::Valid(Property::Rotation) => (Target::Rotation(node), Type::Vec4),
                Checked::Valid(Property::Scale) => (Target::Scale(node), Type::Vec3),
                Checked::Valid(Property::MorphTargetWeights) => {
                    report.warn_once(element, "morph targets are not read; the base shape is drawn");
                    continue;
                }
                Checked::Invalid => {
                    let reason = "is none of translation, rotation, scale and weights";
                    return Err(Fault::new(format!("{element}.target.path"), reason));
                }
            };
            if !targets.insert(target) {
                report.warn(element, "an earlier channel has the same target; this one is left out");
                continue;
            }
            let element = format!("animations[{index}].samplers[{}]", channel.sampler);
            let channel = read(source, sampler, target, shape, &element)?;
            values += channel.values.len();
            if values > MAX_VALUES {
                return Err(Fault::new(element, format!("the file has more than {MAX_VALUES} animated values")));
            }
            channels.push(channel);
        }
        let name = animation.name.clone().unwrap_or_else(|| format!("animation {index}"));
        scene.animations.push(Animation { name, channels });
    }
    Ok(())
}

fn read(source: &Source<'_>, sampler: &Sampler, target: Target, shape: Type, element: &str) -> Result<Channel, Fault> {
    let (interpolation, per_key) = match sampler.interpolation {
        Checked::Valid(json::Interpolation::Step) => (Interpolation::Step, 1),
        Checked::Valid(json::Interpolation::Linear) => (Interpolation::Linear, 1),
        Checked::Valid(json::Interpolation::CubicSpline) => (Interpolation::CubicSpline, 3),
        Checked::Invalid => {
            return Err(Fault::new(format!("{element}.interpolation"), "is none of LINEAR, STEP and CUBICSPLINE"));
        }
    };
    let (input, output) = (format!("{element}.input"), format!("{element}.output"));
    let times = Elements::open(source, sampler.input, Type::Scalar, &[ComponentType::F32], &input)?;
    let values = Elements::open(source, sampler.output, shape, REAL, &output)?;
    let (keys, outputs) = (times.len(), values.len());
    if keys == 0 {
        return Err(Fault::new(input, "there are no keys"));
    }
    if keys.checked_mul(per_key) != Some(outputs) {
        return Err(Fault::new(output, format!("{outputs} values for {keys} keys, where each has {per_key}")));
    }
    if outputs > MAX_VALUES {
        return Err(Fault::new(output, format!("{outputs} values; at most {MAX_VALUES} are read")));
    }
    let times: Vec<f32> = (0..keys).map(|key| times.vector::<1>(key)[0]).collect();
    // Also false for NaN.
    let increasing = times.is_sorted_by(|earlier, later| earlier < later);
    if !increasing || times.iter().any(|time| !time.is_finite()) {
        return Err(Fault::new(input, "key times are not finite and increasing"));
    }
    let values: Vec<[f32; 4]> = (0..outputs).map(|index| values.vector(index)).collect();
    if let Some(index) = values.iter().position(|value| value.iter().any(|number| !number.is_finite())) {
        return Err(Fault::new(output, format!("value {index} is not finite")));
    }
    Ok(Channel { target, interpolation, times, values })
}
