//! The traversal against that of obvhs on the CPU, over world-space triangles that this test gathers itself.

use super::gpu::gpu;
use super::random::Random;
use crate::gpu::compose::{Permutation, Shaders};
use crate::gpu::kernel::used_bindings;
use crate::passes::{SceneBinding, visibility};
use crate::plan::{Feature, Features};
use crate::scene::{GpuScene, Material, Mesh, Node, Pose, Scene, Transform, builtin};
use glam::{DMat4, DVec3, Vec3A};
use obvhs::{BvhBuildParams, bvh2::Bvh2, bvh2::builder, ray, triangle::Triangle};
use std::time::Duration;
use wgpu::util::{BufferInitDescriptor, DeviceExt};
use wgpu::{BufferUsages, ComputePipelineDescriptor, ShaderModuleDescriptor, ShaderSource};

const RAYS: usize = 100_000;

/// Relative tolerance of distances: f32 intersections in object space against others in world space.
const DISTANCE: f64 = 1e-4;

/// Tolerance as a fraction of the scene's size, because positions are rounded before their small differences are taken.
const POSITION: f64 = 3e-6;

/// Distance from an edge, in barycentric weights, within which rounding decides if a ray hits.
const EDGE: f64 = 1e-4;

struct Query {
    origin: DVec3,
    direction: DVec3,
    limit: f64,
    /// Size of the scene, in lengths of the direction.
    size: f64,
}

impl Query {
    /// Tolerance of a distance.
    fn tolerance(&self, distance: f64) -> f64 {
        DISTANCE * distance + POSITION * self.size
    }
}

/// The GPU's answer to a query.
struct Answer {
    /// `None` if nothing was hit.
    distance: Option<f64>,
    occluded: bool,
    weights: [f64; 2],
    /// Three times the centre of the triangle, which identifies it independently of its number.
    corners: DVec3,
}

/// A hit in f64.
#[derive(Clone, Copy)]
struct Truth {
    triangle: usize,
    distance: f64,
    weights: [f64; 2],
}

impl Truth {
    /// Distance from the nearest edge in barycentric weights; negative outside.
    fn margin(&self) -> f64 {
        let [u, v] = self.weights;
        u.min(v).min(1.0 - u - v)
    }
}

/// Triangles of a scene in a pose, in world space.
fn triangles(scene: &Scene, pose: &Pose) -> Vec<[DVec3; 3]> {
    let mut all = Vec::new();
    for (node, world) in scene.nodes.iter().zip(&pose.world) {
        let world = DMat4::from_cols_array_2d(world);
        for mesh in node.meshes.iter().map(|&m| &scene.meshes[m]) {
            let at = |i: u32| world.transform_point3(DVec3::from(mesh.positions[i as usize].map(f64::from)));
            all.extend(mesh.triangles.iter().map(|t| t.map(at)));
        }
    }
    all
}

/// The point where a ray meets a triangle's plane, by Cramer's rule; `None` if the plane is parallel or behind.
fn meet(query: &Query, [a, b, c]: &[DVec3; 3]) -> Option<(f64, [f64; 2])> {
    let (e1, e2, s) = (b - a, c - a, query.origin - a);
    let p = query.direction.cross(e2);
    let determinant = e1.dot(p);
    if determinant == 0.0 {
        return None;
    }
    let q = s.cross(e1);
    let distance = e2.dot(q) / determinant;
    (distance > 0.0).then_some((distance, [s.dot(p) / determinant, query.direction.dot(q) / determinant]))
}

/// All hits of a ray, edges included, nearest first.
fn all_hits(query: &Query, triangles: &[[DVec3; 3]]) -> Vec<Truth> {
    let mut hits: Vec<Truth> = triangles
        .iter()
        .enumerate()
        .filter_map(|(i, t)| meet(query, t).map(|(distance, weights)| Truth { triangle: i, distance, weights }))
        .filter(|hit| hit.margin() >= -EDGE)
        .collect();
    hits.sort_by(|a, b| a.distance.total_cmp(&b.distance));
    hits
}

/// Random rays about a scene: some along the axes, some unnormalised like a camera's.
fn queries(triangles: &[[DVec3; 3]]) -> Vec<Query> {
    let points = || triangles.iter().flatten();
    let low = points().fold(DVec3::INFINITY, |m, &p| m.min(p)).min(DVec3::ZERO);
    let high = points().fold(DVec3::NEG_INFINITY, |m, &p| m.max(p)).max(DVec3::ONE);
    let margin = 0.2 * (high - low);
    let mut random = Random(7);
    (0..RAYS)
        .map(|i| {
            let from = |axis: usize, r: &mut Random| r.between(low[axis] - margin[axis], high[axis] + margin[axis]);
            let origin = DVec3::from([0, 1, 2].map(|axis| from(axis, &mut random)));
            let direction = match i % 20 {
                0 => DVec3::AXES[random.below(3)] * if random.unit() < 0.5 { -1.0 } else { 1.0 },
                1 => DVec3::from([0, 1, 2].map(|axis| from(axis, &mut random))) - origin,
                _ => random.direction().into(),
            };
            let limit = random.between(0.0, (high - low).length());
            // The query has the precision of the GPU's.
            let narrow = |v: DVec3| v.as_vec3().as_dvec3();
            let size = (high - low).length() / direction.length();
            Query { origin: narrow(origin), direction: narrow(direction), limit: f64::from(limit as f32), size }
        })
        .collect()
}

fn ask_gpu(scene: &GpuScene, queries: &[Query]) -> Vec<Answer> {
    let gpu = gpu();
    let device = &gpu.device;
    let contents = scene.contents();
    let features = [(Feature::Instanced, contents.instanced), (Feature::FewTriangles, contents.few_triangles)];
    let features: Features = features.into_iter().filter(|(_, on)| *on).map(|(f, _)| f).collect();
    let permutation =
        Permutation { pass: &visibility::PASS, features, traversal: scene.traversal(&scene.contents()), view: None };
    let module = Shaders::new().and_then(|mut s| s.compose_source(include_str!("traversal.wgsl"), permutation));
    let module = module.unwrap_or_else(|e| panic!("{e}"));
    let used = used_bindings(&module).unwrap();
    let words: Vec<[f32; 4]> = queries
        .iter()
        .flat_map(|q| [q.origin.extend(q.limit), q.direction.extend(0.0)])
        .map(|v| v.as_vec4().to_array())
        .collect();
    let rays = device.create_buffer_init(&BufferInitDescriptor {
        label: Some("rays"),
        contents: bytemuck::cast_slice(&words),
        usage: BufferUsages::STORAGE,
    });
    let answers = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("answers"),
        size: rays.size(),
        usage: BufferUsages::STORAGE | BufferUsages::COPY_SRC,
        mapped_at_creation: false,
    });
    let module = device.create_shader_module(ShaderModuleDescriptor {
        label: Some("traversal"),
        source: ShaderSource::Naga(std::borrow::Cow::Owned(module)),
    });
    let pipeline = device.create_compute_pipeline(&ComputePipelineDescriptor {
        label: Some("traversal"),
        layout: None,
        module: &module,
        entry_point: Some("main"),
        compilation_options: Default::default(),
        cache: None,
    });
    let group = |index: u32| {
        let resource = |name: &str| match name {
            "rays" => rays.as_entire_binding(),
            "answers" => answers.as_entire_binding(),
            _ => SceneBinding::named(name)
                .and_then(|binding| scene.resource(binding))
                .unwrap_or_else(|| panic!("no `{name}`")),
        };
        let entries: Vec<_> = used
            .iter()
            .filter(|u| u.group == index)
            .map(|u| wgpu::BindGroupEntry { binding: u.binding, resource: resource(&u.name) })
            .collect();
        let layout = &pipeline.get_bind_group_layout(index);
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: None, layout, entries: &entries })
    };
    let readable = gpu.readable(answers.size());
    gpu.submit(|encoder| {
        let mut pass = encoder.begin_compute_pass(&Default::default());
        pass.set_pipeline(&pipeline);
        pass.set_bind_group(0, &group(0), &[]);
        pass.set_bind_group(1, &group(1), &[]);
        pass.dispatch_workgroups(queries.len().div_ceil(64) as u32, 1, 1);
        drop(pass);
        encoder.copy_buffer_to_buffer(&answers, 0, &readable, 0, answers.size());
    });
    let words: Vec<f32> = bytemuck::pod_collect_to_vec(&gpu.map(&readable));
    words
        .chunks_exact(8)
        .map(|w| Answer {
            distance: (w[0] >= 0.0).then_some(w[0].into()),
            occluded: w[1] != 0.0,
            weights: [w[2].into(), w[3].into()],
            corners: DVec3::new(w[4].into(), w[5].into(), w[6].into()),
        })
        .collect()
}

/// obvhs' answer: triangle and distance.
fn ask_obvhs(bvh: &Bvh2, triangles: &[Triangle], query: &Query) -> Option<(usize, f64)> {
    let ray = ray::Ray::new_inf(query.origin.as_vec3a(), query.direction.as_vec3a());
    let mut hit = ray::RayHit::none();
    let primitive = |id: usize| bvh.primitive_indices[id] as usize;
    bvh.ray_traverse(ray, &mut hit, |ray, id| triangles[primitive(id)].intersect(ray));
    (hit.primitive_id != ray::INVALID_ID).then(|| (primitive(hit.primitive_id as usize), f64::from(hit.t)))
}

/// Asserts that an answer is right up to rounding: the named triangle is there, and none is surely before it.
fn assert_right(query: &Query, answer: &Answer, triangles: &[[DVec3; 3]], what: &str) {
    let hits = all_hits(query, triangles);
    let sure = hits.iter().find(|h| h.margin() > EDGE).map_or(f64::INFINITY, |h| h.distance);
    let Some(distance) = answer.distance else {
        assert!(sure == f64::INFINITY, "{what}: a hit at {sure} was missed");
        return;
    };
    let size = answer.corners.length() + 1.0;
    let named = hits.iter().any(|h| {
        (h.distance - distance).abs() <= query.tolerance(distance)
            && triangles[h.triangle].iter().sum::<DVec3>().abs_diff_eq(answer.corners, 1e-4 * size)
    });
    assert!(named, "{what}: what was hit at {distance} is not there");
    assert!(distance <= sure + query.tolerance(sure), "{what}: {distance} lies behind a hit at {sure}");
}

/// Compares the GPU's answers with obvhs'. Where they differ, an f64 intersection with every triangle decides.
fn check(name: &str, scene: &Scene, pose: &Pose) {
    let gpu = gpu();
    let mut uploaded = GpuScene::new(&gpu.device, &gpu.queue, scene).unwrap();
    gpu.submit(|encoder| uploaded.update(&gpu.device, encoder, pose)).unwrap();
    let world = triangles(scene, pose);
    let narrow: Vec<Triangle> =
        world.iter().map(|t| t.map(|p| Vec3A::from(p.as_vec3()))).map(|[v0, v1, v2]| Triangle { v0, v1, v2 }).collect();
    let bvh = builder::build_bvh2_from_tris(&narrow, BvhBuildParams::medium_build(), &mut Duration::default());
    let queries = queries(&world);
    let mut expected = |query: &Query| if world.is_empty() { None } else { ask_obvhs(&bvh, &narrow, query) };
    if uploaded.contents().few_triangles {
        compare(&format!("{name}, each triangle"), &world, &queries, &mut expected, &ask_gpu(&uploaded, &queries));
        uploaded.use_trees();
    }
    compare(name, &world, &queries, &mut expected, &ask_gpu(&uploaded, &queries));
}

fn compare(
    name: &str,
    world: &[[DVec3; 3]],
    queries: &[Query],
    expected: &mut dyn FnMut(&Query) -> Option<(usize, f64)>,
    answers: &[Answer],
) {
    let (mut hits, mut disputed) = (0, 0);
    for (i, (query, answer)) in queries.iter().zip(answers).enumerate() {
        let what = format!("{name}, ray {i}");
        let expected = expected(query);
        hits += usize::from(expected.is_some());
        let (same_distance, same_triangle) = match (expected, answer.distance) {
            (None, None) => (true, true),
            (Some((triangle, distance)), Some(found)) => {
                let corners: DVec3 = world[triangle].iter().sum();
                let same = corners.abs_diff_eq(answer.corners, 1e-5 * (corners.length() + 1.0));
                ((distance - found).abs() <= query.tolerance(distance), same)
            }
            _ => (false, false),
        };
        // Either of two surfaces that coincide will do, such as the bottom of a block and the floor.
        disputed += usize::from(!same_distance);
        if !(same_distance && same_triangle) {
            assert_right(query, answer, world, &what);
        }
        // The weights lead to the point on the ray.
        if answer.distance.is_some() {
            let [u, v] = answer.weights;
            assert!(u >= 0.0 && v >= 0.0 && u + v <= 1.0 + 1e-6, "{what}: weights {u}, {v}");
        }
        // The any-hit query finds a hit before its limit, unless the nearest hit is at the limit.
        let distance = answer.distance.unwrap_or(f64::INFINITY);
        let undecided = (distance - query.limit).abs() <= query.tolerance(query.limit);
        assert!(
            undecided || answer.occluded == (distance < query.limit),
            "{what}: nearest hit at {distance}; any before {}? {}",
            query.limit,
            answer.occluded
        );
    }
    println!("{name}: {} triangles, {hits} of {RAYS} rays hit, {disputed} decided in f64", world.len());
    assert!(disputed <= RAYS / 1000, "{name}: {disputed} answers differ");
    assert!(hits > RAYS / 100 || world.len() < 2, "{name}: only {hits} hits");
}

fn check_built_in(name: &str, animation: &str, time: f32) {
    let scene = builtin::scene(name, animation).unwrap();
    check(&format!("{name} {animation}"), &scene, &scene.pose(Some(0), time));
}

fn triangle_scene(positions: Vec<[f32; 3]>) -> Scene {
    let triangles = (0..positions.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Scene {
        materials: vec![Material::default()],
        meshes: vec![Mesh { positions, triangles, ..Default::default() }],
        nodes: vec![Node { meshes: vec![0], ..Default::default() }],
        ..Default::default()
    }
}

/// Triangles of many sizes (powers of 10 between these) anywhere.
fn soup(count: usize, sizes: [f64; 2]) -> Vec<[f32; 3]> {
    let mut random = Random(3);
    (0..count)
        .flat_map(|_| {
            let centre = [0; 3].map(|_| random.between(-5.0, 5.0));
            let size = 10.0_f64.powf(random.between(sizes[0], sizes[1]));
            [0; 3].map(|_| {
                let d = random.direction();
                [0, 1, 2].map(|i| (centre[i] + size * d[i]) as f32)
            })
        })
        .collect()
}

#[test]
fn a_scene_of_one_level() {
    check_built_in("cornell", "static", 0.0);
}

#[test]
fn scenes_of_two_levels_that_have_moved() {
    check_built_in("cornell", "all", 1.3);
    check_built_in("pillars", "all", 2.9);
}

#[test]
fn a_soup_of_triangles() {
    let scene = triangle_scene(soup(5000, [-2.0, 0.3]));
    check("soup", &scene, &scene.pose(None, 0.0));
}

#[test]
fn a_thousand_instances_mirrored_and_stretched() {
    let mut scene = triangle_scene(soup(12, [-2.0, 0.3]));
    scene.nodes.clear();
    let mut random = Random(11);
    for _ in 0..1000 {
        let d = random.direction();
        let angle = random.between(0.0, 3.0);
        let (s, c) = (angle / 2.0).sin_cos();
        let rotation = [d[0] * s, d[1] * s, d[2] * s, c].map(|x| x as f32);
        let scale =
            [0; 3].map(|_| random.between(0.05, 0.4) * if random.unit() < 0.5 { -1.0 } else { 1.0 }).map(|x| x as f32);
        let translation = [0; 3].map(|_| random.between(-10.0, 10.0) as f32);
        let transform = Transform::Trs { translation, rotation, scale };
        scene.nodes.push(Node { meshes: vec![0], transform, ..Default::default() });
    }
    let pose = scene.pose(None, 0.0);
    assert!(GpuScene::new(&gpu().device, &gpu().queue, &scene).unwrap().contents().instanced);
    check("instances", &scene, &pose);
}

/// The stack of the shader is that of the pose at rest. Instances that gather at one place must not need a longer one.
#[test]
fn instances_that_gather_at_one_place() {
    // All boxes are equal, so that obvhs makes a chain of them; each holds another triangle, so that none may be lost.
    let corner = |x: f32| [[x, x, x], [x, x, 0.99 * x], [x, 0.99 * x, x]];
    let triangles = soup(400, [-0.5, 0.3]);
    let meshes = triangles.chunks_exact(3).map(|triangle| {
        let positions = [triangle, &corner(-8.0), &corner(8.0)].concat();
        Mesh { positions, triangles: vec![[0, 1, 2], [3, 4, 5], [6, 7, 8]], ..Default::default() }
    });
    let meshes: Vec<Mesh> = meshes.collect();
    let nodes = (0..meshes.len()).map(|i| {
        let translation = [(i % 20) as f32 - 9.5, (i / 20) as f32 - 9.5, 0.0].map(|x| 20.0 * x);
        let transform = Transform::Trs { translation, rotation: [0.0, 0.0, 0.0, 1.0], scale: [1.0; 3] };
        Node { meshes: vec![i], transform, movable: true, ..Default::default() }
    });
    let nodes = nodes.collect();
    let scene = Scene { materials: vec![Material::default()], meshes, nodes, ..Default::default() };
    let mut pose = scene.pose(None, 0.0);
    pose.world.fill(DMat4::IDENTITY.to_cols_array_2d());
    check("gathered instances", &scene, &pose);
}

#[test]
fn as_many_triangles_as_are_tested_one_by_one_and_one_more() {
    for count in [3, 8, 9, 64, 65] {
        let scene = triangle_scene(soup(count, [0.0, 0.6]));
        check(&format!("{count} triangles"), &scene, &scene.pose(None, 0.0));
    }
}

#[test]
fn one_triangle_and_none() {
    let one = triangle_scene(vec![[0.0, 0.0, 0.0], [1.0, 0.2, 0.0], [0.3, 1.0, 0.5]]);
    check("one", &one, &one.pose(None, 0.0));
    let none = triangle_scene(Vec::new());
    check("none", &none, &none.pose(None, 0.0));
    check("nothing at all", &Scene::default(), &Scene::default().pose(None, 0.0));
}
