//! The light of a triangle, from the emissive image of its material.

use super::division::{Division, Pieces};
use super::grid;
use super::luminance::luminance;
use super::pyramid::Pyramid;
use crate::scene::description::{Material, Scene, Texture};
use glam::Vec3;
use std::collections::HashMap;

/// log₂ of the rows of points at which the image of a large triangle is read: 16 384 points.
const MOST_POINTS: u32 = 7;

/// The light of an emitting triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Emission {
    /// Mean of the image over the triangle, in linear light. It multiplies the material's emission.
    pub mean: Vec3,
    /// The division of the triangle, if the image is uneven.
    pub division: Option<Division>,
}

/// The emissive images of a scene.
pub(crate) struct EmissionMaps<'a> {
    pyramids: HashMap<usize, Pyramid<'a>>,
    /// For each level, the piece of the next coarser level that holds each piece.
    parents: Vec<Vec<usize>>,
}

impl<'a> EmissionMaps<'a> {
    /// The images of the materials that emit and that some mesh has.
    pub fn of(scene: &'a Scene) -> Self {
        let materials = scene.meshes.iter().map(|mesh| &scene.materials[mesh.material]);
        let images = materials.filter(|m| m.is_emitter()).filter_map(|m| Some(m.emissive_texture?.image));
        let mut pyramids = HashMap::new();
        for image in images {
            pyramids.entry(image).or_insert_with(|| Pyramid::of(&scene.images[image]));
        }
        let levels = if pyramids.is_empty() { 0 } else { MOST_POINTS };
        Self { pyramids, parents: (1..=levels).map(grid::parents).collect() }
    }

    /// The light of a triangle of a material, given the texture coordinates of its corners in each set. `None` if the triangle emits
    /// nothing, for certain: no path has to look for it.
    pub fn over(&self, material: &Material, uvs: impl FnOnce(usize) -> [[f32; 2]; 3]) -> Option<Emission> {
        if !material.is_emitter() {
            return None;
        }
        let Some(texture) = &material.emissive_texture else {
            return Some(Emission { mean: Vec3::ONE, division: None });
        };
        let uvs = uvs(texture.uv_set);
        let pyramid = &self.pyramids[&texture.image];
        if pyramid.is_black(texture, bounds(uvs.map(|uv| transformed(texture, uv)))) {
            return None;
        }
        let (mean, pieces) = self.pieces(material, texture, uvs);
        Some(Emission { mean, division: pieces.best().map(|(level, saved)| Division { level, saved, uvs }) })
    }

    /// Probability of each piece of a triangle of a material.
    pub fn probabilities(&self, material: &Material, division: &Division) -> Vec<f64> {
        let Some(texture) = &material.emissive_texture else { return vec![1.0; division.pieces()] };
        let corners = division.uvs.map(|uv| transformed(texture, uv));
        let of_piece = |piece| bounds(grid::corners(division.level, piece).map(|weights| place(corners, weights)));
        let is_black = |piece| self.pyramids[&texture.image].is_black(texture, of_piece(piece));
        self.pieces(material, texture, division.uvs).1.probabilities(division.level, is_black)
    }

    /// The mean of an image over a triangle, and its pieces' light.
    fn pieces(&self, material: &Material, texture: &Texture, uvs: [[f32; 2]; 3]) -> (Vec3, Pieces) {
        let (pyramid, corners) = (&self.pyramids[&texture.image], uvs.map(|uv| transformed(texture, uv)));
        let (points, size) = resolution(pyramid, corners);
        let color = |point| Vec3::from(pyramid.at(size, texture, place(corners, grid::middle(points, point))));
        let colors: Vec<Vec3> = (0..grid::count(points)).map(color).collect();
        let emissive = Vec3::from(material.emissive);
        let light = colors.iter().map(|&color| luminance((color * emissive).to_array())).collect();
        let mean = colors.iter().sum::<Vec3>() / colors.len() as f32;
        (mean, Pieces::of(points, light, &self.parents))
    }
}

/// The point (u, v) of an image at texture coordinates, in parts of its size.
fn transformed(texture: &Texture, [u, v]: [f32; 2]) -> [f64; 2] {
    texture.transform.map(|[x, y, z]| f64::from(x) * f64::from(u) + f64::from(y) * f64::from(v) + f64::from(z))
}

/// The point of a triangle with these weights of the second and of the third corner.
fn place([a, b, c]: [[f64; 2]; 3], weights: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|axis| a[axis] + weights[0] * (b[axis] - a[axis]) + weights[1] * (c[axis] - a[axis]))
}

fn bounds(corners: [[f64; 2]; 3]) -> [[f64; 2]; 2] {
    let extreme =
        |pick: fn(f64, f64) -> f64| [0, 1].map(|axis| pick(pick(corners[0][axis], corners[1][axis]), corners[2][axis]));
    [extreme(f64::min), extreme(f64::max)]
}

/// log₂ of the rows of points at which the image is read, and the size of the image whose texels are as large as the points are apart.
fn resolution(pyramid: &Pyramid<'_>, [a, b, c]: [[f64; 2]; 3]) -> (u32, usize) {
    let [width, height] = pyramid.size(0).map(|length| length as f64);
    let edge = |p: [f64; 2], q: [f64; 2]| ((p[0] - q[0]) * width).hypot((p[1] - q[1]) * height);
    let longest = edge(a, b).max(edge(b, c)).max(edge(c, a));
    // Points are up to two texels apart, which is as far as interpolation reaches.
    let points = (longest.log2().ceil() - 1.0).clamp(1.0, f64::from(MOST_POINTS)) as u32;
    let size = (longest / f64::from(1_u32 << points)).log2().floor();
    (points, (size.max(0.0) as usize).min(pyramid.smallest()))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::description::{Image, Mesh, Wrap};

    /// A scene with one emissive image, and the means of light over triangles of it.
    fn scene(size: u32, texture: Texture, color: impl Fn(u32, u32) -> u8) -> Scene {
        let texels = (0..size * size).map(|i| [color(i % size, i / size), 0, 255, 255]).collect();
        let material = Material { emissive: [2.0, 1.0, 0.0], emissive_texture: Some(texture), ..Default::default() };
        Scene {
            images: vec![Image { width: size, height: size, texels, ..Default::default() }],
            materials: vec![material],
            meshes: vec![Mesh::default()],
            ..Default::default()
        }
    }

    fn emission(scene: &Scene, uvs: [[f32; 2]; 3]) -> Option<Emission> {
        EmissionMaps::of(scene).over(&scene.materials[0], |_| uvs)
    }

    /// The mean of the image's red over a triangle, point by point, from the image itself.
    fn exact(scene: &Scene, uvs: [[f32; 2]; 3]) -> f64 {
        let texture = scene.materials[0].emissive_texture.unwrap();
        let pyramid = Pyramid::of(&scene.images[0]);
        let corners = uvs.map(|uv| transformed(&texture, uv));
        let points = grid::count(9);
        let red = |point| f64::from(pyramid.at(0, &texture, place(corners, grid::middle(9, point)))[0]);
        (0..points).map(red).sum::<f64>() / points as f64
    }

    #[test]
    fn the_mean_is_that_of_the_image_over_the_triangle() {
        let noise = |x: u32, y: u32| ((x * 7919 + y * 104_729) % 251) as u8;
        let spot = |x: u32, y: u32| if x / 8 == 3 && y / 8 == 5 { 255 } else { 0 };
        let turned = Texture { transform: [[0.3, -0.8, 0.4], [0.9, 0.2, -1.7]], ..Texture::new(0) };
        let mirrored = Texture { wrap: [Wrap::Mirror, Wrap::Clamp], nearest: true, ..Texture::new(0) };
        for texture in [Texture::new(0), turned, mirrored] {
            for (what, scene) in [("noise", scene(64, texture, noise)), ("spot", scene(64, texture, spot))] {
                for uvs in [
                    [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0]],
                    [[0.3, 0.5], [0.6, 0.55], [0.4, 0.9]],
                    [[0.0, 0.0], [-2.0, 0.3], [1.5, 3.0]],
                ] {
                    let (found, exact) = (emission(&scene, uvs), exact(&scene, uvs));
                    let found = found.map_or(0.0, |emission| f64::from(emission.mean.x));
                    assert!((found - exact).abs() < 0.05 * exact + 2e-3, "{what}, {uvs:?}: {found}, not {exact}");
                }
            }
        }
    }

    #[test]
    fn only_black_is_no_light() {
        let left = |x: u32, _: u32| if x < 32 { 0 } else { 255 };
        let mut scene = scene(64, Texture::new(0), left);
        scene.images[0].texels.iter_mut().for_each(|texel| texel[2] = 0);
        let black = [[0.1, 0.1], [0.4, 0.1], [0.4, 0.9]];
        let grey = [[0.1, 0.1], [0.6, 0.1], [0.4, 0.9]];
        assert_eq!(emission(&scene, black), None);
        assert!(emission(&scene, grey).is_some());
        scene.materials[0].emissive = [0.0; 3];
        assert_eq!(emission(&scene, grey), None);
        scene.materials[0] = Material { emissive: [1.0; 3], ..Default::default() };
        assert_eq!(emission(&scene, black), Some(Emission { mean: Vec3::ONE, division: None }));
    }
}
