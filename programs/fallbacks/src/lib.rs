//! Default camera and default light for scenes without, so that the programs and the demo show any file; and the scene files that both ship.

pub mod framing;
pub mod shipped;
pub mod sky;
