//! The demo in a browser: the functions that the page calls.

use asvgf_demo::action::Action;
use asvgf_demo::app::Demo;
use asvgf_demo::gpu;
use asvgf_demo::state::State;
use eframe::egui::Context;
use eframe::web_sys::HtmlCanvasElement;
use eframe::{WebOptions, WebRunner};
use std::cell::OnceCell;
use std::rc::Rc;
use wasm_bindgen::prelude::{JsValue, wasm_bindgen};

/// A canvas with the demo on it.
#[wasm_bindgen]
pub struct Page {
    runner: WebRunner,
    context: Rc<OnceCell<Context>>,
}

#[wasm_bindgen]
impl Page {
    /// Starts the demo. The error is a text for the user.
    pub async fn start(canvas: HtmlCanvasElement) -> Result<Page, JsValue> {
        let runner = WebRunner::new();
        let options = WebOptions { wgpu_options: gpu::configuration(), ..Default::default() };
        let context = Rc::<OnceCell<Context>>::default();
        let kept = Rc::clone(&context);
        let create: eframe::AppCreator<'static> = Box::new(move |context| {
            kept.get_or_init(|| context.egui_ctx.clone());
            let gpu = context.wgpu_render_state.as_ref().ok_or("this browser has no WebGPU")?;
            Ok(Box::new(Demo::new(gpu, State::default())?))
        });
        runner.start(canvas, options, create).await?;
        Ok(Self { runner, context })
    }

    /// Adopts the state of a saved file.
    pub fn choose(&self, saved: &str) -> Result<(), JsValue> {
        let state = State::load(saved)?;
        self.demo(|demo| demo.adopt(state))
    }

    /// The state, as a saved file holds it.
    pub fn chosen(&self) -> Result<String, JsValue> {
        self.demo(|demo| demo.state.save())
    }

    /// Asks for one frame while time stands still.
    pub fn step(&self) -> Result<(), JsValue> {
        self.demo(|demo| demo.act(Action::Step))
    }

    /// Number of frames rendered so far.
    pub fn frames(&self) -> Result<u32, JsValue> {
        self.demo(|demo| demo.frames())
    }

    /// Asks for the linear radiance of the left half's last frame.
    pub fn ask(&self) -> Result<(), JsValue> {
        self.demo(|demo| demo.picture.ask_radiance = true)
    }

    /// The requested radiance, three numbers for each pixel. It is empty until the radiance has arrived.
    pub fn radiance(&self) -> Result<Vec<f32>, JsValue> {
        self.demo(|demo| demo.picture.take_radiance())
    }

    /// The messages to the user.
    pub fn messages(&self) -> Result<String, JsValue> {
        self.demo(|demo| demo.messages())
    }

    fn demo<T>(&self, act: impl FnOnce(&mut Demo) -> T) -> Result<T, JsValue> {
        let mut demo = self.runner.app_mut::<Demo>().ok_or("the demo has stopped")?;
        // A window that stands still would not notice the change, so request a repaint.
        self.context.get().into_iter().for_each(Context::request_repaint);
        Ok(act(&mut demo))
    }
}
