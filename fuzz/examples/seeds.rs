//! Makes the corpora for the start of fuzzing: `cargo run --example seeds -- FOLDER_OF_SCENES`.

use asvgf::image_io::{Channels, write_exr};
use asvgf_fuzz::NEXT_FILE;
use std::error::Error;
use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

/// Largest seed in bytes: with larger files, a fuzzer spends more of its work on copying.
const LARGEST: u64 = 40_000;

fn main() -> Result<(), Box<dyn Error>> {
    let corpus = Path::new(env!("CARGO_MANIFEST_DIR")).join("corpus");
    for target in ["gltf", "obj", "exr"] {
        fs::create_dir_all(corpus.join(target))?;
    }
    for folder in std::env::args_os().skip(1) {
        scenes(Path::new(&folder), &corpus)?;
    }
    images(&corpus.join("exr"))?;
    Ok(())
}

/// Copies the scene files of a folder and of its subfolders.
fn scenes(folder: &Path, corpus: &Path) -> Result<(), Box<dyn Error>> {
    let entries =
        fs::read_dir(folder)?.map(|entry| Ok(entry?.path())).collect::<Result<Vec<PathBuf>, std::io::Error>>()?;
    let own = folder.file_name().unwrap_or_default().to_string_lossy();
    for path in entries {
        if path.is_dir() {
            scenes(&path, corpus)?;
            continue;
        }
        let name = format!("{own}-{}", path.file_name().unwrap_or_default().to_string_lossy());
        match path.extension().and_then(OsStr::to_str) {
            Some("gltf" | "glb") if path.metadata()?.len() <= LARGEST => {
                let mut bytes = fs::read(&path)?;
                if let Ok(data) = fs::read(path.with_extension("bin"))
                    && data.len() as u64 <= LARGEST
                {
                    bytes.push(NEXT_FILE);
                    bytes.extend(data);
                }
                fs::write(corpus.join("gltf").join(name), bytes)?;
            }
            Some("obj") if path.metadata()?.len() <= LARGEST => {
                let mut bytes = fs::read(&path)?;
                if let Ok(materials) = fs::read(path.with_extension("mtl")) {
                    // The target gives the library this name.
                    bytes.extend(b"\nmtllib scene.mtl\n");
                    bytes.push(NEXT_FILE);
                    bytes.extend(materials);
                }
                fs::write(corpus.join("obj").join(name), bytes)?;
            }
            _ => {}
        }
    }
    Ok(())
}

/// Writes small images of few and of many channels.
fn images(folder: &Path) -> Result<(), Box<dyn Error>> {
    let sets: [&[&str]; 3] = [
        &["R", "G", "B"],
        &["R", "G", "B", "depth.Z", "normal.X", "normal.Y", "normal.Z", "motion.X", "motion.Y", "albedo.R"],
        &["View.Combined.R", "View.Combined.G", "View.Combined.B", "View.Depth.Z", "View.Vector.X", "View.Vector.Y"],
    ];
    for (number, names) in sets.into_iter().enumerate() {
        for (width, height) in [(1, 1), (5, 3), (17, 33)] {
            let samples = |c: usize| (0..width * height).map(|i| (i * (c as u32 + 1)) as f32 * 0.01).collect();
            let channels = names.iter().enumerate().map(|(c, name)| ((*name).to_owned(), samples(c))).collect();
            write_exr(folder.join(format!("{number}-{width}x{height}.exr")), &Channels { width, height, channels })?;
        }
    }
    Ok(())
}
