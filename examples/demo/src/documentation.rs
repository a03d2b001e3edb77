//! The library's own documentation as hover text, so that it is written once.

const SETTINGS: &str = include_str!("../../../src/settings.rs");
const VIEWS: &str = include_str!("../../../src/view.rs");

/// Signs that egui's fonts lack, and what is written instead.
const ABSENT: [(&str, &str); 8] =
    [("←", ":="), ("∇", "grad "), ("⁻³", "^-3"), ("ᵏ", "^k"), ("ⁿ", "^n"), ("₁", "1"), ("₂", "2"), ("₃", "3")];

/// What a field of the settings is, and what a higher and a lower value cost.
pub fn of_setting(field: &str) -> Option<String> {
    above(SETTINGS, &format!("    pub {field}:"))
}

/// What an image shows, by the name of its variant.
pub fn of_view(variant: &str) -> Option<String> {
    above(VIEWS, &format!("    {variant} ="))
}

/// The doc comment above the first line that starts so, as plain text.
fn above(source: &str, start: &str) -> Option<String> {
    let lines: Vec<&str> = source.lines().collect();
    let at = lines.iter().position(|line| line.starts_with(start))?;
    let text: Vec<&str> = lines[..at].iter().rev().map_while(|line| line.trim().strip_prefix("///")).collect();
    let text: String = text.into_iter().rev().collect();
    (!text.is_empty()).then(|| plain(text.trim()))
}

/// Without the marks of rustdoc: links keep their text, code its words.
fn plain(text: &str) -> String {
    let mut out = String::new();
    let mut rest = text.replace(['`', '\\'], "");
    for (sign, letters) in ABSENT {
        rest = rest.replace(sign, letters);
    }
    // [name](path) is name, [name] too; [0, 1] does not occur.
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
    use asvgf::View;

    #[test]
    fn links_keep_their_text() {
        assert_eq!(plain("as [`Denoiser::show`](crate::Denoiser::show) says, `α`"), "as Denoiser::show says, α");
        assert_eq!(plain("with [`Gradient::Off`] and A\\[x\\]"), "with Gradient::Off and Ax");
    }

    #[test]
    fn egui_can_write_all_of_it() {
        use eframe::egui::{Context, FontId};
        let context = Context::default();
        // A plan's reasons are shown as they are.
        let reasons = include_str!("../../../src/plan/choice.rs");
        let texts = [SETTINGS, VIEWS].map(|source| {
            let comments = source.lines().filter_map(|line| line.trim().strip_prefix("///"));
            plain(&comments.collect::<String>())
        });
        let mut output = context.run_ui(Default::default(), |ui| {
            ui.fonts_mut(|fonts| {
                let shown = reasons.chars().filter(|c| !c.is_control());
                let strange = |c: &char| !fonts.has_glyph(&FontId::default(), *c);
                let strange: Vec<char> =
                    texts.iter().flat_map(|text| text.chars()).chain(shown).filter(strange).collect();
                assert!(strange.is_empty(), "{strange:?}");
            });
        });
        // Nobody draws it.
        output.textures_delta.clear();
    }

    #[test]
    fn every_view_is_documented() {
        for view in View::ALL {
            assert!(of_view(&format!("{view:?}")).is_some_and(|text| text.len() > 10), "{view:?}");
        }
    }
}
