//! Growth of cost with pixels and with triangles.

use crate::film::Film;
use crate::gpu::Gpu;
use crate::report::hash::Hash;
use crate::report::identity::CODE;
use crate::report::keep::{load, save};
use crate::report::tessellation::tessellated;
use crate::times::{PassTimes, median};
use crate::tracing;
use asvgf::scene::{GpuScene, Scene, builtin};
use asvgf::{Settings, View};
use serde::{Deserialize, Serialize};
use std::error::Error;
use std::path::Path;

/// Sizes of the image.
const SIZES: [[u32; 2]; 5] = [[160, 90], [320, 180], [640, 360], [1280, 720], [1920, 1080]];

/// Numbers n, each for a scene in which every triangle is cut into n²: up to a million in all.
const CUTS: [u32; 7] = [1, 2, 5, 15, 50, 100, 172];

/// Size of the image for the cuts.
const SIZE: [u32; 2] = [256, 144];

/// Frames before the first that counts, and frames that do.
const WARM_UP: u32 = 3;
const FRAMES: u32 = 5;

/// Passes that trace; all others filter.
const TRACING: [&str; 2] = ["visibility", "trace"];

/// Costs at one size of image, or at one number of triangles.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Cost {
    pub size: [u32; 2],
    pub triangles: usize,
    /// True if rays go down a tree; with few triangles, rays test each of them.
    pub tree: bool,
    /// Median milliseconds of a frame.
    pub tracing: f64,
    pub filter: f64,
    /// Rays of a frame.
    pub rays: f64,
    /// Bytes of the denoiser's images, and of the scene.
    pub images: u64,
    pub scene: u64,
}

#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Growth {
    /// Hash of everything that decides the costs.
    pub key: String,
    /// Costs of one scene in images of several sizes.
    pub sizes: Vec<Cost>,
    /// Costs of one image of the same scene with more and more triangles.
    pub triangles: Vec<Cost>,
}

impl Growth {
    /// Loads the costs, or measures them anew. Calls back before each measurement with its size or its number of
    /// triangles.
    pub fn find(gpu: &Gpu, path: &Path, mut next: impl FnMut(&str)) -> Result<Self, Box<dyn Error>> {
        let key = Hash::of(&CODE)?.and_files(&["programs/src/report/growth.rs"])?.and(&gpu.adapter.name).to_string();
        if let Some(kept) = load(path).filter(|kept: &Self| kept.key == key) {
            return Ok(kept);
        }
        let scene = builtin::scene("cornell", "static").ok_or("no such scene")?;
        let (mut sizes, mut triangles) = (Vec::new(), Vec::new());
        for size in SIZES {
            next(&format!("{}×{}", size[0], size[1]));
            sizes.push(measure(gpu, &scene, size)?);
        }
        for n in CUTS {
            let scene = tessellated(&scene, n);
            next(&format!("{} triangles", count(&scene)));
            triangles.push(measure(gpu, &scene, SIZE)?);
        }
        let growth = Self { key, sizes, triangles };
        save(&growth, path)?;
        Ok(growth)
    }
}

impl Growth {
    /// Returns the costs of the scenes whose rays go down a tree.
    pub fn with_trees(&self) -> impl Iterator<Item = &Cost> {
        self.triangles.iter().filter(|cost| cost.tree)
    }
}

fn count(scene: &Scene) -> usize {
    scene.nodes.iter().flat_map(|node| &node.meshes).map(|&mesh| scene.meshes[mesh].triangles.len()).sum()
}

fn measure(gpu: &Gpu, scene: &Scene, size: [u32; 2]) -> Result<Cost, Box<dyn Error>> {
    let uploaded = GpuScene::new(&gpu.device, &gpu.queue, scene)?;
    let pose = scene.pose(None, 0.0);
    let camera = scene.camera_node().and_then(|node| scene.camera_view(&pose, node)).ok_or("no camera")?;
    let mut film = Film::new(gpu, size, Settings::adaptive())?;
    let mut frames: Vec<PassTimes> = Vec::new();
    for index in 0..WARM_UP + FRAMES {
        frames.push(tracing::render(&mut film, &uploaded, camera, index)?);
    }
    let typical = |traces: bool| {
        let of = |frame: &PassTimes| {
            frame.iter().filter(|(name, _)| TRACING.contains(name) == traces).map(|(_, ms)| ms).sum()
        };
        median(frames[WARM_UP as usize..].iter().map(of).collect())
    };
    let rays = film.numbers(View::Rays)?.iter().map(|number| f64::from(number[0])).sum();
    let (images, of_scene) = (film.denoiser.memory(), uploaded.memory());
    let (tracing, filter) = (typical(true), typical(false));
    let tree = !uploaded.contents().few_triangles;
    Ok(Cost { size, triangles: count(scene), tree, tracing, filter, rays, images, scene: of_scene })
}
