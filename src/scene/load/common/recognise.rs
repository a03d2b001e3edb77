//! The true format of a file that is not what its name says.

/// The kind of a file that is not the text that a scene or material library should be, if the kind is known. The answer continues "the
/// file": `is a Git LFS pointer …`.
///
/// A glTF importer asks only after it failed to read the bytes, because GLB and JSON are among the kinds.
pub(crate) fn foreign(bytes: &[u8]) -> Option<&'static str> {
    let start = bytes.get(..bytes.len().min(4096)).unwrap_or(bytes);
    let signature = SIGNATURES.iter().find(|(signature, _)| start.starts_with(signature));
    if let Some((_, kind)) = signature {
        return Some(kind);
    }
    let text = start.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(start).trim_ascii_start();
    let lower = text.get(..text.len().min(256)).unwrap_or(text).to_ascii_lowercase();
    let texts: [(&[u8], &str); 6] = [
        (b"version https://git-lfs", "is a Git LFS pointer, not the file itself; `git lfs pull` fetches that"),
        (b"<!doctype html", "is an HTML page, perhaps what a server says instead of the file"),
        (b"<html", "is an HTML page, perhaps what a server says instead of the file"),
        (b"<?xml", "is an XML file, perhaps COLLADA or X3D"),
        (b"<collada", "is a COLLADA file"),
        (b"#usda", "is a USD file"),
    ];
    if let Some((_, kind)) = texts.iter().find(|(start, _)| lower.starts_with(start)) {
        return Some(kind);
    }
    if lower.starts_with(b"{") && lower.contains(&b'"') {
        return Some("is a JSON file, perhaps glTF, whose name ends in .gltf");
    }
    if lower.starts_with(b"solid") && contains(start, b"facet normal") {
        return Some("is an STL file");
    }
    if lower.starts_with(b"; fbx") {
        return Some("is an FBX file");
    }
    None
}

/// First bytes of binary files, and of texts that start with a fixed word.
const SIGNATURES: [(&[u8], &str); 16] = [
    (b"glTF", "is a binary glTF file, whose name ends in .glb"),
    (b"Kaydara FBX Binary", "is an FBX file"),
    (b"BLENDER", "is a Blender file; Blender exports it as glTF"),
    (b"PXR-USDC", "is a USD file"),
    (b"PK\x03\x04", "is a ZIP archive, perhaps USDZ; its content has to be unpacked first"),
    (b"\x1F\x8B", "is compressed with gzip, and has to be unpacked first"),
    (b"BZh", "is compressed with bzip2, and has to be unpacked first"),
    (b"\xFD7zXZ", "is compressed with xz, and has to be unpacked first"),
    (b"\x28\xB5\x2F\xFD", "is compressed with Zstandard, and has to be unpacked first"),
    (b"7z\xBC\xAF\x27\x1C", "is a 7z archive; its content has to be unpacked first"),
    (b"Rar!", "is a RAR archive; its content has to be unpacked first"),
    (b"ply\n", "is a PLY file"),
    (b"ply\r", "is a PLY file"),
    (b"\x89PNG", "is a PNG image"),
    (b"\xFF\xD8\xFF", "is a JPEG image"),
    (b"%PDF", "is a PDF document"),
];

/// True if a text is none, because it is full of ASCII control characters. All code pages have these.
#[cfg(feature = "obj")]
pub(crate) fn is_binary(text: &str) -> bool {
    let control = |c: char| c.is_ascii_control() && !matches!(c, '\t' | '\n' | '\r' | '\u{B}' | '\u{C}' | '\u{1A}');
    let looked_at = text.chars().take(4096);
    let (all, controls) = looked_at.fold((0, 0), |(all, controls), c| (all + 1, controls + usize::from(control(c))));
    controls * 20 > all
}

fn contains(bytes: &[u8], part: &[u8]) -> bool {
    bytes.windows(part.len()).any(|window| window == part)
}
