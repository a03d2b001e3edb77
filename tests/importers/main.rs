//! Importers, image files and the checks of scenes, on small files that the tests write themselves.
#![cfg(all(feature = "gltf", feature = "obj"))]

mod common;

mod animation;
mod environment;
mod gltf_errors;
mod gltf_geometry;
mod gltf_materials;
mod gltf_nodes;
mod image_io;
mod memory;
mod obj;
mod obj_broken;
mod obj_colors;
mod obj_faces;
mod obj_maps;
mod obj_materials;
mod obj_normals;
mod obj_text;
mod obj_wild;
mod paths;
mod scene;
