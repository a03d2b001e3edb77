//! Lights that have no triangles.

/// A light without area (KHR_lights_punctual). It shines along −Z of its node. The scale of the node changes neither its intensity nor its
/// range nor its cone.
///
/// Numbers are radiometric and linear, as those of [`Material::emissive`](super::Material::emissive) are: with an intensity I, a surface at
/// the distance d receives I/d² across the light's direction, and a matte one of albedo a reflects the radiance a/π · I/d² · cos θ.
/// Photometric numbers serve as well if all lights and all emission are photometric: lux, candela and cd/m². A luminous efficacy of
/// 683 lm/W converts them.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Light {
    /// Shape of the emission.
    pub kind: LightKind,
    /// Linear colour times intensity: W/m² across the light's direction for a directional light, W/sr for the others.
    pub intensity: [f32; 3],
    /// Distance in metres at which the light has faded to nothing (as KHR_lights_punctual defines), or infinity for one that does not
    /// fade.
    pub range: f32,
}

impl Light {
    /// A light that reaches infinitely far.
    pub fn new(kind: LightKind, intensity: [f32; 3]) -> Self {
        Self { kind, intensity, range: f32::INFINITY }
    }
}

/// Shape of a [`Light`].
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum LightKind {
    /// Parallel light from infinitely far away.
    Directional,
    /// Light of the same intensity in all directions.
    Point,
    /// A cone: full intensity inside `inner`, none outside `outer` (half angles, radians). In between, the intensity is
    /// ((cos θ − cos `outer`) / (cos `inner` − cos `outer`))² of the full one.
    Spot {
        /// Half angle of the full cone.
        inner: f32,
        /// Half angle at which the light ends, > `inner`.
        outer: f32,
    },
}

/// Light from infinitely far away as an equirectangular image. Direction (x, y, z) is at u = ½ + atan2(z, x)/2π, v = acos(y)/π. The
/// first row is +Y; u grows from −X over −Z, +X and +Z.
#[derive(Clone, Debug, PartialEq)]
pub struct Environment {
    /// Texels per row, ≥ 1.
    pub width: u32,
    /// Rows, ≥ 1.
    pub height: u32,
    /// `width · height` linear radiances, finite and ≥ 0.
    pub radiance: Vec<[f32; 3]>,
}

impl Environment {
    /// The same radiance from everywhere.
    pub fn uniform(radiance: [f32; 3]) -> Self {
        Self { width: 1, height: 1, radiance: vec![radiance] }
    }
}
