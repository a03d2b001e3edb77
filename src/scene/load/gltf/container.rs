//! The way from bytes to JSON: the GLB container, the version and the extensions of a file.

use std::collections::BTreeSet;

use gltf::json::Root;
use serde_json::Value;

use super::mend::mend;
use super::pointer::{PointerChannel, extract};
use super::text::tidy;
use crate::scene::load::common::encoding;
use crate::scene::load::common::recognise::foreign;
use crate::scene::load::common::report::{Fault, Report};

/// The extensions that are honoured.
const READ: [&str; 15] = [
    "EXT_mesh_gpu_instancing",
    "EXT_texture_webp",
    "KHR_animation_pointer",
    "KHR_lights_punctual",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_node_visibility",
    "KHR_texture_transform",
];

/// An opened file.
pub(super) struct Container<'a> {
    pub root: Root,
    /// Animation channels that are not those of nodes.
    pub pointers: Vec<PointerChannel>,
    /// The binary chunk of a GLB file.
    pub binary: Option<&'a [u8]>,
}

/// Splits a `.gltf` or `.glb` file into its parts, whatever its name, and checks that it can be read at all.
pub(super) fn open<'a>(bytes: &'a [u8], report: &mut Report) -> Result<Container<'a>, Fault> {
    let (json, binary) = if bytes.starts_with(b"glTF") { split(bytes, report)? } else { (bytes, None) };
    let (root, pointers) = parse(json, report)?;
    check_version(&root)?;
    check_extensions(&root, report)?;
    Ok(Container { root, pointers, binary })
}

/// The JSON chunk and the binary chunk of a GLB file.
fn split<'a>(bytes: &'a [u8], report: &mut Report) -> Result<(&'a [u8], Option<&'a [u8]>), Fault> {
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

    let is_chunk = |at: usize| matches!(bytes.get(at + 4..at + 8), Some(b"JSON" | b"BIN\0"));
    let mut chunks = Vec::new();
    let mut at = 12;
    // Streaming writers leave a length of 0. Other writers count the first chunk alone.
    while at < length.min(bytes.len()) || is_chunk(at) {
        let size = word(at).map(|size| size as usize);
        let kind = word(at + 4).map(u32::to_le_bytes);
        let start = at + 8;
        let chunk = size.as_ref().ok().and_then(|&size| bytes.get(start..start.checked_add(size)?));
        let (Ok(size), Ok(kind), Some(chunk)) = (&size, &kind, chunk) else {
            if !chunks.is_empty() && !is_chunk(at) {
                break; // bytes after the last chunk
            }
            size.as_ref().map_err(Fault::clone)?;
            kind.as_ref().map_err(Fault::clone)?;
            let reason = format!("{} bytes from {start} on are past the end", size.unwrap_or_default());
            return Err(Fault::new(format!("GLB chunk {}", chunks.len()), reason));
        };
        chunks.push((*kind, chunk));
        // Some writers leave the padding out.
        let unpadded = start + size;
        at = if is_chunk(unpadded) { unpadded } else { start + size.next_multiple_of(4) };
    }
    let json = chunks.first().filter(|(kind, _)| kind == b"JSON").map(|&(_, chunk)| chunk);
    let json = json.ok_or_else(|| Fault::new("GLB chunk 0", "is not JSON"))?;
    // The specification says to ignore chunks of other kinds.
    let binary = chunks.iter().find(|(kind, _)| kind == b"BIN\0").map(|&(_, chunk)| chunk);
    if length > bytes.len() {
        if binary.is_none() {
            return Err(fault(format!("announces {length} bytes; the file has {}", bytes.len())));
        }
        report.warn("GLB header", format!("announces {length} bytes; the file has {}, which are read", bytes.len()));
    }
    Ok((json, binary))
}

fn parse(json: &[u8], report: &mut Report) -> Result<(Root, Vec<PointerChannel>), Fault> {
    let whole = json.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(json);
    // Writers pad chunks with zeros as well as with spaces.
    let end = whole.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
    let json = whole.get(..end).unwrap_or_default();
    if json.iter().all(u8::is_ascii_whitespace) {
        return Err(Fault::new("JSON", "the file is empty"));
    }
    if let Ok(root) = Root::from_slice(json) {
        let mut primitives = root.meshes.iter().flat_map(|mesh| &mesh.primitives);
        if primitives.any(|primitive| primitive.targets.is_some())
            && let Ok(root) = serde_json::from_slice(json)
        {
            warn_of_targets(&root, report);
        }
        // A channel with a pointer has no node, without which the JSON reader refuses the file.
        return Ok((root, Vec::new()));
    }
    let mut value = match serde_json::from_slice(json) {
        Ok(value) => value,
        Err(error) => {
            let (value, instead) = match before_rest(json, &error) {
                Some(value) => (value, "they are left out"),
                None => (nearly_json(whole, &error)?, "it is read as if it were JSON"),
            };
            report.warn("JSON", format!("{error}; {instead}"));
            value
        }
    };
    check_kind(&mut value, report)?;
    warn_of_targets(&value, report);
    let pointers = extract(&mut value);
    Ok((mend(value, report)?, pointers))
}

/// The value at the start of a text that continues with other characters.
fn before_rest(json: &[u8], error: &serde_json::Error) -> Option<Value> {
    let rest = error.to_string().starts_with("trailing characters");
    rest.then(|| serde_json::Deserializer::from_slice(json).into_iter().next()?.ok()).flatten()
}

/// The value of a text in any encoding that is not strict JSON. The fault is that of the JSON reader, unless the file is of another
/// kind.
fn nearly_json(whole: &[u8], error: &serde_json::Error) -> Result<Value, Fault> {
    let (text, _) = encoding::decode(whole);
    serde_json::from_str(&tidy(&text)).map_err(|_| match foreign(whole) {
        Some(kind) if !whole.trim_ascii_start().starts_with(b"{") => Fault::new("file", kind),
        _ => Fault::new("JSON", error.to_string()),
    })
}

/// Warns of attributes that morph targets move beside positions and normals. The JSON reader drops these.
fn warn_of_targets(root: &Value, report: &mut Report) {
    fn list<'a>(value: &'a Value, name: &str) -> &'a [Value] {
        value.get(name).and_then(Value::as_array).map_or(&[], Vec::as_slice)
    }
    for (mesh, description) in list(root, "meshes").iter().enumerate() {
        for (number, primitive) in list(description, "primitives").iter().enumerate() {
            let targets = list(primitive, "targets");
            let mut names = targets.iter().filter_map(Value::as_object).flat_map(|target| target.keys());
            if let Some(name) = names.find(|name| name.starts_with("COLOR_") || name.starts_with("TEXCOORD_")) {
                let element = format!("meshes[{mesh}].primitives[{number}].targets");
                report.warn_once(element, format!("{name} of morph targets is not read"));
            }
        }
    }
}

/// Refuses JSON that is not glTF 2.0.
fn check_kind(root: &mut Value, report: &mut Report) -> Result<(), Fault> {
    let lists = ["meshes", "nodes", "accessors"];
    let version = root.pointer("/asset/version").cloned();
    // In glTF 1.0, lists are objects.
    let first = lists.iter().any(|&list| root.get(list).is_some_and(Value::is_object));
    match version {
        Some(Value::String(version)) if !version.starts_with('1') && !first => return Ok(()),
        Some(Value::Number(number)) if number.as_f64().is_some_and(|number| (2.0..3.0).contains(&number)) => {
            report.warn("asset.version", "is a number; it is read as 2.0");
        }
        None if !first && lists.iter().all(|&list| root.get(list).is_some_and(Value::is_array)) => {
            report.warn("asset.version", "there is none; the file is read as glTF 2.0");
        }
        None if !first => return Err(Fault::new("JSON", "there is no asset.version: this is not a glTF file")),
        version => {
            let version = version.map_or("1.0".into(), |version| version.to_string().replace('"', ""));
            return Err(Fault::new("asset.version", format!("{version}: glTF {version} is not read; 2.0 is")));
        }
    }
    if let Some(root) = root.as_object_mut() {
        root.insert("asset".into(), serde_json::json!({"version": "2.0"}));
    }
    Ok(())
}

fn check_version(root: &Root) -> Result<(), Fault> {
    let asset = &root.asset;
    // A later minor version is readable, unless the file says that it is not.
    let number = |version: &str| version.trim().trim_start_matches(['v', 'V']).parse::<f32>().ok();
    let readable = match asset.min_version.as_deref().and_then(number) {
        Some(minimum) => minimum <= 2.0,
        None => number(&asset.version).is_some_and(|version| (2.0..3.0).contains(&version)),
    };
    if readable {
        return Ok(());
    }
    Err(Fault::new(
        "asset.version",
        format!(
            "{} needs glTF {}; only 2.0 is read",
            asset.version,
            asset.min_version.as_deref().unwrap_or(&asset.version)
        ),
    ))
}

fn check_extensions(root: &Root, report: &mut Report) -> Result<(), Fault> {
    for (index, name) in root.extensions_required.iter().enumerate() {
        if !READ.contains(&name.as_str()) {
            let element = format!("extensionsRequired[{index}]");
            return Err(Fault::new(element, format!("{name} is not supported; supported are {}", READ.join(", "))));
        }
    }
    // Extensions that a file uses without declaring them are read like the others.
    let materials = root.materials.iter().filter_map(|material| Some(&material.extensions.as_ref()?.others));
    let nodes = root.nodes.iter().filter_map(|node| Some(&node.extensions.as_ref()?.others));
    let undeclared: BTreeSet<&String> = materials.chain(nodes).flat_map(|others| others.keys()).collect();
    for name in root.extensions_used.iter().chain(undeclared) {
        if !READ.contains(&name.as_str()) {
            report.warn_once(format!("extension {name}"), format!("{name} is not read; the file is drawn without it"));
        }
    }
    Ok(())
}
