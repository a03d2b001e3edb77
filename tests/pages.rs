//! Links of the Markdown pages lead to existing files, and those of pages in the package to files in the package.

use std::fs;
use std::path::{Component, Path, PathBuf};

fn root() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR"))
}

/// The README, its siblings, and docs/, as paths from the root.
fn pages() -> Vec<PathBuf> {
    let mut pages: Vec<PathBuf> = ["README.md", "CHANGELOG.md", "CONTRIBUTING.md"].map(PathBuf::from).into();
    let docs =
        fs::read_dir(root().join("docs")).unwrap().map(|entry| Path::new("docs").join(entry.unwrap().file_name()));
    pages.extend(docs.filter(|page| page.extension().is_some_and(|extension| extension == "md")));
    pages
}

/// Targets of the links and images on a page.
fn links(text: &str) -> impl Iterator<Item = &str> {
    text.split("](").skip(1).filter_map(|rest| Some(rest.split_once(')')?.0))
}

/// `docs/../benches/x` as `benches/x`.
fn tidy(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut tidied, component| {
        if component == Component::ParentDir {
            tidied.pop();
        } else {
            tidied.push(component);
        }
        tidied
    })
}

/// The anchor that renderers of Markdown give a heading.
fn anchor(heading: &str) -> String {
    let kept =
        heading.trim().to_lowercase().chars().filter(|c| c.is_alphanumeric() || " -_".contains(*c)).collect::<String>();
    kept.replace(' ', "-")
}

/// Entries of `include` in Cargo.toml.
fn packaged() -> Vec<String> {
    let manifest = fs::read_to_string(root().join("Cargo.toml")).unwrap();
    let list = manifest.split_once("include = [").unwrap().1.split_once(']').unwrap().0;
    list.split('"').skip(1).step_by(2).map(str::to_owned).collect()
}

#[test]
fn links_of_the_pages_lead_to_files_and_headings() {
    let include = packaged();
    let in_package = |path: &str| {
        include.iter().any(|entry| match entry.strip_suffix("**") {
            Some(folder) => format!("/{path}").starts_with(folder),
            None => format!("/{path}") == *entry,
        })
    };
    let mut followed = 0;
    for page in pages() {
        let text = fs::read_to_string(root().join(&page)).unwrap();
        assert!(in_package(page.to_str().unwrap()), "{page:?} is not in the package");
        for link in links(&text).filter(|link| !link.contains("://")) {
            let (file, heading) = link.split_once('#').unwrap_or((link, ""));
            let target = if file.is_empty() { page.clone() } else { tidy(&page.parent().unwrap().join(file)) };
            assert!(root().join(&target).exists(), "{page:?}: {link} leads nowhere");
            assert!(in_package(target.to_str().unwrap()), "{page:?}: {link} is not in the package");
            if !heading.is_empty() {
                let text = fs::read_to_string(root().join(&target)).unwrap();
                let found =
                    text.lines().any(|line| line.starts_with('#') && anchor(line.trim_start_matches('#')) == heading);
                assert!(found, "{page:?}: {link} names no heading");
            }
            followed += 1;
        }
    }
    assert!(followed > 40, "{followed} links");
}
