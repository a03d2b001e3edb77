//! An intermediate image shown, see shaders/view.wgsl.

use super::{Pass, bindings, gradient_pairs};
use crate::plan::{Feature, Features, Grid, Image, Plan, Slot, Step};
use crate::{Error, Mode, View};
use wgpu::TextureFormat;

/// The step that shows a view of what a plan's steps have left, in a target of this format.
/// `holds` tells which of their images are still there.
pub(crate) fn step(
    view: View,
    plan: &Plan,
    mode: Mode,
    target: TextureFormat,
    holds: impl Fn(Image) -> bool,
) -> Result<Step, Error> {
    let missing = |reason| Err(Error::NoView { view, reason });
    let has = |image| plan.images().iter().any(|(i, _)| *i == image);
    let color = match (view, plan.color) {
        (View::Denoised | View::NonFinite, Some(image)) => Slot::Now(image),
        (View::Denoised | View::NonFinite, None) => return missing("nothing is filtered in this mode"),
        _ => Slot::Target,
    };
    let gradient = match (view, plan.gradient) {
        (View::Gradient, Some(image)) => Slot::Now(image),
        (View::Gradient, None) if !plan.features.has(Feature::Unchanged) => return missing("the gradient is off"),
        _ => Slot::Target,
    };
    if matches!(view, View::Lambda | View::Alpha | View::Outliers | View::HistoryLength | View::Variance)
        && mode != Mode::Denoise
    {
        return missing("there is no history in this mode");
    }
    if view == View::Outliers && !plan.features.has(Feature::Outliers) {
        return missing("every sample is believed: set FilterSettings::outlier_limit");
    }
    if view == View::TriangleId && !has(Image::Visibility) {
        return missing("there is no visibility buffer");
    }
    if view == View::Albedo && !plan.features.has(Feature::Albedo) {
        return missing("the host gave no albedo");
    }
    if view == View::Rays && !plan.steps.iter().any(|s| s.pass.traces()) {
        return missing("the host traced the rays");
    }
    if view == View::Emission && !plan.features.has(Feature::DirectEmission) {
        return missing("nothing emits, or the host gave no emission");
    }
    if view == View::Object && !plan.features.has(Feature::Objects) {
        return missing("objects are not told apart");
    }
    if view == View::Mean && !has(Image::Sum) {
        return missing("frames are only summed in Mode::Reference");
    }
    let paired = matches!(view, View::PairNow | View::PairBefore);
    if paired && plan.features.has(Feature::Unchanged) {
        return missing("nothing changed, so that no path was repeated");
    }
    let traced = plan.features.has(Feature::Reshade) || plan.features.has(Feature::Pairs);
    if paired && !traced {
        return missing("the gradient does not come from paths");
    }
    let [now, before] = gradient_pairs::sources(plan.features);
    let radiance = match view {
        View::PairNow => now,
        View::PairBefore => before,
        _ => Slot::Now(Image::Radiance),
    };
    let known = [
        Feature::TemporalOnly,
        Feature::Steady,
        Feature::Albedo,
        Feature::DirectEmission,
        Feature::Background,
        Feature::Pairs,
    ];
    let mut features = plan.features.and(Features::of(&known));
    if !matches!(view, View::Denoised | View::Noisy | View::Emission) {
        features = features.without(Feature::DirectEmission);
    }
    if !matches!(view, View::Denoised | View::NonFinite) {
        features = features.without(Feature::TemporalOnly).without(Feature::Steady);
    }
    if view != View::Denoised {
        features = features.without(Feature::Background);
    }
    if !matches!(view, View::Denoised | View::Noisy | View::Albedo) && !paired {
        features = features.without(Feature::Albedo);
    }
    if !paired {
        features = features.without(Feature::Pairs);
    }
    if view == View::Gradient && plan.features.has(Feature::Unchanged) {
        features = features.with(Feature::Unchanged);
    }
    match target {
        TextureFormat::Rgba8Unorm => features = features.with(Feature::TargetPicture),
        TextureFormat::Rgba16Float => features = features.with(Feature::TargetF16),
        _ => {}
    }
    let all = bindings(
        features,
        [
            ("color", color, &[]),
            ("radiance", radiance, &[]),
            ("samples", Slot::Now(Image::Samples), &[]),
            ("object", Slot::Now(Image::Object), &[]),
            ("albedo", Slot::Now(Image::Albedo), if view == View::Rays { &[] } else { &[Feature::Albedo] }),
            ("emission", Slot::Now(Image::Emission), &[Feature::DirectEmission]),
            ("guide", Slot::Now(Image::Guide), &[]),
            ("visibility", Slot::Now(Image::Visibility), &[]),
            ("motion", Slot::Now(Image::Motion), &[]),
            ("gradient", gradient, &[]),
            ("history", Slot::Now(Image::History), &[]),
            ("sum", Slot::Now(Image::Sum), &[]),
            ("weights", Slot::Now(Image::Weights), &[]),
            ("target_out", Slot::Target, &[]),
        ],
    );
    let names: &[&str] = match view {
        View::Denoised if features.has(Feature::Background) => &["color", "radiance", "guide", "albedo", "emission"],
        View::Denoised => &["color", "albedo", "emission"],
        View::Noisy => &["radiance", "albedo", "emission"],
        View::Albedo | View::Rays => &["albedo"],
        View::Normal | View::Depth => &["guide"],
        View::TriangleId => &["visibility"],
        View::Motion => &["motion"],
        View::MotionError => &["guide", "motion"],
        View::Gradient if features.has(Feature::Unchanged) => &[],
        View::Gradient => &["gradient"],
        View::Lambda | View::Alpha | View::Outliers => &["weights"],
        View::HistoryLength | View::Variance => &["history"],
        View::NonFinite => &["color"],
        View::Emission => &["emission"],
        View::Object => &["object"],
        View::PairNow | View::PairBefore => &["samples", "radiance", "albedo"],
        View::Mean => &["sum"],
    };
    let used = all.into_iter().filter(|(name, _)| *name == "target_out" || names.contains(name));
    let bindings: Vec<_> = used.collect();
    if bindings.iter().any(|(_, slot)| matches!(slot, Slot::Now(image) if !holds(*image))) {
        return missing("its image was not kept: set DenoiserDescriptor::views");
    }
    Ok(Step { pass: Pass::View, features, grid: Grid::Pixels, iteration: view as u32, bindings })
}
