//! The source of files: the disk, or memory.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Component, Path, PathBuf};

use crate::image_io::read_file;

/// Maximum number of entries that are listed, because a scene may lie in a folder with all the files of a person.
const MAX_LISTED: usize = 20_000;
/// Maximum number of levels of folders in which files are looked for.
const MAX_DEPTH: usize = 8;

/// All files that an importer may read.
#[derive(Clone, Copy)]
pub(crate) enum Files<'a> {
    Disk,
    /// Files by their paths.
    Memory(&'a BTreeMap<PathBuf, Vec<u8>>),
}

impl<'a> Files<'a> {
    /// The canonical path of a folder. The error is a reason.
    pub fn folder(self, path: &Path) -> Result<PathBuf, String> {
        match self {
            Self::Disk => canonical(path),
            Self::Memory(_) => Ok(plain(path)),
        }
    }

    /// The canonical path of an existing file. Links are followed. The error is a reason.
    ///
    /// Browsers do not tell the folder of a dropped file. In memory, if no file has that path, the file of the same name in `root`
    /// stands for it.
    pub fn file(self, root: &Path, name: &str) -> Result<PathBuf, String> {
        let path = root.join(name);
        let Self::Memory(files) = self else { return canonical(&path) };
        let exact = plain(&path);
        let beside = exact.file_name().map(|name| root.join(name));
        [Some(exact), beside]
            .into_iter()
            .flatten()
            .find(|path| files.contains_key(path))
            .ok_or_else(|| "is not among the files that were given".into())
    }

    /// The files in a folder and below, nearest folders first, sorted within each folder: at most [`MAX_LISTED`] entries, down to
    /// [`MAX_DEPTH`] folders. A link is followed only to a file in the folder.
    pub fn list(self, root: &Path) -> Vec<PathBuf> {
        match self {
            Self::Disk => list(root),
            Self::Memory(files) => {
                files.keys().filter(|path| path.starts_with(root)).take(MAX_LISTED).cloned().collect()
            }
        }
    }

    /// The bytes of a file. The error is a reason.
    pub fn read(self, path: &Path) -> Result<Cow<'a, [u8]>, String> {
        match self {
            Self::Disk => read_file(path).map(Cow::Owned),
            Self::Memory(files) => match files.get(path) {
                Some(bytes) => Ok(Cow::Borrowed(bytes)),
                None => Err("is not among the files that were given".into()),
            },
        }
    }

    /// The first bytes of a file, enough to recognise its format.
    #[cfg(feature = "gltf")]
    pub fn start(self, path: &Path) -> Cow<'a, [u8]> {
        use std::{fs::File, io::Read as _};
        /// No image format has a longer signature.
        const START: usize = 64;
        match self {
            Self::Disk => {
                let mut start = Vec::new();
                let read = |file: File| file.take(START as u64).read_to_end(&mut start);
                // Pipes and devices may never end.
                let read = path.is_file().then(|| File::open(path).and_then(read));
                Cow::Owned(if matches!(read, Some(Ok(_))) { start } else { Vec::new() })
            }
            Self::Memory(files) => {
                let bytes = files.get(path).map_or(&[][..], Vec::as_slice);
                Cow::Borrowed(&bytes[..bytes.len().min(START)])
            }
        }
    }
}

fn canonical(path: &Path) -> Result<PathBuf, String> {
    path.canonicalize().map_err(|error| format!("cannot be read: {error}"))
}

fn list(root: &Path) -> Vec<PathBuf> {
    let mut found = Vec::new();
    let mut left = MAX_LISTED;
    let mut folders = vec![root.to_path_buf()];
    for _ in 0..MAX_DEPTH {
        let mut below = Vec::new();
        for folder in folders {
            let Ok(entries) = fs::read_dir(&folder) else { continue };
            let mut entries: Vec<_> = entries.take(left).filter_map(Result::ok).collect();
            left -= entries.len();
            entries.sort_by_key(fs::DirEntry::file_name);
            for entry in entries {
                let path = entry.path();
                match entry.file_type() {
                    Ok(kind) if kind.is_dir() => below.push(path),
                    Ok(kind) if kind.is_file() => found.push(path),
                    Ok(kind) if kind.is_symlink() => {
                        let target = path.canonicalize();
                        if target.is_ok_and(|target| target.starts_with(root) && target.is_file()) {
                            found.push(path);
                        }
                    }
                    _ => {}
                }
            }
        }
        folders = below;
    }
    found
}

/// A path without `.` and `..`.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}
