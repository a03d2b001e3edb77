#[path = "support/gpu.rs"]
mod gpu;
use asvgf::wgpu::TextureFormat;
use asvgf::*;
unsafe extern "C" { fn clock_gettime(c: i32, t: *mut [i64; 2]) -> i32; }
fn cpu() -> f64 { let mut t = [0i64; 2]; unsafe { clock_gettime(2, &mut t) }; t[0] as f64 * 1e3 + t[1] as f64 * 1e-6 }
fn main() {
    let args: Vec<String> = std::env::args().collect();
    let name = args.get(1).map_or("cornell", |s| s);
    let anim = args.get(2).map_or("static", |s| s);
    let frames: u32 = args.get(3).map_or(8, |s| s.parse().unwrap());
    let size: Vec<u32> = args.get(4).map_or("640x360", |s| s).split('x').map(|s| s.parse().unwrap()).collect();
    let size = [size[0], size[1]];
    let mode = args.get(5).map_or("adaptive", |s| s);
    let g = gpu::Gpu::new().map_err(|e| e.to_string()).unwrap();
    eprintln!("{:?}", g.adapter);
    let scene = scene::builtin::scene(name, anim).unwrap();
    let mut gs = scene::GpuScene::new(&g.device, &g.queue, &scene).unwrap();
    let settings = match mode { "classic" => Settings::classic(), "constant" => Settings::adaptive().constant(0.2), "noisy" => Settings{mode: Mode::Noisy, ..Default::default()}, "bp" => {let mut s = Settings::default(); s.filter.gradient = Gradient::BlinnPhong; s}, "reference" => Settings{mode: Mode::Reference, ..Default::default()}, _ => Settings::adaptive() };
    let mut d = Denoiser::new(&g.device, &g.queue, &DenoiserDescriptor { size, settings, timing: true }).unwrap();
    let target = g.target(size, TextureFormat::Rgba32Float);
    let pic = g.target(size, TextureFormat::Rgba8Unorm);
    let mut times: std::collections::BTreeMap<&str, Vec<f64>> = Default::default();
    for f in 0..frames {
        let pose = scene.pose(Some(0), f as f32 / 30.0);
        let v = scene.camera_view(&pose, scene.camera_node().unwrap()).unwrap();
        let camera = Camera { eye: v.eye, target: v.target, up: v.up, fov_y: v.fov_y, jitter: [0.0; 2] };
        let mut e = g.device.create_command_encoder(&Default::default());
        gs.update(&g.device, &mut e, &pose).unwrap();
        let t = std::time::Instant::now();
        let mut ft: std::collections::BTreeMap<&str, f64> = Default::default();
        let mut t1 = cpu();
        d.render_stepwise(&g.device, &mut e, &Frame { scene: &gs, camera, index: f, target: &target }, |p, e| {
            let full = std::mem::replace(e, g.device.create_command_encoder(&Default::default()));
            g.queue.submit([full.finish()]); g.wait();
            *ft.entry(p.name()).or_default() += (cpu() - t1) / 2.0; t1 = cpu();
        }).unwrap();
        g.queue.submit([e.finish()]);
        g.wait();
        let wall = t.elapsed();
        let c = g.read_colors(&target);
        let mean: f64 = c.iter().map(|c| c[1] as f64).sum::<f64>() / c.len() as f64;
        eprintln!("frame {f} mean {mean:.5} wall {:.1} ms", wall.as_secs_f64()*1e3);
        if f > 2 { for (n, ms) in ft { times.entry(n).or_default().push(ms); } }
    }
    let mut total = 0.0;
    for (n, mut t) in times { t.sort_by(f64::total_cmp); let m = t[t.len()/2]; if n != "trace" && n != "visibility" { total += m; } eprintln!("{n:24} {m:8.2}"); }
    eprintln!("filter total {total:.2}");
    for view in View::ALL {
        let mut e = g.device.create_command_encoder(&Default::default());
        if let Err(err) = d.show(&g.device, &mut e, view, ViewOptions { exposure: 1.0, range: view.default_range() }, &pic) { eprintln!("{err}"); continue; }
        g.queue.submit([e.finish()]);
        let bytes = g.read(&pic);
        let px: Vec<[u8; 4]> = bytes.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect();
        std::fs::create_dir_all("out").unwrap();
        image_io::write_png(format!("out/{}.png", view.name()), size[0], size[1], &px).unwrap();
    }
}
