//! A feature that a plan leaves out is absent from its shaders, as naga sees them, from its bindings and from its memory.

use crate::gpu::compose::{Permutation, Shaders};
use crate::passes::{Pass, resolve, temporal, trace, visibility};
use crate::plan::{Changes, Feature, Features, Plan, SceneContents, Step, Traversal};
use crate::{FilterSettings, Gradient, Settings};
use std::collections::BTreeSet;
use wgpu::TextureFormat;
use wgpu::naga::Module;

/// A scene with everything except few triangles.
const ALL: SceneContents = SceneContents {
    instanced: true,
    deforming: true,
    textures: true,
    folded_images: false,
    shading_normals: true,
    normal_maps: true,
    vertex_colors: true,
    specular: true,
    transmission: true,
    clearcoat: true,
    clear_glass: true,
    matte: false,
    alpha_mask: true,
    alpha_blend: true,
    emitters: true,
    emitter_pieces: true,
    punctual_lights: true,
    environment: true,
    environment_run: 1,
    unlit: true,
    few_triangles: false,
    levels: 8,
    views: false,
};

fn plan(contents: &SceneContents, filter: FilterSettings, changes: Changes) -> Plan {
    Plan::path_traced(contents, &Settings { filter, ..Settings::adaptive() }, changes, TextureFormat::Rgba32Float)
}

fn compose(shaders: &mut Shaders, step: &Step) -> Module {
    let traversal = Traversal::Tree { stack: 8 };
    shaders.compose(Permutation::of(step, traversal)).unwrap_or_else(|e| panic!("{e}"))
}

/// Names of all functions and bindings of a shader.
fn names(module: &Module) -> BTreeSet<&str> {
    let functions = module.functions.iter().filter_map(|(_, f)| f.name.as_deref());
    let globals = module.global_variables.iter().filter_map(|(_, v)| v.name.as_deref());
    functions.chain(globals).map(|name| name.split("X_naga_oil").next().unwrap_or(name)).collect()
}

/// The amount of code, as the number of expressions.
fn expressions(module: &Module) -> usize {
    let entries = module.entry_points.iter().map(|entry| entry.function.expressions.len());
    entries.chain(module.functions.iter().map(|(_, f)| f.expressions.len())).sum()
}

/// A step with a feature, and the step of the same pass without it.
fn pair<'a>(with: &'a Plan, without: &'a Plan, pass: &Pass) -> [&'a Step; 2] {
    [with, without]
        .map(|plan| plan.steps.iter().find(|step| step.pass == pass).unwrap_or_else(|| panic!("no {pass:?}")))
}

/// Asserts that a step has less code without the feature, and lacks exactly these functions and bindings.
fn assert_leaner(shaders: &mut Shaders, [with, without]: [&Step; 2], lost: &[&str]) {
    let [with, lean] = [with, without].map(|step| compose(shaders, step));
    let what = format!("{:?} with {:?}", without.pass, without.features);
    let found: Vec<_> = names(&with).difference(&names(&lean)).copied().collect();
    assert_eq!(found, lost, "{what}: what is gone");
    assert!(names(&lean).is_subset(&names(&with)), "{what}: nothing takes its place");
    let [before, after] = [&with, &lean].map(expressions);
    println!("{what}: {before} → {after} expressions");
    assert!(after < before, "{what}: no code is gone");
}

#[test]
fn what_a_scene_does_not_have_is_not_in_its_shaders() {
    let mut shaders = Shaders::new().unwrap_or_else(|e| panic!("{e}"));
    let everything = plan(&ALL, FilterSettings::default(), Changes::ANY);
    let shapes = ["corner_before", "corners_previous", "instance_corners"];
    let moving = [
        "instance_error",
        "instance_grid",
        "instance_numbers",
        "instance_record",
        "object_to_world",
        "pack_displacement",
        "placements_previous",
        "previous_object_to_world",
        "stored_triangle_before",
        "transform_normal",
        "transform_point",
        "transform_vector",
        "triangle_before",
        "world_to_object",
    ];
    let mut moving = [&shapes[..], &moving[..]].concat();
    moving.sort_unstable();
    let images = &["exists", "sample_texture", "srgb_to_linear", "texel", "texture_coordinates", "wrap"][..];
    let blending = [
        "belongs_to_neighbour",
        "blended_albedo",
        "cover_at_random",
        "cover_from",
        "coverage",
        "coverage_seed",
        "covered_at",
        "descends",
        "is_blended",
        "passes_through",
        "start_of_path",
        "whole_demodulation",
    ];
    let mut opacity = [&blending[..], &["emitting_part", "is_hole", "meets_back", "opacity_at"]].concat();
    opacity.sort_unstable();
    let sky = &["environment", "environment_density", "environment_table", "environment_texel", "texel_radiance"][..];
    let maps = ["load_normal_map", "mapped_normal", "normal_from", "tangent_at", "unpack_tangent"];
    let mut images = [&maps[..], images].concat();
    images.sort_unstable();
    let normals = ["interpolated_normal", "octahedral", "transform_normal", "unpack_octahedral"];
    let mut normals = [&maps[..], &normals[..]].concat();
    normals.sort_unstable();
    let glass = [
        "absorbed",
        "add_light_sample",
        "arriving_part",
        "begin_shadow",
        "body_before",
        "boundaries",
        "dielectric",
        "enter",
        "entered",
        "eye",
        "facets",
        "follows",
        "glass_scattering",
        "goes_through",
        "grazing_part",
        "is_clear",
        "is_glass",
        "is_refracted",
        "lambert_share",
        "leave",
        "load_glass",
        "matte",
        "met_glass",
        "narrow",
        "optical_depth",
        "origin_towards",
        "refracting_facet",
        "sample_glass",
        "seen",
        "seen_previous",
        "sees_through",
        "split",
        "straight_part",
        "straight_through",
        "sum",
        "ways_behind",
    ];
    let coat = ["choice_below", "coat_density", "coat_share", "coated", "load_coat", "sample_coat"];
    let mut shine = [
        &glass[..],
        &coat[..],
        &[
            "diffuse_reflectance",
            "distribution",
            "fresnel",
            "is_mirrored",
            "mirroring_facet",
            "of_lobe",
            "other_side",
            "pack_displacement",
            "reflecting_normal",
            "sample_visible_normal",
            "seen_from",
            "smith",
            "specular_demodulation",
            "specular_radiance_out",
            "specular_share",
            "to_world",
            "visible_normals",
        ],
    ]
    .concat();
    shine.sort_unstable();
    let cases: [(SceneContents, &[&str]); 16] = [
        (SceneContents { instanced: false, deforming: false, ..ALL }, &moving),
        (SceneContents { deforming: false, ..ALL }, &shapes),
        (SceneContents { textures: false, normal_maps: false, ..ALL }, &images),
        (SceneContents { shading_normals: false, normal_maps: false, ..ALL }, &normals),
        (SceneContents { normal_maps: false, ..ALL }, &maps),
        (SceneContents { vertex_colors: false, ..ALL }, &["corner_color", "vertex_color"]),
        (SceneContents { specular: false, transmission: false, clear_glass: false, clearcoat: false, ..ALL }, &shine),
        (SceneContents { clearcoat: false, ..ALL }, &coat),
        (SceneContents { transmission: false, clear_glass: false, ..ALL }, &glass),
        (
            SceneContents { clear_glass: false, ..ALL },
            &["follows", "is_clear", "seen", "seen_previous", "sees_through"],
        ),
        (SceneContents { alpha_mask: false, alpha_blend: false, ..ALL }, &opacity),
        (SceneContents { alpha_blend: false, ..ALL }, &blending),
        (
            SceneContents { emitters: false, ..ALL },
            &["emitter_density", "emitting_part", "even_density", "piece_density", "piece_entry", "sample_piece"],
        ),
        (SceneContents { emitter_pieces: false, ..ALL }, &["piece_density", "piece_entry", "sample_piece"]),
        (SceneContents { punctual_lights: false, ..ALL }, &[]),
        (SceneContents { environment: false, ..ALL }, sky),
    ];
    for (contents, lost) in cases {
        let lean = plan(&contents, FilterSettings::default(), Changes::ANY);
        assert_leaner(&mut shaders, pair(&everything, &lean, &trace::PASS), lost);
    }
}

#[test]
fn what_the_settings_and_the_frame_do_not_ask_for_is_not_in_the_shaders() {
    let mut shaders = Shaders::new().unwrap_or_else(|e| panic!("{e}"));
    let adaptive = plan(&ALL, FilterSettings::default(), Changes::ANY);
    let off = FilterSettings { gradient: Gradient::Off, ..Default::default() };
    let constant = plan(&ALL, off.clone(), Changes::ANY);
    let still = plan(&ALL, off, Changes::NONE);
    let [with, without] = pair(&adaptive, &constant, &temporal::PASS);
    for binding in ["samples", "gradient", "ratio"] {
        assert!(names(&compose(&mut shaders, with)).contains(binding), "{binding}");
        assert!(!names(&compose(&mut shaders, without)).contains(binding), "{binding}");
    }
    for binding in ["guide_previous", "motion", "object", "object_previous"] {
        let [with, without] = pair(&constant, &still, &temporal::PASS);
        assert!(names(&compose(&mut shaders, with)).contains(binding), "{binding}");
        assert!(!names(&compose(&mut shaders, without)).contains(binding), "{binding}");
    }
    // A frame in which nothing changed runs the same passes as a constant α.
    let quiet = plan(&ALL, FilterSettings::default(), Changes { camera: true, scene: false });
    let passes = |plan: &Plan| plan.steps.iter().map(|step| step.pass).collect::<Vec<_>>();
    assert_eq!(passes(&quiet), passes(&constant));
    assert_eq!(
        adaptive.steps.len() - quiet.steps.len(),
        15,
        "sample, pairs, 3 × their filter, gradient, 2 × its filter, and all but the first again for specular light"
    );
    let bare = FilterSettings { iterations: 0, gradient: Gradient::Off, outlier_limit: 0.0, ..Default::default() };
    let bare = plan(&SceneContents::default(), bare, Changes::ANY);
    assert_eq!(passes(&bare), [&visibility::PASS, &trace::PASS, &temporal::PASS, &resolve::PASS]);
    let size = [1920, 1080];
    let bytes = [&adaptive, &constant, &bare].map(|plan| plan.bytes(size, false));
    assert!(bytes[0] > bytes[1] && bytes[1] > bytes[2], "{bytes:?}");
}

#[test]
fn every_decision_has_a_reason_and_is_carried_out() {
    for (contents, changes) in [(ALL, Changes::ANY), (SceneContents::default(), Changes::ANY), (ALL, Changes::NONE)] {
        let plan = plan(&contents, FilterSettings::default(), changes);
        let mut decided = BTreeSet::new();
        for decision in &plan.decisions {
            assert!(!decision.reason.is_empty(), "{decision:?}");
            assert!(decided.insert(decision.feature), "{:?} is decided twice", decision.feature);
            assert_eq!(plan.features.has(decision.feature), decision.included, "{decision:?}");
        }
        let compiled: Features = plan.steps.iter().flat_map(|step| step.features.iter()).collect();
        let own = Features::of(&[Feature::FirstIteration, Feature::SpecularSignal]);
        let undecided = compiled.iter().filter(|f| !own.has(*f) && !decided.contains(f)).collect::<Vec<_>>();
        assert!(undecided.is_empty(), "{undecided:?} are in for no reason");
    }
}

#[test]
fn a_plan_can_be_read() {
    let plan = plan(&SceneContents::default(), FilterSettings::default(), Changes::ANY);
    let table = plan.to_string();
    for expected in [
        format!("{} dispatches", plan.steps.len()).as_str(),
        "no material has an image",
        "last history",
        " → reprojected, history",
        "atrous",
    ] {
        assert!(table.contains(expected), "`{expected}` is not in\n{table}");
    }
    let graph = plan.graph();
    assert!(graph.starts_with("flowchart TD\n"), "{graph}");
    for expected in [
        "atrous[\"atrous ×5\"]:::pass",
        "i_last_history --> temporal",
        "temporal --> i_history",
        "resolve --> i_target",
    ] {
        assert!(graph.contains(expected), "`{expected}` is not in\n{graph}");
    }
}
