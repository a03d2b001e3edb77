//! Repair of JSON that was not written by a JSON library.
//!
//! Some exporters print numbers with `printf`, which brings NaN and infinity into a file, paste paths with backslashes into strings, and
//! break data URIs into lines. None of these is JSON, and a JSON parser would refuse the whole file. Here the text is rewritten into
//! JSON, token by token. A number that is none becomes `null`, and the element that holds it is repaired like any other
//! ([`super::mend`]).

/// Rewrites text towards JSON. The result may still not be JSON.
pub(super) fn tidy(text: &str) -> String {
    let mut tidy = String::with_capacity(text.len() + 64);
    let mut rest = text;
    while let Some(first) = rest.chars().next() {
        rest = match first {
            '"' => string(&mut tidy, rest),
            '/' if rest.starts_with("//") => rest.find('\n').map_or("", |end| &rest[end..]),
            '/' if rest.starts_with("/*") => rest.find("*/").map_or("", |end| &rest[end + 2..]),
            ',' => comma(&mut tidy, &rest[1..]),
            _ if is_word(first) => word(&mut tidy, rest),
            _ => {
                tidy.push(first);
                &rest[first.len_utf8()..]
            }
        };
    }
    tidy
}

/// A comma before a closing bracket separates nothing.
fn comma<'a>(tidy: &mut String, rest: &'a str) -> &'a str {
    if !rest.trim_start().starts_with([']', '}']) {
        tidy.push(',');
    }
    rest
}

fn is_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || matches!(c, '+' | '-' | '.' | '#' | '(' | ')' | '_' | '$')
}

/// A number, `true`, `false` or `null`. `-nan(ind)`, `1.#QNAN` and `Infinity` become `null`.
fn word<'a>(tidy: &mut String, rest: &'a str) -> &'a str {
    let end = rest.find(|c| !is_word(c)).unwrap_or(rest.len());
    let (word, rest) = rest.split_at(end);
    let number = || word.parse::<f64>().ok().filter(|number| number.is_finite());
    if matches!(word, "true" | "false" | "null") || serde_json::from_str::<f64>(word).is_ok() {
        tidy.push_str(word);
    } else if let Some(number) = number() {
        tidy.push_str(&number.to_string());
    } else {
        tidy.push_str("null");
    }
    rest
}

/// A string from its first quotation mark to its last. Control characters are escaped. If a backslash escapes nothing, all backslashes of
/// the string count as those of a path.
fn string<'a>(tidy: &mut String, rest: &'a str) -> &'a str {
    let mut characters = rest.char_indices().skip(1);
    let mut escapes = true;
    let mut end = rest.len();
    while let Some((at, c)) = characters.next() {
        match c {
            '"' => {
                end = at;
                break;
            }
            '\\' => escapes &= is_escape(&rest[at + 1..]) && characters.next().is_some(),
            _ => {}
        }
    }
    tidy.push('"');
    for c in rest[1..end].chars() {
        match c {
            '\\' if !escapes => tidy.push_str("\\\\"),
            c if c.is_control() => tidy.push_str(&format!("\\u{:04x}", c as u32)),
            c => tidy.push(c),
        }
    }
    tidy.push('"');
    rest.get(end + 1..).unwrap_or_default()
}

fn is_escape(after: &str) -> bool {
    match after.chars().next() {
        Some('"' | '\\' | '/' | 'b' | 'f' | 'n' | 'r' | 't') => true,
        Some('u') => after.get(1..5).is_some_and(|digits| digits.chars().all(|c| c.is_ascii_hexdigit())),
        _ => false,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use serde_json::{Value, from_str};

    #[test]
    fn json_stays_what_it_is() {
        let text = r#"{"a": [1, -2.5e-3, true, false, null, "é \" \\ \u00e9 // no comment, ]"], "b": {}}"#;
        assert_eq!(from_str::<Value>(&tidy(text)).unwrap(), from_str::<Value>(text).unwrap());
    }

    #[test]
    fn text_that_is_nearly_json() {
        for (text, json) in [
            ("[NaN, -nan(ind), 1.#QNAN, -Infinity, inf, 1e999]", "[null, null, null, null, null, null]"),
            ("[.5, 5., +1, 007]", "[0.5, 5, 1, 7]"),
            ("[1, 2,\n]", "[1, 2]"),
            ("{\"a\": 1, }", "{\"a\": 1}"),
            ("[1, // one\n 2 /* two */]", "[1, 2]"),
            ("[\"a\nb\"]", "[\"a\\nb\"]"),
            (r#"["textures\wood\new.png"]"#, r#"["textures\\wood\\new.png"]"#),
        ] {
            assert_eq!(from_str::<Value>(&tidy(text)).unwrap(), from_str::<Value>(json).unwrap(), "{text}");
        }
    }

    #[test]
    fn any_text_comes_to_an_end() {
        for text in ["", "\"", "\"\\", "\"\\u", "/", "/*", "//", ",", "é\"é\\é", "[[[\"a\\\""] {
            tidy(text);
        }
    }
}
