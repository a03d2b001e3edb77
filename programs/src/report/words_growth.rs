//! Growth of costs, in words.

use crate::report::fit::Power;
use crate::report::growth::{Cost, Growth};
use std::fmt::Write as _;

const MEBIBYTE: f64 = 1024.0 * 1024.0;

pub fn growth(growth: &Growth, plots: &[String]) -> String {
    let mut out = String::from("\n## How cost grows\n\n");
    let scene = "`cornell`, animation `static`, the default's settings";
    let _ = writeln!(
        out,
        "{scene}; cost is proportional to the count to the power of the exponent, fitted by least squares of logarithms.\n"
    );
    out += "| pixels | filter ms | tracing ms | MiB of images | bytes per pixel |\n|---|--:|--:|--:|--:|\n";
    for cost in &growth.sizes {
        let ([width, height], bytes) = (cost.size, cost.images as f64);
        let (mebibytes, each) = (bytes / MEBIBYTE, bytes / pixels(cost));
        let [filter, tracing] = [cost.filter, cost.tracing];
        let _ = writeln!(out, "| {width}×{height} | {filter:.2} | {tracing:.2} | {mebibytes:.1} | {each:.0} |");
    }
    let sizes = |number: fn(&Cost) -> f64| exponent(growth.sizes.iter().map(|cost| (pixels(cost), number(cost))));
    let [filter, tracing, images] = [sizes(|c| c.filter), sizes(|c| c.tracing), sizes(|c| c.images as f64)];
    let _ = writeln!(out, "| exponent | {filter} | {tracing} | {images} | |\n");
    out += "| triangles | tracing ms | million rays/s | MiB of the scene |\n|--:|--:|--:|--:|\n";
    for cost in &growth.triangles {
        let (count, tracing, mebibytes) = (cost.triangles, cost.tracing, cost.scene as f64 / MEBIBYTE);
        let note = if cost.tree { "" } else { " (no tree)" };
        let speed = cost.rays / cost.tracing * 1e-3;
        let _ = writeln!(out, "| {count}{note} | {tracing:.2} | {speed:.1} | {mebibytes:.2} |");
    }
    let trees =
        |number: fn(&Cost) -> f64| exponent(growth.with_trees().map(|cost| (cost.triangles as f64, number(cost))));
    let [tracing, scene] = [trees(|c| c.tracing), trees(|c| c.scene as f64)];
    let _ = writeln!(out, "| exponent, with a tree | {tracing} | | {scene} |");
    if let Some([width, height]) = growth.triangles.first().map(|cost| cost.size) {
        let _ = writeln!(
            out,
            "\nImages of {width}×{height} of one picture: surfaces that do not emit are cut into more and more triangles."
        );
    }
    for plot in plots {
        let _ = write!(out, "\n![{plot}]({plot}.svg)\n");
    }
    out
}

fn pixels(cost: &Cost) -> f64 {
    f64::from(cost.size[0] * cost.size[1])
}

fn exponent(points: impl Iterator<Item = (f64, f64)>) -> String {
    let points: Vec<_> = points.collect();
    Power::through(&points).map_or("–".into(), |power| format!("{:.2}", power.exponent))
}
