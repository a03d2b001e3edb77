//! Composes the shader of a pass from shaders/ and the features that are compiled in.

use crate::passes::{Features, Pass, Step, Traversal};
use crate::{Error, View};
use naga_oil::compose::{ComposableModuleDescriptor, Composer, NagaModuleDescriptor, ShaderDefValue};
use std::collections::HashMap;
use wgpu::naga::Module;

/// The shared modules, each after those that it imports.
const SHARED: &[(&str, &str)] = &[
    ("color", include_str!("../../shaders/shared/color.wgsl")),
    ("packing", include_str!("../../shaders/shared/packing.wgsl")),
    ("random", include_str!("../../shaders/shared/random.wgsl")),
    ("history", include_str!("../../shaders/shared/history.wgsl")),
    ("frame", include_str!("../../shaders/shared/frame.wgsl")),
    ("counts", include_str!("../../shaders/shared/counts.wgsl")),
    ("strata", include_str!("../../shaders/shared/strata.wgsl")),
    ("edge_stop", include_str!("../../shaders/shared/edge_stop.wgsl")),
    ("host_motion", include_str!("../../shaders/shared/host_motion.wgsl")),
    ("host_light", include_str!("../../shaders/shared/host_light.wgsl")),
    ("sample", include_str!("../../shaders/shared/sample.wgsl")),
    ("reproject", include_str!("../../shaders/shared/reproject.wgsl")),
    ("gloss", include_str!("../../shaders/shared/gloss.wgsl")),
    ("history_taps", include_str!("../../shaders/shared/history_taps.wgsl")),
    ("evidence", include_str!("../../shaders/shared/evidence.wgsl")),
    ("specular_history", include_str!("../../shaders/shared/specular_history.wgsl")),
    ("means", include_str!("../../shaders/shared/means.wgsl")),
    ("pairs", include_str!("../../shaders/shared/pairs.wgsl")),
    ("outliers", include_str!("../../shaders/shared/outliers.wgsl")),
    ("pair_taps", include_str!("../../shaders/shared/pair_taps.wgsl")),
    ("strata_filter", include_str!("../../shaders/shared/strata_filter.wgsl")),
    ("strata_taps", include_str!("../../shaders/shared/strata_taps.wgsl")),
    ("means_taps", include_str!("../../shaders/shared/means_taps.wgsl")),
    ("history_ratio", include_str!("../../shaders/shared/history_ratio.wgsl")),
    ("change", include_str!("../../shaders/shared/change.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("scene", include_str!("../../shaders/shared/scene.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("texture", include_str!("../../shaders/shared/texture.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("ray", include_str!("../../shaders/shared/ray.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("few_triangles", include_str!("../../shaders/shared/few_triangles.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("surface", include_str!("../../shaders/shared/surface.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("normal_map", include_str!("../../shaders/shared/normal_map.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("bent_normal", include_str!("../../shaders/shared/bent_normal.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("ggx", include_str!("../../shaders/shared/ggx.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("glass", include_str!("../../shaders/shared/glass.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("material", include_str!("../../shaders/shared/material.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("demodulation", include_str!("../../shaders/shared/demodulation.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("bsdf", include_str!("../../shaders/shared/bsdf.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("glass_scattering", include_str!("../../shaders/shared/glass_scattering.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("clearcoat", include_str!("../../shaders/shared/clearcoat.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("scattering", include_str!("../../shaders/shared/scattering.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("throughput", include_str!("../../shaders/shared/throughput.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("glass_path", include_str!("../../shaders/shared/glass_path.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("glass_shadow", include_str!("../../shaders/shared/glass_shadow.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("traverse", include_str!("../../shaders/shared/traverse.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("emitter_pieces", include_str!("../../shaders/shared/emitter_pieces.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("light", include_str!("../../shaders/shared/light.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("path", include_str!("../../shaders/shared/path.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("blended", include_str!("../../shaders/shared/blended.wgsl")),
    #[cfg(feature = "path-tracer")]
    ("blinn_phong", include_str!("../../shaders/shared/blinn_phong.wgsl")),
];

/// One shader: a pass, its features, and the numbers in its source.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) struct Permutation {
    pub pass: &'static Pass,
    pub features: Features,
    /// `STACK_SIZE` or `TRIANGLE_COUNT`, in shaders that follow rays.
    pub traversal: Traversal,
    /// `VIEW_…`, in the shader of views.
    pub view: Option<View>,
}

impl Permutation {
    /// The shader of a step, given the way in which rays find triangles.
    pub fn of(step: &Step, traversal: Traversal) -> Self {
        let traversal = if step.pass.traces { traversal } else { Traversal::default() };
        Self { pass: step.pass, features: step.features, traversal, view: step.view }
    }
}

/// The shared modules, parsed once.
pub(crate) struct Shaders(Composer);

impl Shaders {
    pub fn new() -> Result<Self, Error> {
        let mut composer = Composer::default();
        for &(name, source) in SHARED {
            let descriptor = ComposableModuleDescriptor { source, file_path: name, ..Default::default() };
            if let Err(e) = composer.add_composable_module(descriptor) {
                let message = e.emit_to_string(&composer);
                return Err(Error::Shader { shader: name, features: "nothing".into(), message });
            }
        }
        Ok(Self(composer))
    }

    pub fn compose(&mut self, permutation: Permutation) -> Result<Module, Error> {
        self.compose_source(permutation.pass.source, permutation)
    }

    /// Composes a shader from another source than the pass's own.
    pub fn compose_source(&mut self, source: &str, permutation: Permutation) -> Result<Module, Error> {
        let Permutation { pass, features, traversal, view } = permutation;
        let mut defs: HashMap<String, ShaderDefValue> =
            features.iter().map(|f| (f.define(), ShaderDefValue::Bool(true))).collect();
        match traversal {
            Traversal::Tree { stack } => defs.insert("STACK_SIZE".into(), ShaderDefValue::UInt(stack)),
            Traversal::Every { triangles } => defs.insert("TRIANGLE_COUNT".into(), ShaderDefValue::UInt(triangles)),
        };
        if let Some(view) = view {
            let name = format!("VIEW_{}", view.name().to_uppercase().replace('-', "_"));
            defs.insert(name, ShaderDefValue::Bool(true));
        }
        let descriptor =
            NagaModuleDescriptor { source, file_path: pass.name(), shader_defs: defs, ..Default::default() };
        self.0.make_naga_module(descriptor).map_err(|e| Error::Shader {
            shader: pass.name(),
            features: format!("{features:?}"),
            message: e.emit_to_string(&self.0),
        })
    }
}
