//! Tables by which light samples choose a piece of an emitting triangle.

use super::alias;
use super::record::GpuLight;
use crate::scene::gpu::emission::division::Division;
use crate::scene::gpu::memory::folded::Texel;
use std::collections::HashMap;

/// Most pieces of a scene: 1 MiB of tables. Divisions that save most variance per piece are kept; other triangles stay whole.
const MOST: usize = 1 << 16;

/// The divided triangles of a scene.
#[derive(Default)]
pub(crate) struct Tables {
    divided: Vec<Divided>,
    /// Number of each row's triangle in the list.
    rows: HashMap<u32, usize>,
}

struct Divided {
    /// The lights that share the table, because they are instances of one triangle.
    lights: Vec<usize>,
    material: usize,
    division: Division,
    /// Variance saved by each piece: it counts by the power of the lights.
    worth: f64,
}

impl Tables {
    /// Divides the triangle of a row, which has this material and is a light of this number and power.
    pub fn divide(&mut self, (light, power): (usize, f64), row: u32, material: usize, division: Division) {
        let worth = power * division.saved / division.pieces() as f64;
        if let Some(&shared) = self.rows.get(&row) {
            self.divided[shared].lights.push(light);
            self.divided[shared].worth += worth;
            return;
        }
        self.rows.insert(row, self.divided.len());
        self.divided.push(Divided { lights: vec![light], material, division, worth });
    }

    /// Writes the place of each table into its lights. Returns the tables, which follow the lights. `probabilities` are those of the
    /// pieces of a triangle of a material.
    pub fn finish(self, lights: &mut [GpuLight], probabilities: impl Fn(usize, &Division) -> Vec<f64>) -> Vec<Texel> {
        let mut divided = self.divided;
        divided.sort_by(|a, b| b.worth.total_cmp(&a.worth));
        let mut texels = Vec::new();
        let first = size_of_val(lights) / size_of::<Texel>();
        for Divided { lights: users, material, division, .. } in divided {
            if texels.len() + division.pieces() > MOST {
                continue;
            }
            for light in users {
                lights[light].pieces = (first + texels.len()) as u32;
                lights[light].level = division.level;
            }
            let count = division.pieces() as f32;
            let entries = alias::table(&probabilities(material, &division)).into_iter();
            texels.extend(entries.map(|e| [e.alias, e.threshold.to_bits(), (e.pmf * count).to_bits(), 0]));
        }
        texels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn division(level: u32) -> Division {
        Division { level, saved: 1.0, uvs: Default::default() }
    }

    fn probabilities(material: usize, division: &Division) -> Vec<f64> {
        (0..division.pieces()).map(|piece| ((piece + material) % 2) as f64).collect()
    }

    #[test]
    fn tables_follow_the_lights_and_instances_share_one() {
        let mut tables = Tables::default();
        tables.divide((0, 1.0), 7, 4, division(1));
        tables.divide((2, 1e6), 9, 5, division(2));
        tables.divide((3, 1.0), 7, 4, division(1));
        let mut lights = vec![GpuLight::default(); 4];
        let texels = tables.finish(&mut lights, probabilities);
        assert_eq!(texels.len(), 4 + 16);
        let places: Vec<_> = lights.iter().map(|light| (light.pieces, light.level)).collect();
        assert_eq!(places, [(36, 1), (0, 0), (20, 2), (36, 1)]);
        let densities: Vec<f32> = texels[16..].iter().map(|texel| f32::from_bits(texel[2])).collect();
        assert_eq!(densities, [0.0, 2.0, 0.0, 2.0]);
    }

    #[test]
    fn the_number_of_pieces_is_bounded_and_the_best_are_kept() {
        let mut tables = Tables::default();
        for row in 0..40 {
            tables.divide((row as usize, f64::from(row)), row, 0, division(6));
        }
        tables.divide((40, 0.0), 40, 0, division(1));
        let mut lights = vec![GpuLight::default(); 41];
        assert_eq!(tables.finish(&mut lights, probabilities).len(), MOST);
        let divided: Vec<usize> = (0..41).filter(|&light| lights[light].level > 0).collect();
        assert_eq!(divided, (24..40).collect::<Vec<_>>());
    }
}
