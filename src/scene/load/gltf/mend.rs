//! Repair of JSON that is not glTF in places: each element that cannot be read is left out on its own.
//!
//! The JSON reader refuses a whole file for one value of a wrong type. Here the value is found and removed, so that its default applies.
//! If an element requires the value, the element is removed. An element to which others refer by number is replaced by an empty one,
//! because a gap would renumber the elements after it.

use gltf::json::{self, Root};
use serde::de::DeserializeOwned;
use serde_json::{Map, Value, json};
use serde_path_to_error::{Path, Segment, deserialize};

use crate::scene::load::common::report::{Fault, Report};

/// Maximum number of values that are removed from one element before the element itself is removed.
const MOST: usize = 256;

/// The root of a file whose JSON is not that of glTF 2.0 everywhere.
pub(super) fn mend(mut root: Value, report: &mut Report) -> Result<Root, Fault> {
    whole_numbers(&mut root);
    if remove_absent(&mut root) {
        report.warn_once("JSON", "an index of -1 is read as no index");
    }
    if remove_foreign_channels(&mut root) {
        report.warn_once("animations", "channels that do not move a node are not read");
    }
    macro_rules! lists {
        ($($name:literal: $element:ty,)+) => { $(mend_list::<$element>(&mut root, $name, report);)+ };
    }
    lists! {
        "accessors": json::Accessor,
        "animations": json::Animation,
        "buffers": json::Buffer,
        "bufferViews": json::buffer::View,
        "cameras": json::Camera,
        "images": json::Image,
        "materials": json::Material,
        "meshes": json::Mesh,
        "nodes": json::Node,
        "samplers": json::texture::Sampler,
        "scenes": json::Scene,
        "skins": json::Skin,
        "textures": json::Texture,
    }
    read::<Root>(&mut root, "", report)
}

/// Reads the elements of a list one by one.
fn mend_list<T: DeserializeOwned>(root: &mut Value, name: &str, report: &mut Report) {
    let Some(list) = root.get_mut(name).and_then(Value::as_array_mut) else { return };
    for (index, element) in list.iter_mut().enumerate() {
        let place = format!("{name}[{index}]");
        if let Err(fault) = read::<T>(element, &place, report) {
            report.remove(&place, &fault.reason);
            *element = empty(name);
        }
    }
}

/// Reads an element at `place`, after its unreadable values have been removed.
fn read<T: DeserializeOwned>(element: &mut Value, place: &str, report: &mut Report) -> Result<T, Fault> {
    let mut removed: Option<Vec<Key>> = None;
    for _ in 0..MOST {
        let error = match deserialize::<_, T>(&*element) {
            Ok(read) => return Ok(read),
            Err(error) => error,
        };
        let reason = error.inner().to_string();
        let fault = || Fault::new(if place.is_empty() { "JSON" } else { place }, reason.clone());
        let place_of_error = keys(error.path());
        // Without a required value the element is lost, and one warning is enough for both.
        if removed.as_ref().is_some_and(|removed| removed.starts_with(&place_of_error)) {
            report.withdraw();
        }
        let path = removable(&place_of_error, element, &reason).ok_or_else(fault)?;
        let name = written(place, &path);
        if !remove(element, &path) {
            return Err(fault());
        }
        report.remove(&name, &reason);
        removed = Some(path);
    }
    Err(Fault::new(place, format!("more than {MOST} of its values cannot be read")))
}

/// A step down into a value.
#[derive(Clone, Debug, PartialEq)]
enum Key {
    Member(String),
    Index(usize),
}

fn keys(path: &Path) -> Vec<Key> {
    let key = |segment: &Segment| match segment {
        Segment::Seq { index } => Some(Key::Index(*index)),
        Segment::Map { key } => Some(Key::Member(key.clone())),
        Segment::Enum { .. } | Segment::Unknown => None,
    };
    path.iter().map_while(key).collect()
}

/// The smallest part of `element`, at the end of `path` or above it, that may be absent.
fn removable(path: &[Key], element: &Value, reason: &str) -> Option<Vec<Key>> {
    let mut path = path.to_vec();
    // In extensions the path ends at an object with a faulty member, because the reader does not tell which.
    if let Some(Value::Object(members)) = at(element, &path)
        && path.last() == Some(&Key::Member("extensions".into()))
        && members.len() == 1
        && !reason.starts_with("missing field")
    {
        path.extend(members.keys().next().map(|key| Key::Member(key.clone())));
    }
    loop {
        match (path.last()?, path.get(path.len().wrapping_sub(2))) {
            (Key::Member(_), _) => return Some(path),
            // Lists without references into them, and lists that are read one by one.
            (Key::Index(_), Some(Key::Member(list))) if list_of(list).is_some() => return Some(path),
            // The components of a vector.
            (Key::Index(_), _) => path.pop(),
        };
    }
}

fn at<'a>(mut value: &'a Value, path: &[Key]) -> Option<&'a Value> {
    for key in path {
        value = match key {
            Key::Member(name) => value.get(name)?,
            Key::Index(index) => value.get(index)?,
        };
    }
    Some(value)
}

/// Removes a member of an object or an element of a list.
fn remove(element: &mut Value, path: &[Key]) -> bool {
    let Some((last, above)) = path.split_last() else { return false };
    let mut value = element;
    for key in above {
        let next = match key {
            Key::Member(name) => value.get_mut(name),
            Key::Index(index) => value.get_mut(index),
        };
        let Some(next) = next else { return false };
        value = next;
    }
    match (last, value, above.last()) {
        (Key::Member(name), Value::Object(members), _) => members.remove(name).is_some(),
        (Key::Index(index), Value::Array(list), Some(Key::Member(name))) => match list_of(name) {
            Some(List::Free) if *index < list.len() => {
                list.remove(*index);
                true
            }
            Some(List::Numbered) => list.get_mut(*index).map(|element| *element = empty(name)).is_some(),
            _ => false,
        },
        _ => false,
    }
}

/// The rule for removing elements of a list.
enum List {
    /// Nothing refers to them by number.
    Free,
    /// Others refer to them by number, so that an empty one takes the place of a removed one.
    Numbered,
}

fn list_of(name: &str) -> Option<List> {
    match name {
        "children" | "channels" | "primitives" | "nodes" | "extensionsUsed" | "extensionsRequired" => Some(List::Free),
        "samplers" | "targets" | "lights" => Some(List::Numbered),
        _ => None,
    }
}

/// An element that is read and draws nothing.
fn empty(list: &str) -> Value {
    const NONE: u32 = u32::MAX;
    match list {
        "accessors" => json!({"componentType": 5126, "count": 0, "type": "SCALAR"}),
        "animations" => json!({"channels": [], "samplers": []}),
        "buffers" => json!({"byteLength": 0}),
        "bufferViews" => json!({"buffer": NONE, "byteLength": 0}),
        "cameras" | "lights" => json!({"type": "none"}),
        "meshes" => json!({"primitives": []}),
        "samplers" => json!({"input": NONE, "output": NONE}),
        "scenes" => json!({"nodes": []}),
        "skins" => json!({"joints": []}),
        _ => json!({}),
    }
}

/// A path as messages write it: `nodes[3].rotation`.
fn written(place: &str, path: &[Key]) -> String {
    let mut written = place.to_owned();
    for key in path {
        match key {
            Key::Member(name) if written.is_empty() => written.push_str(name),
            Key::Member(name) => written.extend([".", name]),
            Key::Index(index) => written.push_str(&format!("[{index}]")),
        }
    }
    written
}

/// Writes whole numbers without a decimal point, because some exporters print all numbers with one and the reader does not take `5126.0`
/// for an integer. Real numbers may be written as whole ones.
fn whole_numbers(value: &mut Value) {
    /// Whole numbers up to here are exact in f64.
    const LARGEST: f64 = 9_007_199_254_740_992.0;
    match value {
        Value::Number(number) if number.is_f64() => {
            let whole = number.as_f64().filter(|real| real.fract() == 0.0 && real.abs() <= LARGEST);
            if let Some(whole) = whole {
                *value = if whole < 0.0 { json!(whole as i64) } else { json!(whole as u64) };
            }
        }
        Value::Array(list) => list.iter_mut().for_each(whole_numbers),
        Value::Object(members) => members.values_mut().for_each(whole_numbers),
        _ => {}
    }
}

/// Removes indices of −1, which some writers use for an absent one. Returns true if there were any.
fn remove_absent(value: &mut Value) -> bool {
    const INDICES: [&str; 9] =
        ["material", "mesh", "skin", "camera", "sampler", "source", "skeleton", "scene", "inverseBindMatrices"];
    match value {
        Value::Array(list) => list.iter_mut().fold(false, |any, element| remove_absent(element) | any),
        Value::Object(members) => {
            let before = members.len();
            members.retain(|name, value| value.as_i64() != Some(-1) || !INDICES.contains(&name.as_str()));
            let removed = members.len() < before;
            members.values_mut().fold(removed, |any, value| remove_absent(value) | any)
        }
        _ => false,
    }
}

/// Removes animation channels without a node, which belong to an extension, and gives a scene without nodes an empty list. The
/// specification allows both, but the reader does not. Returns true if channels were removed.
fn remove_foreign_channels(root: &mut Value) -> bool {
    let mut removed = false;
    for animation in elements(root, "animations") {
        if let Some(channels) = animation.get_mut("channels").and_then(Value::as_array_mut) {
            let before = channels.len();
            let extended = |channel: &Value| {
                channel.get("target").is_some_and(|target| target.is_object() && target.get("node").is_none())
            };
            channels.retain(|channel| !extended(channel));
            removed |= channels.len() < before;
        }
    }
    for scene in elements(root, "scenes") {
        scene.entry("nodes").or_insert_with(|| json!([]));
    }
    removed
}

/// The objects of a list of the root.
fn elements<'a>(root: &'a mut Value, name: &str) -> impl Iterator<Item = &'a mut Map<String, Value>> {
    let list = root.get_mut(name).and_then(Value::as_array_mut);
    list.into_iter().flatten().filter_map(Value::as_object_mut)
}
