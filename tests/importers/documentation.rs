//! docs/scenes.md names a test for each row, and each of these tests exists.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

/// Names of all test functions below a folder.
fn tests(folder: &Path, names: &mut BTreeSet<String>) {
    for entry in fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            tests(&path, names);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            let text = fs::read_to_string(&path).unwrap();
            let lines: Vec<&str> = text.lines().map(str::trim).collect();
            let after_attribute = lines.windows(2).filter(|pair| pair[0] == "#[test]").map(|pair| pair[1]);
            names.extend(
                after_attribute.filter_map(|line| Some(line.strip_prefix("fn ")?.split('(').next()?.to_owned())),
            );
        }
    }
}

#[test]
fn every_row_of_the_page_about_scenes_has_a_test() {
    let root = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut names = BTreeSet::new();
    for folder in ["tests", "src"] {
        tests(&root.join(folder), &mut names);
    }
    let page = fs::read_to_string(root.join("docs/scenes.md")).unwrap();
    let mut rows = 0;
    // True inside a table whose last column names tests.
    let mut tested = false;
    for line in page.lines() {
        let cells: Vec<&str> = line.trim_matches('|').split('|').map(str::trim).collect();
        tested = line.starts_with('|') && (tested || cells.last() == Some(&"test"));
        let Some(&test) = cells.last().filter(|cell| **cell != "test") else { continue };
        if !tested || line.starts_with("|-") {
            continue;
        }
        rows += 1;
        assert!(test.contains('`'), "no test: {line}");
        for name in test.split(',').map(|name| name.trim().trim_matches('`')) {
            assert!(names.contains(name), "there is no test {name}: {line}");
        }
    }
    assert!(rows > 120, "{rows} rows");
}
