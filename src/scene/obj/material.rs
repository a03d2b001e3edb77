//! MTL material libraries.

use std::collections::HashMap;
use std::path::PathBuf;

use super::text::{numbers, statements};
use crate::scene::description::{Alpha, Material, Scene, Texture, Wrap};
use crate::scene::load::decode::decode;
use crate::scene::load::folder::Folder;
use crate::scene::load::report::{Fault, Report};

/// Opacity below which a surface is taken to be absent.
const CUTOFF: f32 = 0.5;

/// What faces without a known material look like.
pub(super) fn grey() -> Material {
    Material { name: "default".into(), base_color: [0.8, 0.8, 0.8, 1.0], double_sided: true, ..Material::default() }
}

/// Reads the libraries that `mtllib` statements name (with their lines) and adds their materials to the scene.
/// Returns the index of each name; where a name is defined twice, the last definition counts.
pub(super) fn read_libraries(
    statements: &[(String, usize)],
    folder: &Folder<'_>,
    report: &mut Report,
    scene: &mut Scene,
) -> Result<HashMap<String, usize>, Fault> {
    let mut names = HashMap::new();
    let mut textures = Textures { folder, known: HashMap::new() };
    for path in locate(statements, folder, report) {
        let bytes = match folder.read(&path) {
            Ok(bytes) => bytes,
            Err(reason) => {
                report.warn(path.display().to_string(), format!("{reason}; its materials are drawn in grey"));
                continue;
            }
        };
        let file = path.file_name().map(|name| name.to_string_lossy().into_owned()).unwrap_or_default();
        for source in parse(&String::from_utf8_lossy(&bytes), &file, report) {
            let material = source.convert(&mut textures, &file, report, scene);
            names.insert(source.name, scene.materials.len());
            scene.materials.push(material);
        }
    }
    Ok(names)
}

/// The library files, each once.
fn locate(statements: &[(String, usize)], folder: &Folder<'_>, report: &mut Report) -> Vec<PathBuf> {
    let mut paths = Vec::new();
    for (argument, line) in statements {
        // Either one name that may hold spaces, or several names without.
        let found: Result<Vec<PathBuf>, String> = match folder.locate(&argument.replace('\\', "/")) {
            Ok(path) => Ok(vec![path]),
            Err(reason) if argument.contains(char::is_whitespace) => argument
                .split_whitespace()
                .map(|name| folder.locate(name))
                .collect::<Result<_, _>>()
                .map_err(|_| reason),
            Err(reason) => Err(reason),
        };
        match found {
            Ok(found) => paths.extend(found),
            Err(reason) => {
                report.warn(format!("line {line}"), format!("mtllib: {reason}; its materials are drawn in grey"))
            }
        }
    }
    let mut seen = std::collections::HashSet::new();
    paths.retain(|path| seen.insert(path.clone()));
    paths
}

/// A material as its library describes it.
#[derive(Default)]
struct Source {
    name: String,
    diffuse: Option<[f32; 3]>,
    specular: Option<[f32; 3]>,
    emissive: Option<[f32; 3]>,
    shininess: Option<f32>,
    opacity: Option<f32>,
    illumination: Option<f32>,
    diffuse_map: Option<Map>,
    emissive_map: Option<Map>,
    opacity_map: Option<Map>,
}

fn parse(text: &str, file: &str, report: &mut Report) -> Vec<Source> {
    let mut materials: Vec<Source> = Vec::new();
    for (line, keyword, arguments) in statements(text) {
        let element = format!("{file} line {line}");
        if keyword == "newmtl" {
            materials.push(Source { name: arguments, ..Source::default() });
            continue;
        }
        let Some(material) = materials.last_mut() else { continue };
        if let Err(reason) = material.set(&keyword, &arguments, &element, report) {
            report.warn(element, format!("{keyword}: {reason}; the statement is left out"));
        }
    }
    materials
}

impl Source {
    fn set(&mut self, keyword: &str, arguments: &str, element: &str, report: &mut Report) -> Result<(), String> {
        match keyword {
            "Kd" => self.diffuse = Some(color(arguments)?),
            "Ks" => self.specular = Some(color(arguments)?),
            "Ke" => self.emissive = Some(color(arguments)?),
            "Ns" => self.shininess = Some(number(arguments)?),
            "d" => self.opacity = Some(number(arguments.strip_prefix("-halo").unwrap_or(arguments))?),
            "Tr" => self.opacity = Some(1.0 - number(arguments)?),
            "illum" => self.illumination = Some(number(arguments)?),
            "map_Kd" => self.diffuse_map = Some(Map::parse(arguments)?),
            "map_Ke" => self.emissive_map = Some(Map::parse(arguments)?),
            "map_d" => self.opacity_map = Some(Map::parse(arguments)?),
            "map_Ks" | "map_Ns" => report.warn_once(element, "specular maps are not read"),
            "bump" | "map_bump" | "map_Bump" | "norm" | "disp" => report.warn_once(element, "bump maps are not read"),
            _ => {}
        }
        Ok(())
    }

    fn convert(&self, textures: &mut Textures, file: &str, report: &mut Report, scene: &mut Scene) -> Material {
        let element = format!("{file} material \"{}\"", self.name);
        let specular = match self.illumination {
            // Models 0 and 1 are without highlights.
            Some(model) if model < 2.0 => [0.0; 3],
            _ => self.specular.unwrap_or_default(),
        };
        let diffuse = self.diffuse.unwrap_or(if self.diffuse_map.is_some() { [1.0; 3] } else { [0.8; 3] });
        let strongest = |color: [f32; 3]| color.into_iter().fold(0.0, f32::max);
        // A surface that only reflects specularly is a metal.
        let metal = strongest(diffuse) == 0.0 && strongest(specular) > 0.0;
        let [r, g, b] = if metal { specular } else { diffuse }.map(|x| report.clamp_unit(x, || element.clone()));

        let opacity = report.clamp_unit(self.opacity.unwrap_or(1.0), || element.clone());
        let same_file = |a: &Map| self.diffuse_map.as_ref().is_some_and(|b| a.file == b.file);
        let alpha = match &self.opacity_map {
            // The opacity is in the fourth channel of the colour texture.
            Some(map) if same_file(map) => Alpha::Mask(CUTOFF),
            Some(_) => {
                report.warn(&element, "map_d is not read; the surface is drawn as opaque");
                Alpha::Opaque
            }
            None if opacity < CUTOFF => {
                report.warn(&element, format!("opacity {opacity} is below {CUTOFF}; the surface is not drawn"));
                Alpha::Mask(CUTOFF)
            }
            None => {
                if opacity < 1.0 {
                    report.warn(&element, format!("opacity {opacity} is drawn as 1"));
                }
                Alpha::Opaque
            }
        };

        let mut texture = |map: &Option<Map>| map.as_ref().and_then(|map| textures.get(map, &element, report, scene));
        let base_color_texture = texture(&self.diffuse_map);
        let emissive_texture = texture(&self.emissive_map);
        let emissive = self.emissive.filter(|&emissive| strongest(emissive) > 0.0);
        // A map on its own means that it is shown as it is.
        let emissive = emissive.unwrap_or(if emissive_texture.is_some() { [1.0; 3] } else { [0.0; 3] });
        Material {
            name: self.name.clone(),
            base_color: [r, g, b, opacity],
            base_color_texture,
            metallic: if metal { 1.0 } else { 0.0 },
            roughness: self.shininess.map_or(1.0, roughness),
            emissive: report.clamp_radiance(emissive, || element.clone()),
            emissive_texture,
            alpha,
            // Windings in OBJ files are not to be relied on.
            double_sided: true,
            specular: if metal { [0.0; 3] } else { specular.map(|x| x.clamp(0.0, 1.0)) },
            ..Material::default()
        }
    }
}

/// Perceptual roughness of the GGX lobe that is as wide as a Blinn-Phong lobe of that exponent.
fn roughness(shininess: f32) -> f32 {
    let alpha = (2.0 / (shininess.max(0.0) + 2.0)).sqrt();
    alpha.sqrt()
}

fn number(text: &str) -> Result<f32, String> {
    numbers(text, 1)?.first().copied().ok_or_else(|| "there is no number".into())
}

/// Three numbers, or one that stands for all three.
fn color(text: &str) -> Result<[f32; 3], String> {
    match numbers(text, 3)?.as_slice() {
        &[r, g, b] => Ok([r, g, b]),
        &[grey] => Ok([grey; 3]),
        other => Err(format!("{} numbers, where 3 belong", other.len())),
    }
}

/// A texture statement: options and a file.
struct Map {
    file: String,
    scale: [f32; 2],
    offset: [f32; 2],
    clamp: bool,
}

impl Map {
    fn parse(arguments: &str) -> Result<Self, String> {
        let mut map = Self { file: String::new(), scale: [1.0; 2], offset: [0.0; 2], clamp: false };
        let mut rest = arguments.trim();
        while rest.starts_with('-') {
            let option = word(&mut rest);
            match option {
                "-s" => vector(&mut rest, &mut map.scale),
                "-o" => vector(&mut rest, &mut map.offset),
                "-t" => vector(&mut rest, &mut [0.0; 2]),
                "-clamp" => map.clamp = word(&mut rest) == "on",
                "-mm" => {
                    word(&mut rest);
                    word(&mut rest);
                }
                "-blendu" | "-blendv" | "-bm" | "-boost" | "-cc" | "-imfchan" | "-texres" | "-type" => {
                    word(&mut rest);
                }
                other => return Err(format!("the option {other} is not known")),
            }
        }
        if rest.is_empty() {
            return Err("there is no file name".into());
        }
        map.file = rest.replace('\\', "/");
        Ok(map)
    }

    /// The affine map of texture coordinates whose v grows downwards.
    fn transform(&self) -> [[f32; 3]; 2] {
        let [[su, sv], [ou, ov]] = [self.scale, self.offset];
        [[su, 0.0, ou], [0.0, sv, 1.0 - sv - ov]]
    }
}

/// Takes the first word off a text.
fn word<'a>(rest: &mut &'a str) -> &'a str {
    let (first, others) = rest.split_once(char::is_whitespace).unwrap_or((rest, ""));
    *rest = others.trim_start();
    first
}

/// Takes one to three numbers off a text; the third is for solid textures.
fn vector(rest: &mut &str, vector: &mut [f32; 2]) {
    for index in 0..3 {
        let mut after = *rest;
        let Some(number) = word(&mut after).parse::<f32>().ok().filter(|number| number.is_finite()) else { break };
        *rest = after;
        if let Some(element) = vector.get_mut(index) {
            *element = number;
        }
    }
}

/// The images of all libraries, each read once.
struct Textures<'a> {
    folder: &'a Folder<'a>,
    known: HashMap<PathBuf, Option<usize>>,
}

impl Textures<'_> {
    fn get(&mut self, map: &Map, element: &str, report: &mut Report, scene: &mut Scene) -> Option<Texture> {
        let path = match self.folder.locate(&map.file) {
            Ok(path) => path,
            Err(reason) => {
                report.warn(element, format!("{reason}; it is drawn without this texture"));
                return None;
            }
        };
        let image = *self.known.entry(path.clone()).or_insert_with(|| {
            match self.folder.read(&path).and_then(|bytes| decode(&map.file, &bytes)) {
                Ok(image) => {
                    scene.images.push(image);
                    Some(scene.images.len() - 1)
                }
                Err(reason) => {
                    report.warn(element, format!("\"{}\" {reason}; materials are drawn without it", map.file));
                    None
                }
            }
        });
        let wrap = if map.clamp { Wrap::Clamp } else { Wrap::Repeat };
        image.map(|image| Texture { wrap: [wrap; 2], transform: map.transform(), ..Texture::new(image) })
    }
}
