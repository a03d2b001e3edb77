//! OBJ files modelled on reports to loaders, from `../shared/wild/obj` next to the repository if it is at hand.

use asvgf::scene::{Alpha, Loaded, load};

use crate::common::*;
use crate::shared::shared;

/// The colour of the material that is drawn.
fn color(loaded: &Loaded) -> [f32; 4] {
    loaded.scene.materials[loaded.scene.meshes[0].material].base_color
}

fn first_texel(loaded: &Loaded) -> [u8; 4] {
    let material = &loaded.scene.materials[loaded.scene.meshes[0].material];
    loaded.scene.images[material.base_color_texture.unwrap().image].texels[0]
}

#[test]
fn files_in_the_wild() {
    let Some(folder) = shared("wild/obj") else { return };
    let read = |name: &str| load(folder.join(format!("{name}.obj"))).unwrap_or_else(|error| panic!("{error}"));
    for name in ["quad_a", "quad_b", "concave_arrow"] {
        assert_warnings(&read(name), &[]);
        assert!((area(&read(name)) - 0.64).abs() < 1e-6, "{name}");
    }
    for name in ["zero_normal", "zero_uv", "vn_qnan", "vt_nan"] {
        assert_eq!((area(&read(name)), read(name).warnings.len()), (4.0, 1), "{name}");
    }
    for name in ["d_tr0", "d_tr1", "lower", "cr"] {
        assert_warnings(&read(name), &[]);
        let material = &read(name).scene.materials[0];
        assert_eq!((color(&read(name)), material.alpha), ([0.5, 0.25, 0.125, 1.0], Alpha::Opaque), "{name}");
    }
    assert_eq!(first_texel(&read("lower_map"))[1..], [0, 0, 255]);
    for name in ["path0", "path1", "path2", "path5"] {
        let loaded = read(name);
        assert_warnings(&loaded, &[("material \"m\"", "\"red.png\" is read instead")]);
        assert_eq!(first_texel(&loaded), first_texel(&read("lower_map")), "{name}");
    }
    for name in ["quoted_lib", "abs_lib"] {
        let loaded = read(name);
        assert_warnings(&loaded, &[("line 1", "\"quoted.mtl\" is read instead")]);
        assert_eq!(color(&loaded), [0.5, 0.25, 0.125, 1.0], "{name}");
    }
    let metal = &read("pbr").scene.materials[0];
    assert_eq!((metal.base_color, metal.roughness, metal.metallic), ([0.9, 0.6, 0.3, 1.0], 0.2, 1.0));
    assert_warnings(&read("glass"), &[("object \"\"", "faces of its glass enclose no body")]);
    for name in ["mapd", "mapd_alone", "mapd_same_grey"] {
        let loaded = read(name);
        assert_warnings(&loaded, &[]);
        assert_eq!(loaded.scene.materials[0].alpha, Alpha::Blend, "{name}");
        let texels = loaded.scene.images.iter().flat_map(|image| &image.texels);
        assert!(texels.clone().any(|texel| texel[3] == 0) && texels.clone().any(|texel| texel[3] == 255), "{name}");
    }
    for name in ["tex_tga", "tex_bmp", "tex_webp", "tex_tiff"] {
        assert_warnings(&read(name), &[]);
        // WebP is lossy.
        assert!(std::iter::zip(first_texel(&read(name)), [255, 0, 0, 255]).all(|(a, b)| a.abs_diff(b) <= 1), "{name}");
    }
    let mesh = &read("smooth").scene.meshes[0];
    for (position, normal) in std::iter::zip(&mesh.positions, &mesh.normals) {
        assert_close(normal, &[position[0], 0.0, position[2]], 1e-6);
    }
    assert_eq!(read("vcol").scene.meshes[0].colors, [[1.0, 0.0, 0.0, 1.0]; 4]);
    assert_warnings(&read("bigs"), &[("line 11", "points and lines")]);
    assert_eq!(area(&read("bigs")), 4.0);
    assert_error(load(folder.join("pointer.obj")), "pointer.obj", "file", "is a Git LFS pointer");
}
