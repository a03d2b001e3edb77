//! Conversion of MTL materials.
//!
//! - `Kd` is the base colour, `Ks` the reflectance at normal incidence, `Ns` the exponent of Blinn and Phong. A surface with a
//!   black `Kd` that reflects is a metal. Models (`illum`) 0 and 1 are without highlights.
//! - `Pr` and `Pm`, and their maps, are the metallic-roughness model of glTF. `Ks` has no place there: a dielectric reflects by its index
//!   of refraction (`Ni`, 1.5 by default). A map replaces its number, as in Blender, which writes an unused number beside each map.
//! - Glass (`illum` 4, 6, 7, 9) transmits `Tf`, white by default. Models 6 and 7 refract if their faces are closed ([`super::body`]).
//!   Other glass is a pane, through which light goes straight. Both are smooth, unless `Pr` says otherwise. If `d` is below 1, that is the
//!   opacity.
//! - `d` is opacity: the part that the surface covers of everything behind it. It takes precedence over `Tr` = 1 − `d`, which some
//!   exporters write the other way round.
//! - `map_d` is opacity for each texel. If it is the same file as `map_Kd` and that has an alpha channel, it is this channel. Otherwise it
//!   is the luminance, or the alpha of an image of one colour. `-imfchan` takes precedence over both. The alpha channel of `map_Kd`
//!   alone has no meaning.
//! - `norm` is a normal map. So is `map_bump` if its image is one, because Blender and others write normal maps there; heights are not
//!   read. `-bm` scales the slopes.

use super::map::{Channel, Map};
use super::source::{Source, Texture as Kind};
use super::text::shortened;
use super::textures::{Raw, Textures};
use crate::scene::description::{Alpha, Clearcoat, Interior, Material, Texture};
use crate::scene::load::common::report::Report;

/// Index of refraction of most dielectrics.
const GLASS: f32 = 1.5;

/// The material of faces without a known one: grey, or white if their vertices have colours.
pub(super) fn default(colored: bool) -> Material {
    let [r, g, b] = if colored { [1.0; 3] } else { [0.8; 3] };
    Material { name: "default".into(), base_color: [r, g, b, 1.0], double_sided: true, ..Material::default() }
}

/// The kind of surface that `illum` selects.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Model {
    Matte,
    Glossy,
    /// Glass, with its number in the file.
    Glass(u8),
}

/// The meaning of an opacity for the surface.
struct Opacity {
    /// Alpha of the base colour.
    factor: f32,
    alpha: Alpha,
    texture: Option<Texture>,
}

impl Source {
    /// The material, with warnings about all parts that are not read.
    pub fn convert(&self, textures: &mut Textures<'_>, file: &str, report: &mut Report) -> Material {
        let [name, _] = &self.names;
        let element = &format!("{file} material \"{}\"", shortened(name));
        let mut get = |kind: Kind, report: &mut Report| {
            let map = self.maps.get(&kind)?;
            let colored = matches!(kind, Kind::Diffuse | Kind::Specular | Kind::Emissive | Kind::Normal);
            let unread = colored && map.channel.is_some();
            if map.unread || unread {
                report.warn_once(element, "the options -mm and -t, and -imfchan of a colour, are not read");
            }
            Some((textures.file(map, element, report)?, map))
        };
        let diffuse_map = get(Kind::Diffuse, report);
        let specular_map = get(Kind::Specular, report);
        let emissive_map = get(Kind::Emissive, report);
        let opacity_map = get(Kind::Opacity, report);
        let surface_maps = [get(Kind::Roughness, report), get(Kind::Metallic, report)];
        let normal_maps = [get(Kind::Normal, report), get(Kind::Bump, report)];

        let model = self.model(element, report);
        let physical = self.roughness.is_some()
            || self.metallic.is_some()
            || self.maps.contains_key(&Kind::Roughness)
            || self.maps.contains_key(&Kind::Metallic);
        let specular = match self.specular {
            _ if physical || matches!(model, Model::Glass(_)) => [self.normal_reflectance(); 3],
            _ if model == Model::Matte => [0.0; 3],
            Some(specular) => unit_color(specular, element, report),
            // A map without a number is shown unchanged.
            None => [if specular_map.is_some() { 1.0 } else { 0.0 }; 3],
        };
        if physical && specular_map.is_some() {
            report.warn(element, "map_Ks is not read beside Pr and Pm");
        }
        let diffuse = self.diffuse(diffuse_map.is_some(), element, report);
        // A surface that only reflects specularly is a metal.
        let metal = !physical && model == Model::Glossy && strongest(diffuse) == 0.0 && strongest(specular) > 0.0;
        let [r, g, b] = if metal { specular } else { diffuse };
        let specular_map = specular_map.filter(|_| !physical && model == Model::Glossy && strongest(specular) > 0.0);
        let color_map = if metal { specular_map } else { diffuse_map };

        let opacity = self.opacity(color_map, opacity_map, textures, element, report);
        let emissive_texture = emissive_map.map(|(raw, map)| textures.plain(raw, map));
        let emissive = self.emissive.map(|emissive| report.clamp_radiance(emissive, || element.clone()));
        let emissive = emissive.filter(|&emissive| strongest(emissive) > 0.0);
        let emissive = emissive.unwrap_or([if emissive_texture.is_some() { 1.0 } else { 0.0 }; 3]);
        let metallic_roughness_texture = surface(surface_maps, textures, element, report);
        let normal_map = normal_map(normal_maps, textures, element, report);
        let [rough, metallic] = surface_maps.map(|map| map.is_some() && metallic_roughness_texture.is_some());
        let unit = |value: f32, report: &mut Report| report.clamp_unit(value, || element.clone());
        let material = Material {
            name: name.clone(),
            base_color: [r, g, b, opacity.factor],
            base_color_texture: opacity.texture.or_else(|| color_map.map(|(raw, map)| textures.plain(raw, map))),
            metallic: match self.metallic {
                _ if metallic || metal => 1.0,
                given => unit(given.unwrap_or(0.0), report),
            },
            roughness: match self.roughness {
                _ if rough => 1.0,
                Some(given) => unit(given, report),
                // Rays are refracted and mirrored sharply. `Ns` describes highlights.
                None if matches!(model, Model::Glass(_)) => 0.0,
                None => self.shininess.map_or(1.0, roughness),
            },
            metallic_roughness_texture,
            normal_texture: normal_map.map(|(raw, map)| textures.plain(raw, map)),
            normal_scale: normal_map.map_or(1.0, |(_, map)| map.bump),
            emissive,
            emissive_texture,
            alpha: opacity.alpha,
            // The windings of OBJ files are unreliable.
            double_sided: true,
            specular: if metal { [0.0; 3] } else { specular },
            specular_color_texture: specular_map.filter(|_| !metal).map(|(raw, map)| textures.plain(raw, map)),
            ..Material::default()
        };
        let clearcoat = self.clearcoat(element, report);
        self.transmission(model, Material { clearcoat, ..material }, element, report)
    }

    fn clearcoat(&self, element: &str, report: &mut Report) -> Clearcoat {
        let mut unit = |value: Option<f32>| report.clamp_unit(value.unwrap_or(0.0), || element.to_owned());
        Clearcoat { weight: unit(self.coat), roughness: unit(self.coat_roughness), ..Clearcoat::default() }
    }

    fn model(&self, element: &str, report: &mut Report) -> Model {
        match self.illumination {
            None => Model::Glossy,
            Some(0.0 | 1.0) => Model::Matte,
            Some(2.0 | 3.0 | 5.0 | 8.0 | 10.0) => Model::Glossy,
            Some(glass @ (4.0 | 6.0 | 7.0 | 9.0)) => Model::Glass(glass as u8),
            Some(other) => {
                report.warn(element, format!("illum {other} is not known; 2 is used"));
                Model::Glossy
            }
        }
    }

    /// True if `illum` asks for refraction.
    pub fn refracts(&self) -> bool {
        matches!(self.illumination, Some(6.0 | 7.0))
    }

    fn diffuse(&self, mapped: bool, element: &str, report: &mut Report) -> [f32; 3] {
        match self.diffuse {
            Some(diffuse) if mapped && strongest(diffuse) == 0.0 => {
                report.warn(element, "Kd is black, and would blacken map_Kd; the map is drawn as it is");
                [1.0; 3]
            }
            Some(diffuse) => unit_color(diffuse, element, report),
            None if self.maps.contains_key(&Kind::Diffuse) => [1.0; 3],
            None => [0.8; 3],
        }
    }

    /// Reflectance of a dielectric at normal incidence.
    fn normal_reflectance(&self) -> f32 {
        let index = self.index();
        ((index - 1.0) / (index + 1.0)).powi(2)
    }

    fn index(&self) -> f32 {
        self.refraction.filter(|index| *index > 1.0 && *index <= Interior::MOST_INDEX).unwrap_or(GLASS)
    }

    /// The use of opacity. Nothing else decides it.
    fn opacity(
        &self,
        color: Option<(Raw, &Map)>,
        mask: Option<(Raw, &Map)>,
        textures: &mut Textures<'_>,
        element: &str,
        report: &mut Report,
    ) -> Opacity {
        let given = self.opacity.or(self.transparency.map(|transparency| 1.0 - transparency)).unwrap_or(1.0);
        let factor = report.clamp_unit(given, || element.to_owned());
        if factor == 0.0 {
            report.warn(element, "its opacity is 0; nothing of the surface is seen");
        }
        let alpha = if factor < 1.0 { Alpha::Blend } else { Alpha::Opaque };
        let Some((raw, map)) = mask else { return Opacity { factor, alpha, texture: None } };

        let same = color.is_some_and(|(color, _)| color == raw);
        let channel = match map.channel {
            Some(channel) => channel,
            None if same && textures.has_alpha(raw) => Channel::One(3),
            None if same && !textures.is_grey(raw) => {
                report.warn(element, "map_d is map_Kd, which has no alpha channel; the surface is drawn as opaque");
                return Opacity { factor, alpha, texture: None };
            }
            None if textures.has_alpha(raw) && textures.is_plain(raw) => Channel::One(3),
            None => Channel::Luminance,
        };
        if let Some((_, place)) = color
            && !same
            && !map.is_placed_as(place)
        {
            report.warn(element, "map_d is placed otherwise than map_Kd; it is drawn in the place of map_Kd");
        }
        let texture = match color {
            Some((raw, place)) if same && channel == Channel::One(3) => Ok(textures.plain(raw, place)),
            _ => textures.masked(color, (raw, map, channel)),
        };
        match texture {
            Ok(texture) => Opacity { factor, alpha: Alpha::Blend, texture: Some(texture) },
            Err(reason) => {
                report.warn(element, format!("map_d {reason}; the surface is drawn as opaque"));
                Opacity { factor, alpha, texture: None }
            }
        }
    }

    /// Glass and coloured transmission.
    fn transmission(&self, model: Model, material: Material, element: &str, report: &mut Report) -> Material {
        let filter = self.transmission.unwrap_or([1.0; 3]);
        match model {
            Model::Glass(model) if material.alpha == Alpha::Blend => {
                report.warn(element, format!("illum {model} (glass) does not refract"));
                material
            }
            Model::Glass(_) => {
                let index = self.index();
                if let Some(given) = self.refraction.filter(|&given| given != index) {
                    let most = Interior::MOST_INDEX;
                    report.warn(element, format!("Ni {given} is not above 1 and at most {most}; {index} is used"));
                }
                if strongest(filter) <= 0.0 {
                    report.warn(element, "Tf is black, and no light would go through the glass; white is used");
                }
                let filter = if strongest(filter) > 0.0 { filter } else { [1.0; 3] };
                let [r, g, b] = unit_color(filter, element, report);
                // Glass scatters nothing, whatever Kd says.
                Material {
                    base_color: [r, g, b, 1.0],
                    base_color_texture: None,
                    metallic: 0.0,
                    metallic_roughness_texture: None,
                    transmission: 1.0,
                    interior: Interior { index, absorption: None },
                    ..material
                }
            }
            _ if filter != [1.0; 3] && filter != [0.0; 3] => {
                report.warn(element, "Tf (coloured transmission) is not read");
                material
            }
            _ => material,
        }
    }
}

/// The normal map of `norm`, or of `map_bump` if that is one.
fn normal_map<'a>(
    [normal, bump]: [Option<(Raw, &'a Map)>; 2],
    textures: &Textures<'_>,
    element: &str,
    report: &mut Report,
) -> Option<(Raw, &'a Map)> {
    let bump = bump.filter(|&(raw, _)| {
        let mapped = textures.is_normal_map(raw);
        if !mapped {
            report.warn_once(element, "map_bump has heights, which are not read; normal maps are");
        }
        mapped
    });
    normal.or(bump)
}

/// Roughness and metalness in one texture.
fn surface(
    maps: [Option<(Raw, &Map)>; 2],
    textures: &mut Textures<'_>,
    element: &str,
    report: &mut Report,
) -> Option<Texture> {
    let [roughness, metallic] = maps;
    if let (Some((one, place)), Some((other, map))) = (roughness, metallic) {
        if !map.is_placed_as(place) {
            report.warn(element, "map_Pm is placed otherwise than map_Pr; it is drawn in the place of map_Pr");
        }
        // If both are one file that is not grey, it holds them as glTF does.
        if one == other && place.channel.is_none() && map.channel.is_none() && !textures.is_grey(one) {
            return Some(textures.plain(one, place));
        }
    }
    let channels = maps.map(|map| map.map(|(raw, map)| (raw, map, map.channel.unwrap_or(Channel::Luminance))));
    textures.packed(channels).unwrap_or_else(|reason| {
        report.warn(element, format!("map_Pr {reason}"));
        None
    })
}

fn strongest(color: [f32; 3]) -> f32 {
    color.into_iter().fold(0.0, f32::max)
}

/// A colour clamped to 0…1, with one warning if that changes it visibly.
fn unit_color(color: [f32; 3], element: &str, report: &mut Report) -> [f32; 3] {
    let clamped = color.map(|x| x.clamp(0.0, 1.0));
    if std::iter::zip(color, clamped).any(|(a, b)| (a - b).abs() > 1e-4) {
        report.warn(element, format!("{color:?} is outside 0…1; {clamped:?} is used"));
    }
    clamped
}

/// Perceptual roughness of a GGX lobe as wide as the Blinn-Phong lobe of this exponent.
fn roughness(shininess: f32) -> f32 {
    let alpha = (2.0 / (shininess.max(0.0) + 2.0)).sqrt();
    alpha.sqrt()
}
