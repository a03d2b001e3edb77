//! Default camera and default light for scenes without, so that the programs and the demo show any file.

pub mod framing;
pub mod sky;
