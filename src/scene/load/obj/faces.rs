//! `f` statements.

use super::part::{Context, Corner, NONE, Parts};
use super::polygon::{Outcome, Triangulator};
use super::tally::{Defect, Tally};
use super::text::shortened;
use super::vectors::Vectors;

/// An index that is present but cannot be used.
const BROKEN: i64 = -1;
/// An absent index.
const ABSENT: i64 = 0;

/// Names of positions, texture coordinates and normals in messages.
const KINDS: [&str; 3] = ["vertices", "texture coordinates", "normals"];

/// The faces of a file.
pub(super) struct Faces {
    pub parts: Parts,
    /// Number of statements.
    pub count: usize,
    triangulator: Triangulator,
    /// Faces that use vectors of later lines.
    later: Vec<(usize, Context, Vec<[i64; 3]>)>,
    corners: Vec<[i64; 3]>,
    places: Vec<[f32; 3]>,
    triangles: Vec<[u32; 3]>,
    resolved: Vec<Corner>,
}

impl Default for Faces {
    fn default() -> Self {
        Self {
            parts: Parts::default(),
            count: 0,
            triangulator: Triangulator::new(),
            later: Vec::new(),
            corners: Vec::new(),
            places: Vec::new(),
            triangles: Vec::new(),
            resolved: Vec::new(),
        }
    }
}

impl Faces {
    /// Adds one statement.
    pub fn add(&mut self, line: usize, values: &str, context: Context, vectors: &Vectors, tally: &mut Tally) {
        self.count += 1;
        let counts = vectors.counts();
        let mut corners = std::mem::take(&mut self.corners);
        corners.clear();
        let mut whole = true;
        for word in values.split_ascii_whitespace() {
            match corner(word, counts, line, tally) {
                Ok(corner) => corners.push(corner),
                Err(reason) => {
                    tally.add(Defect::FaceIndex, line, || format!("f: {reason}; the face is left out"));
                    whole = false;
                    break;
                }
            }
        }
        if whole && corners.iter().any(|corner| std::iter::zip(corner, counts).any(|(&index, count)| index > count)) {
            self.later.push((line, context, corners.clone()));
        } else if whole {
            self.face(line, context, &corners, vectors, tally);
        }
        self.corners = corners;
    }

    /// Adds the faces that waited for vectors.
    pub fn finish(&mut self, vectors: &Vectors, tally: &mut Tally) {
        for (line, context, corners) in std::mem::take(&mut self.later) {
            self.face(line, context, &corners, vectors, tally);
        }
    }

    fn face(&mut self, line: usize, context: Context, corners: &[[i64; 3]], vectors: &Vectors, tally: &mut Tally) {
        let counts = vectors.counts();
        self.places.clear();
        for &[position, ..] in corners {
            match usize::try_from(position - 1).ok().and_then(|at| vectors.positions.get(at)) {
                Some(&place) => self.places.push(place),
                None => {
                    let reason = || format!("f: {}; the face is left out", out_of_range(position, 0, counts[0]));
                    return tally.add(Defect::FaceIndex, line, reason);
                }
            }
        }
        if self.places.as_flattened().iter().any(|x| x.is_nan()) {
            // The defect of the position is counted already.
            return;
        }
        if corners.len() < 3 {
            let reason = || format!("f: {} corners, where 3 or more belong; the face is left out", corners.len());
            return tally.add(Defect::ShortFace, line, reason);
        }
        // A face has an attribute only if all its corners have it.
        let [uvs, normals] = [1, 2].map(|kind| corners.iter().filter(|corner| corner[kind] != ABSENT).count());
        if [uvs, normals].iter().any(|&count| count > 0 && count < corners.len()) {
            let reason = "f: only some corners have texture coordinates or normals; the face is drawn without them";
            tally.add(Defect::PartialFace, line, || reason.into());
        }
        let [uvs, normals] = [uvs, normals].map(|count| count == corners.len());

        self.triangles.clear();
        match self.triangulator.split(&self.places, &mut self.triangles) {
            Outcome::Covered => {}
            Outcome::Crossing => {
                let reason = "f: its edges cross; it is drawn as triangles between its corners";
                tally.add(Defect::CrossingFace, line, || reason.into());
            }
            Outcome::Huge => {
                let reason = || format!("f: {} corners are too many; it is drawn as a fan", corners.len());
                tally.add(Defect::HugeFace, line, reason);
            }
            Outcome::Flat => {
                let reason = "f: the corners lie on one line, and have no area; the face is left out";
                tally.add(Defect::FlatFace, line, || reason.into());
            }
        }
        let mut whole = |&[position, uv, normal]: &[i64; 3]| -> Corner {
            let mut attribute = |index: i64, wanted: bool, kind: usize| {
                if !wanted {
                    return NONE;
                }
                let Some(at) = u32::try_from(index - 1).ok().filter(|_| index <= counts[kind]) else {
                    if index != BROKEN {
                        count_attribute(kind, line, || out_of_range(index, kind, counts[kind]), tally);
                    }
                    return NONE;
                };
                let broken = kind == 2 && vectors.normals.get(at as usize) == Some(&[0.0; 3]);
                if broken { NONE } else { at }
            };
            let [uv, normal] = [attribute(uv, uvs, 1), attribute(normal, normals, 2)];
            [(position - 1) as u32, uv, normal]
        };
        let shaded = normals || context.smoothing != 0;
        let part = self.parts.get(context, uvs, shaded);
        self.resolved.clear();
        self.resolved.extend(corners.iter().map(&mut whole));
        for triangle in &self.triangles {
            part.triangles.push(triangle.map(|at| self.resolved.get(at as usize).copied().unwrap_or([NONE; 3])));
            if shaded {
                part.smoothing.push(context.smoothing);
            }
        }
    }
}

impl Vectors {
    /// Numbers of positions, texture coordinates and normals, capped at 32 bits.
    fn counts(&self) -> [i64; 3] {
        [self.positions.len(), self.uvs.len(), self.normals.len()].map(|count| count.min(NONE as usize) as i64)
    }
}

/// The three indices of a corner: counted from 1, [`ABSENT`] or [`BROKEN`]. Negative ones count back from the latest vector. The error is
/// the reason why the corner has no position.
fn corner(word: &str, counts: [i64; 3], line: usize, tally: &mut Tally) -> Result<[i64; 3], String> {
    let mut indices = [ABSENT; 3];
    for (kind, part) in word.split('/').enumerate() {
        let (Some(slot), Some(&count)) = (indices.get_mut(kind), counts.get(kind)) else {
            let reason = || format!("f: \"{}\" has more than three indices; the first three are used", shortened(word));
            tally.add(Defect::ExtraIndex, line, reason);
            break;
        };
        if part.is_empty() && kind > 0 {
            continue;
        }
        *slot = match index(part) {
            None if kind == 0 => return Err(format!("\"{}\" is not an index", shortened(word))),
            None => {
                count_attribute(kind, line, || format!("\"{}\" is not an index", shortened(word)), tally);
                BROKEN
            }
            Some(index) => {
                let resolved = if index < 0 { index.saturating_add(count + 1) } else { index };
                match resolved {
                    1.. => resolved,
                    _ if kind == 0 => return Err(out_of_range(index, kind, count)),
                    _ => {
                        count_attribute(kind, line, || out_of_range(index, kind, count), tally);
                        BROKEN
                    }
                }
            }
        };
    }
    Ok(indices)
}

/// A whole number. Some exporters write it with a decimal point.
fn index(word: &str) -> Option<i64> {
    let whole = |number: f64| (number.fract() == 0.0 && number.abs() < 1e15).then_some(number as i64);
    word.parse().ok().or_else(|| word.parse::<f64>().ok().and_then(whole))
}

fn out_of_range(index: i64, kind: usize, count: i64) -> String {
    format!("index {index} is out of range: there are {count} {}", KINDS.get(kind).unwrap_or(&""))
}

fn count_attribute(kind: usize, line: usize, reason: impl FnOnce() -> String, tally: &mut Tally) {
    if kind == 1 {
        tally.add(Defect::UvIndex, line, || format!("f: {}; 0 is used", reason()));
    } else {
        tally.add(Defect::NormalIndex, line, || format!("f: {}; the normal of the face is used", reason()));
    }
}
