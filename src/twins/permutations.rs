//! Every shader that a scene and settings can ask for compiles, within core WebGPU and the default limits, and asks for exactly the
//! bindings that its step names.

use crate::gpu::compose::{Permutation, Shaders};
use crate::gpu::kernel::Kernel;
use crate::gpu::resource::Resource;
use crate::plan::{Changes, Feature, Features, HostInputs, PairInputs, Plan, SceneContents, Step, Traversal};
use crate::scene::{Environment, GpuScene, IDENTITY, Influence, Node, Scene, Skin, builtin};
use crate::settings::{Blend, FilterSettings, Gradient, Mode, Sampling, Settings, Stops, TracerSettings, Variance};
use crate::{Error, View};
use std::collections::{BTreeMap, BTreeSet};
use wgpu::{BackendOptions, Backends, Device, DeviceDescriptor, Instance, InstanceDescriptor, Queue, TextureFormat};

/// wgpu's validation without any GPU.
fn noop_device() -> (Device, Queue) {
    let noop = wgpu::NoopBackendOptions { enable: true, ..Default::default() };
    let instance = Instance::new(InstanceDescriptor {
        backends: Backends::NOOP,
        backend_options: BackendOptions { noop, ..Default::default() },
        ..InstanceDescriptor::new_without_display_handle()
    });
    let adapter = pollster::block_on(instance.request_adapter(&Default::default())).unwrap();
    pollster::block_on(adapter.request_device(&DeviceDescriptor::default())).unwrap()
}

/// All combinations of contents. The test checks some 150 shaders a second, and all in a quarter of a minute.
fn contents() -> Vec<SceneContents> {
    (0_u32..1 << 17)
        // Only images may be folded. Folding changes one function, so it is combined with a part of the rest.
        .filter(|bits| bits >> 12 & 1 == 0 || bits >> 1 & 1 == 1 && bits & 0b1101_0110_0000 == 0)
        // There is no alpha mask if each triangle is tested.
        .filter(|bits| bits >> 4 & 1 == 0 || bits >> 9 & 1 == 0)
        // Colours of vertices are independent of the kinds of light.
        .filter(|bits| bits >> 10 & 1 == 0 || bits >> 5 & 15 == 15)
        // A blended material has an opacity to test; the normals are independent of it.
        .filter(|bits| bits >> 11 & 1 == 0 || bits >> 4 & 1 == 1 && bits >> 2 & 3 == 3)
        // Normal maps are images on meshes with normals, and independent of the kinds of light.
        .filter(|bits| bits >> 13 & 1 == 0 || bits >> 1 & 3 == 3 && bits >> 5 & 15 == 15)
        // Glass shines; images and colours are independent of it.
        .filter(|bits| bits >> 14 & 1 == 0 || bits >> 1 & 7 == 6 && bits >> 9 & 0b1_1011 == 0)
        // A mesh that changes its shape is an instance. It changes one function, so it is combined with a part of the rest.
        .filter(|bits| bits >> 15 & 1 == 0 || bits & 1 == 1 && bits >> 5 & 15 == 15 && bits >> 10 & 15 == 0)
        // A coat shines; it depends on images, normal maps and glass alone.
        .filter(|bits| bits >> 16 & 1 == 0 || bits >> 2 & 3 == 3 && bits >> 5 & 15 == 15 && bits >> 9 & 0b100_1111 == 0)
        .map(|bits| {
            let bit = |i: u32| bits >> i & 1 == 1;
            SceneContents {
                instanced: bit(0),
                textures: bit(1),
                shading_normals: bit(2),
                specular: bit(3),
                alpha_mask: bit(4),
                emitters: bit(5),
                emitter_pieces: bit(5) && bit(1) && bit(2),
                punctual_lights: bit(6),
                environment: bit(7),
                unlit: bit(8),
                few_triangles: bit(9),
                vertex_colors: bit(10),
                alpha_blend: bit(11),
                folded_images: bit(12),
                normal_maps: bit(13),
                transmission: bit(14),
                clear_glass: bit(14) && bit(5),
                deforming: bit(15),
                clearcoat: bit(16),
                ..Default::default()
            }
        })
        .collect()
}

fn product<A: Clone, B: Clone>(a: &[A], b: &[B]) -> Vec<(A, B)> {
    a.iter().flat_map(|a| b.iter().map(|b| (a.clone(), b.clone()))).collect()
}

const GRADIENTS: [Gradient; 4] = [Gradient::Reshade, Gradient::Statistics, Gradient::BlinnPhong, Gradient::Off];
const HOST_GRADIENTS: [Gradient; 5] =
    [Gradient::Reshade, Gradient::Pairs, Gradient::Statistics, Gradient::Lambda, Gradient::Off];
const SAMPLINGS: [Sampling; 3] = [Sampling::Both, Sampling::Lights, Sampling::Scattered];
const MODES: [Mode; 3] = [Mode::Denoise, Mode::Noisy, Mode::Reference];
const CHANGES: [Changes; 3] = [Changes::ANY, Changes { camera: true, scene: false }, Changes::NONE];
const TARGETS: [TextureFormat; 2] = [TextureFormat::Rgba16Float, TextureFormat::Rgba32Float];

/// All combinations of a host's inputs.
fn host_inputs() -> Vec<HostInputs> {
    (0_u32..1 << 11)
        .flat_map(|bits| {
            let bit = move |i: u32| bits >> i & 1 == 1;
            // The five forms of normals are direct, mapped, octahedral, both, packed.
            (0..5).map(move |normal| HostInputs {
                octahedral_normals: normal == 2 || normal == 3,
                mapped_normals: normal == 1 || normal == 3,
                packed_normals: normal == 4,
                previous_depth: bit(0),
                instances: bit(1),
                float_instances: bit(1) && bit(2),
                albedo: bit(3),
                emission: bit(4),
                demodulated: bit(5),
                pairs: Some(PairInputs { luminance: bit(6), per_stratum: bit(7), in_place: bit(8) && !bit(7) }),
                lambda: false,
                confidence: bit(9),
                diagnostics: bit(10),
                views: false,
                in_target: false,
                ..Default::default()
            })
        })
        .collect()
}

/// All filters that differ in the compiled code.
fn filters(gradients: &[Gradient]) -> Vec<FilterSettings> {
    let switches = |bits: u32| {
        let on = |i: u32| bits >> i & 1 == 1;
        FilterSettings {
            history_ratio: on(0),
            blend: if on(1) { Blend::Lambda } else { Blend::HistoryLength },
            feedback: on(2),
            variance: if on(3) { Variance::OfSample } else { Variance::OfMean },
            stops: if on(4) { Stops::Classic } else { Stops::NoiseSubtracted },
            kernel: if on(5) { crate::Kernel::Full } else { crate::Kernel::Diamond },
            local_linear_fit: on(6),
            gradient_signed: on(7),
            gradient_across_surfaces: on(6),
            ridge_noise: if on(5) { 1.5 } else { 0.0 },
            final_iteration: on(7),
            steadiness: if on(3) { 0.9 } else { 0.0 },
            outlier_limit: if on(9) { 40.0 } else { 0.0 },
            iterations: if on(8) { 5 } else { 0 },
            gradient_iterations: if on(9) { 3 } else { 0 },
            gloss_clamp: if on(6) { 3.0 } else { 0.0 },
            gloss: on(7),
            ..Default::default()
        }
    };
    product(gradients, &(0..1 << 10).collect::<Vec<_>>())
        .into_iter()
        .map(|(gradient, bits)| FilterSettings { gradient, ..switches(bits) })
        .collect()
}

/// Plans whose steps cover all reachable shaders: tracing depends on contents, sampling and gradient alone, filtering on the filter
/// and on the presence of objects.
fn plans() -> Vec<Plan> {
    let mut plans = Vec::new();
    for (contents, (sampling, gradient)) in product(&contents(), &product(&SAMPLINGS, &GRADIENTS)) {
        for (mode, target) in product(&MODES, &TARGETS) {
            let settings = Settings {
                mode,
                filter: FilterSettings { gradient, ..Default::default() },
                tracer: TracerSettings { sampling, ..Default::default() },
            };
            let plan = Plan::path_traced(&contents, &settings, Changes::ANY, target);
            if (sampling, gradient, mode) == (Sampling::Both, Gradient::Reshade, Mode::Denoise) {
                plans.push(plan.clone().on_cpu());
            }
            plans.push(plan);
        }
    }
    // The paths of a frame take one dispatch, two, or more.
    for (contents, samples) in product(&contents(), &[1, 40, 1000]) {
        let tracer = TracerSettings { samples, ..Default::default() };
        let contents = SceneContents { levels: 12, ..contents };
        let settings = Settings { tracer, ..Settings::adaptive() };
        plans.push(Plan::path_traced(&contents, &settings, Changes::ANY, TARGETS[1]));
    }
    for ((instanced, views), filter) in product(&product(&[false, true], &[false, true]), &filters(&GRADIENTS)) {
        let settings = Settings { filter, ..Settings::adaptive() };
        let contents = SceneContents { instanced, views, specular: instanced, ..Default::default() };
        for changes in CHANGES {
            let plan = Plan::path_traced(&contents, &settings, changes, TextureFormat::Rgba32Float);
            plans.push(plan.clone().on_cpu());
            plans.push(plan);
        }
    }
    plans
}

/// Such plans for hosts' frames: taking them in depends on the inputs and the gradient; filtering depends on the filter, on the
/// presence of objects, and on the kind of pairs or λ.
fn host_plans() -> Vec<Plan> {
    let mut plans = Vec::new();
    for (inputs, gradient) in product(&host_inputs(), &HOST_GRADIENTS) {
        let settings = Settings { filter: FilterSettings { gradient, ..Default::default() }, ..Settings::adaptive() };
        for changes in CHANGES {
            plans.push(Plan::hosted(&inputs, &settings, changes, TextureFormat::Rgba32Float));
        }
    }
    // Gloss: any subset of what is known of it, with light apart or not, albedo or not.
    for (bits, gradient) in product(&(0_u32..1 << 11).collect::<Vec<_>>(), &HOST_GRADIENTS) {
        let bit = |i: u32| bits >> i & 1 == 1;
        let inputs = HostInputs {
            diagnostics: bit(10),
            specular: bit(0),
            reflectance: bit(1),
            roughness: bit(2),
            roughness_in_alpha: bit(2) && bit(3),
            hit_distance: bit(0) && bit(4),
            reflection_motion: bit(0) && bit(5),
            albedo: bit(6),
            demodulated: bit(7),
            views: bit(8),
            previous_depth: bit(9),
            instances: bit(9),
            emission: bit(9),
            specular_pairs: bit(5).then(PairInputs::default),
            pairs: bit(4).then(PairInputs::default),
            ..Default::default()
        };
        let filter = FilterSettings { gradient, ..Default::default() };
        for (mode, changes) in
            [(Mode::Denoise, Changes::ANY), (Mode::Denoise, Changes::NONE), (Mode::Noisy, Changes::ANY)]
        {
            let settings = Settings { mode, filter: filter.clone(), ..Settings::adaptive() };
            let plan = Plan::hosted(&inputs, &settings, changes, TextureFormat::Rgba16Float);
            plans.push(if bit(8) { plan.on_cpu() } else { plan });
        }
    }
    // Combine the host's own images with copies of some or all.
    for (bits, (mode, target)) in product(&(0_u32..1 << 6).collect::<Vec<_>>(), &product(&MODES, &TARGETS)) {
        let bit = |i: u32| bits >> i & 1 == 1;
        let inputs = HostInputs {
            albedo: bit(0),
            emission: bit(1),
            demodulated: bit(2),
            previous_depth: bit(3),
            views: bit(4),
            in_target: bit(5),
            ..Default::default()
        };
        for gradient in HOST_GRADIENTS {
            let filter = FilterSettings { gradient, ..Default::default() };
            let settings = Settings { mode, filter, ..Settings::adaptive() };
            plans.push(Plan::hosted(&inputs, &settings, Changes::ANY, target));
        }
    }
    for (instances, (marked, filter)) in product(&[false, true], &product(&[false, true], &filters(&HOST_GRADIENTS))) {
        let pairs = Some(PairInputs { in_place: marked, ..Default::default() });
        let inputs = HostInputs { instances, pairs, confidence: marked, ..Default::default() };
        // With specular light apart, and with all light in one radiance of which something is known.
        for specular in [true, false] {
            let gloss = HostInputs { specular, specular_pairs: pairs, reflectance: true, roughness: true, ..inputs };
            let settings = Settings { filter: filter.clone(), ..Settings::adaptive() };
            for changes in CHANGES {
                plans.push(Plan::hosted(&gloss, &settings, changes, TextureFormat::Rgba32Float));
            }
        }
        let settings = Settings { filter, ..Settings::adaptive() };
        plans.push(Plan::hosted(&inputs, &settings, Changes::ANY, TextureFormat::Rgba32Float));
    }
    plans
}

/// Every different shader with a step that asks for it.
pub(super) fn steps() -> BTreeMap<Permutation, Step> {
    let formats = [TextureFormat::Rgba8Unorm, TextureFormat::Rgba16Float, TextureFormat::Rgba32Float];
    let mut steps = BTreeMap::new();
    let mut add = |step: Step| {
        let traversal = if step.features.has(Feature::FewTriangles) {
            Traversal::Every { triangles: 24 }
        } else {
            Traversal::Tree { stack: 32 }
        };
        steps.entry(Permutation::of(&step, traversal)).or_insert(step);
    };
    for plan in plans().into_iter().chain(host_plans()) {
        for (view, format) in product(View::ALL, &formats) {
            match plan.show(view, format, |_| true) {
                Ok(step) => add(step),
                Err(Error::NoView { .. }) => {}
                Err(e) => panic!("{e}"),
            }
        }
        plan.steps.into_iter().for_each(&mut add);
    }
    steps
}

/// Every shader for each size of stack and each number of few triangles, in a scene that has everything.
pub(super) fn traversals() -> BTreeMap<Permutation, Step> {
    let stacks = [4, 64].map(|stack| Traversal::Tree { stack });
    let counts = [8, 16, 24, 32, 40, 48, 56, 64].map(|triangles| Traversal::Every { triangles });
    let mut steps = BTreeMap::new();
    for traversal in stacks.into_iter().chain(counts) {
        let few_triangles = matches!(traversal, Traversal::Every { .. });
        let contents = SceneContents {
            instanced: true,
            shading_normals: true,
            normal_maps: true,
            environment: true,
            alpha_mask: !few_triangles,
            few_triangles,
            ..SceneContents::default().everything()
        };
        let plan = Plan::path_traced(&contents, &Settings::adaptive(), Changes::ANY, TextureFormat::Rgba32Float);
        for step in plan.steps.into_iter().filter(|step| step.pass.traces) {
            steps.insert(Permutation::of(&step, traversal), step);
        }
    }
    steps
}

fn check(device: &Device, scene: &GpuScene, shaders: &mut Shaders, permutation: Permutation, step: &Step) {
    let what = format!("{} with {:?}", permutation.pass.name(), permutation.features);
    let scope = device.push_error_scope(wgpu::ErrorFilter::Validation);
    let module = shaders.compose(permutation).unwrap_or_else(|e| panic!("{e}"));
    let kernel = Kernel::new(device, module, step).unwrap_or_else(|e| panic!("{e}"));
    if let Some(error) = pollster::block_on(scope.pop()) {
        panic!("{what}: {error}");
    }
    let mut used = BTreeSet::new();
    for resource in kernel.resources() {
        match resource {
            Resource::Image(number) => assert!(used.insert(number), "{what}: {:?} twice", step.bindings[number]),
            Resource::Scene(binding) => {
                let there = scene.resource(binding).is_some() || scene.snapshot().resource(binding).is_some();
                assert!(there, "{what}: the scene has no {binding:?}");
            }
            Resource::Frame | Resource::Stride | Resource::Show | Resource::Counts => {}
        }
    }
    let unused: Vec<_> = (0..step.bindings.len()).filter(|number| !used.contains(number)).collect();
    let unused: Vec<_> = unused.into_iter().map(|number| step.bindings[number].name).collect();
    assert!(unused.is_empty(), "{what}: its shader does not use {unused:?}");
    let names: BTreeSet<_> = step.bindings.iter().map(|bound| bound.name).collect();
    assert_eq!(names.len(), step.bindings.len(), "{what}: a name is bound twice");
}

#[test]
fn every_reachable_permutation_compiles_and_binds_what_its_step_names() {
    let (device, queue) = noop_device();
    let sky = Some(Environment::uniform([1.0; 3]));
    let mut scene = Scene { environment: sky, ..builtin::scene("cornell", "static").unwrap() };
    // A node that moves is the joint of a skin.
    let joint = scene.nodes.len();
    scene.nodes.push(Node { movable: true, ..Default::default() });
    scene.skins.push(Skin { joints: vec![joint], inverse_bind: vec![IDENTITY] });
    scene.nodes[0].skin = Some(0);
    let mesh = &mut scene.meshes[scene.nodes[0].meshes[0]];
    mesh.influences = vec![Influence { joint: 0, weight: 1.0 }; mesh.positions.len()];
    let scene = GpuScene::new(&device, &queue, &scene).unwrap();
    let mut shaders = Shaders::new().unwrap_or_else(|e| panic!("{e}"));
    let steps = steps();
    let mut counts = BTreeMap::<&str, usize>::new();
    for (&permutation, step) in &steps {
        check(&device, &scene, &mut shaders, permutation, step);
        *counts.entry(permutation.pass.name()).or_default() += 1;
    }
    println!("{counts:?}");
    assert_eq!(counts.len(), 28, "a pass is never run: {counts:?}");
    let reached: Features = steps.keys().flat_map(|permutation| permutation.features.iter()).collect();
    // Statistics decide which passes run, and nothing within them.
    let reached = reached.with(Feature::Statistics);
    let unreached: Vec<_> = Feature::ALL.iter().filter(|feature| !reached.has(**feature)).collect();
    assert!(unreached.is_empty(), "never compiled in: {unreached:?}");
}

#[test]
fn every_size_of_stack_and_of_few_triangles_compiles() {
    let (device, queue) = noop_device();
    let sky = Some(Environment::uniform([1.0; 3]));
    let scene = Scene { environment: sky, ..builtin::scene("pillars", "all").unwrap() };
    let scene = GpuScene::new(&device, &queue, &scene).unwrap();
    let mut shaders = Shaders::new().unwrap_or_else(|e| panic!("{e}"));
    for (permutation, step) in traversals() {
        check(&device, &scene, &mut shaders, permutation, &step);
    }
}
