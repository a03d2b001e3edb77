//! Bytes to text.

use std::borrow::Cow;

/// The encoding of a text that is neither UTF-8 nor ASCII, in the words of a warning.
pub(crate) type Note = Option<&'static str>;

/// Decodes the bytes of a text file: UTF-8, UTF-16 (known by its byte-order mark, or by the zero bytes between ASCII characters), and
/// Latin-1 wherever bytes are not UTF-8, because exporters write names in the code page of their machine.
pub(crate) fn decode(bytes: &[u8]) -> (Cow<'_, str>, Note) {
    const NOTE: &str = "is UTF-16, where ASCII or UTF-8 belongs; it is read as UTF-16";
    let little: fn([u8; 2]) -> u16 = u16::from_le_bytes;
    let (content, unit) = match bytes {
        [0xFF, 0xFE, content @ ..] => (content, little),
        [0xFE, 0xFF, content @ ..] => (content, u16::from_be_bytes as fn([u8; 2]) -> u16),
        [1..=255, 0, 1..=255, 0, ..] => (bytes, little),
        [0, 1..=255, 0, 1..=255, ..] => (bytes, u16::from_be_bytes as fn([u8; 2]) -> u16),
        _ => {
            let bytes = bytes.strip_prefix(b"\xEF\xBB\xBF").unwrap_or(bytes);
            // Zeros pad files and end C strings.
            let end = bytes.iter().rposition(|&byte| byte != 0).map_or(0, |last| last + 1);
            return (without_zeros(one_byte(&bytes[..end])), None);
        }
    };
    let units = content.as_chunks::<2>().0.iter().map(|&pair| unit(pair));
    let text = char::decode_utf16(units).map(|unit| unit.unwrap_or(char::REPLACEMENT_CHARACTER)).collect();
    (Cow::Owned(text), Some(NOTE))
}

fn without_zeros(text: Cow<'_, str>) -> Cow<'_, str> {
    // A binary file has many zeros, and must still be recognised as binary.
    let zeros = text.bytes().filter(|&byte| byte == 0).count();
    if zeros == 0 || zeros * 20 > text.len() { text } else { Cow::Owned(text.replace('\0', "")) }
}

fn one_byte(bytes: &[u8]) -> Cow<'_, str> {
    if let Ok(text) = std::str::from_utf8(bytes) {
        return Cow::Borrowed(text);
    }
    let mut text = String::with_capacity(bytes.len() + bytes.len() / 8);
    for chunk in bytes.utf8_chunks() {
        text.push_str(chunk.valid());
        text.extend(chunk.invalid().iter().map(|&byte| char::from(byte)));
    }
    Cow::Owned(text)
}
