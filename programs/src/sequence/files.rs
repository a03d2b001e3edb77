//! Files of a sequence: their grouping, and their order.

use super::{SequenceError, wrong};
use asvgf::View;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

/// A file with the number of its frame.
#[derive(Clone, Debug, PartialEq)]
pub struct FrameFile {
    pub number: i64,
    /// The number as in the name, leading zeros included.
    pub digits: String,
    pub path: PathBuf,
}

/// A sequence's file name without the number.
#[derive(Clone, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Template {
    before: String,
    after: String,
}

impl Template {
    fn display(&self) -> String {
        format!("{}####{}", self.before, self.after)
    }
}

/// Most digits of a frame's number: more digits are a date or a checksum.
const MOST_DIGITS: usize = 9;

/// Names before the number that mark results or references, not frames; so do the names of all views, which `render` and
/// `denoise` write.
const NOT_FRAMES: [&str; 4] = ["history", "light", "reference", "specular-history"];

/// Returns the frames of a folder, of a pattern (`shot.####.exr`), or of the sequence that a file belongs to, in order.
pub fn list(input: &Path) -> Result<Vec<FrameFile>, SequenceError> {
    let (folder, wanted) = if input.is_dir() {
        (input.to_owned(), None)
    } else {
        let name = input.file_name().and_then(|name| name.to_str()).unwrap_or_default();
        let parent = input.parent().filter(|parent| !parent.as_os_str().is_empty()).unwrap_or(Path::new("."));
        if !input.is_file() && !name.contains('#') {
            return Err(wrong(input, "cannot be read: there is no such folder or file"));
        }
        (parent.to_owned(), Some(name.to_owned()))
    };
    let entries = fs::read_dir(&folder).map_err(|e| wrong(&folder, format!("cannot be read: {e}")))?;
    let mut names: Vec<String> = entries.filter_map(|entry| entry.ok()?.file_name().into_string().ok()).collect();
    // Names with a leading dot are hidden files, such as those that macOS leaves beside files.
    names.retain(|name| name.to_lowercase().ends_with(".exr") && !name.starts_with('.'));
    names.sort();
    let (template, members) = match &wanted {
        Some(name) => pick_named(&names, name)
            .ok_or_else(|| wrong(input, "there is no file with a number in its name that fits"))?,
        None => {
            let groups = groups(&names);
            let (template, members) = pick(&groups).map_err(|reason| wrong(&folder, reason))?;
            (template.clone(), members.clone())
        }
    };
    let mut files: Vec<FrameFile> = Vec::new();
    for digits in members {
        let path = folder.join(format!("{}{digits}{}", template.before, template.after));
        let number = digits.parse().map_err(|_| wrong(&path, "has a number above 999999999"))?;
        files.push(FrameFile { number, digits: digits.clone(), path });
    }
    files.sort_by_key(|file| file.number);
    if let Some([a, b]) = files.windows(2).find_map(|pair| pair.first_chunk().filter(|[a, b]| a.number == b.number)) {
        return Err(wrong(&b.path, format!("is frame {}, and so is {}", b.number, a.path.display())));
    }
    Ok(files)
}

/// Returns the frames with numbers from one to another.
pub fn within(files: &[FrameFile], [from, to]: [i64; 2]) -> Vec<FrameFile> {
    files.iter().filter(|file| (from..=to).contains(&file.number)).cloned().collect()
}

/// Groups names into sequences, with the digits of their members. A name's frame number is the one in which most names
/// differ, else the last.
fn groups(names: &[String]) -> BTreeMap<Template, Vec<String>> {
    let mut counts: BTreeMap<Template, usize> = BTreeMap::new();
    for (template, _) in names.iter().flat_map(|name| numbers(name)) {
        *counts.entry(template).or_default() += 1;
    }
    let mut groups: BTreeMap<Template, Vec<String>> = BTreeMap::new();
    for name in names {
        let best = numbers(name).into_iter().max_by_key(|(template, _)| counts[template]);
        if let Some((template, digits)) = best {
            groups.entry(template).or_default().push(digits);
        }
    }
    groups
}

/// Returns each run of digits in a name, the last one last.
fn numbers(name: &str) -> Vec<(Template, String)> {
    let stem = name.len() - ".exr".len();
    let bytes = &name.as_bytes()[..stem];
    let mut found = Vec::new();
    let mut at = 0;
    while at < stem {
        let digits = bytes[at..].iter().take_while(|b| b.is_ascii_digit()).count();
        if (1..=MOST_DIGITS).contains(&digits) {
            // A dash is a sign at the start of the name, or after another separator.
            let signed = at > 0 && bytes[at - 1] == b'-' && (at == 1 || matches!(bytes[at - 2], b'_' | b'.' | b'-'));
            let first = at - usize::from(signed);
            let template = Template { before: name[..first].into(), after: name[at + digits..].into() };
            found.push((template, name[first..at + digits].into()));
        }
        at += digits.max(1);
    }
    found
}

type Group<'a> = (&'a Template, &'a Vec<String>);

/// Picks the sequence of a folder: the one called frame_, else the only one that is not a result.
fn pick(groups: &BTreeMap<Template, Vec<String>>) -> Result<Group<'_>, String> {
    let usual = groups.iter().find(|(template, _)| template.before == "frame_" && template.after == ".exr");
    if let Some(usual) = usual {
        return Ok(usual);
    }
    let is_frame = |(template, _): &Group<'_>| {
        let name = template.before.trim_end_matches(['_', '.', '-']).to_lowercase();
        !NOT_FRAMES.contains(&name.as_str()) && !View::ALL.iter().any(|view| view.name() == name)
    };
    let mut frames: Vec<Group<'_>> = groups.iter().filter(is_frame).collect();
    if frames.is_empty() {
        frames = groups.iter().collect();
    }
    frames.sort_by_key(|(_, members)| std::cmp::Reverse(members.len()));
    match frames.as_slice() {
        [only] => Ok(*only),
        [] => Err("there are no frames: names such as frame_0001.exr, shot.1001.exr or 0001.exr are read".into()),
        several => {
            let list = several.iter().map(|(template, members)| format!("{} ({})", template.display(), members.len()));
            let list = list.collect::<Vec<_>>().join(", ");
            Err(format!(
                "has several sequences, {list}: give one of them as IN, as in IN_DIR/{}",
                several[0].0.display()
            ))
        }
    }
}

/// Picks the sequence of a pattern or of a file. Its frame number is the last of its numbers in which other files
/// differ, else the last of its numbers.
fn pick_named(names: &[String], name: &str) -> Option<(Template, Vec<String>)> {
    let members = |wanted: &Template| -> Vec<String> {
        let of = |name: &String| {
            numbers(name).into_iter().find(|(template, _)| template == wanted).map(|(_, digits)| digits)
        };
        names.iter().filter_map(of).collect()
    };
    let templates: Vec<Template> = match name.find('#') {
        Some(at) => vec![Template { before: name[..at].into(), after: name[at..].trim_start_matches('#').into() }],
        None => numbers(name).into_iter().rev().map(|(template, _)| template).collect(),
    };
    let several = templates.iter().find(|template| members(template).len() > 1);
    let template = several.or_else(|| templates.iter().find(|template| !members(template).is_empty()))?;
    Some((template.clone(), members(template)))
}

/// Returns the most frequent step from frame to frame.
pub fn usual_step(files: &[FrameFile]) -> i64 {
    let steps: Vec<i64> = files.windows(2).map(|pair| pair[1].number - pair[0].number).collect();
    let mut counts: BTreeMap<i64, usize> = BTreeMap::new();
    steps.iter().for_each(|&step| *counts.entry(step).or_default() += 1);
    // Among equally frequent steps, the least wins.
    counts.iter().rev().max_by_key(|(_, count)| **count).map_or(1, |(&step, _)| step)
}

/// Returns the frames that do not follow the one before by the step.
pub fn gaps(files: &[FrameFile], step: i64) -> Vec<usize> {
    (1..files.len()).filter(|&i| files[i].number - files[i - 1].number != step).collect()
}
