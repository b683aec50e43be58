//! Imports within a crate, file by file.
//!
//! An arrow is a `use` or a path in the code that begins with `crate`, `super` or the crate's own name. A re-exported
//! name is followed to the file that defines it. A module's references to its own children are not arrows; tests are
//! ignored.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use proc_macro2::{TokenStream, TokenTree};
use syn::visit::{self, Visit};
use syn::{Attribute, File, Item, ItemMacro, ItemUse, Macro, Path, UseTree};

use crate::{files, root};

/// The files of a crate and the arrows between them; file names are relative to `src`.
#[derive(Debug, Default)]
pub(crate) struct Imports {
    /// The files referenced by each file, with the line of the first reference.
    pub(crate) arrows: BTreeMap<String, BTreeMap<String, usize>>,
    /// Every file.
    pub(crate) files: BTreeSet<String>,
}

/// A file as a module.
#[derive(Debug, Default)]
struct Module {
    file: String,
    /// The path of each imported name.
    uses: BTreeMap<String, Vec<String>>,
    /// Every path that is imported or written out, with its line.
    paths: Vec<(Vec<String>, usize)>,
    /// The macros that it defines.
    macros: Vec<String>,
}

/// Reads the crate in `folder`.
pub(crate) fn read(folder: &str) -> Imports {
    let src = root().join(folder).join("src");
    let mut modules: BTreeMap<Vec<String>, Module> = BTreeMap::new();
    for path in files(&src, "rs") {
        let file = path.strip_prefix(&src).expect("it lies there").to_string_lossy().replace('\\', "/");
        if is_test(&file) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("sources are UTF-8");
        let syntax: File =
            syn::parse_file(&text).unwrap_or_else(|error| panic!("{}: {error}", path.display()));
        let mut module = Module { file, ..Module::default() };
        module.visit_file(&syntax);
        modules.insert(module_path(&module.file), module);
    }
    let macros =
        modules.values().flat_map(|module| module.macros.iter().map(|name| (name.as_str(), &*module.file)));
    let name = folder.rsplit('/').next().unwrap_or(folder);
    let resolver = Resolver { name, modules: &modules, macros: macros.collect() };
    let mut imports =
        Imports { files: modules.values().map(|module| module.file.clone()).collect(), ..Imports::default() };
    for (at, module) in &modules {
        for (path, line) in &module.paths {
            if let Some(target) = resolver.resolve(at, path, 0).filter(|target| *target != module.file) {
                imports.arrows.entry(module.file.clone()).or_default().entry(target).or_insert(*line);
            }
        }
    }
    imports
}

/// Returns whether a file contains only tests, or tools for tests.
pub(crate) fn is_test(file: &str) -> bool {
    file.split('/').any(|part| matches!(part, "tests" | "tests.rs" | "testing" | "testing.rs"))
}

/// The path of the module in a file; empty for the root of the crate.
fn module_path(file: &str) -> Vec<String> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let mut parts: Vec<String> = stem.split('/').map(str::to_owned).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib")) {
        parts.pop();
    }
    parts
}

/// Returns whether an item is only for tests.
fn is_for_tests(attributes: &[Attribute]) -> bool {
    attributes.iter().any(|attribute| {
        let Ok(list) = attribute.meta.require_list() else { return attribute.path().is_ident("test") };
        let words = list.tokens.to_string();
        list.path.is_ident("cfg") && words.contains("test") && !words.contains("not")
    })
}

impl<'ast> Visit<'ast> for Module {
    fn visit_item(&mut self, item: &'ast Item) {
        let attributes = match item {
            Item::Fn(item) => &item.attrs,
            Item::Impl(item) => &item.attrs,
            Item::Macro(item) => &item.attrs,
            Item::Mod(item) => &item.attrs,
            Item::Struct(item) => &item.attrs,
            Item::Use(item) => &item.attrs,
            _ => return visit::visit_item(self, item),
        };
        if !is_for_tests(attributes) {
            visit::visit_item(self, item);
        }
    }

    fn visit_item_use(&mut self, item: &'ast ItemUse) {
        self.tree(&item.tree, &mut Vec::new());
    }

    fn visit_item_macro(&mut self, item: &'ast ItemMacro) {
        self.macros.extend(item.ident.as_ref().map(ToString::to_string));
        visit::visit_item_macro(self, item);
    }

    fn visit_macro(&mut self, item: &'ast Macro) {
        self.visit_path(&item.path);
        self.tokens(item.tokens.clone());
    }

    fn visit_visibility(&mut self, _: &'ast syn::Visibility) {
        // Visibility is not an arrow.
    }

    fn visit_path(&mut self, path: &'ast Path) {
        if path.segments.len() > 1 {
            let line = path.segments[0].ident.span().start().line;
            self.paths.push((path.segments.iter().map(|segment| segment.ident.to_string()).collect(), line));
        }
        visit::visit_path(self, path);
    }
}

impl Module {
    /// Reads the tree between `use` and `;`.
    fn tree(&mut self, tree: &UseTree, head: &mut Vec<String>) {
        let (name, line) = match tree {
            UseTree::Path(path) => {
                head.push(path.ident.to_string());
                self.tree(&path.tree, head);
                head.pop();
                return;
            }
            UseTree::Group(group) => return group.items.iter().for_each(|tree| self.tree(tree, head)),
            UseTree::Glob(glob) => {
                return self.paths.push((head.clone(), glob.star_token.spans[0].start().line));
            }
            UseTree::Name(name) => (&name.ident, name.ident.span().start().line),
            UseTree::Rename(name) => (&name.ident, name.ident.span().start().line),
        };
        let mut path = head.clone();
        path.extend((name != "self").then(|| name.to_string()));
        let known_as = match tree {
            UseTree::Rename(name) => Some(name.rename.to_string()),
            _ => path.last().cloned(),
        };
        self.paths.push((path.clone(), line));
        if let Some(name) = known_as {
            self.uses.entry(name).or_insert(path);
        }
    }

    /// Finds paths in the tokens of a macro.
    fn tokens(&mut self, tokens: TokenStream) {
        let (mut path, mut line, mut colons) = (Vec::new(), 0, 0);
        for tree in tokens {
            match tree {
                TokenTree::Punct(sign) if sign.as_char() == ':' => colons += 1,
                TokenTree::Ident(ident) => {
                    if colons != 2 {
                        self.paths.extend((path.len() > 1).then(|| (std::mem::take(&mut path), line)));
                        path.clear();
                        line = ident.span().start().line;
                    }
                    path.push(ident.to_string());
                    colons = 0;
                }
                other => {
                    self.paths.extend((path.len() > 1).then(|| (std::mem::take(&mut path), line)));
                    path.clear();
                    colons = 0;
                    if let TokenTree::Group(group) = other {
                        self.tokens(group.stream());
                    }
                }
            }
        }
        self.paths.extend((path.len() > 1).then_some((path, line)));
    }
}

struct Resolver<'a> {
    name: &'a str,
    modules: &'a BTreeMap<Vec<String>, Module>,
    macros: BTreeMap<&'a str, &'a str>,
}

impl Resolver<'_> {
    /// The file to which a path in the module `at` leads; `None` for paths that are not arrows.
    fn resolve(&self, at: &[String], path: &[String], depth: usize) -> Option<String> {
        let (first, mut rest) = path.split_first()?;
        let start = match first.as_str() {
            "crate" => Vec::new(),
            name if name == self.name => Vec::new(),
            "super" => {
                let mut up = at.to_vec();
                up.pop();
                while rest.first().is_some_and(|segment| segment == "super") {
                    up.pop();
                    rest = &rest[1..];
                }
                up
            }
            _ => return None,
        };
        self.descend(start, rest, depth)
    }

    fn descend(&self, mut at: Vec<String>, path: &[String], depth: usize) -> Option<String> {
        for (index, segment) in path.iter().enumerate() {
            let mut child = at.clone();
            child.push(segment.clone());
            if self.modules.contains_key(&child) {
                at = child;
                continue;
            }
            let module = self.modules.get(&at)?;
            if let Some(target) = module.uses.get(segment).filter(|_| depth < 12) {
                let mut further = target.clone();
                further.extend_from_slice(&path[index + 1..]);
                return self.reexport(&at, &further, depth + 1).or_else(|| Some(module.file.clone()));
            }
            if let Some(file) = self.macros.get(segment.as_str()) {
                return Some((*file).to_owned());
            }
            break;
        }
        self.modules.get(&at).map(|module| module.file.clone())
    }

    /// Returns the file that defines a name imported by the module `at`; its own children count here.
    fn reexport(&self, at: &[String], path: &[String], depth: usize) -> Option<String> {
        self.resolve(at, path, depth).or_else(|| {
            let mut child = at.to_vec();
            child.push(path.first()?.clone());
            self.modules.contains_key(&child).then(|| self.descend(at.to_vec(), path, depth)).flatten()
        })
    }
}
