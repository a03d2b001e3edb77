//! The bytes to which a file refers: the binary chunk, data URIs and files.

use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

use base64::Engine as _;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json::Root;

use crate::scene::load::common::folder::{Folder, Located, percent_decode};
use crate::scene::load::common::report::{Fault, Report};

/// Base64 with or without padding at the end, because many writers omit it.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new()
        .with_decode_padding_mode(DecodePaddingMode::Indifferent)
        .with_decode_allow_trailing_bits(true),
);

/// The bytes of a buffer, or the reason why there are none. A missing buffer affects only the elements that use it.
pub(super) type Buffer = Result<Rc<[u8]>, Fault>;

/// Reads all buffers of a file. Buffers that name the same file share its bytes.
pub(super) fn read_all(root: &Root, binary: Option<&[u8]>, folder: &Folder<'_>, report: &mut Report) -> Vec<Buffer> {
    let mut files: HashMap<PathBuf, Rc<[u8]>> = HashMap::new();
    let mut read = |(index, buffer): (usize, &gltf::json::Buffer)| {
        let element = format!("buffers[{index}]");
        let fault = |reason: String| Fault::new(&element, reason);
        let uri = buffer.uri.as_ref().filter(|uri| !uri.is_empty());
        let bytes: Rc<[u8]> = match (uri, binary) {
            (Some(uri), _) => match data_uri(uri) {
                Some(bytes) => bytes.map_err(fault)?.into(),
                None => {
                    let Located { path, note } = folder.locate_uri(uri).map_err(fault)?;
                    if let Some(note) = note {
                        report.warn(&element, note);
                    }
                    match files.get(&path) {
                        Some(bytes) => bytes.clone(),
                        None => {
                            let bytes = folder.read(&path).map_err(|reason| fault(format!("\"{uri}\" {reason}")))?;
                            files.entry(path).or_insert(bytes.into()).clone()
                        }
                    }
                }
            },
            (None, Some(binary)) if index == 0 => binary.into(),
            (None, _) => return Err(fault("has neither a uri nor a binary chunk".into())),
        };
        let announced = buffer.byte_length.0;
        if announced > bytes.len() as u64 {
            report.warn(element, format!("byteLength is {announced}, but there are only {} bytes", bytes.len()));
        }
        Ok(bytes)
    };
    root.buffers.iter().enumerate().map(&mut read).collect()
}

/// The content of a `data:` URI of any MIME type, or `None` for any other URI. The error is a reason.
pub(super) fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let (scheme, rest) = uri.trim_start().split_once(':').filter(|(scheme, _)| scheme.eq_ignore_ascii_case("data"))?;
    let Some((kind, content)) = rest.split_once(',') else {
        return Some(Err(format!("its {scheme} URI is not of the form data:…,…")));
    };
    let is_base64 = kind.rsplit(';').next().is_some_and(|last| last.trim().eq_ignore_ascii_case("base64"));
    if !is_base64 {
        return Some(percent_decode(content).ok_or_else(|| format!("its {scheme} URI is not percent-encoded")));
    }
    // Some writers break lines, encode the signs of base64 again, or use the alphabet of URLs (RFC 4648, §5).
    let text = percent_decode(content).unwrap_or_else(|| content.as_bytes().to_vec());
    let text: Vec<u8> = text
        .into_iter()
        .filter(|byte| !byte.is_ascii_whitespace())
        .map(|byte| match byte {
            b'-' => b'+',
            b'_' => b'/',
            other => other,
        })
        .collect();
    Some(BASE64.decode(text).map_err(|error| format!("its {scheme} URI is not base64: {error}")))
}
