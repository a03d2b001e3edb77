//! Curves over time.

use glam::{DQuat, DVec4};

/// Curves over time that move nodes, change shapes and dim lights together.
#[derive(Clone, Debug, Default)]
pub struct Animation {
    /// Name by which it is chosen; may be empty.
    pub name: String,
    /// The curves. No two may have the same target.
    pub channels: Vec<Channel>,
}

/// One animated property.
#[derive(Clone, Debug)]
pub struct Channel {
    /// The property.
    pub target: Target,
    /// The curve between keys.
    pub interpolation: Interpolation,
    /// Key times in seconds, increasing, at least one.
    pub times: Vec<f32>,
    /// One value per key: xyz for translation, scale and colours, a quaternion for rotation, x for weights and factors.
    /// [`Interpolation::CubicSpline`] has three per key: in-tangent, value, out-tangent.
    pub values: Vec<[f32; 4]>,
}

impl Channel {
    /// A linear curve through these keys.
    pub fn new(target: Target, times: Vec<f32>, values: Vec<[f32; 4]>) -> Self {
        Self { target, interpolation: Interpolation::Linear, times, values }
    }
}

/// The property that a [`Channel`] animates.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Target {
    /// Translation of a node.
    Translation(usize),
    /// Rotation of a node.
    Rotation(usize),
    /// Scale of a node.
    Scale(usize),
    /// Weight of a morph target in the meshes of a node.
    Weight {
        /// The node.
        node: usize,
        /// Index into [`Mesh::targets`](super::Mesh::targets).
        target: usize,
    },
    /// Factor ≥ 0 on a material's emission.
    Emission(usize),
    /// Factors ≥ 0 on the colour channels of a material's emission. They multiply [`Target::Emission`].
    EmissionColor(usize),
    /// Factor ≥ 0 on a light's intensity.
    Intensity(usize),
    /// Factors ≥ 0 on the colour channels of a light's intensity. They multiply [`Target::Intensity`].
    IntensityColor(usize),
}

/// The curve of a [`Channel`] between its keys.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub enum Interpolation {
    /// The value of the key before.
    Step,
    /// Linear; spherical for rotations.
    #[default]
    Linear,
    /// Cubic Hermite with the given tangents.
    CubicSpline,
}

impl Animation {
    /// Last key time of all channels in seconds, never below 0.
    pub(super) fn duration(&self) -> f32 {
        self.channels.iter().filter_map(|channel| channel.times.last()).fold(0.0, |last, &time| last.max(time))
    }
}

impl Target {
    /// The node that this target moves, if it is one.
    pub(crate) fn node(self) -> Option<usize> {
        match self {
            Self::Translation(node) | Self::Rotation(node) | Self::Scale(node) => Some(node),
            Self::Weight { .. }
            | Self::Emission(_)
            | Self::EmissionColor(_)
            | Self::Intensity(_)
            | Self::IntensityColor(_) => None,
        }
    }
}

impl Channel {
    /// Value at `time`, held outside the keys. `None` where keys or values are missing.
    pub(super) fn sample(&self, time: f32) -> Option<DVec4> {
        let after = self.times.partition_point(|&key| key <= time);
        let Some(before) = after.checked_sub(1) else { return self.value(0) };
        let (Some(&from), Some(&to)) = (self.times.get(before), self.times.get(after)) else {
            return self.value(before);
        };
        let span = f64::from(to - from);
        let t = if span > 0.0 { f64::from(time - from) / span } else { 0.0 };
        match self.interpolation {
            Interpolation::Step => self.value(before),
            Interpolation::Linear => {
                let (a, b) = (self.value(before)?, self.value(after)?);
                Some(match self.target {
                    // glam's slerp takes the short way round, as glTF requires.
                    Target::Rotation(_) => DVec4::from(unit(a).slerp(unit(b), t)),
                    _ => a.lerp(b, t),
                })
            }
            Interpolation::CubicSpline => {
                let (a, b) = (self.value(before)?, self.value(after)?);
                let (leaving, arriving) = (self.key(3 * before + 2)? * span, self.key(3 * after)? * span);
                let (t2, t3) = (t * t, t * t * t);
                Some(
                    a * (2.0 * t3 - 3.0 * t2 + 1.0)
                        + leaving * (t3 - 2.0 * t2 + t)
                        + b * (3.0 * t2 - 2.0 * t3)
                        + arriving * (t3 - t2),
                )
            }
        }
    }

    /// Value of a key, without its tangents.
    fn value(&self, key: usize) -> Option<DVec4> {
        match self.interpolation {
            Interpolation::CubicSpline => self.key(3 * key + 1),
            Interpolation::Step | Interpolation::Linear => self.key(key),
        }
    }

    fn key(&self, index: usize) -> Option<DVec4> {
        self.values.get(index).map(|value| value.map(f64::from).into())
    }
}

/// The rotation nearest to a quaternion of any length: the identity for length zero.
pub(super) fn unit(quaternion: DVec4) -> DQuat {
    DQuat::from_vec4(quaternion.try_normalize().unwrap_or(DVec4::W))
}
