//! Display of an intermediate image, see shaders/view.wgsl: a row for each view.

use super::prelude::*;
use super::{Features, Grid, Nth, Slot, Step};
use crate::View;
use wgpu::TextureFormat;

pub(crate) static PASS: Pass = Pass {
    name: "view",
    source: include_str!("../../shaders/view.wgsl"),
    grid: Grid::Pixels,
    features: &[&[knows(TargetPicture), knows(TargetF16)]],
    // Each view has bindings of its own.
    bindings: &[],
    traces: false,
};

/// A view, shown by a block of the shader.
struct Row {
    /// The view whose name the block has, if it is another one: it shows other images in the same way.
    block: Option<View>,
    /// True if features and images are those of the specular signal.
    specular: bool,
    /// The conditions under which a frame has the view, each with the reason to give if it fails.
    needs: &'static [(Need, &'static str)],
    features: &'static [Known],
    bindings: &'static [Binding],
}

/// A condition on the frame's plan.
enum Need {
    /// The plan has one of these features.
    Any(&'static [Feature]),
    /// The plan lacks this feature.
    Not(Feature),
    /// The denoiser has traced the rays itself.
    Traced,
}

const FILTERED: (Need, &str) = (Need::Not(Unfiltered), "nothing is filtered in this mode");
const SHINES: (Need, &str) = (Need::Any(&[Gloss]), "nothing shines, or all light is one signal");
const HISTORY: (Need, &str) = (Need::Not(Unfiltered), "there is no history in this mode");
const UNCHANGED: (Need, &str) = (Need::Not(Unchanged), "nothing changed, so that no path was repeated");
const NO_PATHS: (Need, &str) = (Need::Any(&[Reshade, Pairs]), "the gradient does not come from paths");
const REPEATED: &[(Need, &str)] = &[UNCHANGED, NO_PATHS];
const GLOSS_REPEATED: &[(Need, &str)] = &[SHINES, UNCHANGED, NO_PATHS];

const RADIANCE: Binding = now("radiance", Image::Radiance);
const ALBEDO: Binding = now("albedo", Image::Albedo);
const EMISSION: Binding = now("emission", Image::Emission);
const SPECULAR_RADIANCE: Binding = now("specular_radiance", Image::Radiance).of_specular();
const SPECULAR_ALBEDO: Binding = now("specular_albedo", Image::Albedo).of_specular();
const GUIDE: Binding = now("guide", Image::Guide);
const MOTION: Binding = now("motion", Image::Motion);
const WEIGHTS: Binding = now("weights", Image::Weights);
const SAMPLES: Binding = now("samples", Image::Samples);
const GLOSS_IMAGE: Binding = now("gloss", Image::Gloss);
const REFLECTION: Binding = now("reflection", Image::Reflection);
const COLOR: Binding = chosen("color");
const SPECULAR_COLOR: Binding = chosen("specular_color").of_specular();

static TARGET: Binding = target("target_out");

/// A view that every frame has.
const PLAIN: Row = Row { block: None, specular: false, needs: &[], features: &[], bindings: &[] };

/// A view of the specular signal.
const GLOSS: Row = Row { specular: true, needs: &[SHINES], ..PLAIN };

/// The light of one signal as traced: the other signal and emission are left out.
const LIGHT: Row =
    Row { block: Some(View::Noisy), features: &[knows(Albedo)], bindings: &[RADIANCE, ALBEDO.with(Albedo)], ..GLOSS };

const PAIR_NOW: Row = Row {
    needs: REPEATED,
    features: &[knows(Albedo), knows(Pairs)],
    bindings: &[SAMPLES, RADIANCE.unless(Pairs), now("radiance", Image::HostPairNow).with(Pairs), ALBEDO.with(Albedo)],
    ..PLAIN
};

const PAIR_BEFORE: Row = Row {
    bindings: &[
        SAMPLES,
        before("radiance", Image::Radiance).unless(Pairs),
        now("radiance", Image::HostPairBefore).with(Pairs),
        ALBEDO.with(Albedo),
    ],
    ..PAIR_NOW
};

const fn row(view: View) -> Row {
    match view {
        View::Denoised => {
            const {
                Row {
                    needs: &[FILTERED],
                    features: &[
                        knows(TemporalOnly),
                        knows(Steady),
                        knows(Background),
                        knows(Albedo),
                        knows(DirectEmission),
                        knows(Gloss),
                        knows(Reflectance).with(Gloss),
                    ],
                    bindings: &[
                        COLOR,
                        SPECULAR_COLOR.with(Gloss),
                        SPECULAR_ALBEDO.with(Gloss).with(Reflectance),
                        RADIANCE.with(Background),
                        GUIDE.with(Background),
                        ALBEDO.with(Albedo),
                        EMISSION.with(DirectEmission),
                    ],
                    ..PLAIN
                }
            }
        }
        View::Noisy => {
            const {
                Row {
                    features: &[knows(Albedo), knows(DirectEmission), knows(Gloss), knows(Reflectance).with(Gloss)],
                    bindings: &[
                        RADIANCE,
                        ALBEDO.with(Albedo),
                        EMISSION.with(DirectEmission),
                        SPECULAR_RADIANCE.with(Gloss),
                        SPECULAR_ALBEDO.with(Gloss).with(Reflectance),
                    ],
                    ..PLAIN
                }
            }
        }
        View::Albedo => {
            const {
                Row {
                    needs: &[(Need::Any(&[Albedo]), "the host gave no albedo")],
                    features: &[knows(Albedo)],
                    bindings: &[ALBEDO],
                    ..PLAIN
                }
            }
        }
        View::Emission => {
            const {
                Row {
                    needs: &[(Need::Any(&[DirectEmission]), "nothing emits, or the host gave no emission")],
                    features: &[knows(DirectEmission)],
                    bindings: &[EMISSION],
                    ..PLAIN
                }
            }
        }
        View::Normal | View::Depth => const { Row { bindings: &[GUIDE], ..PLAIN } },
        View::TriangleId => {
            const {
                Row {
                    needs: &[(Need::Traced, "there is no visibility buffer")],
                    bindings: &[now("visibility", Image::Visibility)],
                    ..PLAIN
                }
            }
        }
        View::Object => {
            const {
                Row {
                    needs: &[(Need::Any(&[Objects]), "objects are not told apart")],
                    bindings: &[now("object", Image::Object)],
                    ..PLAIN
                }
            }
        }
        View::Rays => {
            const { Row { needs: &[(Need::Traced, "the host traced the rays")], bindings: &[ALBEDO], ..PLAIN } }
        }
        View::Motion => const { Row { bindings: &[MOTION], ..PLAIN } },
        View::MotionError => const { Row { bindings: &[GUIDE, MOTION], ..PLAIN } },
        View::Gradient => {
            const {
                Row {
                    needs: &[(Need::Any(&[Gradient, Unchanged]), "the gradient is off")],
                    features: &[knows(Unchanged)],
                    bindings: &[chosen("gradient").unless(Unchanged)],
                    ..PLAIN
                }
            }
        }
        View::Lambda | View::Alpha => const { Row { needs: &[HISTORY], bindings: &[WEIGHTS], ..PLAIN } },
        View::Outliers => {
            const {
                Row {
                    needs: &[
                        HISTORY,
                        (Need::Any(&[Outliers]), "every sample is believed: set FilterSettings::outlier_limit"),
                    ],
                    bindings: &[WEIGHTS],
                    ..PLAIN
                }
            }
        }
        View::HistoryLength | View::Variance => {
            const { Row { needs: &[HISTORY], bindings: &[now("history", Image::History)], ..PLAIN } }
        }
        View::NonFinite => {
            const {
                Row {
                    needs: &[FILTERED],
                    features: &[knows(TemporalOnly), knows(Steady), knows(Gloss)],
                    bindings: &[COLOR, SPECULAR_COLOR.with(Gloss)],
                    ..PLAIN
                }
            }
        }
        View::PairNow => PAIR_NOW,
        View::PairBefore => PAIR_BEFORE,
        View::Mean => {
            const {
                Row {
                    needs: &[(Need::Any(&[Accumulate]), "frames are only summed in Mode::Reference")],
                    bindings: &[now("sum", Image::Sum)],
                    ..PLAIN
                }
            }
        }
        View::DiffuseNoisy => const { Row { specular: false, ..LIGHT } },
        View::SpecularNoisy => LIGHT,
        View::Specular => {
            const {
                Row {
                    block: Some(View::Denoised),
                    needs: &[SHINES, FILTERED],
                    features: &[knows(TemporalOnly), knows(Steady), knows(Albedo)],
                    bindings: &[COLOR, ALBEDO.with(Albedo)],
                    ..GLOSS
                }
            }
        }
        View::SpecularAlbedo => {
            const {
                Row {
                    block: Some(View::Albedo),
                    needs: &[SHINES, (Need::Any(&[Albedo]), "the host gave no specular reflectance")],
                    features: &[knows(Albedo)],
                    bindings: &[ALBEDO],
                    ..GLOSS
                }
            }
        }
        View::Roughness => const { Row { needs: &[SHINES, FILTERED], bindings: &[GLOSS_IMAGE], ..GLOSS } },
        View::HitDistance => {
            const { Row { needs: &[SHINES, FILTERED], bindings: &[GLOSS_IMAGE, REFLECTION], ..GLOSS } }
        }
        View::ReflectionMotion => const { Row { needs: &[SHINES, FILTERED], bindings: &[REFLECTION], ..GLOSS } },
        View::Agreement => {
            const {
                Row {
                    needs: &[SHINES, HISTORY, (Need::Not(Still), "nothing changed, so that both places are one")],
                    bindings: &[GUIDE.of_surfaces(), REFLECTION, now("agreement", Image::Agreement)],
                    ..GLOSS
                }
            }
        }
        View::SpecularHistoryLength => {
            const {
                Row {
                    block: Some(View::HistoryLength),
                    needs: &[SHINES, HISTORY],
                    bindings: &[now("history", Image::History)],
                    ..GLOSS
                }
            }
        }
        View::SpecularPairNow => {
            const { Row { block: Some(View::PairNow), specular: true, needs: GLOSS_REPEATED, ..PAIR_NOW } }
        }
        View::SpecularPairBefore => {
            const { Row { block: Some(View::PairBefore), specular: true, needs: GLOSS_REPEATED, ..PAIR_BEFORE } }
        }
    }
}

/// The frame whose images are shown.
pub(crate) struct Shown {
    /// The features of its plan.
    pub features: Features,
    /// The features of the specular signal, if it is a signal of its own.
    pub specular: Option<Features>,
    /// True if the denoiser traced its rays.
    pub traced: bool,
    /// The image that holds the filtered colour.
    pub color: Option<Image>,
    /// The image that holds the filtered gradient.
    pub gradient: Option<Image>,
}

/// The step that shows a view of a frame in a target of this format, or the reason why the frame has no such view.
/// `holds` says which of its images are still there.
pub(crate) fn step(
    view: View,
    frame: &Shown,
    format: TextureFormat,
    holds: impl Fn(Image) -> bool,
) -> Result<Step, &'static str> {
    let row = row(view);
    let signal = if row.specular { frame.specular.ok_or(SHINES.1)? } else { frame.features };
    for (need, reason) in row.needs {
        let met = match *need {
            Need::Any(features) => signal.has_any(Features::of(features)),
            Need::Not(feature) => !signal.has(feature),
            Need::Traced => frame.traced,
        };
        if !met {
            return Err(reason);
        }
    }
    let targets = Features::of(&[TargetPicture, TargetF16]);
    let features = signal.without(TargetPicture).without(TargetF16);
    let features = match format {
        TextureFormat::Rgba8Unorm => features.with(TargetPicture),
        TextureFormat::Rgba16Float => features.with(TargetF16),
        _ => features,
    };
    let known = row.features.iter().filter_map(|known| known.of(features)).collect::<Features>();
    let features = known.or(features.and(targets));
    let image = if view == View::Gradient { frame.gradient } else { frame.color };
    let bindings: Vec<_> = row
        .bindings
        .iter()
        .chain([&TARGET])
        .filter(|binding| binding.is_bound(features))
        .map(|binding| binding.resolve(features, signal, Nth::of(image)))
        .collect();
    if bindings.iter().any(|bound| matches!(bound.slot, Slot::Now(image) if !holds(image))) {
        return Err("its image was not kept: set DenoiserDescriptor::views");
    }
    let block = row.block.unwrap_or(view);
    Ok(Step { pass: &PASS, features, iteration: 0, batch: 0, view: Some(block), bindings })
}
