//! Messages to the user, shown until they are dismissed.

use eframe::egui::{Align2, Color32, Context, Window};

/// Number of messages that are kept at most.
const KEPT: usize = 6;

/// Messages, oldest first; true marks an error.
#[derive(Default)]
pub struct Messages(Vec<(bool, String)>);

impl Messages {
    pub fn error(&mut self, text: impl Into<String>) {
        self.add(true, text.into());
    }

    pub fn note(&mut self, text: impl Into<String>) {
        self.add(false, text.into());
    }

    /// The text of all messages, one a line.
    pub fn text(&self) -> String {
        self.0.iter().map(|(_, text)| text.as_str()).collect::<Vec<_>>().join("\n")
    }

    /// Shows all messages over the picture, which keeps its size, with a button that dismisses them.
    pub fn show(&mut self, context: &Context) {
        if self.0.is_empty() {
            return;
        }
        let window =
            Window::new("messages").title_bar(false).resizable(false).anchor(Align2::RIGHT_BOTTOM, [-8.0, -8.0]);
        let dismissed = window.show(context, |ui| {
            for (bad, text) in &self.0 {
                let color = if *bad { Color32::from_rgb(255, 130, 110) } else { ui.visuals().text_color() };
                ui.colored_label(color, text);
            }
            ui.button("dismiss").clicked()
        });
        if dismissed.and_then(|response| response.inner).unwrap_or(false) {
            self.0.clear();
        }
    }

    /// Adds a message once, even if the same error occurs in every frame.
    fn add(&mut self, bad: bool, text: String) {
        if self.0.iter().any(|(_, known)| *known == text) {
            return;
        }
        if self.0.len() == KEPT {
            self.0.remove(0);
        }
        self.0.push((bad, text));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_message_is_told_once_and_old_ones_make_room() {
        let mut messages = Messages::default();
        (0..3).for_each(|_| messages.error("the same"));
        assert_eq!(messages.0.len(), 1);
        (0..2 * KEPT).for_each(|i| messages.note(format!("{i}")));
        assert_eq!((messages.0.len(), messages.0[KEPT - 1].1.as_str()), (KEPT, "11"));
    }
}
