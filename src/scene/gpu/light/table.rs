//! The list of everything that emits, in a fixed order with fixed probabilities.
//!
//! The temporal gradient compares paths that share their random numbers. A light must therefore keep its number and its
//! probability while it moves, dims or is switched off. Both follow from the rest pose with every light at its nominal strength, and
//! momentary strengths only enter the radiance.

use super::alias;
use super::analytic::{AnalyticLight, strongest};
use super::emitter::Emitter;
use super::pieces::Tables;
use super::punctual::{self, Punctual};
use super::record::{self, GpuLight};
use crate::scene::description::{Material, Pose, Scene};
use crate::scene::gpu::emission::division::Division;
use crate::scene::gpu::emission::luminance::luminance;
use crate::scene::gpu::emission::maps::Emission;
use crate::scene::gpu::geometry::centre::relative;
use crate::scene::gpu::geometry::groups::Face;
use crate::scene::gpu::memory::folded::{Texel, texels};
use glam::{DVec3, Mat4, Vec3};
use std::collections::BTreeMap;
use std::f64::consts::PI;

/// All lights of a scene.
#[derive(Debug)]
pub(crate) struct Lights {
    /// Triangles that emit, then lights without area, then the environment.
    pub table: Vec<GpuLight>,
    /// Tables of the pieces of emitters that are divided. They follow the lights.
    pub pieces: Vec<Texel>,
    /// Place of the first of `punctual` in the table. The others follow it.
    first_punctual: usize,
    punctual: Vec<Punctual>,
    emitters: Vec<Emitter>,
}

impl Lights {
    /// The records of the lights, and the tables of pieces.
    pub fn texels(&self) -> Vec<Texel> {
        [texels(&self.table), &self.pieces].concat()
    }

    /// The nodes of the lights without area.
    pub fn nodes(&self) -> impl Iterator<Item = usize> {
        self.punctual.iter().map(|light| light.node)
    }

    /// Replaces the emitting triangles of an instance by others.
    pub fn reshape(&mut self, instance: usize, triangles: impl Iterator<Item = [Vec3; 3]>) {
        if let Some(emitter) = self.emitters.iter_mut().find(|emitter| emitter.instance == instance) {
            emitter.reshape(triangles);
        }
    }

    /// Places the lights in a pose, where an instance has this `placement`. Returns those that the Blinn–Phong gradient evaluates.
    pub fn place(
        &mut self,
        materials: &[Material],
        pose: &Pose,
        centre: DVec3,
        placement: impl Fn(usize) -> Mat4,
    ) -> Vec<AnalyticLight> {
        let lamp = |e: &Emitter| e.analytic(materials, pose, placement(e.instance));
        let mut analytic: Vec<AnalyticLight> = self.emitters.iter().map(lamp).collect();
        for (light, entry) in self.punctual.iter().zip(&mut self.table[self.first_punctual..]) {
            let placement = relative(&pose.world[light.node], DVec3::ZERO, centre);
            let placed = punctual::placed(&light.light, placement, pose.intensity[light.index]);
            *entry = GpuLight { alias: entry.alias, threshold: entry.threshold, pmf: entry.pmf, ..placed };
            analytic.push(AnalyticLight::from(placed));
        }
        strongest(analytic)
    }
}

/// Collects the lights of a scene with their powers, from which the probabilities follow.
#[derive(Default)]
pub(crate) struct LightList {
    table: Vec<GpuLight>,
    powers: Vec<f64>,
    pieces: Tables,
    emitters: BTreeMap<(usize, usize), Emitter>,
    first_punctual: usize,
    punctual: Vec<Punctual>,
}

impl LightList {
    /// Number of lights so far.
    pub fn len(&self) -> usize {
        self.table.len()
    }

    /// Adds a triangle with its light, its row in the lookup table and its instance, which has this `placement`.
    pub fn add_emitter(
        &mut self,
        (instance, row): (usize, u32),
        (face, light): (&Face, &Emission),
        (number, material): (usize, &Material),
        placement: Mat4,
    ) {
        let [a, b, c] = face.corners.map(|p| placement.transform_point3(p));
        let area = 0.5 * f64::from((b - a).cross(c - a).length());
        let power = area * PI * luminance((Vec3::from(material.emissive) * light.mean).to_array());
        if let Some(division) = light.division {
            self.pieces.divide((self.table.len(), power), row, number, division);
        }
        let record = GpuLight { kind: record::EMITTER, triangle: row, instance: instance as u32, ..Default::default() };
        self.table.push(record);
        self.powers.push(power);
        let emitter = self.emitters.entry((instance, number));
        let emitter = emitter.or_insert_with(|| Emitter::new(instance, number));
        emitter.add(face.corners, face.area_normal(), light.mean);
    }

    /// Adds the lights without area of a scene of this radius. [`Lights::place`] places them.
    pub fn add_punctual(&mut self, scene: &Scene, radius: f64) {
        self.first_punctual = self.table.len();
        for (node, description) in scene.nodes.iter().enumerate() {
            if let Some(index) = description.light {
                let light = scene.lights[index];
                self.punctual.push(Punctual { node, index, light });
                self.table.push(GpuLight::default());
                self.powers.push(punctual::power(&light, radius));
            }
        }
    }

    /// Adds the environment, whose luminance over all directions is `weight`. Returns its place in the table.
    pub fn add_environment(&mut self, weight: f64, radius: f64) -> usize {
        self.table.push(GpuLight { kind: record::ENVIRONMENT, ..Default::default() });
        self.powers.push(weight * PI * radius * radius);
        self.table.len() - 1
    }

    /// The list with its probabilities. `of_pieces` gives those of the pieces of a triangle of a material.
    pub fn finish(self, of_pieces: impl Fn(usize, &Division) -> Vec<f64>) -> Lights {
        let Self { mut table, powers, pieces, emitters, first_punctual, punctual } = self;
        assign_probabilities(&mut table, &powers);
        let pieces = pieces.finish(&mut table, of_pieces);
        Lights { table, pieces, first_punctual, punctual, emitters: emitters.into_values().collect() }
    }
}

/// Gives the lights probabilities by their powers. A tenth is shared out evenly, so that a weak light is not starved where it is near.
fn assign_probabilities(lights: &mut [GpuLight], powers: &[f64]) {
    let total: f64 = powers.iter().sum();
    let count = lights.len() as f64;
    let weights: Vec<f64> =
        powers.iter().map(|p| if total > 0.0 { 0.9 * p / total + 0.1 / count } else { 1.0 }).collect();
    for (light, entry) in lights.iter_mut().zip(alias::table(&weights)) {
        light.alias = entry.alias;
        light.threshold = entry.threshold;
        light.pmf = entry.pmf;
    }
}
