//! OBJ and MTL files with one element broken at random, and files that are broken all over.

use std::collections::BTreeMap;
use std::path::PathBuf;

use asvgf::scene::{Loaded, load_from_memory};
use proptest::prelude::*;

use crate::common::*;

const OBJ: &str = "mtllib test.mtl\no thing\nv 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n\
                   vn 0 0 1\nvn 0 0 1\nusemtl m\nf 1/1/1 2/2/1 3/3/2 4/4/2\nusemtl n\nv 0 0 1\nv 1 0 1\nv 0 1 1\n\
                   f 5/1/1 6/2/1 7/3/2\n";
const MTL: &str = "newmtl m\nKd 0.5 0.5 0.5\nKs 0.1 0.1 0.1\nNs 30\nillum 2\nd 1\nmap_Kd a.png\nmap_Ke a.png\nnewmtl n\n\
                   Kd 0.2 0.2 0.2\nKe 1 1 1\nPr 0.5\nPm 0.5\nmap_Pr a.png\n";

/// Further statements, for bytes that are broken anywhere.
const MORE: &str = "s 1\nv 0 0 2 1 0 0\nv 2 0 2 0 1 0 1\nv 2 2 2.1 255 0 0\nv 1 .5 2\nv 0 2 2\nv 1 1 3\n\
                    f -6 -5 -4 -3 -2\nf -6 -1 -5\nf -5 -1 -4 -3\ns 2\nf -6/1 -5/2 -4/3 -3 -2/4\n#MRGB ff0011ff\n\
                    f 1 3 2 4\nf 1 2 \\\n3 3 4 1\ng a b\nusemtl q\n";

/// Statements that may be broken, the words after them that break them, and true if a face is lost.
const OBJ_BREAKS: &[(&str, &[&str], bool)] = &[
    ("vt 1 1", &["vt nan 0", "vt", "vt x y", "vt 0 1e99", "vt -nan(ind) 0"], false),
    ("vn 0 0 1", &["vn nan 0 0", "vn", "vn 0 0", "vn 0 0 0", "vn x y z", "vn 1.#QNAN 0 0", "vn inf 0 1"], false),
    ("3/3/2", &["3/9/2", "3/0/2", "3/-9/2", "3/x/2", "3/3/9", "3/3/0", "3/3/-9", "3/3/?", "3/3/2/1"], false),
    ("o thing", &["thing", "o thing\nuh 1 2", "o thing\ncall other.obj", "o thing\nl 1 2", "o thing\nf 1 2"], false),
    ("v 0 0 1\n", &["v nan 0 1\n", "v 0 0\n", "v\n", "v x 0 1\n", "v 0 0 1e99\n"], true),
    ("f 5/1/1 6/2/1 7/3/2", &["f 5/1/1 6/2/1", "f 9/1/1 6/2/1 7/3/2", "f 0/1/1 6/2/1 7/3/2", "f x 6/2/1 7/3/2"], true),
];
const MTL_BREAKS: &[(&str, &[&str])] = &[
    (
        "Kd 0.5 0.5 0.5",
        &["Kd", "Kd 0.5 0.5", "Kd nan 0 0", "Kd x", "Kd 7 7 7", "Kd -1 0 0", "Kd spectral a.rfl", "Kx 1"],
    ),
    ("Ks 0.1 0.1 0.1", &["Ks", "Ks 1 1", "Ks inf 0 0", "Ks 5 0 0", "bump a.png", "Ps 1"]),
    ("Ns 30", &["Ns", "Ns x", "Ns nan", "Ns 1e99"]),
    ("illum 2", &["illum 77", "illum x", "illum 7", "illum"]),
    ("d 1", &["d x", "d", "d nan", "d 0", "d 2"]),
    (
        "map_Kd a.png",
        &["map_Kd absent.png", "map_Kd", "map_Kd -what a.png", "map_Kd C:\\maps\\a.png", "map_Kd junk.png"],
    ),
    ("map_Pr a.png", &["map_Pr absent.png", "map_Pr", "map_Pr ../../a.png", "map_Pr http://localhost/a.png"]),
    ("Pm 0.5", &["Pm 2", "Pm x", "Pm -1", "Pm", "Pm nan"]),
    ("Ke 1 1 1", &["Ke -1 0 0", "Ke 1 2", "Ke x"]),
];

fn read(obj: &[u8], mtl: &[u8]) -> Result<Loaded, asvgf::scene::SceneError> {
    let image = png(2, 2, [100, 100, 100, 255]);
    let files: [(&str, &[u8]); 4] =
        [("test.obj", obj), ("test.mtl", mtl), ("a.png", &image), ("junk.png", b"no image")];
    let files: BTreeMap<PathBuf, Vec<u8>> = files.map(|(name, bytes)| (name.into(), bytes.to_vec())).into();
    load_from_memory(&files, "test.obj")
}

/// Asserts that a file loads with one warning, and draws everything or everything but the second face.
#[track_caller]
fn assert_one_defect(obj: &str, mtl: &str, lost: bool) {
    let loaded = read(obj.as_bytes(), mtl.as_bytes()).unwrap_or_else(|error| panic!("{error}\n{obj}\n{mtl}"));
    assert_eq!(loaded.warnings.len(), 1, "{:#?}\n{obj}\n{mtl}", loaded.warnings);
    assert_eq!(area(&loaded), if lost { 1.0 } else { 1.5 }, "{obj}\n{mtl}");
    assert_eq!(loaded.scene.materials.len(), 2);
}

#[test]
fn the_whole_file_is_without_defects() {
    let loaded = read(OBJ.as_bytes(), MTL.as_bytes()).unwrap();
    assert_warnings(&loaded, &[]);
    assert_eq!(area(&loaded), 1.5);
}

#[test]
fn each_defect_costs_itself_and_gives_one_warning() {
    for (statement, breaks, lost) in OBJ_BREAKS {
        breaks.iter().for_each(|broken| assert_one_defect(&OBJ.replacen(statement, broken, 1), MTL, *lost));
    }
    for (statement, breaks) in MTL_BREAKS {
        breaks.iter().for_each(|broken| assert_one_defect(OBJ, &MTL.replacen(statement, broken, 1), false));
    }
}

proptest! {
    /// Several defects of different kinds, and any way to write lines and keywords.
    #[test]
    fn two_defects_give_two_warnings(
        (statement, broken) in prop::sample::select(MTL_BREAKS).prop_flat_map(|(statement, breaks)| (Just(statement), prop::sample::select(breaks))),
        (other, wrong) in prop::sample::select(&OBJ_BREAKS[..3]).prop_flat_map(|(other, breaks, _)| (Just(other), prop::sample::select(breaks))),
        end in prop::sample::select(&["\n", "\r\n", "\r"][..]),
        upper in any::<bool>(),
    ) {
        let [obj, mtl] = [OBJ.replacen(other, wrong, 1), MTL.replacen(statement, broken, 1)];
        let mtl = if upper { mtl.replace("map_", "MAP_").replace("Kd", "KD").replace("newmtl", "NewMtl") } else { mtl };
        let loaded = read(obj.replace('\n', end).as_bytes(), mtl.replace('\n', end).as_bytes()).unwrap();
        prop_assert_eq!(loaded.warnings.len(), 2, "{:#?}", loaded.warnings);
        prop_assert_eq!(area(&loaded), 1.5);
    }

    /// Any bytes give a valid scene or an error.
    #[test]
    fn any_bytes_are_read_or_refused(
        mutations in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>(), 0..4_u8), 0..12),
        library in any::<bool>(),
        more in ".{0,40}",
    ) {
        let mut texts = [format!("{OBJ}{MORE}{more}\n").into_bytes(), format!("{MTL}{more}\n").into_bytes()];
        let text = &mut texts[usize::from(library)];
        for (place, byte, kind) in mutations {
            let at = place.index(text.len());
            match kind {
                0 => text[at] = byte,
                1 => text.insert(at, byte),
                2 => { text.remove(at); }
                _ => text[at] = b" \n/-#\\\t\"1"[usize::from(byte) % 9],
            }
        }
        if let Ok(loaded) = read(&texts[0], &texts[1]) {
            prop_assert!(loaded.scene.validate().is_ok());
        }
    }
}
