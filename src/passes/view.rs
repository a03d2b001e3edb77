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

/// A view, shown by the shader's block of the same name.
struct Row {
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
const HISTORY: (Need, &str) = (Need::Not(Unfiltered), "there is no history in this mode");
const REPEATED: &[(Need, &str)] = &[
    (Need::Not(Unchanged), "nothing changed, so that no path was repeated"),
    (Need::Any(&[Reshade, Pairs]), "the gradient does not come from paths"),
];

const RADIANCE: Binding = now("radiance", Image::Radiance);
const ALBEDO: Binding = now("albedo", Image::Albedo);
const EMISSION: Binding = now("emission", Image::Emission);
const SPECULAR_RADIANCE: Binding = now("specular_radiance", Image::Radiance).of_specular();
const SPECULAR_ALBEDO: Binding = now("specular_albedo", Image::Albedo).of_specular();
const GUIDE: Binding = now("guide", Image::Guide);
const MOTION: Binding = now("motion", Image::Motion);
const WEIGHTS: Binding = now("weights", Image::Weights);
const SAMPLES: Binding = now("samples", Image::Samples);
const COLOR: Binding = chosen("color");

static TARGET: Binding = target("target_out");

/// A view that every frame has.
const PLAIN: Row = Row { needs: &[], features: &[], bindings: &[] };

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
                        chosen("specular_color").of_specular().with(Gloss),
                        SPECULAR_ALBEDO.with(Gloss).with(Reflectance),
                        RADIANCE.with(Background),
                        GUIDE.with(Background),
                        ALBEDO.with(Albedo),
                        EMISSION.with(DirectEmission),
                    ],
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
                }
            }
        }
        View::Emission => {
            const {
                Row {
                    needs: &[(Need::Any(&[DirectEmission]), "nothing emits, or the host gave no emission")],
                    features: &[knows(DirectEmission)],
                    bindings: &[EMISSION],
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
            const { Row { needs: &[FILTERED], features: &[knows(TemporalOnly), knows(Steady)], bindings: &[COLOR] } }
        }
        View::PairNow => {
            const {
                Row {
                    needs: REPEATED,
                    features: &[knows(Albedo), knows(Pairs)],
                    bindings: &[
                        SAMPLES,
                        RADIANCE.unless(Pairs),
                        now("radiance", Image::HostPairNow).with(Pairs),
                        ALBEDO.with(Albedo),
                    ],
                }
            }
        }
        View::PairBefore => {
            const {
                Row {
                    needs: REPEATED,
                    features: &[knows(Albedo), knows(Pairs)],
                    bindings: &[
                        SAMPLES,
                        before("radiance", Image::Radiance).unless(Pairs),
                        now("radiance", Image::HostPairBefore).with(Pairs),
                        ALBEDO.with(Albedo),
                    ],
                }
            }
        }
        View::Mean => {
            const {
                Row {
                    needs: &[(Need::Any(&[Accumulate]), "frames are only summed in Mode::Reference")],
                    bindings: &[now("sum", Image::Sum)],
                    ..PLAIN
                }
            }
        }
    }
}

/// The frame whose images are shown.
pub(crate) struct Shown {
    /// The features of its plan.
    pub features: Features,
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
    for (need, reason) in row.needs {
        let met = match *need {
            Need::Any(features) => frame.features.has_any(Features::of(features)),
            Need::Not(feature) => !frame.features.has(feature),
            Need::Traced => frame.traced,
        };
        if !met {
            return Err(reason);
        }
    }
    let targets = Features::of(&[TargetPicture, TargetF16]);
    let features = frame.features.without(TargetPicture).without(TargetF16);
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
        .map(|binding| binding.resolve(features, features, Nth::of(image)))
        .collect();
    if bindings.iter().any(|bound| matches!(bound.slot, Slot::Now(image) if !holds(image))) {
        return Err("its image was not kept: set DenoiserDescriptor::views");
    }
    Ok(Step { pass: &PASS, features, iteration: 0, batch: 0, view: Some(view), bindings })
}
