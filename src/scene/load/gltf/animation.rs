//! Animations of nodes and of morph weights.

use std::collections::HashSet;

use gltf::json::accessor::{ComponentType, Type};
use gltf::json::animation::{self as json, Property, Sampler};
use gltf::json::validation::Checked;

use super::accessor::{Elements, REAL};
use super::source::{Places, Source, lookup};
use crate::scene::description::{Animation, Channel, Interpolation, Scene, Target};
use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of values of all channels of one file. The size of the file does not bound them, because channels may share accessors.
pub(super) const MAX_VALUES: usize = 1 << 25;

/// Reads all animations, which keep their indices. Channels of nodes outside the scene are left out.
pub(super) fn read_all(source: &Source<'_>, report: &mut Report, scene: &mut Scene, places: &Places) {
    let mut values = 0;
    for (index, animation) in source.root.animations.iter().enumerate() {
        let mut channels = Vec::new();
        let mut targets = HashSet::new();
        for (number, channel) in animation.channels.iter().enumerate() {
            let element = format!("animations[{index}].channels[{number}]");
            match read_channel(source, animation, index, channel, &element, (places, scene), report) {
                Ok(read) if read.iter().any(|channel| targets.contains(&channel.target)) => {
                    report.warn(element, "an earlier channel has the same target; this one is left out");
                }
                Ok(read) if values + read.iter().map(|channel| channel.values.len()).sum::<usize>() > MAX_VALUES => {
                    let reason = format!("the file has more than {MAX_VALUES} animated values; it is left out");
                    report.warn_once(element, reason);
                }
                Ok(read) => {
                    values += read.iter().map(|channel| channel.values.len()).sum::<usize>();
                    targets.extend(read.iter().map(|channel| channel.target));
                    channels.extend(read);
                }
                Err(fault) => report.replace(fault, "the channel is left out"),
            }
        }
        let name = animation.name.clone().unwrap_or_else(|| format!("animation {index}"));
        scene.animations.push(Animation { name, channels });
    }
}

/// Reads a channel: one for each morph target if it is one of weights, and none if it moves nothing that is drawn.
fn read_channel(
    source: &Source<'_>,
    animation: &json::Animation,
    index: usize,
    channel: &json::Channel,
    element: &str,
    (places, scene): (&Places, &Scene),
    report: &mut Report,
) -> Result<Vec<Channel>, Fault> {
    source.get(channel.target.node, &format!("{element}.target.node"))?;
    let Some(&node) = places.get(&channel.target.node.value()) else { return Ok(Vec::new()) };
    let (targets, shape) = match channel.target.path {
        Checked::Valid(Property::Translation) => (vec![Target::Translation(node)], Type::Vec3),
        Checked::Valid(Property::Rotation) => (vec![Target::Rotation(node)], Type::Vec4),
        Checked::Valid(Property::Scale) => (vec![Target::Scale(node)], Type::Vec3),
        Checked::Valid(Property::MorphTargetWeights) => {
            let count = scene.nodes.get(node).map_or(0, |node| scene.target_count(node));
            if count == 0 {
                let extensions = source.root.nodes[channel.target.node.value()].extensions.as_ref();
                let repeats = extensions.is_some_and(|all| all.others.contains_key("EXT_mesh_gpu_instancing"));
                let reason = if repeats {
                    "animated weights of EXT_mesh_gpu_instancing are not read"
                } else {
                    "the meshes of the node have no morph targets"
                };
                return Err(Fault::new(format!("{element}.target"), reason));
            }
            ((0..count).map(|target| Target::Weight { node, target }).collect(), Type::Scalar)
        }
        Checked::Invalid => {
            let reason = "is none of translation, rotation, scale and weights";
            return Err(Fault::new(format!("{element}.target.path"), reason));
        }
    };
    let sampler = lookup(&animation.samplers, channel.sampler, &format!("{element}.sampler"))?;
    read(source, sampler, &targets, shape, &format!("animations[{index}].samplers[{}]", channel.sampler), report)
}

/// Reads the keys of a channel, of which each has a value for each target.
pub(super) fn read(
    source: &Source<'_>,
    sampler: &Sampler,
    targets: &[Target],
    shape: Type,
    element: &str,
    report: &mut Report,
) -> Result<Vec<Channel>, Fault> {
    let (interpolation, parts) = match sampler.interpolation {
        Checked::Valid(json::Interpolation::Step) => (Interpolation::Step, 1),
        Checked::Valid(json::Interpolation::Linear) => (Interpolation::Linear, 1),
        Checked::Valid(json::Interpolation::CubicSpline) => (Interpolation::CubicSpline, 3),
        Checked::Invalid => {
            let reason = "is none of LINEAR, STEP and CUBICSPLINE";
            report.replace(Fault::new(format!("{element}.interpolation"), reason), "LINEAR is used");
            (Interpolation::Linear, 1)
        }
    };
    // A spline has all in-tangents of a key first, then all values, then all out-tangents.
    let per_key = parts * targets.len();
    let (input, output) = (format!("{element}.input"), format!("{element}.output"));
    let times = Elements::open(source, sampler.input, Type::Scalar, &[ComponentType::F32], &input)?;
    let values = Elements::open(source, sampler.output, shape, REAL, &output)?;
    let (keys, outputs) = (times.len(), values.len());
    if keys == 0 {
        return Err(Fault::new(input, "there are no keys"));
    }
    if outputs > MAX_VALUES {
        return Err(Fault::new(output, format!("{outputs} values; at most {MAX_VALUES} are read")));
    }
    if outputs % per_key != 0 || outputs == 0 {
        return Err(Fault::new(output, format!("{outputs} values for {keys} keys, where each has {per_key}")));
    }
    if outputs / per_key != keys {
        let reason = format!("{outputs} values for {keys} keys, where each has {per_key}");
        report.replace(Fault::new(&output, reason), "keys without values, and values without keys, are left out");
    }
    let mut kept = Keys::default();
    for key in 0..keys.min(outputs / per_key) {
        let own: Vec<[f32; 4]> = (0..per_key).map(|part| values.vector(key * per_key + part)).collect();
        kept.add(times.vector::<1>(key)[0], &own);
    }
    let broken = Fault::new(&input, format!("{} keys are not finite", kept.broken));
    match kept {
        Keys { times, .. } if times.is_empty() => return Err(broken),
        Keys { disordered: true, .. } => return Err(Fault::new(input, "key times decrease")),
        Keys { broken: 0, .. } => {}
        _ => report.replace(broken, "they are left out"),
    }
    let channel = |(number, &target): (usize, &Target)| {
        let values = kept.values.iter().skip(number).step_by(targets.len()).copied().collect();
        Channel { target, interpolation, times: kept.times.clone(), values }
    };
    Ok(targets.iter().enumerate().map(channel).collect())
}

/// Keys whose times increase.
#[derive(Default)]
struct Keys {
    times: Vec<f32>,
    values: Vec<[f32; 4]>,
    /// Number of keys that are not finite.
    broken: usize,
    disordered: bool,
}

impl Keys {
    /// Adds a key. Some exporters write a jump as two keys of the same time; the second one is then moved by an instant.
    fn add(&mut self, time: f32, values: &[[f32; 4]]) {
        if !time.is_finite() || values.iter().flatten().any(|number| !number.is_finite()) {
            self.broken += 1;
            return;
        }
        let later = match self.times.last() {
            Some(&last) if time <= last => {
                // Each further key of the same time moves by one instant more.
                self.disordered |= time < last - 1e-5 * last.abs().max(1.0);
                last.next_up()
            }
            _ => time,
        };
        self.times.push(later);
        self.values.extend_from_slice(values);
    }
}
