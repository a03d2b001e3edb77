//! Lines, statements and numbers, as OBJ and MTL have them in common.

/// A statement of an OBJ or MTL file.
#[derive(Clone, Copy)]
pub(super) struct Statement<'a> {
    /// Number of its first line, counted from 1.
    pub line: usize,
    /// The first word, in the case of the file.
    pub keyword: &'a str,
    /// The rest without its comment. A comment starts a line or follows a space, because names may contain `#`.
    pub arguments: &'a str,
    /// The rest with its comment, because `Material #25` is a name too.
    pub whole: &'a str,
}

/// The keyword of comments in which ZBrush stores colours.
pub(super) const MRGB: &str = "#MRGB";

/// Visits all statements, continuation lines joined. Lines end with LF, CR LF or CR.
pub(super) fn each_statement(text: &str, mut visit: impl FnMut(Statement<'_>)) {
    let mut lines = lines(text);
    let mut joined = String::new();
    while let Some((line, text)) = lines.next() {
        // Concatenated files have byte-order marks in the middle.
        let whole = text.trim_start_matches('\u{FEFF}').trim();
        let statement = if whole.starts_with(MRGB) { whole } else { without_comment(whole) };
        if !continues(statement) {
            visit_one(line, statement, whole, &mut visit);
            continue;
        }
        joined.clear();
        let mut part = statement;
        while let Some(start) = part.strip_suffix('\\') {
            joined.push_str(start);
            joined.push(' ');
            part = lines.next().map_or("", |(_, next)| without_comment(next.trim()));
        }
        joined.push_str(part);
        visit_one(line, joined.trim(), joined.trim(), &mut visit);
    }
}

/// True if a statement continues in the next line. Names may end with a backslash, as Windows paths do.
fn continues(statement: &str) -> bool {
    const NAMES: [&str; 6] = ["g", "o", "usemtl", "newmtl", "mtllib", "map_"];
    let Some(before) = statement.strip_suffix('\\') else { return false };
    let keyword = statement.split_whitespace().next().unwrap_or("").to_ascii_lowercase();
    let names = NAMES.iter().any(|name| keyword == *name || (name.ends_with('_') && keyword.starts_with(name)));
    !names || before.ends_with(char::is_whitespace)
}

fn visit_one(line: usize, statement: &str, whole: &str, visit: &mut impl FnMut(Statement<'_>)) {
    if statement.is_empty() {
        return;
    }
    let (keyword, arguments) = statement.split_once(char::is_whitespace).unwrap_or((statement, ""));
    let whole = whole.get(keyword.len()..).unwrap_or("").trim_start();
    visit(Statement { line, keyword, arguments: arguments.trim_start(), whole });
}

/// Lines with their numbers, which count from 1.
fn lines(text: &str) -> impl Iterator<Item = (usize, &str)> {
    let mut rest = Some(text).filter(|text| !text.is_empty());
    let lines = std::iter::from_fn(move || {
        let text = rest?;
        let Some(end) = text.bytes().position(|byte| matches!(byte, b'\n' | b'\r')) else {
            rest = None;
            return Some(text);
        };
        let (line, after) = text.split_at_checked(end)?;
        rest = after.strip_prefix("\r\n").or_else(|| after.get(1..));
        Some(line)
    });
    (1..).zip(lines)
}

fn without_comment(line: &str) -> &str {
    let mut from = 0;
    while let Some(at) = line.get(from..).and_then(|rest| rest.find('#')).map(|at| from + at) {
        let before = line.get(..at).unwrap_or("");
        if before.is_empty() || before.ends_with(char::is_whitespace) {
            return before.trim_end();
        }
        from = at + 1;
    }
    line
}

/// Reads a number that is finite in 32 bits. A decimal comma counts as a point and is noted in `commas`. The error is a reason.
pub(super) fn number(word: &str, commas: &mut bool) -> Result<f32, String> {
    precise(word, commas).map(|number| number as f32)
}

/// Reads a number as [`number`] does, with all its digits.
pub(super) fn precise(word: &str, commas: &mut bool) -> Result<f64, String> {
    let number = word.parse::<f64>().or_else(|error| {
        let with_point = word.contains(',').then(|| word.replacen(',', ".", 1).parse::<f64>());
        if let Some(Ok(number)) = with_point {
            *commas = true;
            return Ok(number);
        }
        // Fortran and C write numbers like this.
        let is_number = word.starts_with(|c: char| c.is_ascii_digit() || matches!(c, '+' | '-' | '.'));
        let plain = || word.trim_end_matches(['f', 'F']).replace(['D', 'd'], "e").parse::<f64>();
        if is_number { plain() } else { Err(error) }
    });
    match number {
        Ok(number) if (number as f32).is_finite() => Ok(number),
        Ok(number) => Err(format!("{} is not finite", number as f32)),
        Err(_) => Err(format!("\"{}\" is not a number", shortened(word))),
    }
}

/// Up to `N` numbers at the start of a text, and their count. The error is a reason.
pub(super) fn numbers<const N: usize>(text: &str, commas: &mut bool) -> Result<([f32; N], usize), String> {
    let mut numbers = [0.0; N];
    let mut words = text.split_ascii_whitespace();
    for (count, slot) in numbers.iter_mut().enumerate() {
        match words.next() {
            Some(word) => *slot = number(word, commas)?,
            None => return Ok((numbers, count)),
        }
    }
    Ok((numbers, N))
}

/// The start of a text for messages, because files may hold megabytes of anything.
pub(super) fn shortened(text: &str) -> String {
    const LENGTH: usize = 64;
    let start: String = text.chars().take(LENGTH).flat_map(char::escape_debug).collect();
    if text.chars().nth(LENGTH).is_some() { start + "…" } else { start }
}
