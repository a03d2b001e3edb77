//! Counts of geometry defects. A file may have the same defect in a million lines, and one warning is enough for all.

use crate::scene::load::common::report::{Fault, Report};

/// A kind of defect.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Debug)]
pub(super) enum Defect {
    /// A face without the position of one of its corners.
    FaceIndex,
    /// A face of one or two corners.
    ShortFace,
    /// A polygon whose corners lie on one line or point.
    FlatFace,
    /// A polygon whose edges cross.
    CrossingFace,
    /// A polygon with too many corners.
    HugeFace,
    /// A corner of more than three indices.
    ExtraIndex,
    /// A face with texture coordinates or normals at some corners only.
    PartialFace,
    /// The index of texture coordinates.
    UvIndex,
    /// The index of a normal.
    NormalIndex,
    /// A position that is not three finite numbers.
    Position,
    /// Texture coordinates that are not finite numbers.
    Uv,
    /// A normal without direction.
    Normal,
    /// The colour of a vertex.
    Color,
    /// Decimal commas.
    Comma,
    /// `usemtl` without a name.
    UnnamedMaterial,
}

impl Defect {
    /// The elements with the defect, in the plural.
    fn noun(self) -> &'static str {
        match self {
            Self::FaceIndex | Self::ShortFace | Self::FlatFace => "faces",
            Self::CrossingFace | Self::HugeFace | Self::PartialFace => "faces",
            Self::ExtraIndex | Self::UvIndex | Self::NormalIndex => "corners",
            Self::Position | Self::Color => "vertices",
            Self::Uv => "texture coordinates",
            Self::Normal => "normals",
            Self::Comma | Self::UnnamedMaterial => "statements",
        }
    }

    /// True if the face is lost.
    fn loses_faces(self) -> bool {
        matches!(self, Self::FaceIndex | Self::ShortFace | Self::FlatFace | Self::Position)
    }
}

struct Entry {
    defect: Defect,
    line: usize,
    reason: String,
    count: usize,
}

/// The defects of a file, in the order of their first lines.
#[derive(Default)]
pub(super) struct Tally(Vec<Entry>);

impl Tally {
    /// Counts a defect. The first of a kind gives the line and the reason.
    pub fn add(&mut self, defect: Defect, line: usize, reason: impl FnOnce() -> String) {
        match self.0.iter_mut().find(|entry| entry.defect == defect) {
            Some(entry) => entry.count += 1,
            None => self.0.push(Entry { defect, line, reason: reason(), count: 1 }),
        }
    }

    /// Gives one warning for each kind.
    pub fn warn(self, report: &mut Report) {
        for Entry { defect, line, mut reason, count } in self.0 {
            if count > 1 {
                reason += &format!(" ({count} {} like this)", defect.noun());
            }
            report.warn(format!("line {line}"), reason);
        }
    }

    /// The reason why no face is left: the first defect that loses faces.
    pub fn fault(&self) -> Option<Fault> {
        let lost = self.0.iter().find(|entry| entry.defect.loses_faces())?;
        let reason = format!("{}; no face of the file can be drawn", lost.reason);
        Some(Fault::new(format!("line {}", lost.line), reason))
    }
}
