//! Why something is in a plan, or left out.

use super::Feature;
use std::fmt;

/// Something that was decided, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// What about.
    pub feature: Feature,
    /// Whether it is in.
    pub included: bool,
    /// Why it is, or is not: half a sentence.
    pub reason: &'static str,
}

impl Decision {
    /// With why it would be in, and why not.
    pub(super) fn new(feature: Feature, included: bool, [why, why_not]: [&'static str; 2]) -> Self {
        Self { feature, included, reason: if included { why } else { why_not } }
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<22}{}", format!("{:?}", self.feature), self.reason)
    }
}
