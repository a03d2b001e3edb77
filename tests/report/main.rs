//! The example `report`: what it measures, concludes, writes and keeps.
#![cfg(all(feature = "gltf", feature = "obj", feature = "metrics"))]
#![allow(dead_code, reason = "the example's modules, of which these tests use a part")]

#[path = "../../examples/support/arguments.rs"]
mod arguments;
#[path = "../../examples/report/baseline.rs"]
mod baseline;
#[path = "../../examples/report/budget.rs"]
mod budget;
#[path = "../../examples/support/camera.rs"]
mod camera;
#[path = "../../examples/report/canvas.rs"]
mod canvas;
#[path = "../../examples/report/command.rs"]
mod command;
#[path = "../../examples/report/crops.rs"]
mod crops;
#[path = "../../examples/support/export.rs"]
mod export;
#[path = "../../examples/support/film.rs"]
mod film;
#[path = "../../examples/report/fit.rs"]
mod fit;
#[path = "../../examples/support/framing.rs"]
mod framing;
#[path = "../../examples/support/gpu.rs"]
mod gpu;
#[path = "../../examples/report/growth.rs"]
mod growth;
#[path = "../../examples/report/hash.rs"]
mod hash;
#[path = "../../examples/report/keep.rs"]
mod keep;
#[path = "../../examples/support/sequence/layers.rs"]
mod layers;
#[path = "../../examples/report/measure.rs"]
mod measure;
#[path = "../../examples/report/methods.rs"]
mod methods;
#[path = "../../examples/support/options.rs"]
mod options;
#[path = "../../examples/report/pace.rs"]
mod pace;
#[path = "../../examples/report/plots/mod.rs"]
mod plots;
#[path = "../../examples/report/record.rs"]
mod record;
#[path = "../../examples/report/score.rs"]
mod score;
#[path = "../../examples/report/script.rs"]
mod script;
#[path = "../../examples/support/sky.rs"]
mod sky;
#[path = "../../examples/support/stage.rs"]
mod stage;
#[path = "../../examples/report/suite.rs"]
mod suite;
#[path = "../../examples/report/summary.rs"]
mod summary;
#[path = "../../examples/report/tables.rs"]
mod tables;
#[path = "../../examples/report/tessellation.rs"]
mod tessellation;
#[path = "../../examples/support/times.rs"]
mod times;
#[path = "../../examples/support/tone.rs"]
mod tone;
#[path = "../../examples/support/tracing.rs"]
mod tracing;
#[path = "../../examples/report/truth.rs"]
mod truth;
#[path = "../../examples/report/verdict.rs"]
mod verdict;
#[path = "../../examples/report/words.rs"]
mod words;
#[path = "../../examples/report/words_growth.rs"]
mod words_growth;
#[path = "../../examples/report/work.rs"]
mod work;

mod asking;
mod budgeting;
mod growing;
mod keeping;
mod listing;
mod measuring;
mod scoring;
mod verdicts;
mod writing;
