//! Frames of a host's own renderer: the views that it hands in, and those that it receives.

mod views;

pub(crate) use views::{shading, surfaces, target};

use crate::Viewpoint;
use crate::plan::Changes;
use wgpu::{Buffer, TextureView};

/// The surfaces of a host's frame, before any light: the G-buffer.
///
/// All views are of the denoiser's size and have `TEXTURE_BINDING` usage. Shaders leave out the views that are absent. Nothing is
/// read before the host submits the encoder.
#[derive(Clone, Copy, Debug)]
pub struct Surfaces<'a> {
    /// The viewpoint of this frame.
    pub camera: Viewpoint,
    /// Number of the frame. It should decide all random numbers, together with the pixel, and grow by one per frame: any other step
    /// starts a new history, because motion leads to the frame before.
    pub index: u32,
    /// Distance from the eye along the view axis, in the world's unit (not the hardware's depth, not the ray's length): first
    /// channel of `r32float`, `r16float`, `rg16float`, `rg32float`, `rgba16float` or `rgba32float`. 0, negative, infinite and NaN
    /// mean that nothing was hit. So do depths outside 10⁻¹⁸ … 10¹⁸, because some renderers put the sky at f32's largest number.
    pub depth: &'a TextureView,
    /// World-space normal on the visible side. `rgba16float`, `rgba32float` or `rgba8snorm`: of any length. `rgba8unorm` or
    /// `rgb10a2unorm`: mapped to 0…1. On the unfolded octahedron: `rg16float`, `rg32float`, `rg8snorm` or `rg16snorm` as −1…1, `rg8unorm`
    /// or `rg16unorm` as 0…1, and `r32uint` as two 16-bit 0…1 numbers (x in the low half). Zero means that nothing was hit. The
    /// denoiser keeps 10 bits a component.
    pub normal: &'a TextureView,
    /// Place of the surface point in the previous frame's image less its place in this one, in pixels, x right, y down, without either
    /// frame's jitter: first two channels of `rg16float`, `rg32float`, `rgba16float` or `rgba32float`. NaN and infinite mean that the
    /// point was nowhere. [`View::MotionError`](crate::View::MotionError) checks the motion. Passes that
    /// [`Denoiser::denoise`](crate::Denoiser::denoise) records may read it and `previous_depth`: leave both unchanged until then.
    pub motion: &'a TextureView,
    /// The linear depth that the surface point had in the previous frame's camera, in the formats of `depth`. Without it, points are
    /// assumed to rest while the camera moves. With re-shading it gives the former places of moving points: use 32 bits, because 16 bits
    /// place them 5·10⁻⁴ of the depth off their surface.
    pub previous_depth: Option<&'a TextureView>,
    /// Number of the object, so that two objects that touch are not mixed in time. First channel of `r8uint`, `r16uint`, `r32uint`,
    /// `rg32uint`, `rgba32uint`, `r16float` or `r32float`, …; any distinct numbers will do.
    pub instance: Option<&'a TextureView>,
    /// The parts that may have changed since the last frame. If nothing has changed, passes are left out, and a still image converges.
    /// By default anything may have changed. The denoiser notices a moved camera in any case.
    pub changes: Changes,
}

/// The light of a host's frame.
#[derive(Clone, Copy, Debug)]
pub struct Shading<'a> {
    /// Noisy linear radiance, Rec. 709, ≥ 0 (values above 10¹⁵ count as 10¹⁵): `rgba16float`, `rgba32float`, `rg11b10ufloat` or
    /// `rgb9e5ufloat`. Pixels where nothing was hit are shown unfiltered. It may share the target's texture, and is copied then. NaN
    /// is no sample: the pixel's history continues, or its surface fills it from up to 27 pixels away (black without spatial
    /// iterations). +∞ enters no average: it halves the pixel's history, and is shown as 65504 if no history is left.
    /// Take other random numbers in each frame, because the same noise does not average out.
    pub radiance: &'a TextureView,
    /// Linear reflectance at the visible surface, 0…1: `rgba8unorm` and `bgra8unorm` (`-srgb` too), `rgb10a2unorm`, and the formats
    /// of `radiance`. Radiance is divided by it before filtering (by at least 0.02, at most 1) and multiplied by it afterwards, so that
    /// textures stay sharp. An albedo that is not a number divides nothing. Without an albedo, radiance is filtered with its
    /// textures; a frame with an albedo after one without starts a new history.
    pub albedo: Option<&'a TextureView>,
    /// Linear radiance that the visible surface or the sky emits towards the eye, in the formats of `radiance`. It bypasses the
    /// filter: emitters stay sharp, and blink without resetting their surroundings.
    pub emission: Option<&'a TextureView>,
    /// True if `radiance` is the light alone: without `emission`, not yet multiplied by `albedo`. False if it is the full image.
    pub demodulated: bool,
    /// Pairs, for [`Gradient::Pairs`](crate::Gradient::Pairs).
    pub pairs: Option<Pairs<'a>>,
    /// λ itself, for [`Gradient::Lambda`](crate::Gradient::Lambda).
    pub lambda: Option<Lambda<'a>>,
    /// The specular part of the light, or what is known of it.
    pub gloss: Option<Gloss<'a>>,
    /// The view that receives linear radiance: an `rgba16float` or `rgba32float` view of the denoiser's size, with storage usage.
    pub target: &'a TextureView,
}

impl<'a> Surfaces<'a> {
    /// Makes the surfaces that every frame needs: no `previous_depth`, no `instance`, and unknown `changes`.
    pub fn new(
        camera: impl Into<Viewpoint>,
        index: u32,
        depth: &'a TextureView,
        normal: &'a TextureView,
        motion: &'a TextureView,
    ) -> Self {
        Self {
            camera: camera.into(),
            index,
            depth,
            normal,
            motion,
            previous_depth: None,
            instance: None,
            changes: Changes::ANY,
        }
    }
}

impl<'a> Shading<'a> {
    /// Makes a shading of radiance alone, which contains its emission and textures.
    pub fn new(radiance: &'a TextureView, target: &'a TextureView) -> Self {
        Self {
            radiance,
            albedo: None,
            emission: None,
            demodulated: false,
            pairs: None,
            lambda: None,
            gloss: None,
            target,
        }
    }
}

/// The light that surfaces reflect by their specular lobes, and the facts that place reflections.
///
/// Reflections do not move with the surface that shows them. Hand in whatever the renderer has; the denoiser does the best with any
/// subset:
///
/// - **With `radiance`**, specular light is a signal of its own, and [`Shading::radiance`] is the diffuse light alone (with emission,
///   unless it is `demodulated`). The specular history follows reflections, by the roughness and by the distance of what is reflected.
/// - **Without `radiance`**, [`Shading::radiance`] holds all light. Roughness and reflectance say where reflections would smear, and
///   shorten the history there. If both `reflectance` and [`Shading::albedo`] are given, light is divided by their sum.
///
/// All views are of the denoiser's size and have `TEXTURE_BINDING` usage.
#[derive(Clone, Copy, Debug, Default)]
pub struct Gloss<'a> {
    /// Noisy specular radiance, in the formats of [`Shading::radiance`]: the light of paths that leave the visible surface by its specular
    /// lobe. It is multiplied by `reflectance`, unless [`Shading::demodulated`].
    pub radiance: Option<&'a TextureView>,
    /// Part of the light from all around that the specular lobe reflects towards the eye, 0…1, in the formats of [`Shading::albedo`]:
    /// the pre-integrated reflectance of that angle and roughness, or F₀. 0 where there is no specular lobe. Radiance is divided by it
    /// before filtering (by at least 0.02) and multiplied by it afterwards. Without it, all surfaces count as glossy. A pixel
    /// whose reflectance is not a number shows no specular light.
    pub reflectance: Option<&'a TextureView>,
    /// Perceptual roughness, 0…1, the square root of the GGX width α: first channel of `r8unorm`, `r16float`, `r32float` or `rg…` of
    /// these, or fourth channel of `rgba8unorm`, `rgba16float` or `rgba32float`, where renderers keep it beside the normal. Without it,
    /// 0.35.
    pub roughness: Option<&'a TextureView>,
    /// Distance from the visible surface to what the pixel's specular path met first, in the world's unit, in the formats of
    /// [`Surfaces::depth`]. +∞ is the sky; 0, negative and NaN say that it is unknown. Needs `radiance`.
    pub hit_distance: Option<&'a TextureView>,
    /// Place of the reflected point in the previous frame's image less the pixel's, in the formats and units of [`Surfaces::motion`].
    /// NaN and infinite say that it is unknown: it then follows from the distance. Needs `radiance`.
    pub motion: Option<&'a TextureView>,
    /// Pairs of the specular light, for [`Gradient::Pairs`](crate::Gradient::Pairs). Without them, its gradient comes from statistics.
    /// Needs `radiance`.
    pub pairs: Option<Pairs<'a>>,
}

/// Radiances of some surface samples in the last frame, and of the same paths in this one: the gradient's measurements.
///
/// A host takes a sample of the last frame, finds its place in this frame's image, and shades it again: the same point, view
/// direction and random numbers, in this frame's scene. Both values are of the same kind as [`Shading::radiance`] but without
/// emission: reflected light, multiplied by the albedo unless the radiance is `demodulated`.
#[derive(Clone, Copy, Debug)]
pub struct Pairs<'a> {
    /// Radiance now: `rgba16float` or `rgba32float`; or its luminance: `r16float` or `r32float`. Of the denoiser's size, with each
    /// value in the sample's present pixel, at most one in each 3×3 block (the first of several counts), and −1 elsewhere. Or one
    /// texel for each block, ⌈width/3⌉ × ⌈height/3⌉, meant for the block's centre.
    pub current: &'a TextureView,
    /// Radiance in the last frame, of the same size and with as many channels.
    pub previous: &'a TextureView,
    /// True if `radiance` holds the same paths in these pixels, instead of paths of their own: they are then not counted as new
    /// samples. Full size only.
    pub in_place: bool,
}

impl<'a> Pairs<'a> {
    /// Makes pairs that stand beside the pixels' own samples.
    pub fn new(current: &'a TextureView, previous: &'a TextureView) -> Self {
        Self { current, previous, in_place: false }
    }
}

/// The share of each pixel's history that the host wants dropped.
#[derive(Clone, Copy, Debug)]
pub struct Lambda<'a> {
    /// First channel of `r8unorm`, `r16float`, `r32float`, `rg…`, `rgba8unorm`, `rgba16float` or `rgba32float`, 0…1: 0 keeps all, 1
    /// drops all. ⌈width/block⌉ × ⌈height/block⌉ texels.
    pub view: &'a TextureView,
    /// Number of pixels in each direction that share a texel, 1…32768.
    pub block: u32,
    /// True if the view holds the confidence in the history, 1 − λ.
    pub confidence: bool,
}

impl<'a> Lambda<'a> {
    /// Makes a λ with one texel for each pixel.
    pub fn new(view: &'a TextureView) -> Self {
        Self { view, block: 1, confidence: false }
    }
}

/// The paths of the last frame that a host is to repeat, one in each 3×3 pixels, for
/// [`Gradient::Reshade`](crate::Gradient::Reshade).
///
/// Put [`RESHADE_WGSL`](crate::RESHADE_WGSL) before the shader that starts the paths, bind these four, and shade the
/// point that `asvgf_surface` returns, with the seed that it returns. The host does nothing else: pixels that repeat a path are ordinary
/// pixels. No path is repeated in a first frame or after a restart. If [`Surfaces::changes`] says that the scene has not changed, there is
/// no `Reshade`.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Reshade {
    /// The frame's constants: a uniform buffer, `AsvgfFrame`.
    pub frame: Buffer,
    /// The surface that each pixel sees: `rg32uint`, normal (three signed 10-bit numbers) and linear depth (f32 bits), 0 where nothing was hit.
    /// Paths start from it, so that a repeated path starts from exactly the same point. Valid as long as `repeats`.
    pub guide: TextureView,
    /// One `rgba32uint` texel for each stratum of 3×3 pixels, ⌈width/3⌉ × ⌈height/3⌉: place of the pixel that repeats a path (1…9
    /// row by row, 0 for none), the last frame's pixel whose path it is (x | y << 16), that pixel's packed normal and its linear
    /// depth (f32 bits). Valid for passes that are recorded before [`Denoiser::denoise`](crate::Denoiser::denoise), which overwrites it.
    pub repeats: TextureView,
    /// For each texel of `repeats`, the displacement of that path's surface since the last frame (world space, f32 bits).
    pub shifts: TextureView,
}
