//! The reason why a feature is in a plan or left out.

use super::Feature;
use std::fmt;

/// A decision and its reason.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Decision {
    /// The feature in question.
    pub feature: Feature,
    /// True if the feature is in.
    pub included: bool,
    /// The reason, as half a sentence.
    pub reason: &'static str,
}

impl Decision {
    /// Makes a decision, with the first reason if the feature is in, with the second if it is out.
    pub(super) fn new(feature: Feature, included: bool, [why, why_not]: [&'static str; 2]) -> Self {
        Self { feature, included, reason: if included { why } else { why_not } }
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{:<22}{}", format!("{:?}", self.feature), self.reason)
    }
}
