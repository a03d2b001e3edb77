//! Lines, statements and numbers, which OBJ and MTL have in common.

/// A statement of an OBJ or MTL file.
#[derive(Clone, Copy)]
pub(super) struct Statement<'a> {
    /// Number of its first line, counted from 1.
    pub line: usize,
    /// The first word, in the case of the file.
    pub keyword: &'a str,
    /// The rest without its comment. A comment starts a line or follows a space, because names may contain the sign.
    pub arguments: &'a str,
    /// The rest with its comment, because `Material #25` is a name, too.
    pub whole: &'a str,
}

/// The keyword of the comments in which ZBrush stores colours.
pub(super) const MRGB: &str = "#MRGB";

/// Visits all statements, continuation lines joined. Lines end with LF, CR LF or CR.
pub(super) fn each_statement(text: &str, mut visit: impl FnMut(Statement<'_>)) {
    let mut lines = lines(text);
    let mut joined = String::new();
    while let Some((line, text)) = lines.next() {
        let whole = text.trim();
        let statement = if whole.starts_with(MRGB) { whole } else { without_comment(whole) };
        if !statement.ends_with('\\') {
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

/// Reads a finite number. A decimal comma counts as a point, and is noted in `commas`. The error is a reason.
pub(super) fn number(word: &str, commas: &mut bool) -> Result<f32, String> {
    let number = word.parse::<f32>().or_else(|error| {
        let with_point = word.contains(',').then(|| word.replacen(',', ".", 1).parse::<f32>());
        let number = with_point.and_then(Result::ok).ok_or(error)?;
        *commas = true;
        Ok::<_, std::num::ParseFloatError>(number)
    });
    match number {
        Ok(number) if number.is_finite() => Ok(number),
        Ok(number) => Err(format!("{number} is not finite")),
        Err(_) => Err(format!("\"{}\" is not a number", shortened(word))),
    }
}

/// Up to `N` numbers at the start of a text, and how many there are. The error is a reason.
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

/// The start of a text, for messages: files may hold anything, megabytes of it.
pub(super) fn shortened(text: &str) -> String {
    const LENGTH: usize = 64;
    let start: String = text.chars().take(LENGTH).flat_map(char::escape_debug).collect();
    if text.chars().nth(LENGTH).is_some() { start + "…" } else { start }
}
