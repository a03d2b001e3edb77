//! The window: panels around the picture, and the actions that they ask for.

use crate::action::Action;
use crate::camera::Orbit;
use crate::controls::{self, Facts, Fields};
use crate::dropped::{self, Dropped, Files};
use crate::embed::Embed;
use crate::messages::Messages;
use crate::picture::Picture;
use crate::scenes::Stage;
use crate::state::{Motion, Source, State};
use crate::trouble::Trouble;
use crate::{shortcuts, views};
use eframe::egui::{CentralPanel, Panel, Ui};
use eframe::egui_wgpu::RenderState;
use std::path::Path;
use wgpu::{DeviceType, PollType};

/// Height of the plots in points.
const PLOTS: f32 = 190.0;

/// The whole program, independent of who draws its window.
pub struct Demo {
    pub state: State,
    pub picture: Picture,
    stage: Stage,
    fields: Fields,
    dropped: Dropped,
    messages: Messages,
    trouble: Trouble,
    adapter: String,
    /// The scale to use if the user has chosen none.
    scale: f32,
}

impl Demo {
    /// Starts with a state. The error is a text for the user.
    pub fn new(gpu: &RenderState, state: State) -> Result<Self, String> {
        let trouble = Trouble::of(&gpu.device);
        let mut messages = Messages::default();
        let stage = Stage::open(&state.scene).or_else(|error| {
            messages.error(error);
            Stage::open(&State::default().scene)
        })?;
        let embed = Embed::new(gpu, &stage.scene).map_err(|error| error.to_string())?;
        let info = gpu.adapter.get_info();
        // A software adapter renders about 200 × 150 pixels in the time in which a GPU renders the window.
        let scale = if info.device_type == DeviceType::Cpu { 0.25 } else { 1.0 };
        let adapter = format!("{} ({:?})", info.name, info.backend);
        let picture = Picture::new(embed);
        let (fields, dropped) = (Fields::default(), Dropped::default());
        Ok(Self { state, picture, stage, fields, dropped, messages, trouble, adapter, scale })
    }

    /// Draws everything, and renders the next frame if the GPU is done with the last one.
    pub fn show(&mut self, ui: &mut Ui) {
        self.listen();
        let mut actions = self.dropped.take(ui);
        shortcuts::read(ui, &mut self.state, &mut actions);
        self.panels(ui, &mut actions);
        for action in actions {
            self.act(action);
        }
        CentralPanel::no_frame().show(ui, |ui| {
            if self.trouble.is_lost() {
                return;
            }
            let scale = self.state.scale.unwrap_or(self.scale);
            if let Err(error) = self.picture.show(ui, &mut self.state, &mut self.stage, scale) {
                self.messages.error(error.to_string());
            }
        });
        self.messages.show(ui.ctx());
    }

    /// Takes results that have arrived from the GPU, without waiting.
    fn listen(&mut self) {
        // Natively, callbacks run in this call. Browsers run them on their own.
        let polled = self.picture.embed.gpu.device.poll(PollType::Poll);
        if let (Err(error), false) = (polled, self.trouble.is_lost()) {
            self.messages.error(error.to_string());
        }
        self.trouble.take().into_iter().for_each(|text| self.messages.error(text));
        for outcome in self.picture.listen() {
            match outcome {
                Ok(text) => self.messages.note(text),
                Err(text) => self.messages.error(text),
            }
        }
    }

    fn panels(&mut self, ui: &mut Ui, actions: &mut Vec<Action>) {
        Panel::top("top").show(ui, |ui| controls::top(ui, &mut self.state, actions));
        let view = self.state.view();
        let probe = self.picture.sample().map(|sample| views::describe(view, sample));
        let film = self.picture.embed.film(self.state.left);
        let facts = Facts {
            stage: &self.stage,
            plan: film.and_then(|film| film.denoiser.plan()),
            adapter: &self.adapter,
            scale: self.scale,
            size: self.picture.embed.size,
            probe,
            view: self.picture.options(&self.state),
        };
        Panel::left("side").default_size(310.0).show(ui, |ui| {
            controls::side(ui, &mut self.state, &mut self.fields, &facts, actions);
        });
        if self.state.plots {
            Panel::bottom("plots").exact_size(PLOTS).show(ui, |ui| self.picture.curves.show(ui));
        }
    }

    /// Does an action.
    pub fn act(&mut self, action: Action) {
        match action {
            Action::Step => self.picture.step = true,
            Action::Reset => self.picture.forget = true,
            Action::Open(name) => self.open(Stage::open(&name), name),
            Action::Receive(files) => self.receive(&files),
            Action::Cut => {
                self.orbit(Orbit::cut);
                self.picture.forget = true;
            }
            Action::Home => {
                self.picture.orbit = None;
                self.picture.forget = true;
            }
            Action::Walk(steps) => self.orbit(|orbit| orbit.walk(steps)),
            Action::Restore => self.state.restore(),
            Action::Save(path) => {
                let written = std::fs::write(&path, self.state.save());
                self.tell(&path, written.map(|()| "was written").map_err(|error| error.to_string()));
            }
            Action::Load(path) => {
                let text = std::fs::read_to_string(&path).map_err(|error| error.to_string());
                let loaded = text.and_then(|text| State::load(&text)).map(|state| self.adopt(state));
                self.tell(&path, loaded.map(|()| "was loaded"));
            }
            Action::Picture(path) => self.picture.wanted_file = Some(path),
        }
    }

    fn tell(&mut self, path: &Path, outcome: Result<&str, String>) {
        match outcome {
            Ok(text) => self.messages.note(format!("{} {text}", path.display())),
            Err(text) => self.messages.error(format!("{}: {text}", path.display())),
        }
    }

    /// Shows another scene. If that fails, the old one stays and a message gives the reason.
    fn open(&mut self, stage: Result<Stage, String>, name: String) {
        let opened = stage.and_then(|stage| {
            self.picture.embed.set_scene(&stage.scene).map_err(|error| error.to_string())?;
            Ok(stage)
        });
        match opened {
            Ok(stage) => {
                self.stage = stage;
                self.picture.start_over();
                // Animations and offsets by hand belonged to the old scene.
                let Motion { lit, blink, brightness, shake, .. } = self.state.motion;
                self.state.motion = Motion { lit, blink, brightness, shake, ..Motion::default() };
                self.state.scene = name;
            }
            Err(error) => self.messages.error(error),
        }
    }

    /// Opens files that a browser has handed over.
    fn receive(&mut self, files: &Files) {
        let Some(path) = dropped::chief(files) else {
            let names: Vec<String> = files.keys().map(|path| path.display().to_string()).collect();
            let known = "a .gltf, .glb or .obj file, with the files that it refers to, or a saved .json file";
            return self.messages.error(format!("cannot open {}: drop {known}", names.join(", ")));
        };
        if dropped::is_saved(path) {
            let text = String::from_utf8_lossy(&files[path]);
            let loaded = State::load(&text).map(|state| self.adopt(state));
            self.tell(path, loaded.map(|()| "was loaded"));
        } else {
            self.open(Stage::from_memory(files, path), path.display().to_string());
        }
    }

    /// Adopts the state from a file.
    pub fn adopt(&mut self, state: State) {
        if state.scene != self.state.scene {
            self.open(Stage::open(&state.scene), state.scene.clone());
        }
        self.state = State { scene: self.state.scene.clone(), ..state };
    }

    /// Moves the camera by hand, from its present place.
    fn orbit(&mut self, change: impl FnOnce(&mut Orbit)) {
        let camera = self.picture.camera().unwrap_or_default();
        change(self.picture.orbit.get_or_insert_with(|| Orbit::from(&camera, self.stage.centre())));
    }

    /// The messages to the user, one a line.
    pub fn messages(&self) -> String {
        self.messages.text()
    }

    /// Number of frames rendered so far.
    pub fn frames(&self) -> u32 {
        self.picture.embed.index
    }

    /// Returns true if a source can be shown, because its film has a frame.
    pub fn has_frame(&self, source: Source) -> bool {
        self.picture.embed.film(source).is_some_and(|film| film.denoiser.plan().is_some())
    }
}

impl eframe::App for Demo {
    fn ui(&mut self, ui: &mut Ui, _frame: &mut eframe::Frame) {
        self.show(ui);
    }

    #[cfg(target_arch = "wasm32")]
    fn as_any_mut(&mut self) -> Option<&mut dyn std::any::Any> {
        Some(self)
    }
}
