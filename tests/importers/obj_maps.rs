//! MTL files: textures.

use std::io::Cursor;

use asvgf::scene::{Alpha, Image, Loaded, Material, Texture, Wrap, load};

use crate::common::*;

/// A PNG file of these texels, with or without alpha.
fn picture(width: u32, texels: &[[u8; 4]], alpha: bool) -> Vec<u8> {
    let mut bytes = Cursor::new(Vec::new());
    let image = image::RgbaImage::from_raw(width, texels.len() as u32 / width, texels.as_flattened().to_vec()).unwrap();
    let image = image::DynamicImage::from(image);
    let image = if alpha { image } else { image.into_rgb8().into() };
    image.write_to(&mut bytes, image::ImageFormat::Png).unwrap();
    bytes.into_inner()
}

const BLACK: [u8; 4] = [0, 0, 0, 255];
const WHITE: [u8; 4] = [255; 4];
const RED: [u8; 4] = [200, 10, 20, 255];

/// Loads a triangle with a material, beside images of 2 × 1 texels.
fn textured(mtl: &str) -> Loaded {
    let folder = Folder::new();
    folder.write("red.png", picture(2, &[RED; 2], false));
    folder.write("mask.png", picture(2, &[BLACK, WHITE], false));
    folder.write("half.png", picture(2, &[[128, 128, 128, 255], WHITE], false));
    folder.write("small.png", picture(1, &[[64, 64, 64, 255]], false));
    folder.write("packed.png", picture(2, &[[0, 50, 150, 255]; 2], false));
    folder.write("leaf.png", picture(2, &[[200, 10, 20, 0], RED], true));
    folder.write("cover.png", picture(2, &[[255, 255, 255, 0], WHITE], true));
    folder.write("test.mtl", format!("newmtl m\n{mtl}"));
    let text = "mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
    load(folder.write("test.obj", text)).unwrap()
}

fn texels(loaded: &Loaded, texture: impl Fn(&Material) -> Option<Texture>) -> Vec<[u8; 4]> {
    loaded.scene.images[texture(&loaded.scene.materials[0]).unwrap().image].texels.clone()
}

fn base(loaded: &Loaded) -> Vec<[u8; 4]> {
    texels(loaded, |material| material.base_color_texture)
}

#[test]
fn textures_with_options() {
    let folder = Folder::new();
    folder.write("maps/my leaf.png", png(2, 2, [1, 2, 3, 4]));
    folder.write(
        "test.mtl",
        "newmtl m\nmap_Kd -s 2 3 1 -o 0.5 0.25 -clamp on -bm 1 -mm 0 1 maps\\my leaf.png\nmap_d maps/my leaf.png\n\
         map_Ke maps/my leaf.png\nnewmtl n\nmap_Kd absent.png\n",
    );
    let text = "mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
    let loaded = load(folder.write("test.obj", text)).unwrap();
    assert_warnings(&loaded, &[("material \"n\"", "absent.png")]);
    let material = &loaded.scene.materials[0];
    let texture = material.base_color_texture.unwrap();
    assert_eq!(loaded.scene.images.len(), 1);
    assert_eq!(loaded.scene.images[texture.image].texels, [[1, 2, 3, 4]; 4]);
    assert_eq!((texture.wrap, material.alpha), ([Wrap::Clamp; 2], Alpha::Blend));
    assert_eq!((material.base_color, material.emissive), ([1.0; 4], [1.0; 3]));
    // (u, v) = (0.1, 0.2) with v upwards is (0.1, 0.8) here; it maps to (0.7, 0.85) upwards.
    let at = texture.transform.map(|row| row[0] * 0.1 + row[1] * 0.8 + row[2]);
    assert_close(&at, &[0.7, 0.15], 1e-6);
    assert_eq!(loaded.scene.materials[1].base_color_texture, None);
}
#[test]
fn opacity_of_a_file_of_its_own() {
    let mask = textured("Kd 1 1 1\nmap_Kd red.png\nmap_d mask.png\n");
    assert_warnings(&mask, &[]);
    assert_eq!(base(&mask), [[200, 10, 20, 0], RED]);
    assert_eq!((mask.scene.materials[0].alpha, mask.scene.images.len()), (Alpha::Blend, 1));
    let alone = textured("Kd 0 1 0\nmap_d mask.png\n");
    assert_eq!(base(&alone), [[255, 255, 255, 0], WHITE]);
    assert_eq!(alone.scene.materials[0].base_color, [0.0, 1.0, 0.0, 1.0]);
    // Both maps are the same file: opacity is its alpha channel if it has one, otherwise its colour.
    let leaf = textured("map_Kd leaf.png\nmap_d leaf.png\n");
    assert_eq!((base(&leaf), leaf.scene.materials[0].alpha), (vec![[200, 10, 20, 0], RED], Alpha::Blend));
    let grey = textured("map_Kd mask.png\nmap_d mask.png\n");
    assert_eq!(base(&grey), [[0; 4], WHITE]);
    assert_warnings(&grey, &[]);
    let colored = textured("map_Kd red.png\nmap_d red.png\n");
    assert_warnings(&colored, &[("material \"m\"", "which has no alpha channel; the surface is drawn as opaque")]);
    assert_eq!(colored.scene.materials[0].alpha, Alpha::Opaque);
    // An image of one colour can only mean its alpha channel.
    assert_eq!(base(&textured("map_Kd red.png\nmap_d cover.png\n")), [[200, 10, 20, 0], RED]);
    assert_eq!(base(&textured("map_Kd red.png\nmap_d -imfchan r leaf.png\n")), [[200, 10, 20, 200]; 2]);
    assert_eq!(base(&textured("map_Kd red.png\nmap_d -imfchan m leaf.png\n")), [[200, 10, 20, 0], RED]);
}

#[test]
fn images_of_different_sizes_and_places() {
    let finer = textured("map_Kd small.png\nmap_d mask.png\n");
    assert_warnings(&finer, &[]);
    assert_eq!(base(&finer), [[64, 64, 64, 0], [64, 64, 64, 255]]);
    assert_eq!(base(&textured("map_Kd red.png\nmap_d small.png\n")), [[200, 10, 20, 64]; 2]);
    let placed = textured("map_Kd -s 2 2 1 red.png\nmap_d -s 3 3 1 mask.png\n");
    assert_warnings(&placed, &[("material \"m\"", "map_d is placed otherwise than map_Kd")]);
    assert_eq!(placed.scene.materials[0].base_color_texture.unwrap().transform[0][0], 2.0);
    let absent = textured("map_Kd red.png\nmap_d absent.png\n");
    assert_warnings(&absent, &[("material \"m\"", "absent.png")]);
    assert_eq!((base(&absent), absent.scene.materials[0].alpha), (vec![RED; 2], Alpha::Opaque));
}

#[test]
fn images_that_are_something_else() {
    let folder = Folder::new();
    folder.write("a.png", "version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 1\n");
    folder.write("b.png", "<!DOCTYPE html>");
    folder.write("c.png", &png(1, 1, RED)[..40]);
    folder.write("test.mtl", "newmtl a\nmap_Kd a.png\nnewmtl b\nmap_Kd b.png\nnewmtl c\nmap_Kd c.png\n");
    let loaded = load(folder.write("test.obj", "mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")).unwrap();
    let expected = [("\"a\"", "is a Git LFS pointer"), ("\"b\"", "is an HTML page"), ("\"c\"", "cannot be decoded")];
    assert_warnings(&loaded, &expected);
}

#[test]
fn an_image_is_made_once() {
    let two = textured("map_Kd red.png\nmap_d mask.png\nnewmtl n\nmap_d mask.png\nmap_Kd red.png\nmap_Ke red.png\n");
    let names: Vec<_> = two.scene.images.iter().map(|image: &Image| (&*image.name, image.texels.len())).collect();
    assert_eq!(names, [("mask.png", 2), ("red.png", 2)]);
    assert_eq!(two.scene.materials[0].base_color_texture, two.scene.materials[1].base_color_texture);
}

#[test]
fn roughness_and_metalness_in_one_texture() {
    let surface = |mtl: &str| {
        let loaded = textured(mtl);
        let material = &loaded.scene.materials[0];
        let factors = [material.roughness, material.metallic];
        (texels(&loaded, |material| material.metallic_roughness_texture), factors)
    };
    let rough = [[255, 128, 255, 255], WHITE];
    assert_eq!(surface("Pr 0.1\nPm 0.25\nmap_Pr half.png\n"), (rough.to_vec(), [1.0, 0.25]));
    assert_eq!(surface("map_Pr half.png\n"), (rough.to_vec(), [1.0, 0.0]));
    let metal = [[255, 255, 128, 255], WHITE];
    assert_eq!(surface("Pr 0.5\nPm 0\nmap_Pm half.png\n"), (metal.to_vec(), [0.5, 1.0]));
    let both = [[255, 128, 64, 255], [255, 255, 64, 255]];
    assert_eq!(surface("map_Pr half.png\nmap_Pm small.png\n"), (both.to_vec(), [1.0; 2]));
    // The channels are packed as in glTF.
    assert_eq!(surface("map_Pr packed.png\nmap_Pm packed.png\n"), (vec![[0, 50, 150, 255]; 2], [1.0; 2]));
    let channels = surface("map_Pr -imfchan b packed.png\nmap_Pm -imfchan g packed.png\n");
    assert_eq!(channels, (vec![[255, 150, 50, 255]; 2], [1.0; 2]));
    let absent = textured("Pr 0.3\nmap_Pr absent.png\n");
    assert_warnings(&absent, &[("material \"m\"", "absent.png")]);
    assert_eq!(absent.scene.materials[0].roughness, 0.3);
    let placed = textured("map_Pr -o 0.5 0 half.png\nmap_Pm small.png\n");
    assert_warnings(&placed, &[("material \"m\"", "map_Pm is placed otherwise than map_Pr")]);
}

#[test]
fn colours_of_textures() {
    let specular = textured("Kd 0.5 0.5 0.5\nKs 0.2 0.2 0.2\nmap_Ks red.png\n");
    assert_warnings(&specular, &[]);
    assert_eq!(texels(&specular, |material| material.specular_color_texture), [RED; 2]);
    let metal = textured("Kd 0 0 0\nKs 0.9 0.9 0.9\nmap_Ks red.png\n");
    assert_eq!((base(&metal), metal.scene.materials[0].metallic), (vec![RED; 2], 1.0));
    let matte = textured("illum 1\nKs 0.9 0.9 0.9\nmap_Ks red.png\n");
    assert_eq!(matte.scene.materials[0].specular_color_texture, None);
    let black = textured("Kd 0 0 0\nmap_Kd red.png\n");
    assert_warnings(&black, &[("material \"m\"", "Kd is black")]);
    assert_eq!((base(&black), black.scene.materials[0].base_color), (vec![RED; 2], [1.0; 4]));
    let glow = &textured("Ke 2 3 4\nmap_Ke red.png\n").scene.materials[0];
    assert_eq!((glow.emissive, glow.emissive_texture.is_some()), ([2.0, 3.0, 4.0], true));
}

#[test]
fn textures_need_texture_coordinates() {
    let folder = Folder::new();
    folder.write("a #1.png", png(1, 1, RED));
    folder.write("test.mtl", "newmtl m\nmap_Kd a #1.png\n");
    let text = "mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\no thing\nusemtl m\nf 1 2 3\n";
    let loaded = load(folder.write("test.obj", text)).unwrap();
    assert_warnings(&loaded, &[("object \"thing\"", "without texture coordinates have the material \"m\"")]);
    // Text that looks like a comment may be part of a name.
    assert!(loaded.scene.materials[0].base_color_texture.is_some());
}

#[test]
fn normal_maps_and_heights() {
    let folder = Folder::new();
    folder.write("relief.png", picture(2, &[[128, 128, 255, 255], [200, 128, 230, 255]], false));
    folder.write("heights.png", picture(2, &[[200, 200, 200, 255], [220, 220, 220, 255]], false));
    let material = |mtl: &str| {
        folder.write("test.mtl", format!("newmtl m\n{mtl}"));
        let text = "mtllib test.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n";
        load(folder.write("test.obj", text)).unwrap()
    };
    let map = |loaded: &Loaded| {
        let material = &loaded.scene.materials[0];
        material.normal_texture.map(|texture| (loaded.scene.images[texture.image].texels[1], material.normal_scale))
    };
    let relief = Some(([200, 128, 230, 255], 1.0));
    for mtl in ["norm relief.png\n", "map_Bump relief.png\n", "bump heights.png\nnorm relief.png\n"] {
        let loaded = material(mtl);
        assert_eq!(map(&loaded), relief, "{mtl}");
        assert_eq!(loaded.warnings.len(), usize::from(mtl.contains("heights")), "{mtl}");
    }
    assert_eq!(map(&material("map_bump -bm 0.25 -s 2 2 1 relief.png\n")), Some(([200, 128, 230, 255], 0.25)));
    let heights = material("map_bump heights.png\n");
    assert_warnings(&heights, &[("material \"m\"", "map_bump has heights, which are not read")]);
    assert_eq!(map(&heights), None);
    assert!(heights.scene.images.is_empty(), "an image that is not used is not kept");
}
