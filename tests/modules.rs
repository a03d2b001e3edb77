//! Modules depend on each other in one direction: no file of src/, and no folder of it, imports itself through others.
//!
//! The test reads the paths in the source as syn parses them. Test modules are free to import anything.

use std::collections::{BTreeMap, BTreeSet};
use std::path::{Path, PathBuf};
use syn::visit::{self, Visit};
use syn::{Attribute, File, Item, UseTree};

/// A module's path from the crate's root: `["passes", "temporal"]`. The root itself is empty.
type Module = Vec<String>;

/// The imports between modules.
type Graph = BTreeMap<Module, BTreeSet<Module>>;

fn sources(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            sources(&path, found);
        } else if path.extension().is_some_and(|extension| extension == "rs") {
            found.push(path);
        }
    }
}

/// The module that a file holds.
fn module_of(file: &Path, root: &Path) -> Module {
    let path = file.strip_prefix(root).unwrap().with_extension("");
    let mut module: Module = path.iter().map(|part| part.to_string_lossy().into_owned()).collect();
    if module.last().is_some_and(|last| last == "mod" || last == "lib") {
        module.pop();
    }
    module
}

/// True if an item is compiled for tests alone.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    let conditions = attributes.iter().filter(|attribute| attribute.path().is_ident("cfg"));
    conditions.filter_map(|attribute| attribute.meta.require_list().ok()).any(|list| {
        let words: Vec<_> = list.tokens.to_string().split(|c: char| !c.is_alphanumeric()).map(str::to_owned).collect();
        words.iter().any(|word| word == "test") && !words.iter().any(|word| word == "not")
    })
}

/// The modules in files of their own that a file declares for tests alone.
fn test_modules(module: &Module, file: &File) -> Vec<Module> {
    let declared = file.items.iter().filter_map(|item| if let Item::Mod(item) = item { Some(item) } else { None });
    let for_tests = declared.filter(|item| item.content.is_none() && is_for_tests(&item.attrs));
    for_tests.map(|item| [&module[..], &[item.ident.to_string()]].concat()).collect()
}

/// Collects the paths of a file that begin at the crate's root or at a parent.
#[derive(Default)]
struct Paths(Vec<Vec<String>>);

impl Paths {
    fn tree(&mut self, tree: &UseTree, before: &mut Vec<String>) {
        match tree {
            UseTree::Path(path) => {
                before.push(path.ident.to_string());
                self.tree(&path.tree, before);
                before.pop();
            }
            UseTree::Name(name) => self.0.push([&before[..], &[name.ident.to_string()]].concat()),
            UseTree::Rename(name) => self.0.push([&before[..], &[name.ident.to_string()]].concat()),
            UseTree::Glob(_) => self.0.push(before.clone()),
            UseTree::Group(group) => group.items.iter().for_each(|tree| self.tree(tree, before)),
        }
    }
}

impl<'ast> Visit<'ast> for Paths {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Mod(item) => &item.attrs,
            Item::Fn(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if is_for_tests(attributes) {
            return;
        }
        match item {
            Item::Use(item) => self.tree(&item.tree, &mut Vec::new()),
            _ => visit::visit_item(self, item),
        }
    }

    fn visit_impl_item_fn(&mut self, function: &'ast syn::ImplItemFn) {
        if !is_for_tests(&function.attrs) {
            visit::visit_impl_item_fn(self, function);
        }
    }

    fn visit_path(&mut self, path: &'ast syn::Path) {
        self.0.push(path.segments.iter().map(|segment| segment.ident.to_string()).collect());
        visit::visit_path(self, path);
    }
}

/// The names that the crate's root exports, with the module of each.
fn exports(root: &File, files: &BTreeMap<Module, File>) -> BTreeMap<String, Module> {
    let mut exports = BTreeMap::new();
    for item in &root.items {
        let Item::Use(item) = item else { continue };
        let mut paths = Paths::default();
        paths.tree(&item.tree, &mut Vec::new());
        for path in paths.0 {
            if files.contains_key(&path) {
                // A glob exports what the module exports or declares.
                let file = &files[&path];
                for name in names(file) {
                    exports.insert(name, path.clone());
                }
            } else if let Some((name, module)) = path.split_last() {
                exports.insert(name.clone(), module.to_vec());
            }
        }
    }
    exports
}

/// The names that a module declares or re-exports.
fn names(file: &File) -> Vec<String> {
    let mut names = Vec::new();
    for item in &file.items {
        match item {
            Item::Struct(item) => names.push(item.ident.to_string()),
            Item::Enum(item) => names.push(item.ident.to_string()),
            Item::Trait(item) => names.push(item.ident.to_string()),
            Item::Use(item) => {
                let mut paths = Paths::default();
                paths.tree(&item.tree, &mut Vec::new());
                names.extend(paths.0.into_iter().filter_map(|path| path.last().cloned()));
            }
            _ => {}
        }
    }
    names
}

/// The imports of the library, file by file.
fn graph() -> Graph {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("src");
    let mut paths = Vec::new();
    sources(&root, &mut paths);
    let mut files: BTreeMap<Module, File> = paths
        .iter()
        .map(|path| {
            let file = syn::parse_file(&std::fs::read_to_string(path).unwrap());
            (module_of(path, &root), file.unwrap_or_else(|e| panic!("{}: {e}", path.display())))
        })
        .collect();
    let tests: Vec<Module> = files.iter().flat_map(|(module, file)| test_modules(module, file)).collect();
    files.retain(|module, _| !tests.iter().any(|tests| module.starts_with(tests)));
    let exports = exports(&files[&Module::new()], &files);
    let mut graph = Graph::new();
    for (module, file) in files.iter().filter(|(module, _)| !module.is_empty()) {
        let mut paths = Paths::default();
        paths.visit_file(file);
        let targets = paths.0.iter().filter_map(|path| target(module, path, &files, &exports));
        graph.insert(module.clone(), targets.filter(|target| target != module).collect());
    }
    graph
}

/// The module that a path leads to.
fn target(
    from: &Module,
    path: &[String],
    files: &BTreeMap<Module, File>,
    exports: &BTreeMap<String, Module>,
) -> Option<Module> {
    let full = match path.first()?.as_str() {
        "crate" => match path.get(1).and_then(|name| exports.get(name)) {
            Some(module) => module.clone(),
            None => path[1..].to_vec(),
        },
        "super" => {
            let ups = path.iter().take_while(|part| *part == "super").count();
            [&from[..from.len().checked_sub(ups)?], &path[ups..]].concat()
        }
        _ => return None,
    };
    // The module is the longest prefix that names one; the rest are names in it.
    (1..=full.len()).rev().map(|length| full[..length].to_vec()).find(|module| files.contains_key(module))
}

/// The same graph for folders, down to a depth.
fn rooms(graph: &Graph, depth: usize) -> Graph {
    let room = |module: &Module| module[..module.len().min(depth)].to_vec();
    let mut rooms = Graph::new();
    for (from, targets) in graph {
        let others = targets.iter().map(room).filter(|to| *to != room(from));
        rooms.entry(room(from)).or_default().extend(others);
    }
    rooms
}

/// The modules that can be reached from a module.
fn reached(graph: &Graph, from: &Module) -> BTreeSet<Module> {
    let mut reached = BTreeSet::new();
    let mut open = vec![from.clone()];
    while let Some(module) = open.pop() {
        for next in graph.get(&module).into_iter().flatten() {
            if reached.insert(next.clone()) {
                open.push(next.clone());
            }
        }
    }
    reached
}

/// The modules that lie on a cycle.
fn circles(graph: &Graph) -> BTreeSet<String> {
    graph.keys().filter(|module| reached(graph, module).contains(*module)).map(|module| module.join("::")).collect()
}

#[test]
fn modules_import_each_other_in_one_direction() {
    let graph = graph();
    assert!(graph.len() > 100, "the source was found: {} files", graph.len());
    // A wrong reading of the source would find no import, and so no cycle.
    let expected = vec!["plan".to_owned()];
    assert!(graph[&vec!["denoiser".to_owned(), "hosted".to_owned()]].contains(&expected), "the imports were found");
    let found = circles(&graph);
    assert!(found.is_empty(), "files that import each other in a circle: {found:?}");
    let found = circles(&rooms(&graph, 1));
    assert!(found.is_empty(), "rooms that import each other in a circle: {found:?}");
}

#[test]
fn a_circle_is_found() {
    let module = |name: &str| vec![name.to_owned()];
    let graph: Graph = [("a", vec!["b"]), ("b", vec!["c"]), ("c", vec!["b"]), ("d", vec!["a"])]
        .map(|(from, to)| (module(from), to.into_iter().map(module).collect()))
        .into();
    assert_eq!(circles(&graph), BTreeSet::from(["b".to_owned(), "c".to_owned()]));
}
