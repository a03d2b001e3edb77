//! The meaning of a view's colours, and the value under the pointer in words.

use crate::documentation;
use crate::probe::Sample;
use asvgf::{View, ViewOptions};
use eframe::egui::{Color32, ComboBox, Rect, Sense, Ui, pos2, vec2};

/// The name of a view in the window.
pub fn title(view: View) -> String {
    view.name().replace('-', " ")
}

/// Shows the list of views, each with the library's own documentation.
pub fn choose(ui: &mut Ui, chosen: &mut String) {
    ComboBox::from_label("view").selected_text(chosen.replace('-', " ")).height(500.0).show_ui(ui, |ui| {
        for &view in View::ALL {
            ui.selectable_value(chosen, view.name().into(), title(view)).on_hover_text(documentation::of_view(view));
        }
    });
}

/// Explains the shown view in words and, if one colour stands for one number, with a colour scale.
pub fn legend(ui: &mut Ui, view: View, options: ViewOptions) {
    ui.label(documentation::of_view(view));
    let Some(most) = white_at(view, options) else { return };
    ui.horizontal(|ui| {
        ui.label("0");
        let (rect, _) = ui.allocate_exact_size(vec2(120.0, 12.0), Sense::hover());
        let steps = 60;
        for i in 0..steps {
            let (from, to) = (i as f32 / steps as f32, (i + 1) as f32 / steps as f32);
            let x = |t: f32| rect.left() + t * rect.width();
            let part = Rect::from_min_max(pos2(x(from), rect.top()), pos2(x(to), rect.bottom()));
            ui.painter().rect_filled(part, 0.0, ramp(0.5 * (from + to)));
        }
        ui.label(format!("{most}"));
    });
}

/// The number that is shown white, for views that go from black over a scale of colours to white.
fn white_at(view: View, options: ViewOptions) -> Option<f32> {
    match view {
        View::Gradient | View::Lambda | View::Alpha | View::Roughness | View::Agreement => Some(1.0),
        View::HistoryLength | View::SpecularHistoryLength | View::Rays => Some(options.range),
        _ => None,
    }
}

/// The colour scale of shaders/view.wgsl.
pub fn ramp(x: f32) -> Color32 {
    let t = x.clamp(0.0, 1.0);
    let channels = [1.8 * t, 2.2 * t * t * t, 1.6 * t - 2.6 * t * t + 2.0 * t * t * t];
    let [r, g, b] = channels.map(|c| (255.0 * c.clamp(0.0, 1.0)).round() as u8);
    Color32::from_rgb(r, g, b)
}

/// Describes a texel in words.
pub fn describe(view: View, sample: Sample) -> String {
    let [x, y] = sample.pixel;
    let [r, g, b] = sample.value;
    let value = match view {
        View::TriangleId | View::Object if b == 0.0 => "nothing was hit".into(),
        View::TriangleId | View::Object => format!("{}", r + 65536.0 * g),
        View::PairNow | View::PairBefore | View::SpecularPairNow | View::SpecularPairBefore if r < 0.0 => {
            "no repeated path".into()
        }
        View::Depth if r == 0.0 => "nothing was hit".into(),
        View::Motion | View::MotionError => format!("{r:.2}, {g:.2} pixels; depth {b:.3}"),
        View::SpecularHistoryLength | View::ReflectionMotion | View::HitDistance if [r, g, b] == [0.0; 3] => {
            "nothing shines".into()
        }
        View::ReflectionMotion => format!("{r:.2}, {g:.2} pixels; distance {b:.3}"),
        View::HitDistance => format!("{r:.3}; of the pixel's own path {g:.3}"),
        View::HistoryLength | View::SpecularHistoryLength => format!("{r:.1} frames"),
        View::Denoised | View::Noisy | View::Mean | View::Albedo | View::Normal | View::Emission => {
            format!("{r:.3}, {g:.3}, {b:.3}")
        }
        View::DiffuseNoisy | View::SpecularNoisy | View::Specular | View::SpecularAlbedo => {
            format!("{r:.3}, {g:.3}, {b:.3}")
        }
        View::PairNow | View::PairBefore | View::SpecularPairNow | View::SpecularPairBefore => {
            format!("{r:.3}, {g:.3}, {b:.3}")
        }
        _ => format!("{r:.4}"),
    };
    format!("{} at {x}, {y}: {value}", title(view))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_said_in_their_unit() {
        let sample = |value| Sample { pixel: [3, 4], value };
        assert_eq!(describe(View::HistoryLength, sample([12.0; 3])), "history length at 3, 4: 12.0 frames");
        assert_eq!(describe(View::TriangleId, sample([1.0, 2.0, 1.0])), "triangle id at 3, 4: 131073");
        assert_eq!(describe(View::TriangleId, sample([0.0; 3])), "triangle id at 3, 4: nothing was hit");
        assert_eq!(describe(View::PairNow, sample([-1.0; 3])), "pair now at 3, 4: no repeated path");
        let distances = describe(View::HitDistance, sample([1.0, 2.0, 0.0]));
        assert_eq!(distances, "hit distance at 3, 4: 1.000; of the pixel's own path 2.000");
    }

    #[test]
    fn the_scale_goes_from_black_to_white_and_grows() {
        let sum = |c: Color32| u32::from(c.r()) + u32::from(c.g()) + u32::from(c.b());
        let sums: Vec<u32> = (0..=20).map(|i| sum(ramp(i as f32 / 20.0))).collect();
        assert_eq!((sums[0], sums[20]), (0, 765));
        assert!(sums.windows(2).all(|w| w[0] <= w[1]), "{sums:?}");
    }
}
