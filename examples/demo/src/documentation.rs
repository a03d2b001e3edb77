//! Hover texts from the library's own documentation, so that they are written once.

use asvgf::{Choice, Compiles, Setting, SettingKind, View};

/// Signs that egui's fonts lack, with their substitutes.
const ABSENT: [(&str, &str); 8] =
    [("←", ":="), ("∇", "grad "), ("⁻³", "^-3"), ("ᵏ", "^k"), ("ⁿ", "^n"), ("₁", "1"), ("₂", "2"), ("₃", "3")];

/// Documentation of a setting, with its accepted range.
pub fn of_setting(setting: &Setting) -> String {
    let mut text = plain(setting.documentation);
    if let SettingKind::Number { accepted, .. } | SettingKind::Whole { accepted, .. } = &setting.kind {
        text += &format!(" Takes {accepted}.");
    }
    if setting.compiles == Compiles::Always {
        text += " Changing it compiles.";
    }
    text
}

/// Documentation of a choice.
pub fn of_choice(choice: Choice) -> String {
    plain(choice.documentation)
}

/// Documentation of a view.
pub fn of_view(view: View) -> String {
    plain(view.documentation())
}

/// Removes the marks of rustdoc: links keep their text, code its words, and all paragraphs become one.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text.split_whitespace().collect::<Vec<_>>().join(" ").replace(['`', '\\'], "");
    for (sign, letters) in ABSENT {
        rest = rest.replace(sign, letters);
    }
    // [name](path) becomes name, and so does [name]; [0, 1] does not occur.
    while let Some((before, after)) = rest.split_once('[') {
        out.push_str(before);
        let Some((name, after)) = after.split_once(']') else { break };
        out.push_str(name);
        let target = after.strip_prefix('(').and_then(|link| link.split_once(')'));
        rest = target.map_or(after, |(_, after)| after).to_owned();
    }
    out + &rest
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_keep_their_text() {
        assert_eq!(plain("as [`Denoiser::show`](crate::Denoiser::show) says, `α`"), "as Denoiser::show says, α");
        assert_eq!(plain("with [`Gradient::Off`] and A\\[x\\]"), "with Gradient::Off and Ax");
        assert_eq!(plain(" one\n two\n"), "one two");
    }

    /// Every text that the window takes from the library, but for the reasons of plans.
    fn texts() -> Vec<String> {
        let mut texts: Vec<String> = View::ALL.iter().map(|&view| of_view(view)).collect();
        for setting in Setting::all() {
            texts.push(of_setting(setting));
            if let SettingKind::Choice { choices, .. } = &setting.kind {
                texts.extend(choices().into_iter().map(of_choice));
            }
        }
        texts
    }

    #[test]
    fn egui_can_write_all_of_it() {
        use eframe::egui::{Context, FontId};
        let context = Context::default();
        let (texts, reasons) = (texts(), include_str!("../../../src/plan/choice.rs"));
        let mut output = context.run_ui(Default::default(), |ui| {
            ui.fonts_mut(|fonts| {
                let shown = texts.iter().map(String::as_str).chain([reasons]).flat_map(str::chars);
                let shown = shown.filter(|c| !c.is_control());
                let strange: Vec<char> = shown.filter(|c| !fonts.has_glyph(&FontId::default(), *c)).collect();
                assert!(strange.is_empty(), "{strange:?}");
            });
        });
        // The output is never drawn.
        output.textures_delta.clear();
    }

    #[test]
    fn everything_is_documented() {
        for setting in Setting::all() {
            assert!(setting.documentation.len() > 10, "{}", setting.name);
        }
        for view in View::ALL {
            assert!(view.documentation().len() > 10, "{view:?}");
        }
        assert!(texts().iter().all(|text| !text.is_empty()));
    }
}
