//! The order of the parts of the folded geometry: lookup table, top level, trees.

use super::groups::Group;
use super::instances::{NODE_TEXELS, top_level_nodes, top_level_texels};
use crate::scene::gpu::memory::folded::{self, Texel};
use crate::scene::gpu::tree::Node;

/// Texels of a row of the lookup table, as in shaders/shared/scene.wgsl.
pub(crate) const ROW_TEXELS: usize = 3;

/// Places of the parts. The top level and the records of instances have texture rows of their own, because they are replaced when
/// something moves.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sections {
    /// True if there are two levels of trees.
    pub instanced: bool,
    pub instances: usize,
    /// First texel of the top level.
    top: usize,
    /// Texels of the top level and the records.
    top_texels: usize,
}

impl Sections {
    pub fn of(groups: &[Group]) -> Self {
        let instanced =
            groups.len() > 1 || groups.iter().any(|group| !group.nodes.is_empty() || group.deforms.is_some());
        let instances = groups.iter().map(|group| group.nodes.len().max(1)).sum();
        Self::new(groups.iter().map(|group| group.faces.len()).sum(), instances, instanced)
    }

    fn new(rows: usize, instances: usize, instanced: bool) -> Self {
        let table = rows * ROW_TEXELS;
        let (top, top_texels) = if instanced {
            (table.next_multiple_of(folded::WIDTH), top_level_texels(instances))
        } else {
            (table.next_multiple_of(NODE_TEXELS), 0)
        };
        Self { instanced, instances, top, top_texels }
    }

    /// Number of the node where rays begin.
    pub fn root(&self) -> u32 {
        (self.top / NODE_TEXELS) as u32
    }

    /// First texel of the instances' records.
    pub fn records(&self) -> u32 {
        (self.top + top_level_nodes(self.instances) * NODE_TEXELS) as u32
    }

    /// Number of the first node of the trees over triangles.
    pub fn first_node(&self) -> u32 {
        ((self.top + self.top_texels) / NODE_TEXELS) as u32
    }

    /// All parts in their places.
    pub fn joined(&self, rows: &[[Texel; ROW_TEXELS]], top_level: &[Texel], nodes: &[Node]) -> Vec<Texel> {
        let mut texels = folded::texels(rows).to_vec();
        texels.resize(self.top, Texel::default());
        texels.extend_from_slice(top_level);
        texels.resize(self.top + self.top_texels, Texel::default());
        texels.extend_from_slice(folded::texels(nodes));
        texels
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn one_tree_follows_the_lookup_table() {
        let sections = Sections::new(3, 1, false);
        assert_eq!((sections.root(), sections.first_node()), (5, 5));
        let texels = sections.joined(&[[[1; 4]; 3]; 3], &[], &[]);
        assert_eq!(texels, [vec![[1; 4]; 9], vec![[0; 4]]].concat());
    }

    #[test]
    fn the_top_level_has_texture_rows_of_its_own() {
        let sections = Sections::new(1366, 3, true);
        // 1366 rows are 4098 texels; three instances have two nodes of two texels above them.
        assert_eq!((sections.root(), sections.records(), sections.first_node()), (4096, 8196, 6144));
        let texels = sections.joined(&[[[1; 4]; 3]; 1366], &[[2; 4]; 7], &[]);
        let filled = |texel: [u32; 4]| texels.iter().enumerate().filter(move |(_, t)| **t == texel).map(|(i, _)| i);
        assert!(filled([1; 4]).eq(0..4098) && filled([2; 4]).eq(8192..8199));
        assert_eq!(texels.len(), 3 * 4096);
    }
}
