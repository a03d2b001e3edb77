//! The panels: they show and change the state, and ask for actions.

use crate::action::Action;
use crate::documentation;
use crate::scenes::Stage;
use crate::state::{Source, State};
use crate::{plan, shortcuts, views};
use asvgf::plan::Plan;
use asvgf::scene::builtin;
use asvgf::{FilterSettings, Gradient, Setting, SettingKind, Settings, TracerSettings, ViewOptions};
use asvgf_fallbacks::shipped;
use eframe::egui::{Button, ComboBox, ScrollArea, Slider, TextEdit, Ui};
use std::path::PathBuf;

/// True if files can be read and written by their names: a page in a browser cannot.
const FILES: bool = cfg!(not(target_arch = "wasm32"));

/// File names that are being typed.
pub struct Fields {
    scene: String,
    state: String,
    picture: String,
}

impl Default for Fields {
    fn default() -> Self {
        Self { scene: String::new(), state: "demo.json".into(), picture: "picture.png".into() }
    }
}

/// Facts that the panels show besides the state.
pub struct Facts<'a> {
    pub stage: &'a Stage,
    /// The plan of the last frame of the left half.
    pub plan: Option<&'a Plan>,
    /// Name and back end of the adapter.
    pub adapter: &'a str,
    /// The scale to use if the user has chosen none.
    pub scale: f32,
    /// Size of the image in pixels.
    pub size: [u32; 2],
    /// The value under the pointer, in words.
    pub probe: Option<String>,
    pub view: ViewOptions,
}

/// The top panel, for the first questions: which α, how high, and both side by side.
pub fn top(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        for source in Source::SHOWN {
            let help = match source {
                Source::OneSignal => "adaptive α, with specular light in one signal with diffuse light",
                _ => "A: adaptive or constant",
            };
            ui.selectable_value(&mut state.left, source, source.name()).on_hover_text(help);
        }
        ui.separator();
        ui.add(Slider::new(&mut state.alpha, 0.01..=1.0).logarithmic(true).text("constant α"))
            .on_hover_text("Weight of each new frame in the moving average. Higher: noisier. Lower: more lag.");
        ui.separator();
        ui.checkbox(&mut state.split, "split").on_hover_text("D: two halves with the same noise; drag the divider");
        if state.split {
            ComboBox::from_label("right half").selected_text(state.right.name()).show_ui(ui, |ui| {
                for source in Source::SHOWN {
                    ui.selectable_value(&mut state.right, source, source.name());
                }
            });
        }
        ui.separator();
        ui.toggle_value(&mut state.paused, "pause").on_hover_text("Space");
        if ui.add_enabled(state.paused, Button::new("step")).on_hover_text("S: one frame").clicked() {
            actions.push(Action::Step);
        }
        if ui.button("reset").on_hover_text("R: forget all history").clicked() {
            actions.push(Action::Reset);
        }
        ui.toggle_value(&mut state.plots, "plots").on_hover_text("P: errors, means and times, live");
    });
}

/// The side panel: everything else.
pub fn side(ui: &mut Ui, state: &mut State, fields: &mut Fields, facts: &Facts<'_>, actions: &mut Vec<Action>) {
    ScrollArea::vertical().auto_shrink(false).show(ui, |ui| {
        let open = |title| eframe::egui::CollapsingHeader::new(title).default_open(true);
        open("light and motion").show(ui, |ui| motion(ui, state, facts.stage));
        open("view").show(ui, |ui| {
            views::choose(ui, &mut state.view);
            ui.add(Slider::new(&mut state.exposure, 0.1..=10.0).logarithmic(true).text("exposure"));
            views::legend(ui, state.view(), facts.view);
            ui.label(facts.probe.as_deref().unwrap_or("point at the picture to read its numbers"));
        });
        open("scene and camera").show(ui, |ui| {
            scene(ui, state, fields, actions);
            camera(ui, state, actions);
            let mut scale = state.scale.unwrap_or(facts.scale);
            let slider = Slider::new(&mut scale, 0.05..=1.0).logarithmic(true).text("resolution");
            if ui.add(slider).on_hover_text("Pixels per window pixel. Higher: sharper. Lower: faster.").changed() {
                state.scale = Some(scale);
            }
            ui.label(format!("{} × {} pixels", facts.size[0], facts.size[1]));
            ui.label(facts.adapter);
        });
        ui.collapsing("settings", |ui| all_settings(ui, state, actions));
        if FILES {
            ui.collapsing("files", |ui| files(ui, fields, actions));
        }
        ui.collapsing("plan", |ui| match facts.plan {
            Some(p) => plan::show(ui, p),
            None => {
                ui.label("no frame has been rendered yet");
            }
        });
        open("keys").show(ui, shortcuts::list);
        ui.collapsing("notes on the scene", |ui| {
            if facts.stage.notes.is_empty() {
                ui.label("nothing was left out");
            }
            for note in &facts.stage.notes {
                ui.label(note);
            }
        });
    });
}

fn motion(ui: &mut Ui, state: &mut State, stage: &Stage) {
    let motion = &mut state.motion;
    let reach = stage.reach();
    if stage.has_lamps() {
        ui.checkbox(&mut motion.lit, "lamps on").on_hover_text("L");
        ui.checkbox(&mut motion.blink, "lamps blink").on_hover_text("B: a second on, a second off");
        ui.add(Slider::new(&mut motion.brightness, 0.0..=3.0).text("brightness"));
        ui.horizontal(|ui| {
            let label = ui.label("colour of the lamps");
            ui.color_edit_button_rgb(&mut motion.tint).labelled_by(label.id);
        });
        for (axis, label) in [(0, "lamps sideways"), (2, "lamps forward")] {
            ui.add(Slider::new(&mut motion.lamp[axis], -reach..=reach).text(label));
        }
    }
    if let Some(name) = &stage.object_name {
        for (axis, label) in [(0, "sideways"), (2, "forward")] {
            ui.add(Slider::new(&mut motion.object[axis], -reach..=reach).text(format!("{name} {label}")));
        }
    }
    for name in stage.animations() {
        let mut plays = motion.playing.iter().any(|playing| playing == name);
        if ui.checkbox(&mut plays, name.replace('-', " ")).changed() {
            motion.playing.retain(|playing| playing != name);
            motion.playing.extend(plays.then(|| name.to_owned()));
        }
    }
    ui.checkbox(&mut motion.shake, "shake the camera");
}

fn scene(ui: &mut Ui, state: &State, fields: &mut Fields, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        for name in builtin::NAMES.into_iter().chain(shipped::NAMES) {
            if ui.selectable_label(state.scene == name, name).clicked() {
                actions.push(Action::Open(name.into()));
            }
        }
    });
    if !FILES {
        ui.label("drop a glTF or OBJ file here, with the files that it refers to");
        return;
    }
    let (path, open) = file(ui, &mut fields.scene, "glTF or OBJ file, or drop one here", &["open"]);
    if open.is_some() && !path.is_empty() {
        actions.push(Action::Open(path));
    }
}

fn camera(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        ui.checkbox(&mut state.fly, "fly").on_hover_text("F: drag turns the head, arrows walk");
        if ui.button("cut").on_hover_text("C: jump a quarter of the way around, with a new history").clicked() {
            actions.push(Action::Cut);
        }
        if ui.button("home").on_hover_text("H: the scene's own camera").clicked() {
            actions.push(Action::Home);
        }
    });
}

fn files(ui: &mut Ui, fields: &mut Fields, actions: &mut Vec<Action>) {
    let (path, pressed) = file(ui, &mut fields.state, "file of settings", &["save", "load"]);
    match pressed {
        Some("save") => actions.push(Action::Save(PathBuf::from(path))),
        Some(_) => actions.push(Action::Load(PathBuf::from(path))),
        None => {}
    }
    let (path, pressed) = file(ui, &mut fields.picture, ".png, or .exr for numbers", &["screenshot"]);
    if pressed.is_some() {
        actions.push(Action::Picture(PathBuf::from(path)));
    }
}

/// Shows a line for a file name, with buttons. Returns the name and the pressed button.
fn file(ui: &mut Ui, text: &mut String, hint: &str, buttons: &[&'static str]) -> (String, Option<&'static str>) {
    let mut pressed = None;
    ui.horizontal(|ui| {
        ui.add(TextEdit::singleline(text).hint_text(hint).desired_width(150.0)).on_hover_text(hint);
        for button in buttons {
            if ui.button(*button).clicked() {
                pressed = Some(*button);
            }
        }
    });
    (text.trim().to_owned(), pressed)
}

fn all_settings(ui: &mut Ui, state: &mut State, actions: &mut Vec<Action>) {
    ui.horizontal_wrapped(|ui| {
        ui.label("preset");
        // A preset changes the filter alone and leaves the path tracer's settings.
        if ui.button("default").clicked() {
            state.settings.filter = Settings::adaptive().filter;
        }
        if ui.button("classic").on_hover_text("The published formulas").clicked() {
            state.settings.filter = Settings::classic().filter;
        }
        if ui.button("restore everything").clicked() {
            actions.push(Action::Restore);
        }
    });
    for (title, fields) in [("filter", FilterSettings::FIELDS), ("path tracer", TracerSettings::FIELDS)] {
        ui.label(title);
        for field in fields {
            setting(ui, &mut state.settings, field);
        }
    }
}

/// Choices that only a host's renderer can use: the demo has none.
const OF_HOSTS: [&str; 2] = [Gradient::Pairs.name(), Gradient::Lambda.name()];

fn setting(ui: &mut Ui, settings: &mut Settings, setting: &Setting) {
    let label = setting.field_name().replace('_', " ");
    let response = match &setting.kind {
        SettingKind::Number { useful, logarithmic, field, .. } => {
            ui.add(Slider::new((field.get_mut)(settings), useful.clone()).logarithmic(*logarithmic).text(label))
        }
        SettingKind::Whole { useful, field, .. } => {
            ui.add(Slider::new((field.get_mut)(settings), useful.clone()).text(label))
        }
        SettingKind::Switch { field } => ui.checkbox((field.get_mut)(settings), label),
        SettingKind::Choice { choices, get, set } => {
            let mut chosen = get(settings);
            let list = ComboBox::from_label(label).selected_text(chosen);
            let response = list.show_ui(ui, |ui| {
                let of_hosts = |name| setting.name == "filter.gradient" && OF_HOSTS.contains(&name);
                for choice in choices().into_iter().filter(|choice| !of_hosts(choice.name)) {
                    ui.selectable_value(&mut chosen, choice.name, choice.name)
                        .on_hover_text(documentation::of_choice(choice));
                }
            });
            set(settings, chosen);
            response.response
        }
        _ => return,
    };
    response.on_hover_text(documentation::of_setting(setting));
}
