//! Structs that exist in Rust and in WGSL must agree on the place of each field.

use crate::gpu::compose::{Permutation, Shaders};
use crate::passes::{Pass, trace};
use crate::plan::{Feature, Features};
use wgpu::naga::{Module, TypeInner};

/// A field's name in WGSL and its place in Rust.
pub(crate) type Field = (&'static str, usize);

/// Asserts that a struct of the tracing shader has exactly these fields at these offsets, and this size.
pub(crate) fn assert_layout(name: &str, fields: &[Field], size: usize) {
    assert_layout_with(&[], name, fields, size);
}

/// Does the same as [`assert_layout`] for a struct that the shader has with these features alone.
pub(crate) fn assert_layout_with(more: &[Feature], name: &str, fields: &[Field], size: usize) {
    use Feature::*;
    let features =
        Features::of(&[Textures, Lights, Emitters, PunctualLights, EnvironmentLight, DirectEmission, Specular]);
    assert_layout_in(&trace::PASS, features.or(Features::of(more)), name, fields, size);
}

/// Does the same as [`assert_layout`] for another shader.
pub(crate) fn assert_layout_in(pass: &'static Pass, features: Features, name: &str, fields: &[Field], size: usize) {
    let permutation = Permutation { pass, features, traversal: Default::default(), view: None };
    let module = Shaders::new().and_then(|mut s| s.compose(permutation)).unwrap_or_else(|e| panic!("{e}"));
    let (members, span) = find(&module, name);
    assert_eq!(members, fields.iter().map(|&(n, at)| (n.to_owned(), at)).collect::<Vec<_>>(), "{name}");
    assert_eq!(span, size, "size of {name}");
}

fn find(module: &Module, name: &str) -> (Vec<(String, usize)>, usize) {
    for (_, ty) in module.types.iter() {
        let plain = ty.name.as_deref().unwrap_or_default().split("X_naga_oil").next();
        if let (true, TypeInner::Struct { members, span }) = (plain == Some(name), &ty.inner) {
            // Padding has no name to compare.
            let named = members.iter().filter_map(|m| Some((m.name.clone()?, m.offset as usize)));
            return (named.filter(|(n, _)| !n.starts_with("_pad")).collect(), *span as usize);
        }
    }
    panic!("no struct {name} in the shader")
}

/// Pairs `field` or `field as "wgsl_name"` with `offset_of!`.
macro_rules! fields {
    ($struct:ty: $($field:ident $(as $wgsl:literal)?),+ $(,)?) => {
        &[$((fields!(@ $field $($wgsl)?), std::mem::offset_of!($struct, $field))),+]
    };
    (@ $field:ident $wgsl:literal) => { $wgsl };
    (@ $field:ident) => { stringify!($field) };
}
pub(crate) use fields;
