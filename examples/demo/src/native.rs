//! The demo as a desktop program with a window and a command line.

use asvgf_demo::app::Demo;
use asvgf_demo::options::{self, HELP, Options};
use asvgf_demo::state::State;
use asvgf_demo::{gpu, window_shot::WindowShot};
use eframe::NativeOptions;
use eframe::egui::ViewportBuilder;
use std::process::ExitCode;

const NO_DISPLAY: &str = "there is no display to open a window on (neither DISPLAY nor WAYLAND_DISPLAY is set).\n\
    Without one, pictures can be written to files: cargo run --release --example render\n\
    Or use a virtual one: xvfb-run cargo run --release -p asvgf-demo";

const NO_ADAPTER: &str = "no GPU that wgpu can use was found. Install your GPU's Vulkan driver, or a software one:\n  \
    Debian, Ubuntu: sudo apt-get install -y mesa-vulkan-drivers\n  Fedora: sudo dnf install mesa-vulkan-drivers\n  \
    Arch: sudo pacman -S vulkan-swrast";

/// Runs the demo to its end.
pub fn main() -> ExitCode {
    let options = match options::parse(std::env::args_os().skip(1)) {
        Ok(Some(options)) => options,
        Ok(None) => {
            print!("{HELP}");
            return ExitCode::SUCCESS;
        }
        Err(error) => {
            eprintln!("error: {error}\n(--help lists all options)");
            return ExitCode::from(2);
        }
    };
    match run(options) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn run(options: Options) -> Result<(), String> {
    let mut state = match &options.state {
        Some(path) => {
            let text = std::fs::read_to_string(path).map_err(|error| error.to_string());
            text.and_then(|text| State::load(&text)).map_err(|error| format!("{}: {error}", path.display()))?
        }
        None => State::default(),
    };
    if let Some(scene) = options.scene {
        state.scene = scene;
    }
    if cfg!(target_os = "linux") && ["DISPLAY", "WAYLAND_DISPLAY"].iter().all(|name| std::env::var_os(name).is_none()) {
        return Err(NO_DISPLAY.into());
    }
    let native = NativeOptions {
        viewport: ViewportBuilder::default().with_inner_size(options.size).with_drag_and_drop(true),
        wgpu_options: gpu::configuration(),
        ..Default::default()
    };
    let shot = options.screenshot.map(|path| WindowShot::new(path, options.frames));
    let failed = shot.as_ref().map(WindowShot::failure);
    let ended = eframe::run_native(
        "A-SVGF",
        native,
        Box::new(move |context| {
            let gpu = context.wgpu_render_state.as_ref().ok_or("eframe was built without wgpu")?;
            let demo = Demo::new(gpu, state)?;
            Ok(match shot {
                Some(shot) => Box::new(shot.of(demo)),
                None => Box::new(demo),
            })
        }),
    );
    match ended {
        // The advice fits every failure of wgpu: a machine without a driver has no surface either.
        Err(eframe::Error::Wgpu(error)) => Err(format!("{error}\n{NO_ADAPTER}")),
        Err(error) => Err(error.to_string()),
        Ok(()) => failed.and_then(|failed| failed.lock().ok()?.take()).map_or(Ok(()), Err),
    }
}
