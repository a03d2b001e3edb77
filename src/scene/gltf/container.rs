//! From bytes to JSON: the GLB container, the version and the extensions of a file.

use gltf::json::Root;
use serde_json::Value;

use crate::scene::load::report::{Fault, Report};

/// Extensions that are honoured.
const READ: [&str; 5] = [
    "KHR_lights_punctual",
    "KHR_materials_emissive_strength",
    "KHR_materials_unlit",
    "KHR_mesh_quantization",
    "KHR_texture_transform",
];

/// An opened file.
pub(super) struct Container<'a> {
    pub root: Root,
    /// The binary chunk of a GLB file.
    pub binary: Option<&'a [u8]>,
}

/// Takes a `.gltf` or `.glb` file apart, whatever its name, and checks that it can be read at all.
pub(super) fn open<'a>(bytes: &'a [u8], report: &mut Report) -> Result<Container<'a>, Fault> {
    let (json, binary) = if bytes.starts_with(b"glTF") { split(bytes)? } else { (bytes, None) };
    let root = parse(json, report)?;
    check_version(&root)?;
    check_extensions(&root, report)?;
    Ok(Container { root, binary })
}

/// The JSON chunk and the binary chunk of a GLB file.
fn split(bytes: &[u8]) -> Result<(&[u8], Option<&[u8]>), Fault> {
    let fault = |reason: String| Fault::new("GLB header", reason);
    let word = |at: usize| {
        let word = bytes.get(at..).and_then(|rest| rest.first_chunk::<4>());
        word.map(|&word| u32::from_le_bytes(word))
            .ok_or_else(|| fault(format!("the file ends at byte {}", bytes.len())))
    };
    let (version, length) = (word(4)?, word(8)? as usize);
    if version != 2 {
        return Err(fault(format!("version {version}; only 2 is read")));
    }
    if length > bytes.len() {
        return Err(fault(format!("announces {length} bytes; the file has {}", bytes.len())));
    }

    let mut chunks = Vec::new();
    let mut at = 12;
    while at < length {
        let size = word(at)? as usize;
        let kind = word(at + 4)?.to_le_bytes();
        let start = at + 8;
        let chunk = start.checked_add(size).and_then(|end| bytes.get(start..end)).ok_or_else(|| {
            Fault::new(format!("GLB chunk {}", chunks.len()), format!("{size} bytes from {start} on are past the end"))
        })?;
        chunks.push((kind, chunk));
        at = start + size.next_multiple_of(4);
    }
    let json = chunks.first().filter(|(kind, _)| kind == b"JSON").map(|&(_, chunk)| chunk);
    let json = json.ok_or_else(|| Fault::new("GLB chunk 0", "is not JSON"))?;
    // Chunks of other kinds are to be ignored.
    let binary = chunks.iter().find(|(kind, _)| kind == b"BIN\0").map(|&(_, chunk)| chunk);
    Ok((json, binary))
}

fn parse(json: &[u8], report: &mut Report) -> Result<Root, Fault> {
    let json = json.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(json);
    if json.iter().all(u8::is_ascii_whitespace) {
        return Err(Fault::new("JSON", "the file is empty"));
    }
    Root::from_slice(json).or_else(|error| {
        let fault = || Fault::new("JSON", error.to_string());
        let mut value: Value = serde_json::from_slice(json).map_err(|_| fault())?;
        let dropped = repair(&mut value);
        let root = serde_json::from_value(value).map_err(|_| fault())?;
        if dropped {
            report.warn_once("animations", "channels that do not move a node are not read");
        }
        Ok(root)
    })
}

/// Changes what the specification allows and the reader does not: a scene without nodes, and animation channels
/// without a node (they belong to an extension). Tells whether channels were dropped.
fn repair(root: &mut Value) -> bool {
    let list = |value: &mut Value, name: &str| -> Vec<Value> {
        value.get_mut(name).and_then(Value::as_array_mut).map(std::mem::take).unwrap_or_default()
    };
    let mut scenes = list(root, "scenes");
    for scene in scenes.iter_mut().filter_map(Value::as_object_mut) {
        scene.entry("nodes").or_insert_with(|| Value::Array(Vec::new()));
    }
    let mut dropped = false;
    let mut animations = list(root, "animations");
    for channels in animations.iter_mut().filter_map(|animation| animation.get_mut("channels")?.as_array_mut()) {
        let before = channels.len();
        channels.retain(|channel| channel.pointer("/target/node").is_some());
        dropped |= channels.len() < before;
    }
    if let Some(root) = root.as_object_mut() {
        root.insert("scenes".into(), Value::Array(scenes));
        root.insert("animations".into(), Value::Array(animations));
    }
    dropped
}

fn check_version(root: &Root) -> Result<(), Fault> {
    let asset = &root.asset;
    // A later minor version is readable, unless the file says that it is not.
    let readable = match &asset.min_version {
        Some(minimum) => minimum == "2.0",
        None => asset.version.split('.').next() == Some("2"),
    };
    if readable {
        return Ok(());
    }
    Err(Fault::new("asset.version", format!("{}; only glTF 2.0 is read", asset.version)))
}

fn check_extensions(root: &Root, report: &mut Report) -> Result<(), Fault> {
    for (index, name) in root.extensions_required.iter().enumerate() {
        if !READ.contains(&name.as_str()) {
            let element = format!("extensionsRequired[{index}]");
            return Err(Fault::new(element, format!("{name} is not supported; supported are {}", READ.join(", "))));
        }
    }
    for name in &root.extensions_used {
        if !READ.contains(&name.as_str()) {
            report.warn_once(format!("extension {name}"), format!("{name} is not read; the file is drawn without it"));
        }
    }
    Ok(())
}
