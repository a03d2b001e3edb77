//! glTF files and environments modelled on reports to loaders, from `../shared/wild` next to the repository if it is at hand.

use asvgf::scene::{Alpha, Environment, Loaded, load};

use crate::common::*;
use crate::shared::shared;

fn color(loaded: &Loaded) -> [f32; 4] {
    loaded.scene.materials[loaded.scene.meshes[0].material].base_color
}

#[test]
fn gltf_files_in_the_wild() {
    let Some(folder) = shared("wild/gltf") else { return };
    let file = |name: &str| folder.join(if name.contains('.') { name.to_owned() } else { format!("{name}.gltf") });
    let read = |name: &str| load(file(name)).unwrap_or_else(|error| panic!("{error}"));
    for name in
        ["unpadded.glb", "float_enum", "float_count", "float_index", "stride0", "data_percent", "skin_plain", "morph"]
    {
        assert_warnings(&read(name), &[]);
        assert!((area(&read(name)) - 4.0).abs() < 1e-4, "{name}: {}", area(&read(name)));
        assert_close(bounds(&read(name)).as_flattened(), &[-1.0, -1.0, 0.0, 1.0, 1.0, 0.0], 1e-5);
        assert_eq!(color(&read(name)), [0.5, 0.25, 0.125, 1.0], "{name}");
    }
    for (name, element, reason) in [
        ("anim_no_keys", "samplers[0].input", "no keys; the channel is left out"),
        ("gl_clamp", "textures[0].sampler", "the texture repeats"),
        ("rot0", "nodes[0].rotation", "the identity is used"),
        ("rot_null", "nodes[0].rotation", "null"),
        ("backslash0", "images[0]", "\"tex/re d.png\" is read instead"),
        ("backslash1", "images[0]", "\"tex/re d.png\" is read instead"),
        ("backslash_bin", "buffers[0]", "\"tex/mesh.bin\" is read instead"),
        ("image_ktx2", "images[0]", "KTX2"),
    ] {
        assert_warnings(&read(name), &[(element, reason)]);
    }
    for name in ["backslash0", "backslash1", "image_bmp", "image_webp", "gl_clamp"] {
        let image = read(name).scene.images[0].texels[0];
        assert!(std::iter::zip(image, [255, 0, 0, 255]).all(|(a, b)| a.abs_diff(b) <= 1), "{name}: {image:?}");
    }
    for name in ["instancing_used", "instancing_required"] {
        assert_warnings(&read(name), &[]);
        assert_eq!(read(name).scene.triangle_count(), 6, "{name}");
    }
    for name in ["color_u8rgb", "color_f32rgb"] {
        assert_warnings(&read(name), &[]);
        assert!(!read(name).scene.meshes[0].colors.is_empty(), "{name}");
    }
    for (name, reflectance) in [("specular0", 0.0), ("ior1", 0.0), ("ior2", 1.0 / 9.0)] {
        assert_warnings(&read(name), &[]);
        assert_close(&read(name).scene.materials[0].specular, &[reflectance; 3], 1e-6);
    }
    let blend = read("blend");
    assert_warnings(&blend, &[]);
    assert_eq!((blend.scene.materials[1].alpha, blend.scene.materials[1].base_color[3]), (Alpha::Blend, 0.3));
    let green = color(&read("specgloss"));
    assert_close(&green, &[0.1 * 0.96, 0.6 * 0.96, 0.1 * 0.96, 1.0], 1e-5);
    for (name, reason) in [
        ("pointer.glb", "Git LFS pointer"),
        ("pointer.gltf", "Git LFS pointer"),
        ("page.glb", "HTML page"),
        ("one.gltf", "glTF 1.0"),
    ] {
        assert_error(load(folder.join(name)), name, "", reason);
    }
}

#[test]
fn environments_in_the_wild() {
    let Some(folder) = shared("wild/env") else { return };
    for (name, corners, warnings) in [
        ("rgbe.hdr", [[4.0, 0.5, 0.25], [0.25, 0.5, 2.0]], 0),
        ("crlf.hdr", [[4.0, 0.5, 0.25], [0.25, 0.5, 2.0]], 0),
        ("plusY.hdr", [[4.0, 0.5, 0.25], [0.25, 0.5, 2.0]], 0),
        ("xmajor.hdr", [[4.0, 0.5, 0.25], [0.25, 0.5, 2.0]], 0),
        ("yc.exr", [[4.0, 0.5, 0.25], [0.25, 0.5, 2.0]], 0),
        ("window.exr", [[4.0, 0.5, 0.25], [0.0; 3]], 0),
        ("neg.exr", [[0.0, 0.5, 0.25], [0.0, 0.5, 2.0]], 1),
        ("inf.exr", [[65504.0, 0.5, 0.25], [0.25, 0.5, 2.0]], 1),
    ] {
        let (environment, said) = Environment::load(folder.join(name)).unwrap_or_else(|error| panic!("{error}"));
        assert_eq!(said.len(), warnings, "{name}: {said:?}");
        let [first, last] = [environment.radiance[0], *environment.radiance.last().unwrap()];
        assert_close(&[first, last].concat(), &corners.concat(), 1e-3);
    }
    // Colours of ACES exceed those of Rec. 709. They are converted, and negative values become 0 with a warning.
    let (environment, said) = Environment::load(folder.join("ap0.exr")).unwrap();
    assert_eq!(said.len(), 1);
    assert!(environment.radiance[0][0] > 9.0, "{:?}", environment.radiance[0]);
}
