//! The statements of a material library.

use std::collections::HashMap;

use super::map::Map;
use super::text::{Statement, each_statement, number, numbers, shortened};
use crate::scene::load::common::report::Report;

/// A material as its library describes it.
#[derive(Default)]
pub(super) struct Source {
    /// The name without and with a suffix that may be a comment.
    pub names: [String; 2],
    pub diffuse: Option<[f32; 3]>,
    pub specular: Option<[f32; 3]>,
    pub emissive: Option<[f32; 3]>,
    pub transmission: Option<[f32; 3]>,
    pub shininess: Option<f32>,
    pub refraction: Option<f32>,
    /// `d`.
    pub opacity: Option<f32>,
    /// `Tr`.
    pub transparency: Option<f32>,
    pub illumination: Option<f32>,
    pub roughness: Option<f32>,
    pub metallic: Option<f32>,
    /// Weight of the clear coat, `Pc`.
    pub coat: Option<f32>,
    /// Roughness of the clear coat, `Pcr`.
    pub coat_roughness: Option<f32>,
    /// The textures, by their keywords.
    pub maps: HashMap<Texture, Map>,
}

/// The texture statements that are read.
#[derive(Clone, Copy, PartialEq, Eq, Hash, Debug)]
pub(super) enum Texture {
    Diffuse,
    Specular,
    Emissive,
    Opacity,
    Roughness,
    Metallic,
    /// A normal map.
    Normal,
    /// Heights, or a normal map: exporters write both.
    Bump,
}

/// Reads a library.
pub(super) fn parse(text: &str, file: &str, report: &mut Report) -> Vec<Source> {
    let mut materials: Vec<Source> = Vec::new();
    let mut reader = Reader { file, commas: None, unknown: 0 };
    each_statement(text, |statement| {
        if statement.keyword.eq_ignore_ascii_case("newmtl") {
            let names = [statement.arguments.to_owned(), statement.whole.to_owned()];
            materials.push(Source { names, ..Source::default() });
        } else if let Some(material) = materials.last_mut() {
            reader.read(material, statement, report);
        } else {
            report.warn_once(reader.element(statement.line), "stands before the first newmtl, and is left out");
        }
    });
    if let Some(line) = reader.commas {
        let reason = "numbers have a decimal comma, where MTL has a point; it is read as a point";
        report.warn(reader.element(line), reason);
    }
    materials
}

struct Reader<'a> {
    file: &'a str,
    /// The first line with a decimal comma.
    commas: Option<usize>,
    /// Number of unknown keywords.
    unknown: usize,
}

impl Reader<'_> {
    fn element(&self, line: usize) -> String {
        format!("{} line {line}", self.file)
    }

    fn read(&mut self, material: &mut Source, statement: Statement<'_>, report: &mut Report) {
        let mut commas = false;
        let keyword = statement.keyword.to_ascii_lowercase();
        match material.set(&keyword, statement, &mut commas) {
            Ok(true) => {}
            Ok(false) => self.unread(&keyword, statement, report),
            Err(reason) => {
                let reason = format!("{}: {reason}; the statement is left out", shortened(statement.keyword));
                report.warn(self.element(statement.line), reason);
            }
        }
        if commas {
            self.commas.get_or_insert(statement.line);
        }
    }

    /// Warns once for each keyword about the part of it that is not read.
    fn unread(&mut self, keyword: &str, statement: Statement<'_>, report: &mut Report) {
        /// Maximum number of unknown keywords that get a warning.
        const MAX_UNKNOWN: usize = 16;
        let element = self.element(statement.line);
        let named = shortened(statement.keyword);
        let what = match keyword {
            "disp" | "map_disp" => "displacement maps are",
            "refl" | "map_refl" => "reflection maps are",
            "map_ns" => "maps of the shininess are",
            "map_tr" | "map_tf" => "maps of the transparency other than map_d are",
            "decal" => "decals are",
            "ps" | "map_ps" => "sheen is",
            "map_pc" | "map_pcr" => "maps of the clear coat are",
            "aniso" => "anisotropy is",
            _ => {
                self.unknown += 1;
                if self.unknown <= MAX_UNKNOWN {
                    report.warn_once(element, format!("the statement \"{named}\" is not known, and left out"));
                }
                return;
            }
        };
        report.warn_once(element, format!("{named}: {what} not read"));
    }
}

impl Source {
    /// Adds a statement. Returns false if it is not read.
    fn set(&mut self, keyword: &str, statement: Statement<'_>, commas: &mut bool) -> Result<bool, String> {
        let values = statement.arguments;
        let mut map = |texture: Texture, commas: &mut bool| {
            self.maps.insert(texture, Map::parse(statement, commas)?);
            Ok::<_, String>(())
        };
        match keyword {
            "kd" => self.diffuse = Some(color(values, commas)?),
            "ks" => self.specular = Some(color(values, commas)?),
            "ke" => self.emissive = Some(color(values, commas)?),
            "tf" => self.transmission = Some(color(values, commas)?),
            "ns" => self.shininess = Some(one(values, commas)?),
            "ni" => self.refraction = Some(one(values, commas)?),
            "d" => self.opacity = Some(one(values.strip_prefix("-halo").unwrap_or(values), commas)?),
            "tr" => self.transparency = Some(one(values, commas)?),
            "illum" => self.illumination = Some(one(values, commas)?),
            "pr" => self.roughness = Some(one(values, commas)?),
            "pm" => self.metallic = Some(one(values, commas)?),
            "pc" => self.coat = Some(one(values, commas)?),
            "pcr" => self.coat_roughness = Some(one(values, commas)?),
            "map_kd" => map(Texture::Diffuse, commas)?,
            "map_ks" => map(Texture::Specular, commas)?,
            "map_ke" => map(Texture::Emissive, commas)?,
            "map_d" => map(Texture::Opacity, commas)?,
            "map_pr" => map(Texture::Roughness, commas)?,
            "map_pm" => map(Texture::Metallic, commas)?,
            "norm" | "map_norm" | "map_kn" => map(Texture::Normal, commas)?,
            "bump" | "map_bump" => map(Texture::Bump, commas)?,
            // The path tracer computes ambient light itself. The others are about filtering, or about statements that are not read.
            "ka" | "map_ka" | "sharpness" | "map_aat" | "anisor" => {}
            // Exporters write these for all materials; 0 says that there is none.
            "ps" | "aniso" => return Ok(one(values, commas)? == 0.0),
            _ => return Ok(false),
        }
        Ok(true)
    }
}

fn one(text: &str, commas: &mut bool) -> Result<f32, String> {
    number(text.split_whitespace().next().ok_or("there is no number")?, commas)
}

/// Three numbers, or one that stands for all three; after the word `xyz`, coordinates of CIE 1931.
fn color(text: &str, commas: &mut bool) -> Result<[f32; 3], String> {
    if text.starts_with("spectral") {
        return Err("\"spectral\" is not a number; spectral curves are not read".into());
    }
    let (values, xyz) = match text.strip_prefix("xyz") {
        Some(values) => (values, true),
        None => (text, false),
    };
    let color = match numbers::<3>(values, commas)? {
        (color, 3) => color,
        ([grey, ..], 1) => [grey; 3],
        (_, count) => return Err(format!("{count} numbers, where 3 belong")),
    };
    Ok(if xyz { rec709(color) } else { color })
}

/// Linear Rec. 709 of CIE XYZ.
fn rec709([x, y, z]: [f32; 3]) -> [f32; 3] {
    [
        3.240_97 * x - 1.537_383_2 * y - 0.498_610_76 * z,
        -0.969_243_65 * x + 1.875_967_5 * y + 0.041_555_06 * z,
        0.055_630_08 * x - 0.203_976_96 * y + 1.056_971_5 * z,
    ]
}
