//! The command line.

use lexopt::prelude::*;
use std::ffi::OsString;
use std::path::PathBuf;

/// The text of `--help`.
pub const HELP: &str = "\
Shows a path-traced scene in a window, denoised live with a constant and an adaptive α.

Usage: cargo run --release -p asvgf-demo -- [SCENE] [OPTIONS]

  SCENE                 a .gltf, .glb or .obj file, or a scene that comes along: cornell,
                        pillars, gloss, textured, still-life                 [cornell]
  --state FILE          start with a saved state
  --size WxH            the window in points                                 [1280x800]
  --screenshot FILE     write the window to a PNG file and end
  --frames N            the number of frames before the screenshot                 [60]
  -h, --help            print this

Exit status: 0 done, 1 failed, 2 wrong usage.
Without a display, `cargo run --release --example render` writes pictures to files.
";

/// The options of the command line.
#[derive(Clone, Debug, PartialEq)]
pub struct Options {
    pub scene: Option<String>,
    pub state: Option<PathBuf>,
    pub size: [f32; 2],
    pub screenshot: Option<PathBuf>,
    pub frames: u32,
}

/// Parses the command line. `None` stands for a request for help. The error names the wrong argument.
pub fn parse(arguments: impl IntoIterator<Item = OsString>) -> Result<Option<Options>, String> {
    let mut options = Options { scene: None, state: None, size: [1280.0, 800.0], screenshot: None, frames: 60 };
    let mut parser = lexopt::Parser::from_args(arguments);
    while let Some(argument) = parser.next().map_err(|error| error.to_string())? {
        match argument {
            Short('h') | Long("help") => return Ok(None),
            Long("state") => options.state = Some(value(&mut parser)?.into()),
            Long("screenshot") => options.screenshot = Some(value(&mut parser)?.into()),
            Long("frames") => {
                let text = value(&mut parser)?;
                let frames = text.parse().ok().filter(|frames| (1..=100_000).contains(frames));
                options.frames =
                    frames.ok_or_else(|| format!("--frames {text}: must be a whole number from 1 to 100000"))?;
            }
            Long("size") => {
                let text = value(&mut parser)?;
                options.size = size(&text)
                    .ok_or_else(|| format!("--size {text}: must be two numbers from 200 to 8192, as in 1280x800"))?;
            }
            Value(scene) if options.scene.is_none() => options.scene = Some(scene.string().map_err(|e| e.to_string())?),
            other => return Err(other.unexpected().to_string()),
        }
    }
    Ok(Some(options))
}

fn value(parser: &mut lexopt::Parser) -> Result<String, String> {
    parser.value().and_then(|value| value.string()).map_err(|error| error.to_string())
}

fn size(text: &str) -> Option<[f32; 2]> {
    let (width, height) = text.split_once('x')?;
    let side = |text: &str| text.parse().ok().filter(|side| (200.0..=8192.0).contains(side));
    Some([side(width)?, side(height)?])
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(line: &str) -> Result<Option<Options>, String> {
        parse(line.split_whitespace().map(OsString::from))
    }

    #[test]
    fn options_are_understood() {
        let options = parsed("pillars --size 800x600 --screenshot a.png --frames 5").unwrap().unwrap();
        assert_eq!(options.scene.as_deref(), Some("pillars"));
        assert_eq!((options.size, options.frames), ([800.0, 600.0], 5));
        assert_eq!(parsed("-h"), Ok(None));
    }

    #[test]
    fn wrong_ones_are_named() {
        for line in ["--size 10x10", "--size wide", "--frames 0", "--frames", "--what", "a b"] {
            let error = parsed(line).unwrap_err();
            let named = line.split_whitespace().any(|word| error.contains(word.trim_start_matches('-')));
            assert!(named, "{line}: {error}");
        }
    }
}
