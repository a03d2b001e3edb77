//! The bytes that a file refers to: the binary chunk, data URIs and files.

use std::collections::HashMap;
use std::path::PathBuf;
use std::rc::Rc;

use base64::Engine as _;
use base64::alphabet;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::json::Root;

use crate::scene::load::folder::{Folder, Located};
use crate::scene::load::report::{Fault, Report};

/// Padding at the end is often left out.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &alphabet::STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

/// Reads all buffers of a file. Those that name the same file share its bytes.
pub(super) fn read_all(
    root: &Root,
    binary: Option<&[u8]>,
    folder: &Folder<'_>,
    report: &mut Report,
) -> Result<Vec<Rc<[u8]>>, Fault> {
    let mut files: HashMap<PathBuf, Rc<[u8]>> = HashMap::new();
    let read = |(index, buffer): (usize, &gltf::json::Buffer)| {
        let element = format!("buffers[{index}]");
        let fault = |reason: String| Fault::new(&element, reason);
        let bytes: Rc<[u8]> = match (&buffer.uri, binary) {
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
            return Err(fault(format!("byteLength is {announced}, but there are only {} bytes", bytes.len())));
        }
        Ok(bytes)
    };
    root.buffers.iter().enumerate().map(read).collect()
}

/// The content of a `data:` URI, or `None` where it is none. The error is a reason.
pub(super) fn data_uri(uri: &str) -> Option<Result<Vec<u8>, String>> {
    let (scheme, rest) = uri.split_once(':').filter(|(scheme, _)| scheme.eq_ignore_ascii_case("data"))?;
    let content = rest.split_once(',').and_then(|(kind, content)| kind.ends_with(";base64").then_some(content));
    Some(match content {
        Some(content) => BASE64.decode(content).map_err(|error| format!("its {scheme} URI is not base64: {error}")),
        None => Err(format!("its {scheme} URI is not of the form data:…;base64,…")),
    })
}
