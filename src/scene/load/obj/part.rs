//! The faces of a file, sorted into the meshes that they become.

use std::collections::HashMap;

/// The index of an attribute that a corner lacks.
pub(super) const NONE: u32 = u32::MAX;

/// Indices of the position, the texture coordinates and the normal of a corner, counted from 0, or [`NONE`].
pub(super) type Corner = [u32; 3];

/// The statements that apply to the faces after them.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Default, Debug)]
pub(super) struct Context {
    /// Number of the name in the last `o` or `g`, 0 for none.
    pub group: u32,
    /// Number of the name in the last `usemtl`.
    pub material: Option<u32>,
    /// Smoothing group, 0 for none.
    pub smoothing: u32,
}

/// Faces of one name, one material and the same kind of corners.
#[derive(Debug, Default)]
pub(super) struct Part {
    pub group: u32,
    pub material: Option<u32>,
    /// True if corners have texture coordinates.
    pub uvs: bool,
    /// True if corners have normals or will get some.
    pub normals: bool,
    pub triangles: Vec<[Corner; 3]>,
    /// The smoothing group of each triangle, if `normals`.
    pub smoothing: Vec<u32>,
}

/// All parts. A file may switch between names and materials for every face, and still has one part for each pair.
#[derive(Default)]
pub(super) struct Parts {
    pub parts: Vec<Part>,
    places: HashMap<Key, usize>,
    last: Option<(Key, usize)>,
}

/// Name, material, texture coordinates, normals.
type Key = (u32, Option<u32>, bool, bool);

impl Parts {
    /// The part of faces with these properties.
    pub fn get(&mut self, context: Context, uvs: bool, normals: bool) -> &mut Part {
        let Context { group, material, .. } = context;
        let key = (group, material, uvs, normals);
        let place = match self.last {
            Some((last, place)) if last == key => place,
            _ => *self.places.entry(key).or_insert(self.parts.len()),
        };
        self.last = Some((key, place));
        if place == self.parts.len() {
            self.parts.push(Part { group, material, uvs, normals, ..Part::default() });
        }
        &mut self.parts[place]
    }
}

/// Names, each stored once, by numbers from 1; the empty name is 0.
#[derive(Default)]
pub(super) struct Names {
    numbers: HashMap<String, u32>,
    names: Vec<String>,
}

impl Names {
    pub fn number(&mut self, name: &str) -> u32 {
        if name.is_empty() {
            return 0;
        }
        if let Some(&number) = self.numbers.get(name) {
            return number;
        }
        self.names.push(name.to_owned());
        let number = self.names.len() as u32;
        self.numbers.insert(name.to_owned(), number);
        number
    }

    pub fn get(&self, number: u32) -> &str {
        (number as usize).checked_sub(1).and_then(|at| self.names.get(at)).map_or("", String::as_str)
    }
}
