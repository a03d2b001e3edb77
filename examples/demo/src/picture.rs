//! The picture: when a frame is due, its recording, and the mouse on it.

use crate::camera::{Orbit, shaken};
use crate::embed::Embed;
use crate::means::{Means, Quantity, floats};
use crate::plots::Curves;
use crate::probe::{Probe, Sample};
use crate::readback::Readback;
use crate::scenes::Stage;
use crate::screenshot::{self, Outcome};
use crate::split::{self, Half};
use crate::state::{Source, State};
use crate::stopwatch::Stopwatch;
use asvgf::scene::Pose;
use asvgf::{Camera, Settings, View, ViewOptions};
use eframe::egui::{Align2, FontId, PointerButton, Pos2, Rect, Response, Sense, Ui, Vec2};
use std::error::Error;
use std::path::PathBuf;
use std::time::Duration;
use wgpu::{CommandEncoder, DeviceType};

/// Longest time step in seconds. On a slower display or GPU, things move more slowly but in the same steps.
const LONGEST: f64 = 1.0 / 30.0;

/// Delay before the demo asks again if the GPU is done.
const PATIENCE: Duration = Duration::from_millis(4);

/// The inputs of a frame: another frame is due when any of them changes.
#[derive(Clone, PartialEq)]
struct Recipe {
    size: [u32; 2],
    films: Vec<(Source, Settings)>,
    pose: Pose,
    camera: Camera,
}

/// The way in which a frame is shown.
#[derive(Clone, PartialEq)]
struct Look {
    view: View,
    options: ViewOptions,
    pointer: Option<(Source, [u32; 2])>,
}

/// The picture, with all measurements of it.
pub struct Picture {
    pub embed: Embed,
    pub curves: Curves,
    /// The camera, once the user has moved it by hand.
    pub orbit: Option<Orbit>,
    /// True if one frame is wanted although time stands still.
    pub step: bool,
    /// True if all history is to be forgotten.
    pub forget: bool,
    /// The file that the next frame is to be written to.
    pub wanted_file: Option<PathBuf>,
    /// True if the page has asked for the linear radiance of the left half.
    pub ask_radiance: bool,
    /// The rectangle of the picture in the window, in points.
    pub rect: Rect,
    /// Time of the scene in seconds, and the window's time of that moment.
    time: f64,
    clock: Option<f64>,
    last: Option<(Recipe, Look)>,
    /// The reason for which the chosen view is not shown.
    missing: Option<String>,
    means: Means,
    probe: Probe,
    outcomes: Readback<Outcome>,
    radiance: Readback<Vec<f32>>,
}

impl Picture {
    pub fn new(embed: Embed) -> Self {
        Self {
            means: Means::new(&embed.gpu.device),
            embed,
            curves: Curves::default(),
            orbit: None,
            step: false,
            forget: false,
            wanted_file: None,
            ask_radiance: false,
            rect: Rect::NOTHING,
            time: 0.0,
            clock: None,
            last: None,
            missing: None,
            probe: Probe::default(),
            outcomes: Readback::default(),
            radiance: Readback::default(),
        }
    }

    /// Starts over after a change of scene.
    pub fn start_over(&mut self) {
        self.orbit = None;
        self.time = 0.0;
        self.curves.clear();
    }

    /// The camera of the last frame.
    pub fn camera(&self) -> Option<Camera> {
        self.last.as_ref().map(|(recipe, _)| recipe.camera)
    }

    /// The texel under the pointer.
    pub fn sample(&mut self) -> Option<Sample> {
        self.probe.last()
    }

    /// Takes the requested radiance, three numbers for each pixel. It is empty until the radiance has arrived.
    pub fn take_radiance(&self) -> Vec<f32> {
        self.radiance.take().pop().unwrap_or_default()
    }

    /// The mapping from numbers to colours.
    pub fn options(&self, state: &State) -> ViewOptions {
        ViewOptions { exposure: state.exposure, range: state.view().default_range() }
    }

    /// Takes results that have arrived from the GPU. Returns the outcomes of file writes.
    pub fn listen(&mut self) -> Vec<Outcome> {
        self.means.take().into_iter().for_each(|mean| self.curves.add(mean));
        for film in &mut self.embed.films {
            while let Some(times) = film.denoiser.take_times() {
                self.curves.add_times(times.passes);
            }
        }
        self.outcomes.take()
    }

    /// Draws the picture over all available room, and renders the next frame if one is due and the GPU is idle.
    pub fn show(
        &mut self,
        ui: &mut Ui,
        state: &mut State,
        stage: &mut Stage,
        scale: f32,
    ) -> Result<(), Box<dyn Error>> {
        let rect = ui.max_rect();
        self.rect = rect;
        let response = ui.interact(rect, ui.scope_id().with("picture"), Sense::click_and_drag());
        self.steer(ui, &response, state, stage);
        let rendered = match image_size(rect.size(), ui.ctx().pixels_per_point(), scale) {
            Some(size) if !self.embed.is_working() => {
                let pointer = response.hover_pos().map(|at| under(at, rect, size, state));
                self.frame(ui, state, stage, size, pointer)
            }
            _ => Ok(()),
        };
        if self.embed.is_working() {
            ui.ctx().request_repaint_after(PATIENCE);
        }
        let half = |source: Source| self.embed.film(source).map(|film| Half { id: film.id, name: source.name() });
        if let Some(left) = half(state.left) {
            let right = half(state.right).filter(|_| state.split);
            split::show(ui, rect, &left, right.as_ref(), &mut state.divider);
        }
        if let Some(text) = &self.missing {
            let (at, font) = (rect.center_bottom() - Vec2::new(0.0, 8.0), FontId::proportional(14.0));
            ui.painter().text(at, Align2::CENTER_BOTTOM, text, font, ui.visuals().warn_fg_color);
        }
        rendered
    }

    /// Moves the camera by the mouse.
    fn steer(&mut self, ui: &Ui, response: &Response, state: &State, stage: &Stage) {
        let height = response.rect.height().max(1.0);
        let drag = response.drag_delta() / height;
        let wheel = if response.hovered() { ui.input(|input| input.smooth_scroll_delta().y) } else { 0.0 };
        if (drag == Vec2::ZERO && wheel == 0.0) || self.camera().is_none() {
            return;
        }
        let camera = self.camera().unwrap_or_default();
        let orbit = self.orbit.get_or_insert_with(|| Orbit::from(&camera, stage.centre()));
        match drag.into() {
            moved if response.dragged_by(PointerButton::Secondary) => orbit.pan(moved),
            moved if state.fly => orbit.look(moved),
            moved => orbit.orbit(moved),
        }
        // A notch of a wheel is some fifty points.
        orbit.approach(wheel / 50.0);
    }

    /// Records and submits all work that is due.
    fn frame(
        &mut self,
        ui: &Ui,
        state: &State,
        stage: &mut Stage,
        size: [u32; 2],
        pointer: Option<(Source, [u32; 2])>,
    ) -> Result<(), Box<dyn Error>> {
        let step = std::mem::take(&mut self.step);
        self.advance(ui.input(|input| input.time), state.paused, step);
        let recipe = self.recipe(state, stage, size);
        let look = Look { view: state.view(), options: self.options(state), pointer };
        let changed = self.last.as_ref().is_none_or(|(last, _)| *last != recipe);
        let due = !state.paused || step || changed || self.forget;
        let converging = recipe.films.iter().any(|(source, _)| *source == Source::Reference);
        let seen = self.last.as_ref().is_some_and(|(_, last)| *last == look);
        let asked = self.wanted_file.is_some() || self.ask_radiance;
        if !due && !converging && seen && !asked {
            return Ok(());
        }
        self.embed.arrange(size, &recipe.films)?;
        if std::mem::take(&mut self.forget) {
            self.embed.reset();
        }
        let mut encoder = self.embed.begin();
        if due {
            let mut watch = self.stopwatch(state);
            self.embed.render(&mut encoder, &recipe.pose, recipe.camera, watch.as_mut())?;
            watch.into_iter().for_each(|watch| self.curves.add_times(watch.times));
        } else {
            self.embed.converge(&mut encoder, recipe.camera)?;
        }
        self.missing = self.embed.develop(&mut encoder, look.view, look.options)?;
        if let Some((source, pixel)) = pointer
            && self.embed.show_numbers(&mut encoder, source, look.view)?
        {
            self.probe.record(&self.embed.gpu.device, &mut encoder, &self.embed.numbers, pixel);
        }
        if state.plots {
            self.measure(&mut encoder)?;
        }
        if let (Some(path), Some(left)) = (self.wanted_file.take(), self.embed.film(state.left)) {
            let right = self.embed.film(state.right).filter(|_| state.split).map(|film| (film, state.divider));
            screenshot::record(&self.outcomes, &self.embed.gpu.device, &mut encoder, left, right, path);
        }
        if let (true, Some(film)) = (std::mem::take(&mut self.ask_radiance), self.embed.film(state.left)) {
            let texture = film.radiance.texture();
            self.radiance.fetch_texture(&self.embed.gpu.device, &mut encoder, texture, |texels| {
                floats(texels).chunks_exact(4).flat_map(|c| [c[0], c[1], c[2]]).collect()
            });
        }
        self.embed.submit(encoder);
        self.last = Some((recipe, look));
        if !state.paused || converging {
            ui.ctx().request_repaint();
        }
        Ok(())
    }

    /// Advances the scene's time by the time since the last frame.
    fn advance(&mut self, now: f64, paused: bool, step: bool) {
        let passed = self.clock.map_or(0.0, |then| now - then);
        self.clock = Some(now);
        if step {
            self.time += LONGEST;
        } else if !paused {
            self.time += passed.clamp(0.0, LONGEST);
        }
    }

    fn recipe(&self, state: &State, stage: &mut Stage, size: [u32; 2]) -> Recipe {
        let time = self.time as f32;
        let pose = stage.pose(&state.motion, time);
        let aspect = size[0] as f32 / size[1] as f32;
        let camera = self.orbit.map_or_else(|| stage.camera(&pose, aspect), |orbit| orbit.camera());
        let camera = if state.motion.shake { shaken(camera, time) } else { camera };
        let films = state.sources().into_iter().map(|source| (source, state.settings(source))).collect();
        Recipe { size, films, pose, camera }
    }

    /// A stopwatch for the passes of the left half, if the GPU has no timestamps.
    fn stopwatch(&self, state: &State) -> Option<Stopwatch> {
        let software = self.embed.gpu.adapter.get_info().device_type == DeviceType::Cpu;
        // A browser cannot wait.
        let can = software && !cfg!(target_arch = "wasm32");
        (state.plots && can).then(|| Stopwatch::start(&self.embed.gpu, state.left))
    }

    /// Records the measurements for the plots of this frame.
    fn measure(&mut self, encoder: &mut CommandEncoder) -> Result<(), Box<dyn Error>> {
        let frame = self.embed.index.wrapping_sub(1);
        let radiance = |source| self.embed.film(source).map(|film| &film.radiance);
        let device = &self.embed.gpu.device;
        if let (Some(first), Some(second)) = (radiance(Source::Reference), radiance(Source::Witness)) {
            for (source, quantity) in
                [(Source::Adaptive, Quantity::AdaptiveError), (Source::Constant, Quantity::ConstantError)]
            {
                if let Some(image) = radiance(source) {
                    self.means.record(device, encoder, (quantity, frame), image, Some([first, second]));
                }
            }
        }
        for (view, quantity) in [(View::Lambda, Quantity::Lambda), (View::HistoryLength, Quantity::HistoryLength)] {
            if self.embed.show_numbers(encoder, Source::Adaptive, view)? {
                self.means.record(&self.embed.gpu.device, encoder, (quantity, frame), &self.embed.numbers, None);
            }
        }
        Ok(())
    }
}

/// Size in pixels of an image that fills a part of the window. `None` if there is no room, as in a minimised window.
fn image_size(points: Vec2, pixels_per_point: f32, scale: f32) -> Option<[u32; 2]> {
    let pixels = points * pixels_per_point * scale;
    // A smaller image shows nothing, and no default device has larger textures.
    let side = |x: f32| (x.round() as u32).clamp(8, 8192);
    (points.x >= 1.0 && points.y >= 1.0 && pixels.is_finite()).then(|| [side(pixels.x), side(pixels.y)])
}

/// The source and the pixel under the pointer.
fn under(at: Pos2, rect: Rect, [width, height]: [u32; 2], state: &State) -> (Source, [u32; 2]) {
    let part = (at - rect.min) / rect.size();
    let source = if state.split && part.x > state.divider { state.right } else { state.left };
    let index = |part: f32, count: u32| ((part * count as f32) as u32).min(count - 1);
    (source, [index(part.x, width), index(part.y, height)])
}

#[cfg(test)]
mod tests {
    use super::*;
    use eframe::egui::{pos2, vec2};

    #[test]
    fn a_minimised_window_has_no_image_and_a_huge_one_a_possible_one() {
        assert_eq!(image_size(vec2(0.0, 0.0), 1.0, 1.0), None);
        assert_eq!(image_size(vec2(-4.0, 100.0), 1.0, 1.0), None);
        assert_eq!(image_size(vec2(800.0, 600.0), 2.0, 0.25), Some([400, 300]));
        assert_eq!(image_size(vec2(1e9, 1.0), 1.0, 1.0), Some([8192, 8]));
    }

    #[test]
    fn the_pointer_is_over_the_half_on_its_side_of_the_divider() {
        let rect = Rect::from_min_max(pos2(100.0, 50.0), pos2(300.0, 150.0));
        let state = State { split: true, divider: 0.25, ..State::default() };
        assert_eq!(under(pos2(140.0, 50.0), rect, [20, 10], &state), (Source::Adaptive, [4, 0]));
        assert_eq!(under(pos2(300.0, 150.0), rect, [20, 10], &state), (Source::Constant, [19, 9]));
    }
}
