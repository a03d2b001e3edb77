//! `manifest.json` beside the frames: cameras, cuts, and how the gradient was made.

use super::files::FrameFile;
use super::{SequenceError, wrong};
use crate::sequence::camera::Camera;
use serde_json::Value;
use std::fs;
use std::path::Path;

#[derive(Default)]
pub struct Manifest {
    /// One camera for each frame, or none.
    pub cameras: Vec<Camera>,
    /// Numbers of frames that begin another shot.
    pub cuts: Vec<i64>,
    /// True if the gradient's paths stand in the colour in the place of their pixels' own.
    pub in_place: bool,
}

/// Reads the manifest's data on some of a folder's frames, which are usually a step apart, if there is one.
pub fn read(folder: &Path, all: &[FrameFile], files: &[FrameFile], step: i64) -> Result<Manifest, SequenceError> {
    let path = folder.join("manifest.json");
    if !path.exists() {
        return Ok(Manifest::default());
    }
    let text = fs::read_to_string(&path).map_err(|e| wrong(&path, format!("cannot be read: {e}")))?;
    let json: Value = serde_json::from_str(text.trim_start_matches('\u{feff}')).map_err(|e| wrong(&path, e))?;
    let in_place = json["gradient_in_place"] == true;
    let cuts = match &json["cuts"] {
        Value::Null => Vec::new(),
        list => numbers(list).ok_or_else(|| wrong(&path, "cuts must be a list of the numbers of frames"))?,
    };
    let list = match &json["cameras"] {
        Value::Null => return Ok(Manifest { cameras: Vec::new(), cuts, in_place }),
        given => given.as_array().ok_or_else(|| wrong(&path, "cameras must be a list"))?,
    };
    let mismatch = || {
        let (found, frames) = (list.len(), all.len());
        let remedy = "give one for each, in order, or one for all, or \"frames\", a list of their numbers";
        wrong(&path, format!("has {found} cameras for {frames} frames: {remedy}"))
    };
    let (first, last) = (all[0].number, all[all.len() - 1].number);
    let span = ((last - first) / step) as usize + 1;
    let named = numbers(&json["frames"]).filter(|frames| frames.len() == list.len());
    // The cameras belong to the given numbers; else there is one for all, one for each file, or one for each frame,
    // missing frames included.
    let index = |file: &FrameFile| match &named {
        Some(frames) => frames.iter().position(|number| *number == file.number),
        None if list.len() == 1 => Some(0),
        None if list.len() == all.len() => all.iter().position(|known| known.number == file.number),
        None if list.len() == span => Some(((file.number - first) / step) as usize),
        None => None,
    };
    let chosen: Option<Vec<usize>> = files.iter().map(index).collect();
    let chosen = chosen.ok_or_else(mismatch)?;
    let camera = |&i: &usize| Camera::from_json(&list[i]).map_err(|e| wrong(&path, format!("camera {i}: {e}")));
    let cameras = chosen.iter().map(camera).collect::<Result<_, _>>()?;
    Ok(Manifest { cameras, cuts, in_place })
}

fn numbers(list: &Value) -> Option<Vec<i64>> {
    list.as_array()?.iter().map(Value::as_i64).collect()
}
