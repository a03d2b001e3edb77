//! Shows the denoiser in a window: `cargo run --release -p asvgf-demo -- --help`; or in a browser: `sh examples/demo/web/serve`.

#[cfg(not(target_arch = "wasm32"))]
mod native;
#[cfg(target_arch = "wasm32")]
mod web;

#[cfg(not(target_arch = "wasm32"))]
fn main() -> std::process::ExitCode {
    native::main()
}

/// The page starts the demo when it has a canvas.
#[cfg(target_arch = "wasm32")]
fn main() {}
