//! Measures the savings from leaving code and passes out: `cargo bench --bench leaving_out [-- FRAMES]`.
//!
//! For each scene, the rows go from everything compiled in and nothing known to be unchanged down to the least. Each
//! row has the dispatches, the bytes per pixel of the denoiser's images, the milliseconds of a frame's passes, and the
//! milliseconds of the first frame, which compiles the shaders. If the adapter is the CPU, milliseconds are processor
//! time over the number of cores. Set `MESA_SHADER_CACHE_DISABLE=1` on such an adapter: Mesa otherwise keeps compiled
//! shaders from run to run. Compare only figures of one run.
//!
//! A second table has the cost of each feature for a scene that has next to nothing of it: a speck that nobody sees.

use asvgf::scene::{
    Alpha, Environment, GpuScene, Image, Light, LightKind, Material, Mesh, Node, Scene, Texture, builtin,
};
use asvgf::{DenoiserDescriptor, FilterSettings, Frame, Gradient, Settings, Specialize};
use asvgf_fallbacks::shipped;
use asvgf_programs::film::Film;
use asvgf_programs::gpu::Gpu;
use asvgf_programs::times::{Clock, Stopwatch, median};

const SIZE: [u32; 2] = [320, 180];

/// Frames before the first that counts: the first frame takes everything for changed, and only the second knows the
/// scene to be still.
const WARM_UP: usize = 3;

/// Settings that leave something out, and the changes from frame to frame.
struct Case {
    name: &'static str,
    specialize: Specialize,
    filter: FilterSettings,
    /// One of the built-in scenes' animations.
    animation: &'static str,
}

fn cases() -> Vec<Case> {
    let filter = FilterSettings::default;
    let case = |name, specialize, filter, animation| Case { name, specialize, filter, animation };
    let constant = FilterSettings { gradient: Gradient::Off, ..filter() };
    let temporal = FilterSettings { iterations: 0, ..constant.clone() };
    let exactly = Specialize::Exactly;
    vec![
        case("everything compiled in", Specialize::Everything, filter(), "move-light"),
        case("only the scene's features", exactly, filter(), "move-light"),
        case("… only the camera moves", exactly, filter(), "move-camera"),
        case("… nothing changes", exactly, filter(), "static"),
        case("… constant α", exactly, constant, "move-light"),
        case("… and no spatial iterations", exactly, temporal.clone(), "move-light"),
        case("… and nothing changes", exactly, temporal, "static"),
    ]
}

/// A feature, and a function that adds a speck of it to a scene.
type Trait = (&'static str, fn(&mut Scene));

const TRAITS: [Trait; 8] = [
    ("… and a texture", |scene| speck(scene, textured, false, false)),
    ("… and a mask", |scene| speck(scene, |s| Material { alpha: Alpha::Mask(0.5), ..textured(s) }, false, false)),
    ("… and normals", |scene| speck(scene, |_| Material::default(), true, false)),
    ("… and a normal map", |scene| {
        speck(scene, |s| Material { normal_texture: textured(s).base_color_texture, ..textured(s) }, true, false)
    }),
    ("… and gloss", |scene| speck(scene, |_| Material { metallic: 1.0, ..Default::default() }, false, false)),
    ("… and a mesh that moves", |scene| speck(scene, |_| Material::default(), false, true)),
    ("… and a light without area", |scene| {
        scene.lights.push(Light { kind: LightKind::Point, intensity: [1e-3; 3], range: 1.0 });
        scene.nodes.push(Node { light: Some(scene.lights.len() - 1), ..Default::default() });
    }),
    ("… and light from all around", |scene| scene.environment = Some(Environment::uniform([1e-3; 3]))),
];

/// Returns a material with a white image.
fn textured(scene: &mut Scene) -> Material {
    scene.images.push(Image { name: "white".into(), width: 1, height: 1, texels: vec![[255; 4]] });
    Material { base_color_texture: Some(Texture::new(scene.images.len() - 1)), ..Default::default() }
}

/// Adds a triangle of a tenth of a millimetre, far below everything.
fn speck(scene: &mut Scene, material: fn(&mut Scene) -> Material, normals: bool, movable: bool) {
    let material = material(scene);
    scene.materials.push(material);
    scene.meshes.push(Mesh {
        positions: vec![[0.0, -99.0, 0.0], [1e-4, -99.0, 0.0], [0.0, -99.0, 1e-4]],
        normals: if normals { vec![[0.0, 1.0, 0.0]; 3] } else { Vec::new() },
        uvs: [vec![[0.0; 2]; 3], Vec::new()],
        triangles: vec![[0, 2, 1]],
        material: scene.materials.len() - 1,
        ..Default::default()
    });
    scene.nodes.push(Node { meshes: vec![scene.meshes.len() - 1], movable, ..Default::default() });
}

fn main() {
    let frames = std::env::args().filter_map(|a| a.parse().ok()).next().unwrap_or(15);
    let gpu = Gpu::new().unwrap_or_else(|e| {
        eprintln!("{e}");
        std::process::exit(1);
    });
    println!("{} ({}, {:?})", gpu.adapter.name, gpu.adapter.driver_info, gpu.adapter.backend);
    println!("{}×{}, medians of {frames} frames; {}", SIZE[0], SIZE[1], Clock::of(&gpu).name());
    for name in ["cornell", "pillars", "textured"] {
        println!("\n{name:<30}{:>11}{:>13}{:>9}{:>16}", "dispatches", "bytes/pixel", "ms", "first frame, ms");
        for case in cases() {
            // Each feature gets its own device, because lavapipe forgets shaders if a device has many.
            let gpu = Gpu::new().expect("there was an adapter");
            println!("{:<30}{}", case.name, row(&gpu, scene_of(name, case.animation), &case, frames));
        }
    }
    let cases = cases();
    let case = &cases[1];
    for name in ["cornell", "pillars"] {
        println!("\n{name}, {}", case.name);
        let alone: Trait = ("alone", |_| ());
        for (what, add) in [alone].into_iter().chain(TRAITS) {
            let gpu = Gpu::new().expect("there was an adapter");
            let mut scene = scene_of(name, case.animation);
            add(&mut scene);
            println!("{what:<30}{}", row(&gpu, scene, case, frames));
        }
    }
}

/// Returns a built-in scene or a shipped one.
fn scene_of(name: &str, animation: &str) -> Scene {
    builtin::scene(name, animation)
        .unwrap_or_else(|| shipped::load(name).expect("a shipped scene").expect("a scene that loads").scene)
}

/// Measures dispatches, bytes per pixel, and milliseconds of a frame and of the first frame.
fn row(gpu: &Gpu, scene: Scene, case: &Case, frames: usize) -> String {
    let mut uploaded = GpuScene::new(&gpu.device, &gpu.queue, &scene).expect("it fits");
    let settings = Settings { filter: case.filter.clone(), ..Settings::adaptive() };
    let descriptor = DenoiserDescriptor { size: SIZE, settings, specialize: case.specialize, ..Default::default() };
    let mut film = Film::of(gpu, descriptor).expect("a denoiser");
    let first = Stopwatch::start(Clock::of(gpu));
    let mut compiled = 0.0;
    let mut times = Vec::new();
    for index in 0..WARM_UP + frames {
        // The file has a camera that moves, and lamps; one lamp blinks here.
        let still = case.animation == "static";
        let mut pose = scene.pose(Some(0), if still { 0.0 } else { index as f32 / 30.0 });
        if case.animation == "move-light" && index % 2 == 1 {
            pose.emission.iter_mut().flatten().for_each(|factor| *factor *= 0.9);
        }
        let camera = scene.camera_node().and_then(|n| scene.camera_view(&pose, n)).expect("a camera");
        let device = &gpu.device;
        let uploaded = &mut uploaded;
        let passes = film.expose(|denoiser, encoder, target, after| {
            uploaded.update(device, encoder, &pose).expect("a pose of the scene");
            let frame = Frame { scene: uploaded, camera, index: index as u32, target };
            denoiser.stepwise(after).render(device, encoder, &frame)
        });
        times.push(passes.expect("a frame").iter().map(|(_, ms)| ms).sum());
        if index == 0 {
            compiled = first.read();
        }
    }
    let plan = film.denoiser.plan().expect("a frame was rendered");
    let bytes = film.denoiser.memory() as f64 / f64::from(SIZE[0] * SIZE[1]);
    let ms = median(times.split_off(WARM_UP));
    format!("{:>11}{bytes:>13.1}{ms:>9.1}{compiled:>16.0}", plan.steps.len())
}
