//! Animation channels that lead to a property by its JSON pointer instead of a node (KHR_animation_pointer).

use serde_json::{Map, Value, json};

pub(super) const EXTENSION: &str = "KHR_animation_pointer";

/// A channel that is not one of a node.
pub(super) struct PointerChannel {
    pub animation: usize,
    /// The channel, as the file names it.
    pub element: String,
    pub sampler: usize,
    pub pointer: String,
}

/// Takes channels with pointers out of the JSON. Those of nodes' own properties become ordinary ones.
pub(super) fn extract(root: &mut Value) -> Vec<PointerChannel> {
    let mut extracted = Vec::new();
    let animations = root.get_mut("animations").and_then(Value::as_array_mut);
    for (animation, description) in animations.into_iter().flatten().enumerate() {
        let Some(channels) = description.get_mut("channels").and_then(Value::as_array_mut) else { continue };
        let mut number = 0;
        channels.retain_mut(|channel| {
            let element = format!("animations[{animation}].channels[{number}]");
            number += 1;
            let sampler = channel.get("sampler").and_then(Value::as_f64).filter(|sampler| sampler.fract() == 0.0);
            let Some(target) = channel.get_mut("target").and_then(Value::as_object_mut) else { return true };
            let Some(pointer) = pointer_of(target) else { return true };
            if let ["nodes", node, path @ ("translation" | "rotation" | "scale" | "weights")] = steps(&pointer)[..]
                && let Some(node) = number_of(node)
            {
                *target = Map::from_iter([("node".into(), json!(node)), ("path".into(), json!(path))]);
                return true;
            }
            let sampler = sampler.map_or(usize::MAX, |sampler| sampler as usize);
            extracted.push(PointerChannel { animation, element, sampler, pointer });
            false
        });
    }
    extracted
}

/// The pointer of a channel's target that has no node.
fn pointer_of(target: &Map<String, Value>) -> Option<String> {
    let is_pointer = target.get("path")? == "pointer" && !target.contains_key("node");
    let pointer = target.get("extensions")?.get(EXTENSION)?.get("pointer")?.as_str()?;
    is_pointer.then(|| pointer.to_owned())
}

/// The steps of a pointer, which begins with a slash.
pub(super) fn steps(pointer: &str) -> Vec<&str> {
    pointer.strip_prefix('/').map_or_else(Vec::new, |steps| steps.split('/').collect())
}

/// A step that is an index (RFC 6901).
pub(super) fn number_of(step: &str) -> Option<usize> {
    step.parse().ok().filter(|number: &usize| number.to_string() == step)
}

/// A pointer whose indices are left open, so that a property of many elements is named once.
pub(super) fn pattern(pointer: &str) -> String {
    let open = |step| if number_of(step).is_some() { "*" } else { step };
    steps(pointer).iter().fold(String::new(), |all, step| format!("{all}/{}", open(step)))
}
