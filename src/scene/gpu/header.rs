//! The constants of a scene, as shaders/shared/scene.wgsl reads them.

use super::geometry::attributes::Layout;
use super::geometry::sections::Sections;
use super::light::sky::SkyTable;
use super::tree::Quantization;
use bytemuck::{Pod, Zeroable};

/// `Scene` of scene.wgsl.
#[repr(C)]
#[derive(Clone, Copy, Debug, Default, Pod, Zeroable)]
pub(crate) struct Header {
    instances: u32,
    instance_count: u32,
    light_count: u32,
    environment_light: u32,
    environment_width: u32,
    environment_height: u32,
    environment_run: u32,
    environment_cells: u32,
    attribute_stride: u32,
    uv0: u32,
    uv1: u32,
    environment_density: f32,
    grid_base: [f32; 3],
    root: u32,
    grid_step: [f32; 3],
    color_first: u32,
}

impl Header {
    /// The constants of a scene without an environment. [`Header::with_grid`] completes them.
    pub fn new(sections: &Sections, layout: Layout, lights: usize) -> Self {
        Self {
            instances: sections.records(),
            root: sections.root(),
            instance_count: sections.instances as u32,
            light_count: lights as u32,
            environment_light: u32::MAX,
            attribute_stride: layout.stride as u32,
            uv0: layout.uv[0].unwrap_or(0) as u32,
            uv1: layout.uv[1].unwrap_or(0) as u32,
            color_first: layout.color.unwrap_or(0) as u32,
            ..Default::default()
        }
    }

    /// Adds an environment, which is the light with this number and this probability of being chosen.
    pub fn with_environment(self, sky: &SkyTable, light: usize, probability: f32) -> Self {
        Self {
            environment_light: light as u32,
            environment_width: sky.size[0],
            environment_height: sky.size[1],
            environment_run: sky.cells.run,
            environment_cells: sky.cells.all | sky.cells.columns << 8,
            environment_density: (f64::from(probability) / sky.weight) as f32,
            ..self
        }
    }

    /// Adds the grid of the boxes that rays meet first.
    pub fn with_grid(self, grid: Quantization) -> Self {
        Self { grid_base: grid.base, grid_step: grid.step, ..self }
    }

    /// Number of the node where rays begin.
    pub fn root(&self) -> u32 {
        self.root
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::twins::layout::{assert_layout, fields};

    #[test]
    fn the_scene_lies_where_the_shaders_read_it() {
        let header = fields!(Header: instances, instance_count, light_count, environment_light, environment_width,
            environment_height, environment_run, environment_cells, attribute_stride, uv0 as "uv_first",
            uv1 as "uv_second", environment_density, grid_base, root, grid_step, color_first);
        assert_layout("Scene", header, size_of::<Header>());
    }
}
