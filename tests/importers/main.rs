//! Importers, image files and the checks of scenes, on small files that the tests write themselves.
#![cfg(all(feature = "gltf", feature = "obj"))]

mod common;
#[path = "../common/shared.rs"]
mod shared;

mod animation;
mod documentation;
mod environment;
mod gltf_deformation;
mod gltf_errors;
mod gltf_geometry;
mod gltf_materials;
mod gltf_mending;
mod gltf_nodes;
mod gltf_normal_maps;
mod gltf_pointers;
mod gltf_shapes;
mod gltf_specular;
mod image_io;
mod images;
mod memory;
mod obj;
mod obj_broken;
mod obj_colors;
mod obj_faces;
mod obj_maps;
mod obj_materials;
mod obj_normals;
mod obj_oracle;
mod obj_text;
mod obj_wild;
mod paths;
mod properties;
mod scene;
mod shipped;
mod strangers;
mod wild;
