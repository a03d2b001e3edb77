//! Texture statements of MTL: options and a file name.

use super::text::{Statement, number};

/// The number of a texel that a map uses, if it uses only one.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Channel {
    /// Red, green, blue or alpha.
    One(usize),
    /// Luminance.
    Luminance,
}

/// A texture statement.
#[derive(Clone, PartialEq, Debug)]
pub(super) struct Map {
    /// The file name without and with a suffix that may be a comment.
    pub files: [String; 2],
    pub scale: [f32; 2],
    pub offset: [f32; 2],
    pub clamp: bool,
    /// Factor on heights or on the slopes of normals (`-bm`).
    pub bump: f32,
    /// The channel that `-imfchan` selects.
    pub channel: Option<Channel>,
    /// True if the statement has an option that changes texels and is not read (`-mm`, `-t`).
    pub unread: bool,
}

impl Map {
    pub fn parse(statement: Statement<'_>, commas: &mut bool) -> Result<Self, String> {
        let mut map = Self {
            files: Default::default(),
            scale: [1.0; 2],
            offset: [0.0; 2],
            clamp: false,
            bump: 1.0,
            channel: None,
            unread: false,
        };
        let mut rest = statement.arguments.trim();
        while rest.starts_with('-') {
            let option = word(&mut rest);
            match option.to_ascii_lowercase().as_str() {
                "-s" => vector(&mut rest, &mut map.scale, commas),
                "-o" => vector(&mut rest, &mut map.offset, commas),
                "-t" => {
                    let mut turbulence = [0.0; 2];
                    vector(&mut rest, &mut turbulence, commas);
                    map.unread |= turbulence != [0.0; 2];
                }
                "-clamp" => map.clamp = word(&mut rest).eq_ignore_ascii_case("on"),
                "-imfchan" => map.channel = channel(word(&mut rest)),
                "-mm" => {
                    let [base, gain] = [word(&mut rest), word(&mut rest)].map(|word| number(word, commas));
                    map.unread |= base != Ok(0.0) || gain != Ok(1.0);
                }
                "-bm" => map.bump = number(word(&mut rest), commas).unwrap_or(1.0),
                "-blendu" | "-blendv" | "-boost" | "-cc" | "-texres" | "-type" | "-colorspace" => {
                    word(&mut rest);
                }
                _ => return Err(format!("the option {option} is not known")),
            }
        }
        if rest.is_empty() {
            return Err("there is no file name".into());
        }
        let name = |name: &str| name.trim().replace('\\', "/");
        let start = statement.arguments.len() - rest.len();
        let whole = statement.whole.get(start..).unwrap_or(rest);
        map.files = [name(rest), name(whole)];
        Ok(map)
    }

    /// The affine map of texture coordinates whose v grows downwards.
    pub fn transform(&self) -> [[f32; 3]; 2] {
        let [[su, sv], [ou, ov]] = [self.scale, self.offset];
        [[su, 0.0, ou], [0.0, sv, 1.0 - sv - ov]]
    }

    /// True if two maps place their images alike.
    pub fn is_placed_as(&self, other: &Self) -> bool {
        (self.scale, self.offset, self.clamp) == (other.scale, other.offset, other.clamp)
    }
}

fn channel(name: &str) -> Option<Channel> {
    match name.to_ascii_lowercase().as_str() {
        "r" => Some(Channel::One(0)),
        "g" => Some(Channel::One(1)),
        "b" => Some(Channel::One(2)),
        // The matte channel.
        "m" => Some(Channel::One(3)),
        "l" => Some(Channel::Luminance),
        _ => None,
    }
}

/// Splits the first word off a text.
fn word<'a>(rest: &mut &'a str) -> &'a str {
    let (first, others) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    *rest = others.trim_start();
    first
}

/// Splits one to three numbers off a text. The third is for solid textures.
fn vector(rest: &mut &str, vector: &mut [f32; 2], commas: &mut bool) {
    for index in 0..3 {
        let mut after = *rest;
        let Ok(number) = number(word(&mut after), commas) else { break };
        *rest = after;
        if let Some(element) = vector.get_mut(index) {
            *element = number;
        }
    }
}
