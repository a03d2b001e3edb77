//! Why something is in a plan, or left out.

use super::Feature;
use crate::passes::Pass;
use std::fmt;

/// What a plan decides about.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// Something that is compiled into shaders or not.
    Feature(Feature),
    /// A pass that runs or not, where no feature alone decides it.
    Pass(Pass),
}

impl fmt::Display for Subject {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Feature(feature) => write!(f, "{feature:?}"),
            Self::Pass(pass) => write!(f, "pass {}", pass.name()),
        }
    }
}

/// Something that was decided, and why.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Decision {
    /// What about.
    pub subject: Subject,
    /// Whether it is in.
    pub included: bool,
    /// Why it is, or is not: half a sentence.
    pub reason: &'static str,
}

impl Decision {
    pub(super) fn feature(feature: Feature, included: bool, [why, why_not]: [&'static str; 2]) -> Self {
        Self { subject: Subject::Feature(feature), included, reason: if included { why } else { why_not } }
    }

    pub(super) fn pass(pass: Pass, included: bool, [why, why_not]: [&'static str; 2]) -> Self {
        Self { subject: Subject::Pass(pass), included, reason: if included { why } else { why_not } }
    }
}

impl fmt::Display for Decision {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let verdict = if self.included { "in" } else { "out" };
        write!(f, "{:<4}{:<24}{}", verdict, self.subject.to_string(), self.reason)
    }
}
