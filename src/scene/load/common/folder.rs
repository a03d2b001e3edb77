//! Files next to a scene file. A scene file may come from anywhere, so its paths are not to be trusted: they may only lead to files in
//! its own folder.

use std::borrow::Cow;
use std::cell::OnceCell;
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};

use super::files::Files;

/// The folder that a scene file may refer to.
pub(crate) struct Folder<'a> {
    files: Files<'a>,
    root: PathBuf,
    /// All files in the folder by their names in lower case, listed once a file is missing in its place.
    listing: OnceCell<HashMap<String, Vec<PathBuf>>>,
}

/// A file in the folder.
#[derive(Clone, Debug)]
pub(crate) struct Located {
    pub path: PathBuf,
    /// The words of a warning, if another file than the named one was found.
    pub note: Option<String>,
}

impl<'a> Folder<'a> {
    /// The folder that holds the file at `path`. The error is a reason.
    pub fn of(files: Files<'a>, path: &Path) -> Result<Self, String> {
        let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        Ok(Self { files, root: files.folder(parent)?, listing: OnceCell::new() })
    }

    /// The bytes of a file that was located. The error is a reason.
    pub fn read(&self, path: &Path) -> Result<Cow<'a, [u8]>, String> {
        self.files.read(path)
    }

    /// The first bytes of a file that was located, enough to recognise its format.
    #[cfg(feature = "gltf")]
    pub fn start(&self, path: &Path) -> Cow<'a, [u8]> {
        self.files.start(path)
    }

    /// The file that a relative, percent-encoded URI stands for, as [`Folder::locate`] finds it. The error is a reason.
    #[cfg(feature = "gltf")]
    pub fn locate_uri(&self, uri: &str) -> Result<Located, String> {
        let text = |bytes: Vec<u8>| {
            // Names in an unknown code page are read as Latin-1.
            let latin =
                |error: std::string::FromUtf8Error| error.into_bytes().iter().map(|&byte| char::from(byte)).collect();
            String::from_utf8(bytes).unwrap_or_else(latin)
        };
        // Many writers do not percent-encode names at all. A query or a fragment is for servers.
        let plain = uri.split(['?', '#']).next().unwrap_or(uri);
        let names = [uri, plain].map(|name| percent_decode(name).map_or_else(|| name.to_owned(), text));
        let exact = |name: &str| self.locate(name).ok().filter(|located| located.note.is_none());
        if let Some(located) = names.iter().map(String::as_str).chain([uri]).find_map(exact) {
            return Ok(located);
        }
        self.locate(&names[0]).or_else(|reason| self.locate(&names[1]).map_err(|_| reason))
    }

    /// The file that a relative path stands for. The error is a reason.
    ///
    /// If there is no such file, the name may be a path of another machine: with backslashes, in quotes, absolute, out of the folder, or
    /// in the wrong case. Then the file in the folder whose path shares the longest end with it stands for it, a file beside the scene
    /// file before one below. Files outside the folder and network addresses are ignored.
    pub fn locate(&self, name: &str) -> Result<Located, String> {
        let reason = match self.exact(name) {
            Ok(path) => return Ok(Located { path, note: None }),
            Err(reason) => reason,
        };
        let path = self.find(&parts(name)).ok_or_else(|| reason.clone())?;
        let found = path.strip_prefix(&self.root).unwrap_or(&path).display().to_string().replace('\\', "/");
        // A replacement is read, so "is not read" would be wrong.
        let reason = reason.strip_suffix(", and is not read").unwrap_or(&reason);
        Ok(Located { note: Some(format!("{reason}; \"{found}\" is read instead")), path })
    }

    fn exact(&self, name: &str) -> Result<PathBuf, String> {
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
        // Links are resolved by now, and may lead anywhere.
        if path.starts_with(&self.root) { Ok(path) } else { Err(outside()) }
    }

    /// The file whose path shares the longest end with `parts`, beside the scene file or below. A file in the same case comes before one
    /// in another.
    fn find(&self, parts: &[String]) -> Option<PathBuf> {
        let listing = self.listing.get_or_init(|| by_name(self.files.list(&self.root)));
        let candidates = listing.get(&parts.last()?.to_lowercase())?;
        let rating = |path: &Path, same: fn(&str, &str) -> bool| {
            let within: Vec<_> = path.strip_prefix(&self.root).unwrap_or(path).components().collect();
            let own = within.iter().rev().map(|component| component.as_os_str().to_str().unwrap_or(""));
            let alike = std::iter::zip(own, parts.iter().rev()).take_while(|(own, part)| same(own, part)).count();
            // Among equal ends, a path that has no more parts comes first, then the one with the fewest folders.
            (alike, alike == within.len(), usize::MAX - within.len())
        };
        let best = |same: fn(&str, &str) -> bool| {
            // The candidates are sorted; among equals, the first is taken.
            let rated = candidates.iter().rev().map(|path| (rating(path, same), path));
            rated.filter(|((alike, ..), _)| *alike > 0).max_by_key(|(rating, _)| *rating)
        };
        let found = best(|a, b| a == b).or_else(|| best(|a, b| a.to_lowercase() == b.to_lowercase()))?;
        Some(found.1.clone())
    }
}

fn by_name(files: Vec<PathBuf>) -> HashMap<String, Vec<PathBuf>> {
    let mut names: HashMap<String, Vec<PathBuf>> = HashMap::new();
    for path in files {
        let name = path.file_name().and_then(|name| name.to_str()).map(str::to_lowercase);
        names.entry(name.unwrap_or_default()).or_default().push(path);
    }
    names
}

/// The folders and the name of a path of any machine. Empty for a network address.
fn parts(name: &str) -> Vec<String> {
    let name = name.trim().trim_matches(['"', '\'']);
    let (local, decoded) = match name.split_once(':') {
        Some((scheme, rest)) if scheme.eq_ignore_ascii_case("file") => {
            (rest, percent_decode(rest).and_then(|bytes| String::from_utf8(bytes).ok()))
        }
        // A Windows drive.
        Some((drive, rest)) if drive.len() == 1 => (rest, None),
        Some(_) if has_scheme(name) => return Vec::new(),
        _ => (name, None),
    };
    let local = decoded.as_deref().unwrap_or(local);
    if local.contains('\0') {
        return Vec::new();
    }
    let parts = local.split(['/', '\\']).map(str::trim).filter(|part| !matches!(*part, "" | "." | ".."));
    parts.map(str::to_owned).collect()
}

/// True if a URI starts with a scheme (`https:`, `file:`) or a Windows drive.
fn has_scheme(uri: &str) -> bool {
    uri.split_once(':').is_some_and(|(scheme, _)| {
        scheme.starts_with(|c: char| c.is_ascii_alphabetic())
            && scheme.chars().all(|c| c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.'))
    })
}

/// Decodes escapes such as `%20`. `None` for an incomplete escape.
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
