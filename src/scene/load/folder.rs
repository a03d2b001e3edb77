//! Files next to a scene file. A scene file may come from anywhere, so that what it names is not to be trusted: it
//! may only name files in its own folder.

use std::borrow::Cow;
use std::path::{Component, Path, PathBuf};

use super::files::Files;

/// The folder that a scene file may refer to.
pub(crate) struct Folder<'a> {
    files: Files<'a>,
    root: PathBuf,
}

impl<'a> Folder<'a> {
    /// The folder that holds the file at `path`. The error is a reason.
    pub fn of(files: Files<'a>, path: &Path) -> Result<Self, String> {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Self { files, root: files.folder(parent)? })
    }

    /// The bytes of a file that was located. The error is a reason.
    pub fn read(&self, path: &Path) -> Result<Cow<'a, [u8]>, String> {
        self.files.read(path)
    }

    /// The first bytes of a file that was located, as many as there are: enough to recognise it by.
    #[cfg(feature = "gltf")]
    pub fn start(&self, path: &Path) -> Cow<'a, [u8]> {
        self.files.start(path)
    }

    /// The file that a relative, percent-encoded URI stands for. The error is a reason.
    #[cfg(feature = "gltf")]
    pub fn locate_uri(&self, uri: &str) -> Result<PathBuf, String> {
        // Many writers do not encode their names at all.
        let decoded = percent_decode(uri).and_then(|bytes| String::from_utf8(bytes).ok());
        self.locate(decoded.as_deref().unwrap_or(uri)).or_else(|reason| self.locate(uri).map_err(|_| reason))
    }

    /// The file that a relative path stands for. The error is a reason.
    pub fn locate(&self, name: &str) -> Result<PathBuf, String> {
        let outside = || format!("\"{name}\" is not within the folder of the scene file, and is not read");
        if has_scheme(name) || name.starts_with(['/', '\\']) || name.contains('\0') {
            return Err(outside());
        }
        let mut depth = 0_usize;
        for component in Path::new(name).components() {
            depth = match component {
                Component::Normal(_) => depth + 1,
                Component::CurDir => depth,
                Component::ParentDir => depth.checked_sub(1).ok_or_else(outside)?,
                Component::Prefix(_) | Component::RootDir => return Err(outside()),
            };
        }
        let path = self.files.file(&self.root, name).map_err(|reason| format!("\"{name}\" {reason}"))?;
        // Links were followed by now, and they may lead anywhere.
        if path.starts_with(&self.root) { Ok(path) } else { Err(outside()) }
    }
}

/// Whether a URI starts with a scheme (`https:`, `file:`) or a Windows drive.
fn has_scheme(uri: &str) -> bool {
    uri.split_once(':').is_some_and(|(scheme, _)| {
        scheme.starts_with(|c: char| c.is_ascii_alphabetic())
            && scheme.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.'))
    })
}

/// Replaces `%20` and the like. `None` for an incomplete escape.
#[cfg(feature = "gltf")]
pub(crate) fn percent_decode(uri: &str) -> Option<Vec<u8>> {
    let mut decoded = Vec::with_capacity(uri.len());
    let mut bytes = uri.bytes();
    while let Some(byte) = bytes.next() {
        decoded.push(match byte {
            b'%' => {
                let mut digit = || char::from(bytes.next()?).to_digit(16);
                u8::try_from(digit()? * 16 + digit()?).ok()?
            }
            other => other,
        });
    }
    Some(decoded)
}
