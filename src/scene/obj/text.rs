//! Rewrites OBJ and MTL text into the part of the formats that `tobj` reads as it is meant, and checks it on the way.

use std::collections::HashMap;
use std::fmt::Write as _;

use crate::scene::load::report::{Fault, Report};

/// The `mtllib` statement that replaces all those of the file.
const LIBRARY: &str = "mtllib all";

/// An OBJ file, cleaned.
pub(super) struct Geometry {
    /// Only `v`, `vt`, `vn`, `f` with three or more corners and absolute indices, `g`, `usemtl` and one `mtllib`.
    /// Within a group all corners have the same kinds of indices.
    pub text: String,
    /// Arguments of the `mtllib` statements, with their lines.
    pub libraries: Vec<(String, usize)>,
    /// Materials that are asked for, with the first line of each, in the order of the file.
    pub used_materials: Vec<(String, usize)>,
}

/// Lines without comments, continuation lines joined, split into keyword and arguments. Numbers count from 1.
pub(super) fn statements(text: &str) -> impl Iterator<Item = (usize, String, String)> {
    let text = text.strip_prefix('\u{FEFF}').unwrap_or(text);
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        let (index, line) = lines.next()?;
        let mut statement = without_comment(line).to_owned();
        while let Some(joined) = statement.strip_suffix('\\') {
            let next = lines.next().map_or("", |(_, next)| without_comment(next));
            statement = format!("{joined} {next}");
        }
        let statement = statement.trim();
        let (keyword, arguments) = statement.split_once(char::is_whitespace).unwrap_or((statement, ""));
        Some((index + 1, keyword.to_owned(), arguments.trim().to_owned()))
    })
}

/// A comment starts a line or follows a space: names may contain the sign.
fn without_comment(line: &str) -> &str {
    let comment = line.char_indices().scan(' ', |before, (at, c)| Some((at, c, std::mem::replace(before, c))));
    let start = comment.into_iter().find(|&(_, c, before)| c == '#' && before.is_whitespace());
    line.get(..start.map_or(line.len(), |(at, ..)| at)).unwrap_or(line).trim_end()
}

/// Cleans and checks an OBJ file.
pub(super) fn clean_geometry(text: &str, report: &mut Report) -> Result<Geometry, Fault> {
    let mut cleaner = Cleaner::default();
    for (line, keyword, arguments) in statements(text) {
        cleaner
            .statement(line, &keyword, &arguments, report)
            .map_err(|reason| Fault::new(format!("line {line}"), format!("{keyword}: {reason}")))?;
    }
    let Cleaner { mut text, libraries, used_materials, .. } = cleaner;
    // All materials are known before the first face.
    text.insert_str(0, &format!("{LIBRARY}\n"));
    let mut used: Vec<_> = used_materials.into_iter().collect();
    used.sort_by_key(|&(_, line)| line);
    Ok(Geometry { text, libraries, used_materials: used })
}

#[derive(Default)]
struct Cleaner {
    text: String,
    libraries: Vec<(String, usize)>,
    used_materials: HashMap<String, usize>,
    /// How many positions, texture coordinates and normals there were so far.
    counts: [usize; 3],
    group: String,
    /// Which of the three kinds of indices the faces of the group have.
    kinds: Option<[bool; 3]>,
}

impl Cleaner {
    fn statement(&mut self, line: usize, keyword: &str, arguments: &str, report: &mut Report) -> Result<(), String> {
        let element = || format!("line {line}");
        match keyword {
            "v" => {
                // A fourth number is a weight, which only curves use; three more are a colour.
                if arguments.split_whitespace().count() > 4 {
                    report.warn_once(element(), "vertex colours are not read");
                }
                self.vector("v", arguments, 3, 3, 0)
            }
            "vt" => self.vector("vt", arguments, 2, 1, 1),
            "vn" => self.vector("vn", arguments, 3, 3, 2),
            "f" | "fo" => self.face(arguments),
            "o" | "g" => {
                self.group = arguments.to_owned();
                self.start_group();
                Ok(())
            }
            "usemtl" if arguments.is_empty() => Err("there is no name".into()),
            "usemtl" => {
                self.used_materials.entry(arguments.to_owned()).or_insert(line);
                self.emit(&format!("usemtl {arguments}"));
                Ok(())
            }
            "mtllib" => {
                self.libraries.push((arguments.to_owned(), line));
                Ok(())
            }
            "p" | "l" => {
                report.warn_once(element(), "points and lines are not drawn");
                Ok(())
            }
            "curv" | "curv2" | "surf" => {
                report.warn_once(element(), "free-form curves and surfaces are not drawn");
                Ok(())
            }
            _ => Ok(()),
        }
    }

    /// Emits the first `used` numbers of a vector, of which at least `needed` must be there; the rest is 0.
    fn vector(
        &mut self,
        keyword: &str,
        arguments: &str,
        used: usize,
        needed: usize,
        kind: usize,
    ) -> Result<(), String> {
        let numbers = numbers(arguments, used)?;
        if numbers.len() < needed {
            return Err(format!("{} numbers, where {needed} belong", numbers.len()));
        }
        let _ = write!(self.text, "{keyword}");
        for index in 0..used {
            let _ = write!(self.text, " {}", numbers.get(index).copied().unwrap_or(0.0));
        }
        self.text.push('\n');
        if let Some(count) = self.counts.get_mut(kind) {
            *count += 1;
        }
        Ok(())
    }

    fn face(&mut self, arguments: &str) -> Result<(), String> {
        let corners: Vec<_> =
            arguments.split_whitespace().map(|corner| self.corner(corner)).collect::<Result<_, _>>()?;
        if corners.len() < 3 {
            return Err(format!("{} corners, where 3 or more belong", corners.len()));
        }
        // Indices of texture coordinates and normals count only where every corner has them.
        let kinds = [0, 1, 2].map(|kind| corners.iter().all(|corner| corner[kind].is_some()));
        if self.kinds.is_some_and(|before| before != kinds) {
            self.start_group();
        }
        self.kinds = Some(kinds);
        self.text.push('f');
        for [position, uv, normal] in corners {
            let _ = write!(self.text, " {}", position.unwrap_or_default());
            let uv = uv.filter(|_| kinds[1]).map(|uv| uv.to_string()).unwrap_or_default();
            let _ = match normal.filter(|_| kinds[2]) {
                Some(normal) => write!(self.text, "/{uv}/{normal}"),
                None if kinds[1] => write!(self.text, "/{uv}"),
                None => Ok(()),
            };
        }
        self.text.push('\n');
        Ok(())
    }

    /// The three indices of a corner, counted from 1. Negative ones count back from the latest.
    fn corner(&self, corner: &str) -> Result<[Option<usize>; 3], String> {
        let mut indices = [None; 3];
        for (kind, part) in corner.split('/').enumerate() {
            let (Some(index), Some(&count)) = (indices.get_mut(kind), self.counts.get(kind)) else {
                return Err(format!("\"{corner}\" has more than three indices"));
            };
            if part.is_empty() && kind > 0 {
                continue;
            }
            let number: i64 = part.parse().map_err(|_| format!("\"{corner}\" is not an index"))?;
            let resolved = if number < 0 { number.saturating_add(count as i64).saturating_add(1) } else { number };
            *index = usize::try_from(resolved).ok().filter(|resolved| (1..=count).contains(resolved));
            if index.is_none() {
                let name = ["vertices", "texture coordinates", "normals"].get(kind).unwrap_or(&"");
                return Err(format!("index {number} is out of range: there are {count} {name} up to here"));
            }
        }
        Ok(indices)
    }

    fn start_group(&mut self) {
        self.kinds = None;
        self.emit(&format!("g {}", self.group));
    }

    fn emit(&mut self, line: &str) {
        self.text.push_str(line);
        self.text.push('\n');
    }
}

/// Up to `most` numbers at the start of a text. The error is a reason.
pub(super) fn numbers(text: &str, most: usize) -> Result<Vec<f32>, String> {
    let number = |word: &str| match word.parse::<f32>() {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(number) => Err(format!("{number} is not finite")),
        Err(_) => Err(format!("\"{word}\" is not a number")),
    };
    text.split_whitespace().take(most).map(number).collect()
}
