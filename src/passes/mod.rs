//! The passes: one declaration each, in a file that has the name of its shader in shaders/.
//!
//! A declaration says which features its shader knows, which images stand behind its bindings, and when. Group 0 holds those
//! images; group 1 holds the scene. The plan (src/plan/) says which passes run, and in which order.

mod binding;
mod feature;
mod image;
mod pass;
#[cfg(feature = "path-tracer")]
mod scene_binding;
mod shared;
mod step;
mod traversal;

pub(crate) mod agreement;
pub(crate) mod atrous;
#[cfg(feature = "path-tracer")]
pub(crate) mod gloss_surface;
pub(crate) mod gradient;
pub(crate) mod gradient_filter;
pub(crate) mod gradient_means;
pub(crate) mod gradient_means_filter;
pub(crate) mod gradient_of_means;
pub(crate) mod gradient_pairs;
pub(crate) mod gradient_pairs_filter;
pub(crate) mod gradient_sample;
pub(crate) mod ingest_gloss;
pub(crate) mod ingest_pairs;
pub(crate) mod ingest_radiance;
pub(crate) mod ingest_surface;
pub(crate) mod outlier_candidates;
pub(crate) mod outlier_counts;
pub(crate) mod outlier_limit;
pub(crate) mod reflection;
pub(crate) mod reshade;
pub(crate) mod resolve;
#[cfg(feature = "path-tracer")]
pub(crate) mod see_through;
pub(crate) mod steady;
pub(crate) mod temporal;
#[cfg(feature = "path-tracer")]
pub(crate) mod trace;
pub(crate) mod variance;
pub(crate) mod view;
#[cfg(feature = "path-tracer")]
pub(crate) mod visibility;

pub use binding::{Bound, HostView, Slot};
pub use feature::{Feature, Features};
pub use image::{Grid, Image, Twin};
pub use pass::Pass;
#[cfg(feature = "path-tracer")]
pub(crate) use scene_binding::SceneBinding;
pub(crate) use step::Nth;
pub use step::Step;
pub use traversal::Traversal;

/// The words that declarations are written in.
mod prelude {
    pub(super) use super::Feature::{self, *};
    pub(super) use super::Grid::{Pixels, Strata};
    pub(super) use super::binding::*;
    pub(super) use super::pass::{Known, Pass, knows};
    pub(super) use super::shared;
    pub(super) use super::{HostView, Image};
}
