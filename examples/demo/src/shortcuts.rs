//! Keys and their effects.

use crate::action::Action;
use crate::state::State;
use asvgf::View;
use eframe::egui::{Key, Ui};

/// Step of one press of an arrow key, as a fraction of the distance to the target.
const STRIDE: f32 = 0.05;

/// Views of the digit keys, from 1 on.
pub const VIEWS: [View; 9] = [
    View::Denoised,
    View::Noisy,
    View::Albedo,
    View::Normal,
    View::Motion,
    View::Gradient,
    View::Lambda,
    View::HistoryLength,
    View::Variance,
];

const DIGITS: [Key; 9] =
    [Key::Num1, Key::Num2, Key::Num3, Key::Num4, Key::Num5, Key::Num6, Key::Num7, Key::Num8, Key::Num9];

/// The effect of a key.
enum Effect {
    Choose(fn(&mut State)),
    Do(Action),
}

struct Shortcut {
    key: Key,
    help: &'static str,
    effect: Effect,
}

/// Every key but the digits.
fn shortcuts() -> Vec<Shortcut> {
    let choose = |key, help, change| Shortcut { key, help, effect: Effect::Choose(change) };
    let once = |key, help, action| Shortcut { key, help, effect: Effect::Do(action) };
    vec![
        choose(Key::A, "adaptive or constant α", State::toggle),
        choose(Key::D, "divide the picture", |s| s.split = !s.split),
        choose(Key::Space, "pause", |s| s.paused = !s.paused),
        once(Key::S, "render one frame while paused", Action::Step),
        once(Key::R, "forget all history", Action::Reset),
        choose(Key::L, "lamps on or off", |s| s.motion.lit = !s.motion.lit),
        choose(Key::B, "lamps blink", |s| s.motion.blink = !s.motion.blink),
        choose(Key::P, "plots", |s| s.plots = !s.plots),
        choose(Key::F, "go around or fly", |s| s.fly = !s.fly),
        once(Key::C, "camera cut", Action::Cut),
        once(Key::H, "the scene's own camera", Action::Home),
        once(Key::ArrowUp, "walk forward", Action::Walk([0.0, 0.0, STRIDE])),
        once(Key::ArrowDown, "walk backward", Action::Walk([0.0, 0.0, -STRIDE])),
        once(Key::ArrowLeft, "walk left", Action::Walk([-STRIDE, 0.0, 0.0])),
        once(Key::ArrowRight, "walk right", Action::Walk([STRIDE, 0.0, 0.0])),
        once(Key::PageUp, "walk up", Action::Walk([0.0, STRIDE, 0.0])),
        once(Key::PageDown, "walk down", Action::Walk([0.0, -STRIDE, 0.0])),
    ]
}

/// Applies the effects of pressed keys, unless the user types text.
pub fn read(ui: &Ui, state: &mut State, actions: &mut Vec<Action>) {
    if ui.ctx().egui_wants_keyboard_input() {
        return;
    }
    ui.input(|input| {
        for shortcut in shortcuts().into_iter().filter(|s| input.key_pressed(s.key)) {
            match shortcut.effect {
                Effect::Choose(change) => change(state),
                Effect::Do(action) => actions.push(action),
            }
        }
        for (_, view) in DIGITS.iter().zip(VIEWS).filter(|(key, _)| input.key_pressed(**key)) {
            state.view = view.name().into();
        }
    });
}

/// Shows the list of keys in the window.
pub fn list(ui: &mut Ui) {
    for shortcut in shortcuts() {
        ui.label(format!("{}: {}", shortcut.key.name(), shortcut.help));
    }
    for (key, view) in DIGITS.iter().zip(VIEWS) {
        ui.label(format!("{}: {}", key.name(), view.name().replace('-', " ")));
    }
    ui.label("drag: turn · right-button drag: shift · wheel: nearer or farther");
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn no_key_has_two_meanings() {
        let mut keys: Vec<Key> = shortcuts().iter().map(|s| s.key).chain(DIGITS).collect();
        let count = keys.len();
        keys.sort();
        keys.dedup();
        assert_eq!(keys.len(), count);
    }
}
