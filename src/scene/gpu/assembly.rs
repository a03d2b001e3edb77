//! A scene laid out for the GPU, as plain data: the content of its buffers and textures in the rest pose.

use super::arrangement::{Arrangement, Facets, lengths};
use super::contents::contents;
use super::geometry::centre;
use super::geometry::deforming::Deforming;
use super::geometry::drawn::{Drawn, drawn};
use super::geometry::facets;
use super::geometry::groups::{Group, groups};
use super::geometry::instances::Instance;
use super::geometry::rows::Geometry;
use super::geometry::sections::Sections;
use super::header::Header;
use super::light::analytic::AnalyticLight;
use super::light::sky::SkyTable;
use super::light::table::LightList;
use super::memory::capacity::Capacity;
use super::memory::folded::Texel;
use super::surface::places::{are_folded, places};
use super::tree;
use crate::plan::SceneContents;
use crate::scene::description::{Environment, Image, Pose, Scene, SceneError};
use glam::DVec3;

/// Maximum number of slots of the traversal's stack. Trees that obvhs builds over real geometry need far fewer.
const LARGEST_STACK: u32 = 64;

/// All data of a scene.
pub(crate) struct Assembly<'a> {
    pub contents: SceneContents,
    /// Slots of the traversal's stack.
    pub stack: u32,
    /// Rows of the lookup table.
    pub triangles: usize,
    /// The rest pose. All other fields that depend on a pose show this one.
    pub pose: Pose,
    pub arrangement: Arrangement,
    pub header: Header,
    /// Lookup table, top level and trees, see [`Sections`].
    pub geometry: Vec<Texel>,
    pub attributes: Vec<u32>,
    /// Materials and their extensions.
    pub materials: Vec<Texel>,
    pub analytic_lights: Vec<AnalyticLight>,
    pub facets: Option<Facets>,
    pub images: &'a [Image],
    /// `None` if the environment is black.
    pub sky: Option<(&'a Environment, SkyTable)>,
}

impl<'a> Assembly<'a> {
    /// Builds the trees and lays everything out.
    ///
    /// # Errors
    /// The error of [`Scene::validate`], or one that names the part of the scene that exceeds the device's textures or storage bindings.
    pub fn of(scene: &'a Scene, capacity: &Capacity) -> Result<Self, SceneError> {
        scene.validate()?;
        let pose = scene.pose(None, 0.0);
        let bounds = scene.bounds(&pose).map(|corners| corners.map(DVec3::from));
        let centre = bounds.map_or(DVec3::ZERO, centre::centre);
        let radius = bounds.map_or(1.0, |[low, high]| low.distance(high) / 2.0);

        let drawn = drawn(scene, &pose);
        let groups = groups(&drawn, &pose.world, &scene.animated_nodes(), centre);
        let sections = Sections::of(&groups);
        let mut geometry = Geometry::new(scene, &drawn, sections.first_node());
        let mut lights = LightList::default();
        let (instances, deforming) = instances((scene, &drawn), &pose, centre, groups, (&mut geometry, &mut lights));
        let emitters = lights.len();
        lights.add_punctual(scene, radius);
        let punctual = lights.len() - emitters;

        let images = places(&capacity.limits, &scene.images)?;
        let sky = match &scene.environment {
            Some(environment) => SkyTable::of(environment, &capacity.limits)?.map(|table| (environment, table)),
            None => None,
        };
        let sky_light = sky.as_ref().map(|(_, table)| lights.add_environment(table.weight, radius));
        let of_pieces =
            |material: usize, division: &_| geometry.emission.probabilities(&scene.materials[material], division);
        let lights = lights.finish(of_pieces);
        let mut header = Header::new(&sections, geometry.layout, lights.table.len());
        if let (Some((_, table)), Some(light)) = (&sky, sky_light) {
            header = header.with_environment(table, light, lights.table[light].pmf);
        }

        let used = contents(scene, geometry.layout);
        let drawn: usize = instances.iter().map(|instance| instance.row_count as usize).sum();
        let few_triangles = capacity.on_cpu && drawn <= facets::MOST && !used.alpha_mask && !used.transmission;
        let corners = || geometry.rows.iter().map(|row| row.map(corner)).collect();
        let mut arrangement = Arrangement {
            centre,
            instanced: sections.instanced,
            header,
            instances,
            deforming,
            deepest: tree::DEEPEST,
            lights,
            materials: scene.materials.clone(),
            images,
            few: few_triangles.then(corners),
            lengths: lengths(&pose),
        };
        let top_level = arrangement.top_level(&pose);
        let levels = geometry.depth + top_level.depth;
        let stack = checked_stack(levels)?;
        arrangement.deepest = stack - BESIDE_LEVELS - geometry.depth;
        let texels = sections.joined(&geometry.rows, &top_level.texels, &geometry.nodes);
        capacity.check_texels("triangles and their trees", texels.len())?;
        let Geometry { attributes, rows, .. } = geometry;
        capacity.check_bytes("normals and texture coordinates", size_of_val(attributes.as_slice()))?;
        let contents = SceneContents {
            instanced: sections.instanced,
            deforming: !arrangement.deforming.is_empty(),
            emitters: used.emitters && emitters > 0,
            emitter_pieces: !arrangement.lights.pieces.is_empty(),
            punctual_lights: punctual > 0,
            folded_images: are_folded(&scene.images, capacity),
            environment: sky.is_some(),
            environment_run: sky.as_ref().map_or(0, |(_, table)| 1 << table.cells.run),
            few_triangles,
            levels,
            ..used
        };
        Ok(Self {
            contents,
            stack,
            triangles: rows.len(),
            header: top_level.header,
            geometry: texels,
            attributes,
            materials: arrangement.materials(&pose),
            analytic_lights: arrangement.place_lights(&pose),
            facets: arrangement.facets(&pose),
            images: &scene.images,
            sky,
            pose,
            arrangement,
        })
    }
}

/// Builds the tree of each group and places it once for each of its nodes. Collects the triangles that emit, and the meshes that change
/// their shape.
fn instances(
    (scene, drawn): (&Scene, &[Drawn<'_>]),
    pose: &Pose,
    centre: DVec3,
    groups: Vec<Group>,
    (geometry, lights): (&mut Geometry<'_>, &mut LightList),
) -> (Vec<Instance>, Vec<Deforming>) {
    let (mut instances, mut deforming) = (Vec::new(), Vec::new());
    let (mut first_id, mut first_corner) = (0, 0);
    for group in groups {
        let built = geometry.add(scene, drawn, &group);
        let row_count = group.faces.len() as u32;
        for node in group.placements() {
            let instance = Instance {
                node,
                centre: group.centre,
                root: built.root,
                first_row: built.first_row,
                row_count,
                first_id,
                first_light: lights.len() as u32,
                bounds: built.bounds,
                grid: built.grid,
                first_corner: group.deforms.map(|_| first_corner),
            };
            let placement = instance.placement(pose, centre);
            for (row, face, light) in &built.emitters {
                let number = drawn[face.mesh].posed().mesh.material;
                let material = (number, &scene.materials[number]);
                lights.add_emitter((instances.len(), *row), (face, light), material, placement);
            }
            instances.push(instance);
            first_id += row_count;
        }
        if let Some(mesh) = Deforming::of(drawn, pose, geometry, (&group, built), instances.len() - 1) {
            deforming.push(mesh);
            first_corner += row_count;
        }
    }
    (instances, deforming)
}

/// Slots of the stack beside those of the levels: one for the bottom, one for the mark between the two levels of trees, and one that
/// is written before it is known to be kept.
const BESIDE_LEVELS: u32 = 3;

/// Slots that a traversal of so many levels needs.
fn checked_stack(levels: u32) -> Result<u32, SceneError> {
    let stack = (levels + BESIDE_LEVELS).next_multiple_of(4);
    if stack <= LARGEST_STACK {
        return Ok(stack);
    }
    let reason = format!("their tree has {stack} levels, {LARGEST_STACK} at most can be traversed");
    Err(SceneError::of_scene("triangles", reason))
}

/// The vertex in a texel of the lookup table.
fn corner(texel: Texel) -> [f32; 3] {
    [texel[0], texel[1], texel[2]].map(f32::from_bits)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::description::{IDENTITY, Influence, Light, LightKind, Node, Skin, builtin};
    use wgpu::Limits;

    fn capacity(on_cpu: bool) -> Capacity {
        Capacity { limits: Limits::default(), on_cpu }
    }

    #[test]
    fn what_stands_still_is_one_tree_after_its_table() {
        let scene = builtin::scene("cornell", "static").unwrap();
        let assembly = Assembly::of(&scene, &capacity(false)).unwrap();
        // Six quads and three blocks.
        assert_eq!(assembly.triangles, 6 * 2 + 3 * 12);
        assert!(!assembly.contents.instanced && assembly.arrangement.instances.len() == 1);
        assert_eq!(assembly.header.root() as usize, assembly.triangles * 3 / 2);
        // The two triangles of the lamp and twelve of the blue one, and no other light.
        assert_eq!(assembly.arrangement.lights.table.len(), 14);
        assert_eq!(assembly.analytic_lights.len(), 2);
        assert!(assembly.contents.emitters && !assembly.contents.punctual_lights && !assembly.contents.environment);
        assert!(assembly.facets.is_none() && assembly.sky.is_none());
        assert!(assembly.stack >= assembly.contents.levels + 3 && assembly.stack.is_multiple_of(4));
    }

    #[test]
    fn what_moves_has_a_tree_of_its_own_below_a_top_level() {
        let scene = builtin::scene("cornell", "all").unwrap();
        let mut assembly = Assembly::of(&scene, &capacity(false)).unwrap();
        let arrangement = &mut assembly.arrangement;
        // The static geometry, the lamp and the tall block.
        assert!(assembly.contents.instanced && arrangement.instances.len() == 3);
        let (rest, moved) = (scene.pose(None, 0.0), scene.pose(Some(0), 1.0));
        assert!(arrangement.top_level(&rest).texels != arrangement.top_level(&moved).texels);
        assert!(arrangement.visible(&rest) == arrangement.visible(&rest.clone()));
        assert!(!arrangement.visible(&moved).is_placed_as(&arrangement.visible(&rest)));
        // A light keeps its probability while it moves or is dark.
        let before: Vec<f32> = arrangement.lights.table.iter().map(|light| light.pmf).collect();
        let analytic = arrangement.place_lights(&moved);
        assert!(arrangement.lights.table.iter().map(|light| light.pmf).eq(before));
        assert!(bytemuck::cast_slice::<_, u8>(&analytic) != bytemuck::cast_slice::<_, u8>(&assembly.analytic_lights));
    }

    #[test]
    fn what_changes_its_shape_has_rows_of_its_own() {
        let mut scene = builtin::scene("cornell", "static").unwrap();
        let mesh = scene.nodes[0].meshes[0];
        let vertices = scene.meshes[mesh].positions.len();
        scene.meshes[mesh].influences = vec![Influence { joint: 0, weight: 1.0 }; vertices];
        scene.skins.push(Skin { joints: vec![scene.nodes.len()], inverse_bind: vec![IDENTITY] });
        scene.nodes[0].skin = Some(0);
        scene.nodes.push(Node::default());
        let still = Assembly::of(&scene, &capacity(false)).unwrap();
        assert!(!still.contents.deforming && !still.contents.instanced && still.arrangement.corners().is_empty());
        let triangles = still.triangles;
        scene.nodes.last_mut().unwrap().movable = true;
        let mut moving = Assembly::of(&scene, &capacity(false)).unwrap();
        assert!(moving.contents.deforming && moving.contents.instanced && moving.triangles == triangles);
        let (arrangement, rest) = (&mut moving.arrangement, scene.pose(None, 0.0));
        assert_eq!(arrangement.corners().len(), scene.meshes[mesh].triangles.len());
        assert!(arrangement.reshape(&rest).is_empty(), "the shape at rest is the first");
        let mut pose = rest.clone();
        pose.world.last_mut().unwrap()[3][0] = 1.0;
        let (corners, reshaped) = (arrangement.corners(), arrangement.reshape(&pose));
        assert_eq!((reshaped.len(), reshaped[0].rows.len()), (1, corners.len()));
        for (now, before) in arrangement.corners().iter().flatten().zip(corners.iter().flatten()) {
            assert!((now[0] - before[0] - 1.0).abs() < 1e-6 && now[1..] == before[1..], "{now:?}, {before:?}");
        }
        assert!(!arrangement.visible(&pose).is_shaped_as(&arrangement.visible(&rest)));
        pose.weights[0].push(0.0);
        assert_eq!(arrangement.check(&pose).unwrap_err().element, "lengths");
    }

    #[test]
    fn few_triangles_are_tested_one_by_one_where_the_adapter_is_the_cpu() {
        let scene = builtin::scene("cornell", "all").unwrap();
        let assembly = Assembly::of(&scene, &capacity(true)).unwrap();
        let facets = assembly.facets.unwrap();
        assert!(assembly.contents.few_triangles && assembly.triangles == 48);
        assert_eq!((facets.facets.len(), facets.owners.len()), (48, 48));
        assert_eq!(assembly.arrangement.facet_count(), Some(48));
        let mut rows: Vec<u32> = facets.owners.iter().map(|owner| owner[0]).collect();
        rows.sort_unstable();
        assert!(rows.into_iter().eq(0..48));
        let scene = builtin::scene("pillars", "static").unwrap();
        assert!(Assembly::of(&scene, &capacity(true)).unwrap().facets.is_none());
    }

    #[test]
    fn lights_follow_each_other_by_kind() {
        let mut scene = builtin::scene("pillars", "static").unwrap();
        let light = Light { kind: LightKind::Point, intensity: [1.0; 3], range: f32::INFINITY };
        scene.lights.push(light);
        scene.nodes.push(Node { light: Some(0), ..Default::default() });
        let assembly = Assembly::of(&scene, &capacity(false)).unwrap();
        let table = &assembly.arrangement.lights.table;
        assert_eq!(table.iter().map(|light| light.kind).collect::<Vec<_>>(), [0, 0, 1, 3]);
        assert!((table.iter().map(|light| light.pmf).sum::<f32>() - 1.0).abs() < 1e-6);
        assert!(assembly.contents.punctual_lights && assembly.contents.environment);
        assert_eq!(assembly.sky.unwrap().1.size, [1, 1]);
    }

    #[test]
    fn a_scene_that_is_larger_than_the_device_is_refused() {
        let refused = |name: &str, side: u32| {
            let limits = Limits { max_texture_dimension_2d: side, ..Limits::default() };
            let scene = builtin::scene(name, "static").unwrap();
            Assembly::of(&scene, &Capacity { limits, on_cpu: false }).err().map(|error| error.element)
        };
        assert_eq!(refused("pillars", 1), None);
        assert_eq!(refused("pillars", 0).as_deref(), Some("environment"));
        assert_eq!(refused("cornell", 0).as_deref(), Some("triangles and their trees"));
        assert_eq!(checked_stack(61).unwrap(), 64);
        let error = checked_stack(62).unwrap_err();
        assert_eq!((error.element.as_str(), error.reason.contains("68 levels")), ("triangles", true));
    }

    #[test]
    fn a_pose_of_another_scene_is_refused() {
        let [scene, other] = ["cornell", "pillars"].map(|name| builtin::scene(name, "static").unwrap());
        let arrangement = Assembly::of(&scene, &capacity(false)).unwrap().arrangement;
        let mut pose = scene.pose(None, 0.0);
        assert!(arrangement.check(&pose).is_ok());
        assert_eq!(arrangement.check(&other.pose(None, 0.0)).unwrap_err().element, "lengths");
        pose.emission[0] = [-1.0; 3];
        assert_eq!(arrangement.check(&pose).unwrap_err().element, "emission or intensity");
        pose.world[2][0][0] = f64::NAN;
        assert_eq!(arrangement.check(&pose).unwrap_err().element, "world[2]");
    }
}
