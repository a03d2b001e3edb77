//! MTL files: materials.

use asvgf::scene::{Alpha, Loaded, Mesh};
use glam::Vec3;

use crate::common::*;
use crate::obj::{SQUARE, material, read};

#[test]
fn diffuse_glossy_metallic_and_emitting_materials() {
    let diffuse = &material("Kd 0.1 0.2 0.3\nKe 17 12 4\nKs 0 0 0\nNs 10\n").scene.materials[0];
    assert_eq!((diffuse.base_color, diffuse.emissive), ([0.1, 0.2, 0.3, 1.0], [17.0, 12.0, 4.0]));
    assert_eq!((diffuse.metallic, diffuse.specular), (0.0, [0.0; 3]));

    let glossy = &material("Kd 0.5 0.5 0.5\nKs 0.2 0.4 0.1\nNs 30\nillum 2\n").scene.materials[0];
    assert_eq!((glossy.metallic, glossy.specular), (0.0, [0.2, 0.4, 0.1]));
    assert_close(&[glossy.roughness], &[(2.0_f32 / 32.0).powf(0.25)], 1e-6);

    let metal = &material("Kd 0 0 0\nKs 0.725 0.71 0.68\nNs 200\n").scene.materials[0];
    assert_eq!((metal.metallic, metal.base_color), (1.0, [0.725, 0.71, 0.68, 1.0]));

    let matte = &material("Kd 0.5\nKs 0.9 0.9 0.9\nillum 1\n").scene.materials[0];
    assert_eq!(matte.specular, [0.0; 3]);
}

#[test]
fn opacity() {
    for (text, opacity) in [("d 0.2\n", 0.2), ("Tr 0.25\n", 0.75), ("Tr 0\nd 0.1\n", 0.1)] {
        let loaded = material(text);
        assert_warnings(&loaded, &[]);
        assert_eq!((loaded.scene.materials[0].alpha, loaded.scene.materials[0].base_color[3]), (Alpha::Blend, opacity));
    }
    assert_warnings(&material("d 0\n"), &[("material \"m\"", "its opacity is 0")]);
    assert_warnings(&material("d -halo 1\n"), &[]);
    // `d` wins over `Tr` in any order.
    for both in ["d 1\nTr 1\n", "Tr 1\nd 1\n", "TR 0\nD 1.0\n"] {
        assert_warnings(&material(both), &[]);
        assert_eq!(material(both).scene.materials[0].alpha, Alpha::Opaque);
    }
}

#[test]
fn statements_that_cannot_be_read_are_left_out() {
    let loaded = material(
        "Kd spectral file.rfl\nKs 1 2\nNs\nKe nan 0 0\nmap_Kd\nmap_Ke -what 1 a.png\ndisp b.png\nmap_Ks c.png\n",
    );
    assert_warnings(
        &loaded,
        &[
            ("test.mtl line 2", "Kd: \"spectral\" is not a number"),
            ("test.mtl line 3", "Ks: 2 numbers"),
            ("test.mtl line 4", "Ns: there is no number"),
            ("test.mtl line 5", "Ke: NaN"),
            ("test.mtl line 6", "map_Kd: there is no file name"),
            ("test.mtl line 7", "the option -what"),
            ("test.mtl line 8", "displacement maps"),
            ("test.mtl material \"m\"", "\"c.png\" cannot be read"),
        ],
    );
}

#[test]
fn roughness_and_metalness() {
    let metal = &material("Kd .9 .6 .3\nPr 0.2\nPm 1.0\nKs 1 1 1\n").scene.materials[0];
    assert_eq!((metal.base_color, metal.roughness, metal.metallic), ([0.9, 0.6, 0.3, 1.0], 0.2, 1.0));
    assert_close(&metal.specular, &[0.04; 3], 1e-6);
    // A dielectric reflects by its index of refraction, even if Kd is black.
    let dielectric = &material("Kd 0 0 0\nKs 0.5 0.5 0.5\nPr 0.5\nNi 2\n").scene.materials[0];
    assert_eq!((dielectric.metallic, dielectric.roughness), (0.0, 0.5));
    assert_close(&dielectric.specular, &[1.0 / 9.0; 3], 1e-6);
    let shiny = &material("Pm 0.5\nNs 30\n").scene.materials[0];
    assert_close(&[shiny.roughness, shiny.metallic], &[(2.0_f32 / 32.0).powf(0.25), 0.5], 1e-6);
    assert_warnings(&material("Pr 2\n"), &[("material \"m\"", "2 is outside 0…1; 1 is used")]);
}

#[test]
fn illumination_models() {
    let made = |model: &str| material(&format!("Kd 0 0 0\nKs 1 1 1\nNi 1.5\nillum {model}\n"));
    for matte in ["0", "1"] {
        assert_eq!(made(matte).scene.materials[0].specular, [0.0; 3]);
    }
    for glossy in ["2", "3", "5", "8"] {
        assert_warnings(&made(glossy), &[]);
        assert_eq!(made(glossy).scene.materials[0].metallic, 1.0);
    }
    for glass in ["4", "6", "7", "9"] {
        let loaded = made(glass);
        let open = [("object \"\"", "faces of its glass enclose no body; they are drawn as panes")];
        assert_warnings(&loaded, if ["6", "7"].contains(&glass) { &open } else { &[] });
        let material = &loaded.scene.materials[0];
        assert_eq!((material.metallic, material.alpha), (0.0, Alpha::Opaque), "no mirror");
        assert_eq!((material.transmission, material.interior.absorption), (1.0, None), "a pane");
        assert_eq!((material.base_color, material.interior.index, material.roughness), ([1.0; 4], 1.5, 0.0));
        assert_close(&material.specular, &[0.04; 3], 1e-6);
    }
    assert_warnings(&made("12"), &[("material \"m\"", "illum 12 is not known; 2 is used")]);
    assert_eq!(material("illum 7\nNs 10\nPr 0.5\n").scene.materials[0].roughness, 0.5);
    let tinted = &material("illum 6\nNi 1.33\nTf 1 0.5 0.25\n").scene.materials[0];
    assert_eq!((tinted.base_color, tinted.interior.index), ([1.0, 0.5, 0.25, 1.0], 1.33));
    assert_eq!(material("illum 4\nNi 5\n").scene.materials[0].interior.index, 5.0);
    for index in ["0", "1", "10.5"] {
        let loaded = material(&format!("illum 4\nNi {index}\n"));
        let reason = format!("Ni {index} is not above 1 and at most 10; 1.5 is used");
        assert_warnings(&loaded, &[("material \"m\"", reason.as_str())]);
        assert_eq!(loaded.scene.materials[0].interior.index, 1.5);
    }
    let black = material("illum 4\nTf 0 0 0\n");
    assert_warnings(
        &black,
        &[("material \"m\"", "Tf is black, and no light would go through the glass; white is used")],
    );
    assert_eq!(black.scene.materials[0].base_color, [1.0; 4]);
    // One defect gives one warning.
    assert_warnings(&material("illum 9\nd 0.75\nTf 1 0 0\n"), &[("m", "illum 9 (glass) does not refract")]);
    assert_warnings(&material("illum 2\nTf 1 1 1\n"), &[]);
    assert_warnings(&material("illum 2\nTf 1 0.5 1\n"), &[("m", "Tf (coloured transmission) is not read")]);
}

/// A cube of eight corners, with one face left out if it is open.
fn cube(faces: &[&str]) -> String {
    let corners = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n";
    format!("mtllib test.mtl\n{corners}o cube\nusemtl m\nf {}\n", faces.join("\nf "))
}

const OUTWARDS: [&str; 6] = ["4 3 2 1", "5 6 7 8", "1 2 6 5", "2 3 7 6", "3 4 8 7", "4 1 5 8"];
const INWARDS: [&str; 6] = ["1 2 3 4", "8 7 6 5", "5 6 2 1", "6 7 3 2", "7 8 4 3", "8 5 1 4"];

#[test]
fn closed_glass_is_a_body() {
    let mtl = "newmtl m\nillum 7\nNi 1.33\nTf 0.25 1 0.64\n";
    // The back's corner 1 has a second position of the same coordinates.
    let seam = [&["4 3 2 9"], &OUTWARDS[1..]].concat();
    let seam = cube(&seam).replace("o cube", "v -0 0 0\no cube");
    for (text, name) in [(cube(&OUTWARDS), "outwards"), (cube(&INWARDS), "inwards"), (seam, "with a seam")] {
        let loaded = read(text, mtl).unwrap();
        assert_warnings(&loaded, &[]);
        let mesh = &loaded.scene.meshes[0];
        let material = &loaded.scene.materials[mesh.material];
        assert_eq!((material.transmission, material.interior.index), (1.0, 1.33), "{name}");
        assert_eq!(material.interior.absorption, Some([0.0; 3]), "{name}");
        assert_close(&material.base_color, &[0.5, 1.0, 0.8, 1.0], 1e-6);
        let [a, b, c] = mesh.triangles[0].map(|corner| mesh.positions[corner as usize]);
        let [u, v] = [b, c].map(|p| [p[0] - a[0], p[1] - a[1]]);
        assert!(u[0] * v[1] - u[1] * v[0] < 0.0, "{name}: the face at z = 0 looks to −Z");
    }
    let turned = [&OUTWARDS[..5], &[INWARDS[5]]].concat();
    for faces in [&OUTWARDS[1..], &turned] {
        let loaded = read(cube(faces), mtl).unwrap();
        assert_warnings(&loaded, &[("object \"cube\"", "faces of its glass enclose no body; they are drawn as panes")]);
        let material = &loaded.scene.materials[loaded.scene.meshes[0].material];
        assert_eq!((material.interior.absorption, material.base_color), (None, [0.25, 1.0, 0.64, 1.0]));
    }
    let thin = read(cube(&OUTWARDS), mtl.replace("illum 7", "illum 4")).unwrap();
    assert_eq!(thin.scene.materials[thin.scene.meshes[0].material].interior.absorption, None, "4 does not refract");
}

/// Signed volume of the triangles whose material is a body.
fn volume_of_bodies(loaded: &Loaded) -> f32 {
    let scene = &loaded.scene;
    let of_mesh = |mesh: &Mesh| {
        let corner = |&[a, b, c]: &[u32; 3]| {
            let [a, b, c] = [a, b, c].map(|corner| Vec3::from(mesh.positions[corner as usize]));
            a.dot(b.cross(c)) / 6.0
        };
        mesh.triangles.iter().map(corner).sum::<f32>()
    };
    let is_body = |mesh: &&Mesh| scene.materials[mesh.material].interior.absorption.is_some();
    scene.meshes.iter().filter(is_body).map(of_mesh).sum()
}

/// A cube of this size from this corner on, with faces in this order.
fn moved_cube(first: usize, low: f32, size: f32, faces: &[&str]) -> String {
    let corners = [[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 1], [1, 1, 1], [0, 1, 1]];
    let vertex = |corner: [i32; 3]| {
        let [x, y, z] = corner.map(|c| low + size * c as f32);
        format!("v {x} {y} {z}\n")
    };
    let face = |face: &&str| {
        let shifted: Vec<_> = face.split(' ').map(|i| (i.parse::<usize>().unwrap() + first).to_string()).collect();
        format!("f {}\n", shifted.join(" "))
    };
    corners.map(vertex).concat() + &faces.iter().map(face).collect::<String>()
}

#[test]
fn glass_is_closed_whatever_its_objects_are() {
    let mtl = "newmtl m\nillum 7\nNi 1.5\n";
    let load = |text: &str| read(format!("mtllib test.mtl\nusemtl m\n{text}"), mtl).unwrap();
    let assert_volume = |loaded: &Loaded, expected: f32, name: &str| {
        let found = volume_of_bodies(loaded);
        assert!((found - expected).abs() < 1e-4, "{name}: {found}, not {expected}");
    };
    let large = moved_cube(0, 0.0, 1.0, &OUTWARDS);
    // Each face of its own group; some with coordinates, some smooth.
    let mut parted = large.replace("f 1 2 6 5", "vt 0 0\ng part\ns 1\nf 1/1 2/1 6/1 5/1\ns off");
    parted = parted.replace("f 3 4 8 7", "o other\nf 3 4 8 7");
    let whole = load(&parted);
    assert_warnings(&whole, &[]);
    assert_volume(&whole, 1.0, "one surface in parts");
    for inner in [&OUTWARDS, &INWARDS] {
        for outer in [&OUTWARDS, &INWARDS] {
            let hollow = moved_cube(0, 0.0, 1.0, outer) + &moved_cube(8, 0.25, 0.5, inner);
            assert_volume(&load(&hollow), 1.0 - 0.125, "a hollow cube");
            let apart = moved_cube(0, 0.0, 1.0, outer) + &moved_cube(8, 2.0, 0.5, inner);
            assert_volume(&load(&apart), 1.0 + 0.125, "two cubes");
        }
    }
    // A loose triangle stays a pane, and the cube is a body.
    let loose = load(&format!("{large}v 5 5 5\nv 6 5 5\nv 5 6 5\nf 9 10 11\n"));
    assert_warnings(&loose, &[("object", "faces of its glass enclose no body")]);
    assert_volume(&loose, 1.0, "beside a loose triangle");
    assert_eq!(loose.scene.triangle_count(), 13);
    let sheet = load("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\nf 3 2 1\n");
    assert_warnings(&sheet, &[("object", "faces of its glass enclose no body")]);
    let doubled = load(&moved_cube(0, 0.0, 1.0, &[&OUTWARDS[..], &INWARDS[..]].concat()));
    assert_volume(&doubled, 0.0, "a cube of two-sided faces");
}

#[test]
fn clear_coats() {
    let loaded = material("Pc 0.5\nPcr 0.25\n");
    assert_warnings(&loaded, &[]);
    let coat = loaded.scene.materials[0].clearcoat;
    assert_eq!((coat.weight, coat.roughness), (0.5, 0.25));
    assert_eq!(material("Pcr 0.25\n").scene.materials[0].clearcoat.weight, 0.0);
    assert_warnings(&material("Pc 2\n"), &[("material \"m\"", "2 is outside 0…1")]);
}

#[test]
fn keywords_that_are_not_read_are_named_once() {
    let text = "Ka 1 1 1\nNi 1\nsharpness 60\nPs 0.0\nPc 0\naniso 0.000\nPcr 0.03\nanisor 0\nmap_Ka a.png\n\
                disp d\ndecal e\nrefl f\nmap_Ns g\nmap_Tr h\nPs 1\nmap_Pc i\naniso 1\nsurprise\n";
    let loaded = material(&format!("{text}newmtl n\n{text}"));
    let named = ["disp", "decal", "refl", "map_Ns", "map_Tr", "Ps", "map_Pc", "aniso"];
    let mut expected: Vec<_> = named.iter().map(|keyword| ("test.mtl line", format!("{keyword}: "))).collect();
    expected.push(("test.mtl line 19", "\"surprise\" is not known".into()));
    let expected: Vec<_> = expected.iter().map(|(element, reason)| (*element, reason.as_str())).collect();
    assert_warnings(&loaded, &expected);
}

#[test]
fn colours_in_other_spaces() {
    // The colours are the white of Rec. 709, and its green primary at Y = 0.7152.
    let white = material("Kd xyz 0.950456 1 1.089058\n");
    assert_warnings(&white, &[]);
    assert_close(&white.scene.materials[0].base_color, &[1.0; 4], 1e-3);
    let green = material("Kd xyz 0.3575761 0.7151522 0.119192\n");
    assert_close(&green.scene.materials[0].base_color, &[0.0, 1.0, 0.0, 1.0], 1e-3);
    assert_warnings(&material("Kd 255 128 0\n"), &[("m", "[255.0, 128.0, 0.0] is outside 0…1; [1.0, 1.0, 0.0]")]);
}

#[test]
fn names_of_materials() {
    let used = |name: &str, library: &str| {
        read(format!("mtllib test.mtl\n{SQUARE}usemtl {name}\nf 1 2 3\n"), library).unwrap()
    };
    let drawn = |loaded: &asvgf::scene::Loaded| loaded.scene.materials[loaded.scene.meshes[0].material].name.clone();
    // Text that looks like a comment may be a name.
    let library = "newmtl Material #1\nnewmtl Material #2\nnewmtl plain # note\n";
    assert_eq!(used("Material #2", library).scene.meshes[0].material, 1);
    assert_eq!(drawn(&used("plain", library)), "plain");
    assert_eq!(drawn(&used("plain # other note", library)), "plain");
    let other_case = used("PLAIN", library);
    assert_warnings(&other_case, &[("line 6", "there is no material \"PLAIN\"; \"plain\" is used")]);
    let twice = used("a", "newmtl a\nKd 1 0 0\nnewmtl a\nKd 0 1 0\n");
    assert_warnings(&twice, &[("material \"a\"", "is there twice; the last one counts")]);
    assert_eq!(twice.scene.materials[twice.scene.meshes[0].material].base_color, [0.0, 1.0, 0.0, 1.0]);
    let early = used("a", "Kd 1 0 0\nKs 1 1 1\nnewmtl a\n");
    assert_warnings(&early, &[("test.mtl line 1", "before the first newmtl")]);

    let unnamed = read(format!("{SQUARE}usemtl\nf 1 2 3\nusemtl \nf 1 3 4\no\ng\n"), "").unwrap();
    assert_warnings(
        &unnamed,
        &[("line 5", "there is no name; the faces after it are drawn in the default material (2")],
    );
    assert_eq!(drawn(&unnamed), "default");
    // A file that names no library uses the one beside it.
    let unsaid = read(format!("{SQUARE}usemtl a\nf 1 2 3\n"), "newmtl a\nKd 1 0 0\n").unwrap();
    assert_warnings(&unsaid, &[("file", "names no material library; \"test.mtl\" beside it is read")]);
    assert_eq!(drawn(&unsaid), "a");
}
