//! What the example `report` concludes from numbers, and what it draws on.
#![cfg(all(feature = "path-tracer", feature = "image", feature = "metrics"))]
#![allow(dead_code, reason = "the example's modules, of which these tests use a part")]

#[path = "../../examples/report/canvas.rs"]
mod canvas;
#[path = "../../examples/report/hash.rs"]
mod hash;
#[path = "../../examples/report/methods.rs"]
mod methods;
#[path = "../../examples/report/record.rs"]
mod record;
#[path = "../../examples/report/summary.rs"]
mod summary;
#[path = "../../examples/report/verdict.rs"]
mod verdict;

mod keeping;
mod listing;
mod verdicts;
