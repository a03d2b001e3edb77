//! Material libraries: the files, and the materials in them by name.

use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

use super::geometry::{Geometry, Use};
use super::source::{Source, parse};
use super::text::shortened;
use super::textures::Textures;
use crate::scene::description::Material;
use crate::scene::load::common::encoding;
use crate::scene::load::common::folder::Folder;
use crate::scene::load::common::recognise::foreign;
use crate::scene::load::common::report::Report;

/// The materials of all libraries, by their names.
#[derive(Default)]
pub(super) struct Library {
    pub materials: Vec<Material>,
    /// Materials of glass that refracts, if it is the skin of a body.
    pub refracting: HashSet<usize>,
    /// Whole names, including a suffix that may be a comment.
    names: HashMap<String, usize>,
    /// Names without a suffix that may be a comment, unless a whole name is the same.
    short_names: HashMap<String, usize>,
    lower_names: HashMap<String, usize>,
    /// True if a library is missing, so that its materials need no warnings of their own.
    incomplete: bool,
}

impl Library {
    /// Reads the libraries of the OBJ file at `path`.
    pub fn read(
        geometry: &Geometry,
        path: &Path,
        folder: &Folder<'_>,
        textures: &mut Textures<'_>,
        report: &mut Report,
    ) -> Self {
        let mut library = Self::default();
        let (mut paths, complete) = locate(&geometry.libraries, folder, report);
        library.incomplete = !complete;
        if geometry.libraries.is_empty() && !geometry.uses.is_empty() {
            paths.extend(beside(path, folder, report));
        }
        for path in paths {
            let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
            let bytes = folder.read(&path).and_then(|bytes| match foreign(&bytes) {
                Some(kind) => Err(kind.to_owned()),
                None => Ok(bytes),
            });
            let bytes = match bytes {
                Ok(bytes) => bytes,
                Err(reason) => {
                    report.warn(path.display().to_string(), format!("{reason}; its materials are drawn in grey"));
                    library.incomplete = true;
                    continue;
                }
            };
            let (text, note) = encoding::decode(&bytes);
            if let Some(note) = note {
                report.warn(&file, note);
            }
            for source in parse(&text, &file, report) {
                library.add(&source, &file, textures, report);
            }
        }
        library
    }

    fn add(&mut self, source: &Source, file: &str, textures: &mut Textures<'_>, report: &mut Report) {
        let number = self.materials.len();
        let material = source.convert(textures, file, report);
        if source.refracts() && material.transmits() {
            self.refracting.insert(number);
        }
        let [short, whole] = &source.names;
        if self.names.insert(whole.clone(), number).is_some() {
            let element = format!("{file} material \"{}\"", shortened(short));
            report.warn(element, "is there twice; the last one counts");
        }
        self.short_names.insert(short.clone(), number);
        self.lower_names.insert(short.to_lowercase(), number);
        self.materials.push(material);
    }

    /// The material that a `usemtl` statement names. `None`, with a warning, if there is no such material.
    pub fn find(&self, used: &Use, report: &mut Report) -> Option<usize> {
        let [short, whole] = &used.names;
        let exact = self.names.get(whole).or_else(|| self.names.get(short)).or_else(|| self.short_names.get(short));
        if let Some(&number) = exact {
            return Some(number);
        }
        let element = format!("line {}", used.line);
        let name = shortened(short);
        let Some(&number) = self.lower_names.get(&short.to_lowercase()) else {
            if self.incomplete {
                return None;
            }
            report.warn(element, format!("there is no material \"{name}\"; it is drawn in grey"));
            return None;
        };
        let other = self.materials.get(number).map_or("", |material| &material.name);
        report.warn(element, format!("there is no material \"{name}\"; \"{}\" is used", shortened(other)));
        Some(number)
    }
}

/// The library files, each once, and true if all were found.
fn locate(statements: &[([String; 2], usize)], folder: &Folder<'_>, report: &mut Report) -> (Vec<PathBuf>, bool) {
    let mut complete = true;
    let mut paths = Vec::new();
    let mut seen = HashSet::new();
    for ([argument, whole], line) in statements {
        let [argument, whole] = [argument, whole].map(|name| name.trim().replace('\\', "/"));
        if argument.is_empty() {
            report.warn(format!("line {line}"), "mtllib: there is no name");
            continue;
        }
        if !seen.insert(argument.clone()) {
            continue;
        }
        let element = || format!("line {line}");
        // A statement has one name that may hold spaces, or several without. Exact names come first, because they need no warning.
        let exact = |name: &str| folder.locate(name).ok().filter(|found| found.note.is_none());
        let quoted: Vec<&str> = argument.split('"').map(str::trim).filter(|name| !name.is_empty()).collect();
        let names = if quoted.len() > 1 { quoted } else { argument.split_whitespace().collect() };
        let is_list = names.len() > 1 && names.iter().all(|name| name.to_lowercase().ends_with(".mtl"));
        let several = || names.iter().map(|name| exact(name)).collect::<Option<Vec<_>>>();
        let found = match exact(&argument).or_else(|| exact(&whole)) {
            Some(found) => vec![Ok(found)],
            None => match several() {
                Some(found) => found.into_iter().map(Ok).collect(),
                None if is_list => names.iter().map(|name| folder.locate(name)).collect(),
                None => vec![folder.locate(&argument)],
            },
        };
        for found in found {
            match found {
                Ok(located) => {
                    if let Some(note) = located.note {
                        report.warn(element(), format!("mtllib: {note}"));
                    }
                    paths.push(located.path);
                }
                Err(reason) => {
                    complete = false;
                    report.warn(element(), format!("mtllib: {reason}; its materials are drawn in grey"));
                }
            }
        }
    }
    let mut seen = HashSet::new();
    paths.retain(|path| seen.insert(path.clone()));
    (paths, complete)
}

/// The library with the name of the OBJ file, for files that name none.
fn beside(path: &Path, folder: &Folder<'_>, report: &mut Report) -> Option<PathBuf> {
    let name = path.with_extension("mtl").file_name()?.to_str()?.to_owned();
    let located = folder.locate(&name).ok().filter(|located| located.note.is_none())?;
    report.warn("file", format!("names no material library; \"{name}\" beside it is read"));
    Some(located.path)
}
