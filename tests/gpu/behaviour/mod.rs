//! Behaviour over several frames.

mod change;
mod deformation;
mod far;
mod flicker;
mod gloss;
mod gloss_elsewhere;
mod gloss_lag;
mod leaving_out;
mod lifecycle;
mod motion;
mod pauses;
mod recording;
mod refusals;
mod see_through;
mod shipped;
mod still;
mod views;
