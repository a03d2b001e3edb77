//! Substitutes for guides that a sequence lacks.

use super::Pixels;
use super::layers::Layer;
use crate::sequence::camera::{Camera, Raster, dot};

/// Completes a frame with normals and depths. Without depths, everything is one wall that faces the camera, one unit
/// away: the filter then finds edges by normals, if there are any, by albedo and by light. Without normals, they follow
/// from the depths.
pub fn complete(pixels: &mut Pixels, camera: &Camera, raster: Raster) {
    let count = (raster.size[0] * raster.size[1]) as usize;
    let facing = [0.0, 0.0, 1.0];
    let (has_depth, has_normal) = (pixels.get(Layer::Depth).is_some(), pixels.get(Layer::Normal).is_some());
    if !has_depth {
        pixels.set(Layer::Depth, Some(vec![1.0; count]));
        pixels.set(Layer::PreviousDepth, Some(vec![1.0; count]));
        if let Some(normals) = pixels.0[Layer::Normal as usize].as_mut() {
            // A pixel without a normal becomes a surface as well, because only a depth could show a miss.
            let (normals, _) = normals.as_chunks_mut::<3>();
            normals.iter_mut().filter(|n| dot(n.map(f64::from), n.map(f64::from)) < 1e-12).for_each(|n| *n = facing);
        }
    }
    let broken = |n: &[f32; 3]| n.iter().any(|x| !x.is_finite());
    let is_broken = pixels.get(Layer::Normal).is_some_and(|n| n.as_chunks::<3>().0.iter().any(broken));
    if has_normal && is_broken && has_depth {
        let made = normals_of(pixels.get(Layer::Depth).unwrap_or_default(), camera, raster);
        if let Some(normals) = pixels.0[Layer::Normal as usize].as_mut() {
            let pairs = normals.as_chunks_mut::<3>().0.iter_mut().zip(made.as_chunks::<3>().0);
            pairs.filter(|(n, _)| broken(n)).for_each(|(n, made)| *n = *made);
        }
    }
    if !has_normal {
        let normals = match pixels.get(Layer::Depth).filter(|_| has_depth) {
            Some(depths) => normals_of(depths, camera, raster),
            None => facing.repeat(count),
        };
        pixels.set(Layer::Normal, Some(normals));
    }
}

/// Returns the normals of the surfaces through neighbouring points. Of the two differences along each axis, it takes
/// the one that bends less, so that none crosses an edge.
fn normals_of(depths: &[f32], camera: &Camera, raster: Raster) -> Vec<f32> {
    let [width, height] = raster.size.map(|side| side as i32);
    let depth = |x: i32, y: i32| {
        let inside = (0..width).contains(&x) && (0..height).contains(&y);
        inside.then(|| f64::from(depths[(y * width + x) as usize])).filter(|z| *z > 0.0 && *z < 1e9)
    };
    let point = |x: i32, y: i32| Some(camera.position([x as u32, y as u32], depth(x, y)?, raster));
    let minus = |a: [f64; 3], b: [f64; 3]| -> [f64; 3] { std::array::from_fn(|i| a[i] - b[i]) };
    let along = |x: i32, y: i32, [dx, dy]: [i32; 2]| -> Option<[f64; 3]> {
        let here = point(x, y)?;
        let side = |sign: i32| {
            let next = point(x + sign * dx, y + sign * dy)?;
            // Bend: the difference between this step and the next one.
            let bend = point(x + 2 * sign * dx, y + 2 * sign * dy)
                .map_or(f64::MAX, |far| minus(minus(far, next), minus(next, here)).iter().map(|d| d * d).sum());
            Some((bend, minus(next, here).map(|d| d * f64::from(sign))))
        };
        let sides = [side(1), side(-1)];
        sides.into_iter().flatten().min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, step)| step)
    };
    let mut normals = Vec::with_capacity(3 * depths.len());
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let normal = along(x, y, [1, 0]).zip(along(x, y, [0, 1])).map(|(across, down)| {
            let n = cross(down, across);
            // The normal points towards the camera; mirrored cameras would flip it.
            let here = point(x, y).unwrap_or_default();
            let ray = if camera.is_orthographic() { camera.forward } else { minus(here, camera.eye) };
            let side = if dot(n, ray) > 0.0 { -1.0 } else { 1.0 };
            let length = dot(n, n).sqrt();
            n.map(|c| side * c / length)
        });
        let normal = normal.filter(|n| n.iter().all(|c| c.is_finite()));
        // A lone pixel faces the camera.
        let normal =
            normal.unwrap_or_else(|| if depth(x, y).is_some() { camera.forward.map(|c| -c) } else { [0.0; 3] });
        normals.extend(normal.map(|c| c as f32));
    }
    normals
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}
