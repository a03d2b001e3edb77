//! Every shader as the text that wgpu hands to a browser, for a second compiler: see examples/demo/web/check.mjs.

use super::permutations::{steps, traversals};
use crate::gpu::compose::{Permutation, Shaders};
use std::collections::{BTreeMap, HashSet};
use std::path::Path;
use wgpu::naga::back::wgsl::{WriterFlags, write_string};
use wgpu::naga::valid::{Capabilities, ValidationFlags, Validator};

/// The WGSL of a permutation, headed by its name.
fn text(shaders: &mut Shaders, permutation: Permutation) -> (String, String) {
    let module = shaders.compose(permutation).unwrap_or_else(|e| panic!("{e}"));
    let info = Validator::new(ValidationFlags::all(), Capabilities::empty()).validate(&module).unwrap();
    let Permutation { features, traversal, view, .. } = permutation;
    let what = format!("{features:?}, {traversal:?}, view {view:?}");
    (what, write_string(&module, &info, WriterFlags::empty()).unwrap())
}

#[test]
#[ignore = "writes files: target/permutations, for examples/demo/web/check.mjs"]
fn every_reachable_permutation_is_written() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("target/permutations");
    // Files of shaders that no longer exist must not be checked.
    let _ = std::fs::remove_dir_all(&folder);
    std::fs::create_dir_all(&folder).unwrap();
    let mut shaders = Shaders::new().unwrap_or_else(|e| panic!("{e}"));
    let (mut written, mut counts) = (HashSet::new(), BTreeMap::<&str, u32>::new());
    for permutation in steps().into_keys().chain(traversals().into_keys()) {
        let (what, text) = text(&mut shaders, permutation);
        if written.contains(&text) {
            continue;
        }
        let count = counts.entry(permutation.pass.name()).or_default();
        let file = folder.join(format!("{}-{count}.wgsl", permutation.pass.name()));
        std::fs::write(file, format!("// {what}\n{text}")).unwrap();
        *count += 1;
        written.insert(text);
    }
    println!("{counts:?}");
}
