//! Surfaces.

use super::Texture;

/// A surface: Lambert + GGX in the metallic-roughness model of glTF 2.0, and light that it emits.
#[derive(Clone, Debug)]
pub struct Material {
    /// Name for messages and debugging; may be empty.
    pub name: String,
    /// Linear base colour and opacity, each 0…1; multiplies the texture.
    pub base_color: [f32; 4],
    /// Base colour (sRGB) and opacity.
    pub base_color_texture: Option<Texture>,
    /// 0 = dielectric, 1 = metal; multiplies the blue channel of the texture.
    pub metallic: f32,
    /// Perceptual roughness 0…1 (GGX α is its square); multiplies the green channel of the texture.
    pub roughness: f32,
    /// Green = roughness, blue = metallic (linear).
    pub metallic_roughness_texture: Option<Texture>,
    /// Normals of the surface in the space of tangent, bitangent and normal (linear): each channel from 0…1 to −1…1, green upwards in the
    /// image. Tangents are those of the mesh, or made by MikkTSpace.
    pub normal_texture: Option<Texture>,
    /// Factor on the first two coordinates of these normals.
    pub normal_scale: f32,
    /// Radiance that the front face emits (both faces if `double_sided`), ≥ 0; multiplies the texture.
    pub emissive: [f32; 3],
    /// Emitted colour (sRGB).
    pub emissive_texture: Option<Texture>,
    /// The use of opacity.
    pub alpha: Alpha,
    /// True if the back face emits too. Reflection is always two-sided.
    pub double_sided: bool,
    /// True if the base colour is shown without any light (KHR_materials_unlit). Such a surface lights nothing.
    pub unlit: bool,
    /// Normal-incidence reflectance (F₀) of the dielectric part, each 0…1: 0.04 for an index of refraction of 1.5, 0 for a
    /// purely Lambertian surface.
    pub specular: [f32; 3],
    /// Reflectance of the dielectric part at grazing incidence (F₉₀), 0…1.
    pub specular_edge: f32,
    /// Alpha multiplies `specular` and `specular_edge` (KHR_materials_specular).
    pub specular_texture: Option<Texture>,
    /// Colour (sRGB) multiplies `specular` (KHR_materials_specular).
    pub specular_color_texture: Option<Texture>,
    /// Part of the light, of what the dielectric part does not mirror, that goes through the surface instead of being scattered by it, 0…1
    /// (KHR_materials_transmission); multiplies the red channel of the texture. The base colour tints it at each surface.
    pub transmission: f32,
    /// Red = transmission (linear).
    pub transmission_texture: Option<Texture>,
    /// The inside of a surface that transmits light.
    pub interior: Interior,
    /// The clear coat over all of this.
    pub clearcoat: Clearcoat,
    /// True if back faces are invisible to the camera and to light, as in a rasterizer that culls them. Outlines made of hulls need
    /// this.
    pub culled: bool,
}

impl Default for Material {
    /// The default material of glTF 2.0, but purely diffuse: white, not metallic, rough, without a dielectric coat.
    fn default() -> Self {
        Self {
            name: String::new(),
            base_color: [1.0; 4],
            base_color_texture: None,
            metallic: 0.0,
            roughness: 1.0,
            metallic_roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
            emissive: [0.0; 3],
            emissive_texture: None,
            alpha: Alpha::Opaque,
            double_sided: false,
            unlit: false,
            specular: [0.0; 3],
            specular_edge: 1.0,
            specular_texture: None,
            specular_color_texture: None,
            transmission: 0.0,
            transmission_texture: None,
            interior: Interior::default(),
            clearcoat: Clearcoat::default(),
            culled: false,
        }
    }
}

impl Material {
    /// True if the material's triangles are lights.
    pub(crate) fn is_emitter(&self) -> bool {
        !self.unlit && self.emissive.iter().any(|&e| e > 0.0)
    }

    /// True if rays meet the surface with the probability of its opacity.
    pub(crate) fn is_blended(&self) -> bool {
        self.alpha == Alpha::Blend && !self.is_skin()
    }

    /// True if the surface is the skin of a body of glass.
    pub(crate) fn is_skin(&self) -> bool {
        self.transmits() && self.interior.absorption.is_some()
    }

    /// True if the surface has a clear coat.
    pub(crate) fn is_coated(&self) -> bool {
        !self.unlit && self.clearcoat.weight > 0.0
    }

    /// True if the surface has a specular lobe. Glass mirrors at grazing incidence, whatever its reflectance is.
    pub(crate) fn mirrors(&self) -> bool {
        let metallic = !self.unlit && (self.specular != [0.0; 3] || self.metallic > 0.0);
        metallic || self.transmits() || self.is_coated()
    }

    /// True if light goes through the surface.
    pub(crate) fn transmits(&self) -> bool {
        !self.unlit && self.transmission > 0.0
    }

    /// True if the surface may be so smooth that things are seen through it (`NARROW` of shaders/shared/material.wgsl).
    pub(crate) fn is_clear(&self) -> bool {
        self.transmits() && (self.roughness <= 0.2 || self.metallic_roughness_texture.is_some())
    }

    /// The normal map of the surface, and that of its coat.
    pub(crate) fn normal_maps(&self) -> impl Iterator<Item = Texture> {
        let of_coat = self.clearcoat.normal_texture.filter(|_| self.is_coated());
        self.normal_texture.into_iter().chain(of_coat)
    }

    /// All textures in use, each with the name of its field.
    pub(crate) fn textures(&self) -> impl Iterator<Item = (&'static str, Texture)> {
        [
            ("base_color_texture", self.base_color_texture),
            ("metallic_roughness_texture", self.metallic_roughness_texture),
            ("normal_texture", self.normal_texture),
            ("emissive_texture", self.emissive_texture),
            ("specular_texture", self.specular_texture),
            ("specular_color_texture", self.specular_color_texture),
            ("transmission_texture", self.transmission_texture),
            ("clearcoat.weight_texture", self.clearcoat.weight_texture),
            ("clearcoat.roughness_texture", self.clearcoat.roughness_texture),
            ("clearcoat.normal_texture", self.clearcoat.normal_texture),
        ]
        .into_iter()
        .filter_map(|(name, texture)| Some((name, texture?)))
    }
}

/// The inside of a surface that transmits light.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Interior {
    /// Index of refraction over that of air, 1…10. It bends light, and gives what is mirrored as a function of the angle between
    /// `specular` and `specular_edge`. Bodies in each other each refract as against air.
    pub index: f32,
    /// `None` for a pane without thickness, through which light goes straight. For the skin of a closed body (KHR_materials_volume), the
    /// absorption per unit of length of the world, each ≥ 0: light fades to exp(−absorption · length).
    pub absorption: Option<[f32; 3]>,
}

impl Interior {
    /// Greatest index of refraction.
    pub const MOST_INDEX: f32 = 10.0;

    /// A body that leaves this part of light, each above 0 and at most 1, over this length above 0.
    pub fn absorbing(index: f32, color: [f32; 3], length: f32) -> Self {
        Self { index, absorption: Some(color.map(|left| (1.0 / left).ln() / length)) }
    }
}

impl Default for Interior {
    /// A pane of window glass.
    fn default() -> Self {
        Self { index: 1.5, absorption: None }
    }
}

/// A clear layer over a surface, as varnish (KHR_materials_clearcoat). Its index of refraction is 1.5.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Clearcoat {
    /// Part of the surface that is coated, 0…1; multiplies the red channel of the texture.
    pub weight: f32,
    /// Red = weight (linear).
    pub weight_texture: Option<Texture>,
    /// Perceptual roughness 0…1; multiplies the green channel of the texture.
    pub roughness: f32,
    /// Green = roughness (linear).
    pub roughness_texture: Option<Texture>,
    /// Normals of the coat, as [`Material::normal_texture`] has them of the surface below. Without them the coat is as smooth as the mesh.
    pub normal_texture: Option<Texture>,
    /// Factor on the first two coordinates of these normals.
    pub normal_scale: f32,
}

impl Default for Clearcoat {
    /// No coat.
    fn default() -> Self {
        Self {
            weight: 0.0,
            weight_texture: None,
            roughness: 0.0,
            roughness_texture: None,
            normal_texture: None,
            normal_scale: 1.0,
        }
    }
}

/// The use of a material's opacity.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub enum Alpha {
    /// Opacity is ignored.
    #[default]
    Opaque,
    /// Points with an opacity below the cutoff are cut out.
    Mask(f32),
    /// A ray meets the surface with a probability equal to its opacity. Such pixels have more noise, because each path begins on
    /// one of the surfaces that the pixel sees. The denoiser keeps the depth, normal and motion of the nearest surface with an
    /// opacity of at least ½, and the albedo of all of them. The skin of a body of glass is whole whatever its opacity is, because a ray
    /// through a hole would be inside without having entered.
    Blend,
}
