//! The denoiser in a window: shows the difference that an adaptive α makes.
//!
//! [`embed`] is the part that a host needs too; the rest is this program's window. Data flows one way: `controls` and
//! `shortcuts` change the [`state`] and ask for `action`s, `picture` makes a frame from the state, and `embed` renders it.

pub mod action;
pub mod app;
mod camera;
mod controls;
mod documentation;
pub mod dropped;
pub mod embed;
pub mod gpu;
mod means;
mod messages;
#[cfg(not(target_arch = "wasm32"))]
pub mod options;
pub mod picture;
mod plan;
mod plots;
mod probe;
mod readback;
mod scenes;
mod screenshot;
mod settings;
mod shortcuts;
mod split;
pub mod state;
mod stopwatch;
mod trouble;
mod views;
#[cfg(not(target_arch = "wasm32"))]
pub mod window_shot;
