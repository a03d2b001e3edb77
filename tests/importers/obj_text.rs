//! OBJ files: text, numbers, and files of other kinds.

use asvgf::scene::load;

use crate::common::*;
use crate::obj::{SQUARE, read};

#[test]
fn untidy_text() {
    let text = "\u{FEFF}# comment\r\n\tv\t0 0\t0 # note\r\n  v 1 0 0 1.0\r\nv 0 1 0 0.5\r\nmtllib\ttest.mtl\r\n\
                usemtl\ta b#1  # name\r\ns off\r\nvp 1 2\r\nf 1 \\\r\n 2 \\ \r\n 3\r\nl 1 2\r\np 1\r\nunknown words\r\n\
                Unknown again\r\ncall other.obj\r\ncsh rm\r\n\\";
    let loaded = read(text, "newmtl a b#1\n\tKd\t0.5\n").unwrap();
    assert_warnings(
        &loaded,
        &[
            ("line 12", "points and lines"),
            ("line 14", "\"unknown\" is not known"),
            ("line 16", "other files and commands are not run"),
        ],
    );
    let scene = &loaded.scene;
    assert_eq!(scene.materials[scene.meshes[0].material].name, "a b#1");
    assert_eq!(scene.materials[0].base_color, [0.5, 0.5, 0.5, 1.0]);
    assert_eq!(area(&loaded), 0.5);
}

#[test]
fn line_ends_of_all_machines() {
    let text = format!("# note\nmtllib test.mtl\n\n{SQUARE}o thing\nusemtl m\nf 1 2 \\\n3 4");
    for end in ["\n", "\r\n", "\r"] {
        let loaded = read(text.replace('\n', end), "newmtl m\nKd 0 1 0\n".replace('\n', end)).unwrap();
        assert_warnings(&loaded, &[]);
        assert_eq!(area(&loaded), 1.0, "{end:?}");
        let material = &loaded.scene.materials[0];
        assert_eq!((&*loaded.scene.meshes[0].name, material.base_color), ("thing", [0.0, 1.0, 0.0, 1.0]));
    }
    // Lines are numbered as in an editor.
    assert_warnings(&read(format!("\r\r\n{SQUARE}f 1 2 3\rf 1\r"), "").unwrap(), &[("line 8", "1 corners")]);
}

#[test]
fn keywords_in_any_case_and_one_very_long_line() {
    let faces = " 1 2 3 4".repeat(50_000);
    let text = format!("MTLLIB test.mtl\n{}USEMTL m\nF{}\n", SQUARE.replace('v', "V"), &faces[..8]);
    let loaded = read(text, "NEWMTL m\nKD .5 .25 .125\nILLUM 1\n").unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!((area(&loaded), loaded.scene.materials[0].base_color), (1.0, [0.5, 0.25, 0.125, 1.0]));
    // A corner that repeats again and again makes no polygon, and must not hang the reader.
    let text = format!("{SQUARE}f{}\nf 1 2 3\n", faces.replace(' ', " \\\n"));
    assert_eq!(read(text, "").unwrap().warnings.len(), 1);
}

#[test]
fn utf_16_and_code_pages() {
    let folder = Folder::new();
    let text = [b"# caf\xE9\no caf\xE9\n", SQUARE.as_bytes(), b"usemtl caf\xE9\nf 1 2 3 4\nmtllib \xE9.mtl\n"].concat();
    folder.write("é.mtl", b"newmtl caf\xE9\nKd 1 0 0\n");
    let loaded = load(folder.write("latin.obj", text)).unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!((area(&loaded), &*loaded.scene.meshes[0].name), (1.0, "café"));
    assert_eq!(loaded.scene.materials[0].base_color, [1.0, 0.0, 0.0, 1.0]);

    let text = format!("mtllib test.mtl\n{SQUARE}usemtl é\nf 1 2 3 4\n");
    let wide =
        |text: &str, mark: &str, bytes: fn(u16) -> [u8; 2]| le(format!("{mark}{text}").encode_utf16().map(bytes));
    for mark in ["\u{FEFF}", ""] {
        for bytes in [u16::to_le_bytes as fn(u16) -> [u8; 2], u16::to_be_bytes] {
            let loaded = read(wide(&text, mark, bytes), wide("newmtl é\nKd 1 0 0\n", mark, bytes)).unwrap();
            assert_warnings(&loaded, &[("file", "UTF-16"), ("test.mtl", "UTF-16")]);
            assert_eq!(loaded.scene.materials[0].base_color, [1.0, 0.0, 0.0, 1.0]);
        }
    }
}

#[test]
fn numbers_that_are_wrong() {
    let bad = |line: &str, reason: &str| {
        let loaded = read(format!("{SQUARE}{line}\nf 1 2 5\nf 1 2 3 4\n"), "").unwrap();
        assert_warnings(&loaded, &[("line 5", &format!("v: {reason}; faces that use it are left out"))]);
        assert_eq!(area(&loaded), 1.0);
        // No face is left.
        let lost = read(format!("v 0 0 0\nv 1 0 0\n{line}\nf 1 2 3\n"), "");
        assert_error(lost, "test.obj", "line 3", "no face of the file can be drawn");
    };
    bad("v 0 0", "2 numbers, where 3 belong");
    bad("v", "0 numbers, where 3 belong");
    bad("v 0 x 0", "\"x\" is not a number");
    bad("v 0 nan 0", "NaN is not finite");
    bad("v 0 1e99 0", "inf is not finite");
    bad("v 0 -nan(ind) 0", "\"-nan(ind)\" is not a number");
    bad("v 0 0 1.#INF", "\"1.#INF\" is not a number");
    assert_error(read("", ""), "test.obj", "file", "empty");
    assert_error(read(" \r\n\t", ""), "test.obj", "file", "empty");
    assert_warnings(&read("v 0 0 0\n", "").unwrap(), &[("file", "no triangles")]);
    for broken in ["nan nan", "-nan(ind) 0", "", "x 0", "1e99 0"] {
        let loaded = read(format!("{SQUARE}vt 1 1\nvt {broken}\nf 1/1 2/2 3/2\n"), "").unwrap();
        assert_warnings(&loaded, &[("line 6", "; 0 is used")]);
        assert_eq!(loaded.scene.meshes[0].uvs[0], [[1.0, 0.0], [0.0, 1.0], [0.0, 1.0]]);
    }
}

#[test]
fn decimal_commas() {
    let text = SQUARE.replace('1', "1,5") + "vn 0 0 1,0\nmtllib test.mtl\nusemtl m\nf 1 2 3 4\n";
    let loaded = read(text, "newmtl m\nKd 0,5 0,25 1\n").unwrap();
    assert_warnings(&loaded, &[("line 2", "decimal comma"), ("test.mtl line 2", "decimal comma")]);
    assert_eq!((area(&loaded), loaded.scene.materials[0].base_color), (2.25, [0.5, 0.25, 1.0, 1.0]));
    let lost = read("v 1,2,3\nv 1,2,3\nv 1,2,3\nf 1 2 3\n", "");
    assert_error(lost, "test.obj", "line 1", "\"1,2,3\" is not a number");
}

#[test]
fn files_that_are_something_else() {
    let zip = [b"PK\x03\x04".as_slice(), &[0; 100]].concat();
    let stl = [b"made by ".as_slice(), &[0; 100], b"hand"].concat();
    let pointer = b"version https://git-lfs.github.com/spec/v1\noid sha256:00\nsize 12345\n";
    let files: [(&[u8], &str); 14] = [
        (pointer, "is a Git LFS pointer"),
        (b"\n<!DOCTYPE html>\n<html>", "is an HTML page"),
        (b"<HTML><body>404", "is an HTML page"),
        (b"glTF\x02\0\0\0", "is a binary glTF file"),
        (b"{\"asset\": {}}", "is a JSON file, perhaps glTF"),
        (b"Kaydara FBX Binary  \0\x1a\0", "is an FBX file"),
        (b"; FBX 7.3.0 project file\n", "is an FBX file"),
        (b"BLENDER-v300", "is a Blender file"),
        (&zip, "is a ZIP archive, perhaps USDZ"),
        (b"\x1F\x8B\x08\0", "is compressed with gzip"),
        (b"ply\nformat ascii 1.0\n", "is a PLY file"),
        (b"solid thing\nfacet normal 0 0 1\n", "is an STL file"),
        (&stl, "is no text"),
        (b"dear diary\nnothing happened\n", "no line of it is a statement"),
    ];
    let square = format!("mtllib test.mtl\n{SQUARE}f 1 2 3 4\n");
    for (bytes, reason) in files {
        assert_error(read(bytes, ""), "test.obj", "file", reason);
        if !reason.contains("no ") {
            assert_warnings(&read(&square, bytes).unwrap(), &[("test.mtl", reason)]);
        }
    }
}
