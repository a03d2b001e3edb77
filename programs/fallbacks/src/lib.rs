//! A camera and light for scenes that come without: the programs and the demo show any file.

pub mod framing;
pub mod sky;
