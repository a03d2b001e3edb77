//! The statements of an OBJ file.

use std::collections::{HashMap, HashSet};

use super::color::Colors;
use super::faces::Faces;
use super::part::{Context, Names};
use super::tally::{Defect, Tally};
use super::text::{MRGB, Statement, numbers, precise, shortened};
use super::vectors::Vectors;
use crate::scene::load::common::report::Report;

/// Maximum number of unknown keywords that get a warning.
const MAX_UNKNOWN: usize = 16;

/// A name by which faces refer to a material.
pub(super) struct Use {
    /// The name without and with a suffix that may be a comment.
    pub names: [String; 2],
    /// The first line with the name.
    pub line: usize,
}

/// The content of an OBJ file.
#[derive(Default)]
pub(super) struct Geometry {
    pub vectors: Vectors,
    pub colors: Colors,
    pub faces: Faces,
    /// Names of objects and groups.
    pub groups: Names,
    /// The names in `usemtl` statements, by their numbers in parts.
    pub uses: Vec<Use>,
    /// The names in `mtllib` statements, without and with a suffix that may be a comment, and their lines.
    pub libraries: Vec<([String; 2], usize)>,
    pub tally: Tally,
    /// Number of statements that belong to this format.
    pub known: usize,
    use_numbers: HashMap<String, u32>,
    smoothing_groups: Names,
    unknown: HashSet<String>,
    context: Context,
}

impl Geometry {
    /// Adds one statement.
    pub fn statement(&mut self, statement: Statement<'_>, report: &mut Report) {
        let Statement { line, keyword, arguments, whole } = statement;
        let values = values(arguments);
        self.known += 1;
        // Most lines are these. Keywords in another case come last.
        match keyword {
            "v" => return self.position(line, values),
            "vt" => return self.uv(line, values),
            "vn" => return self.normal(line, values),
            "f" => return self.face(line, values),
            MRGB => return self.colors.add_mrgb(arguments),
            _ => {}
        }
        let element = || format!("line {line}");
        match keyword.to_ascii_lowercase().as_str() {
            "v" => self.position(line, values),
            "vt" => self.uv(line, values),
            "vn" => self.normal(line, values),
            "f" | "fo" => self.face(line, values),
            "o" | "g" => self.context.group = self.groups.number(arguments),
            "s" => self.context.smoothing = self.smoothing_group(values.trim()),
            "usemtl" => self.use_material(line, arguments, whole),
            "mtllib" => self.libraries.push(([arguments.to_owned(), whole.to_owned()], line)),
            "p" | "l" => report.warn_once(element(), "points and lines are not drawn"),
            "curv" | "curv2" | "surf" => report.warn_once(element(), "free-form curves and surfaces are not drawn"),
            "call" | "csh" => report.warn_once(element(), "other files and commands are not run"),
            // Parts of free-form geometry, and attributes of display that change no surface.
            "vp" | "deg" | "bmat" | "step" | "cstype" | "parm" | "trim" | "hole" | "scrv" | "sp" | "end" | "con"
            | "mg" | "bevel" | "c_interp" | "d_interp" | "lod" | "shadow_obj" | "trace_obj" | "ctech" | "stech" => {}
            unknown => {
                self.known -= 1;
                self.unknown(unknown, &element(), report);
            }
        }
    }

    fn unknown(&mut self, keyword: &str, element: &str, report: &mut Report) {
        if self.unknown.len() >= MAX_UNKNOWN || !self.unknown.insert(keyword.to_owned()) {
            return;
        }
        report.warn(element, format!("the statement \"{}\" is not known, and left out", shortened(keyword)));
    }

    fn position(&mut self, line: usize, values: &str) {
        let mut commas = false;
        let position = place(values, &mut commas).map(|place| self.vectors.relative(place)).unwrap_or_else(|reason| {
            let reason = || format!("v: {reason}; faces that use it are left out");
            self.tally.add(Defect::Position, line, reason);
            [f32::NAN; 3]
        });
        // A fourth number alone is a weight, which only curves use. Five or more numbers end with a colour.
        let mut more = values.split_ascii_whitespace().skip(3);
        if let (Some(first), Some(second)) = (more.next(), more.next()) {
            let words = [first, second].into_iter().chain(more);
            if let Err(reason) = self.colors.add(self.vectors.positions.len(), words, &mut commas) {
                self.tally.add(Defect::Color, line, || format!("v: as a colour, {reason}; white is used"));
            }
        }
        self.vectors.positions.push(position);
        self.note_commas(line, commas);
    }

    fn uv(&mut self, line: usize, values: &str) {
        let mut commas = false;
        let uv = match numbers::<2>(values, &mut commas) {
            Ok((_, 0)) => Err("there are no numbers".into()),
            Ok((uv, _)) => Ok(uv),
            Err(reason) => Err(reason),
        };
        let uv = uv.unwrap_or_else(|reason| {
            self.tally.add(Defect::Uv, line, || format!("vt: {reason}; 0 is used"));
            [0.0; 2]
        });
        self.vectors.uvs.push(uv);
        self.note_commas(line, commas);
    }

    fn normal(&mut self, line: usize, values: &str) {
        let mut commas = false;
        let unit = vector(values, &mut commas).and_then(|normal| {
            let direction = glam::DVec3::from(normal.map(f64::from)).try_normalize();
            direction.map(|unit| unit.as_vec3().to_array()).ok_or_else(|| "it has no direction".into())
        });
        let unit = unit.unwrap_or_else(|reason| {
            let reason = || format!("vn: {reason}; the normal of the faces is used");
            self.tally.add(Defect::Normal, line, reason);
            [0.0; 3]
        });
        self.vectors.normals.push(unit);
        self.note_commas(line, commas);
    }

    fn note_commas(&mut self, line: usize, commas: bool) {
        if commas {
            let reason = || "numbers have a decimal comma, where OBJ has a point; it is read as a point".into();
            self.tally.add(Defect::Comma, line, reason);
        }
    }

    fn face(&mut self, line: usize, values: &str) {
        self.faces.add(line, values, self.context, &self.vectors, &mut self.tally);
    }

    fn smoothing_group(&mut self, name: &str) -> u32 {
        match name.to_ascii_lowercase().as_str() {
            "" | "off" | "0" | "null" | "none" | "false" => 0,
            // A number of any size, or `on`.
            name => self.smoothing_groups.number(name),
        }
    }

    fn use_material(&mut self, line: usize, name: &str, whole: &str) {
        if whole.is_empty() || name.is_empty() {
            let reason = || "usemtl: there is no name; the faces after it are drawn in the default material".into();
            self.tally.add(Defect::UnnamedMaterial, line, reason);
            self.context.material = None;
            return;
        }
        let next = self.uses.len() as u32;
        let number = *self.use_numbers.entry(whole.to_owned()).or_insert(next);
        if number == next {
            self.uses.push(Use { names: [name.to_owned(), whole.to_owned()], line });
        }
        self.context.material = Some(number);
    }
}

impl Vectors {
    /// A position as it is stored, relative to an origin that the first position of the file decides: a whole multiple of 256 near it, or
    /// 0 if it is nearer than 1024. Copies of a model therefore have the same numbers wherever they are.
    fn relative(&mut self, place: [f64; 3]) -> [f32; 3] {
        let near = |x: f64| if x.abs() < 1024.0 { 0.0 } else { ((x / 256.0).round() * 256.0) as f32 };
        let offset = *self.offset.get_or_insert(place.map(near));
        std::array::from_fn(|axis| (place[axis] - f64::from(offset[axis])) as f32)
    }
}

/// The three coordinates of a position. The error is a reason.
fn place(values: &str, commas: &mut bool) -> Result<[f64; 3], String> {
    let mut words = values.split_ascii_whitespace();
    let mut place = [0.0; 3];
    for (count, coordinate) in place.iter_mut().enumerate() {
        let word = words.next().ok_or_else(|| format!("{count} numbers, where 3 belong"))?;
        *coordinate = precise(word, commas)?;
    }
    Ok(place)
}

/// Arguments without a comment directly after a number. `1.#QNAN` is no comment.
fn values(arguments: &str) -> &str {
    let mut signs = arguments.match_indices('#').map(|(at, _)| arguments.get(..at).unwrap_or(""));
    signs.find(|before| !before.ends_with('.')).unwrap_or(arguments)
}

/// Three numbers. The error is a reason.
fn vector(values: &str, commas: &mut bool) -> Result<[f32; 3], String> {
    match numbers::<3>(values, commas)? {
        (vector, 3) => Ok(vector),
        (_, count) => Err(format!("{count} numbers, where 3 belong")),
    }
}
