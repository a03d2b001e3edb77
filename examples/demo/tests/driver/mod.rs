//! Drives the demo as a person would, and looks at its pictures.

use asvgf::wgpu::{self, PollType, TextureView};
use asvgf::{View, ViewOptions};
use asvgf_demo::app::Demo;
use asvgf_demo::gpu;
use asvgf_demo::state::{Source, State};
use eframe::egui::{
    DroppedFile, Event, Key, Modifiers, MouseWheelSource, MouseWheelUnit, Pos2, Rect, TouchPhase, pos2, vec2,
};
use eframe::egui_wgpu::{RenderState, RendererOptions};
use egui_kittest::Harness;
use egui_kittest::wgpu::{WgpuTestRenderer, create_render_state};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Time limit for a frame, so that a hang fails the test.
const PATIENCE: Duration = Duration::from_secs(120);

pub struct Window {
    pub harness: Harness<'static, Demo>,
    pub gpu: RenderState,
    pub folder: Folder,
}

impl Window {
    /// Opens the window and waits for its first frame.
    pub fn open([width, height]: [f32; 2], state: State) -> Self {
        // A window draws textures with the sampler's filter; the predictable filter is another.
        let options = RendererOptions { predictable_texture_filtering: false, ..RendererOptions::PREDICTABLE };
        let gpu = create_render_state(gpu::setup(), options);
        // The image is small, so that the test stays short on a software adapter.
        let demo = Demo::new(&gpu, State { scale: Some(0.125), ..state }).expect("the demo starts");
        let harness = Harness::builder()
            .with_size(vec2(width, height))
            .renderer(WgpuTestRenderer::from_render_state(gpu.clone()))
            .build_ui_state(|ui, demo: &mut Demo| demo.show(ui), demo);
        let mut window = Self { harness, gpu, folder: Folder::new() };
        window.settle();
        window
    }

    pub fn demo(&self) -> &Demo {
        self.harness.state()
    }

    pub fn demo_mut(&mut self) -> &mut Demo {
        self.harness.state_mut()
    }

    pub fn state(&mut self, change: impl FnOnce(&mut State)) {
        change(&mut self.demo_mut().state);
    }

    /// Repaints once with the GPU idle, and waits for the work that this submits.
    pub fn settle(&mut self) {
        self.wait();
        self.harness.step();
        self.wait();
        // The next repaint shows the results that have arrived.
        self.harness.step();
        self.wait();
    }

    /// Repaints until `count` more frames were rendered.
    pub fn frames(&mut self, count: u32) {
        self.until(self.demo().frames() + count);
    }

    /// Repaints until `last` frames were rendered in all.
    pub fn until(&mut self, last: u32) {
        // Some repaints render nothing, because the GPU is still working.
        for _ in 0..4 * last + 4 {
            self.wait();
            if self.demo().frames() >= last {
                break;
            }
            self.harness.step();
        }
        assert_eq!(self.demo().frames(), last);
    }

    fn wait(&self) {
        let poll = PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
        self.gpu.device.poll(poll).expect("the GPU answers in time");
    }

    /// Presses a key, and repaints.
    pub fn key(&mut self, key: Key) {
        self.wait();
        self.harness.key_press(key);
        self.harness.step();
        self.settle();
    }

    /// Drags from one place of the picture to another, both in 0…1.
    pub fn drag(&mut self, from: [f32; 2], to: [f32; 2]) {
        let (from, to) = (self.place(from), self.place(to));
        let middle = from + 0.5 * (to - from);
        self.harness.hover_at(from);
        self.settle();
        self.harness.drag_at(from);
        self.settle();
        for at in [middle, to] {
            self.harness.hover_at(at);
            self.settle();
        }
        self.harness.drop_at(to);
        self.settle();
    }

    /// Turns the wheel over a place of the picture.
    pub fn wheel(&mut self, at: [f32; 2], points: f32) {
        self.harness.hover_at(self.place(at));
        self.settle();
        let (unit, delta, phase) = (MouseWheelUnit::Point, vec2(0.0, points), TouchPhase::Move);
        let (source, modifiers) = (MouseWheelSource::Unknown, Modifiers::NONE);
        self.harness.event(Event::MouseWheel { unit, delta, phase, source, modifiers });
        // egui smooths the wheel over some repaints.
        (0..4).for_each(|_| self.settle());
    }

    /// Drops a file into the window.
    pub fn drop_file(&mut self, path: &Path) {
        self.harness.input_mut().dropped_files.push(Arc::new(File(path.to_owned())));
        self.settle();
    }

    /// The position of the last frame's camera.
    pub fn eye(&self) -> [f64; 3] {
        self.demo().picture.camera().expect("a frame").eye
    }

    /// The picture of a film.
    pub fn picture(&self, source: Source) -> Image {
        let film = self.demo().picture.embed.film(source).expect("a film");
        Image::read(&self.gpu, &film.picture)
    }

    /// The picture that a film should show, rendered anew.
    pub fn expected(&mut self, source: Source, view: View) -> Image {
        let gpu = self.gpu.clone();
        let film = self.demo_mut().picture.embed.films.iter_mut().find(|film| film.source == source).expect("a film");
        let texture = film.picture.texture();
        let target = gpu.device.create_texture(&wgpu::TextureDescriptor {
            label: None,
            size: texture.size(),
            mip_level_count: 1,
            sample_count: 1,
            dimension: texture.dimension(),
            format: texture.format(),
            usage: texture.usage(),
            view_formats: &[],
        });
        let target = target.create_view(&Default::default());
        let mut encoder = gpu.device.create_command_encoder(&Default::default());
        let options = ViewOptions { exposure: 1.0, range: view.default_range() };
        film.denoiser.show(&gpu.device, &mut encoder, view, options, &target).expect("a view");
        gpu.queue.submit([encoder.finish()]);
        Image::read(&gpu, &target)
    }

    /// The linear radiance of a film.
    pub fn radiance(&self, source: Source) -> Vec<[f32; 3]> {
        let film = self.demo().picture.embed.film(source).expect("a film");
        let bytes = bytes(&self.gpu, &film.radiance, 16);
        let number = |b: &[u8]| f32::from_le_bytes([b[0], b[1], b[2], b[3]]);
        bytes.chunks_exact(16).map(|t| [number(&t[..4]), number(&t[4..8]), number(&t[8..12])]).collect()
    }

    /// The colours that the window draws at places of the picture, 0…1.
    pub fn shown(&mut self, places: &[[f32; 2]]) -> Vec<[u8; 4]> {
        self.wait();
        let window = self.harness.render().expect("a picture of the window");
        let size = vec2(window.width() as f32, window.height() as f32);
        assert!(Rect::from_min_size(Pos2::ZERO, size).contains_rect(self.room()), "{:?} in {size}", self.room());
        let pixel = |at: Pos2| window.get_pixel(at.x as u32, at.y as u32).0;
        places.iter().map(|&place| pixel(self.place(place))).collect()
    }

    /// The rectangle of the picture: the room that the panels leave.
    fn room(&self) -> Rect {
        self.demo().picture.rect
    }

    fn place(&self, [x, y]: [f32; 2]) -> Pos2 {
        let room = self.room();
        pos2(room.left() + x * room.width(), room.top() + y * room.height())
    }
}

/// Pixels of a picture.
pub struct Image {
    pub size: [u32; 2],
    pub texels: Vec<[u8; 4]>,
}

impl Image {
    fn read(gpu: &RenderState, view: &TextureView) -> Self {
        let size = [view.texture().width(), view.texture().height()];
        Self { size, texels: bytes(gpu, view, 4).as_chunks::<4>().0.to_vec() }
    }

    /// The texel at a place, 0…1, and the place of its centre.
    pub fn texel(&self, place: [f32; 2]) -> ([u8; 4], [f32; 2]) {
        let side = |axis: usize| self.size[axis] as f32;
        let [x, y] = [0, 1].map(|axis| (place[axis] * side(axis)) as usize);
        let centre = [(x as f32 + 0.5) / side(0), (y as f32 + 0.5) / side(1)];
        (self.texels[y * self.size[0] as usize + x], centre)
    }
}

/// Returns true if two texels are equal up to the rounding of either renderer.
pub fn alike(a: [u8; 4], b: [u8; 4]) -> bool {
    a.iter().zip(b).all(|(&a, b)| a.abs_diff(b) <= 3)
}

/// Mean over all pixels and channels.
pub fn mean(image: &[[f32; 3]]) -> f32 {
    image.iter().flatten().sum::<f32>() / (3 * image.len()) as f32
}

/// The bytes of a texture, row by row without padding.
fn bytes(gpu: &RenderState, view: &TextureView, texel: u32) -> Vec<u8> {
    let texture = view.texture();
    let row = texture.width() * texel;
    let padded = row.next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
    let buffer = gpu.device.create_buffer(&wgpu::BufferDescriptor {
        label: None,
        size: u64::from(padded) * u64::from(texture.height()),
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let mut encoder = gpu.device.create_command_encoder(&Default::default());
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(padded), rows_per_image: None };
    let destination = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
    encoder.copy_texture_to_buffer(texture.as_image_copy(), destination, texture.size());
    gpu.queue.submit([encoder.finish()]);
    buffer.map_async(wgpu::MapMode::Read, .., |result| result.expect("a readable buffer"));
    let poll = PollType::Wait { submission_index: None, timeout: Some(PATIENCE) };
    gpu.device.poll(poll).expect("the GPU answers in time");
    let bytes = buffer.get_mapped_range(..).expect("mapped");
    bytes.chunks(padded as usize).flat_map(|r| &r[..row as usize]).copied().collect()
}

#[derive(Debug)]
struct File(PathBuf);

impl DroppedFile for File {
    fn path(&self) -> &Path {
        &self.0
    }

    fn bytes(&self) -> Result<Vec<u8>, String> {
        std::fs::read(&self.0).map_err(|error| error.to_string())
    }
}

/// A folder of its own for each test, removed with it.
pub struct Folder(PathBuf);

impl Folder {
    fn new() -> Self {
        use std::sync::atomic::{AtomicU32, Ordering};
        static COUNT: AtomicU32 = AtomicU32::new(0);
        let name = format!("asvgf-demo-{}-{}", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
        let path = std::env::temp_dir().join(name);
        std::fs::create_dir_all(&path).expect("a folder for the test's files");
        Self(path)
    }

    pub fn path(&self, name: &str) -> PathBuf {
        self.0.join(name)
    }

    pub fn file(&self, name: &str, content: &[u8]) -> PathBuf {
        let path = self.path(name);
        std::fs::write(&path, content).expect("a file");
        path
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        // Leftover files of a failed test are not worth an error.
        let _ = std::fs::remove_dir_all(&self.0);
    }
}
