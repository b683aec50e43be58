//! Who imports whom inside a crate, file by file.
//!
//! An arrow is a `use` or a path in the code that begins with `crate`, `super` or the crate's own name. A name that is
//! imported again on the way is followed to the file that defines it. That a module names its own children is not an arrow;
//! tests are left out.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;
use std::path::Path;

use crate::tokens::{Token, closing, tokens};
use crate::{files, root};

/// The files of a crate and the arrows between them; files are named from `src` on.
#[derive(Debug, Default)]
pub(crate) struct Imports {
    /// The lines in which each file names each other one.
    pub(crate) arrows: BTreeMap<String, BTreeMap<String, Vec<usize>>>,
    /// Every file.
    pub(crate) files: BTreeSet<String>,
}

/// The name of a crate in paths.
fn name_of(folder: &str) -> String {
    match folder {
        "cc67" => "cc67".to_owned(),
        folder => folder.rsplit('/').next().unwrap_or(folder).to_owned(),
    }
}

/// One file as a module.
#[derive(Debug, Default)]
struct Module {
    file: String,
    tokens: Vec<Token>,
    /// The path of each name that is imported.
    uses: BTreeMap<String, Vec<String>>,
    /// Every path that is imported or written out, with its line.
    paths: Vec<(Vec<String>, usize)>,
}

/// Reads the crate in `folder`.
pub(crate) fn read(folder: &str) -> Imports {
    let src = root().join(folder).join("src");
    let mut modules: BTreeMap<Vec<String>, Module> = BTreeMap::new();
    let mut macros = BTreeMap::new();
    for path in files(&src, "rs") {
        let file = relative_to(&path, &src);
        if is_test(&file) {
            continue;
        }
        let text = fs::read_to_string(&path).expect("sources are UTF-8");
        let module = Module::new(file, &text);
        for pair in module.tokens.windows(3) {
            if pair[0].text == "macro_rules" {
                macros.insert(pair[2].text.clone(), module.file.clone());
            }
        }
        modules.insert(module_path(&module.file), module);
    }
    let reader = Resolver { name: name_of(folder), modules: &modules, macros: &macros };
    let mut imports =
        Imports { files: modules.values().map(|module| module.file.clone()).collect(), ..Imports::default() };
    for (at, module) in &modules {
        for (path, line) in &module.paths {
            if let Some(target) = reader.resolve(at, path, 0).filter(|target| *target != module.file) {
                let lines = imports.arrows.entry(module.file.clone()).or_default().entry(target).or_default();
                lines.push(*line);
            }
        }
    }
    imports
}

fn relative_to(path: &Path, folder: &Path) -> String {
    path.strip_prefix(folder).expect("it lies there").to_string_lossy().replace('\\', "/")
}

/// Whether a file holds only tests, or what only tests need.
pub(crate) fn is_test(file: &str) -> bool {
    file.split('/').any(|part| matches!(part, "tests" | "tests.rs" | "testing" | "testing.rs"))
}

/// The path of the module that a file holds: none for the root of the crate.
fn module_path(file: &str) -> Vec<String> {
    let stem = file.strip_suffix(".rs").unwrap_or(file);
    let mut parts: Vec<String> = stem.split('/').map(str::to_owned).collect();
    if matches!(parts.last().map(String::as_str), Some("mod" | "lib")) {
        parts.pop();
    }
    parts
}

impl Module {
    fn new(file: String, text: &str) -> Self {
        let mut module = Self { file, tokens: tokens(text), ..Self::default() };
        let mut at = 0;
        while at < module.tokens.len() {
            at = module.path_at(at);
        }
        module
    }

    /// Reads the import or path that begins at `at`; where to continue.
    fn path_at(&mut self, at: usize) -> usize {
        let text = |index: usize| self.tokens.get(index).map_or("", |token| token.text.as_str());
        if text(at) == "use" && !matches!(text(at + 1), "<" | ">" | ",") {
            let end = (at..self.tokens.len()).find(|index| text(*index) == ";").unwrap_or(self.tokens.len());
            let tree: Vec<Token> = self.tokens[at + 1..end].to_vec();
            self.tree(&tree, &[]);
            return end;
        }
        if text(at) == "pub" && text(at + 1) == "(" {
            // Who sees an item is no arrow.
            return closing(&self.tokens, at + 1);
        }
        if text(at + 1) != "::" || !is_word(text(at)) {
            return at + 1;
        }
        let mut path = vec![text(at).to_owned()];
        let mut end = at + 1;
        while text(end) == "::" && is_word(text(end + 1)) {
            path.push(text(end + 1).to_owned());
            end += 2;
        }
        if path.len() > 1 {
            self.paths.push((path, self.tokens[at].line));
        }
        end
    }

    /// Reads what is between `use` and `;`.
    fn tree(&mut self, tree: &[Token], head: &[String]) {
        let mut path = head.to_vec();
        let Some(line) = tree.first().map(|token| token.line) else { return };
        let mut at = 0;
        while at < tree.len() {
            match tree[at].text.as_str() {
                "{" => {
                    for part in parts(&tree[at + 1..closing(tree, at) - 1]) {
                        self.tree(part, &path);
                    }
                    return;
                }
                "as" => {
                    let name = tree.get(at + 1).map_or(String::new(), |token| token.text.clone());
                    return self.import(name, path, line);
                }
                "*" => return self.paths.push((path, line)),
                "self" if !path.is_empty() => {}
                word if is_word(word) => path.push(word.to_owned()),
                _ => {}
            }
            at += 1;
        }
        if let Some(name) = path.last().cloned() {
            self.import(name, path, line);
        }
    }

    fn import(&mut self, name: String, path: Vec<String>, line: usize) {
        self.paths.push((path.clone(), line));
        self.uses.entry(name).or_insert(path);
    }
}

fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// The parts of a list between its commas.
fn parts(tokens: &[Token]) -> Vec<&[Token]> {
    let (mut found, mut start, mut at) = (Vec::new(), 0, 0);
    while at < tokens.len() {
        match tokens[at].text.as_str() {
            "{" => at = closing(tokens, at),
            "," => {
                found.push(&tokens[start..at]);
                (start, at) = (at + 1, at + 1);
            }
            _ => at += 1,
        }
    }
    found.push(&tokens[start..]);
    found
}

struct Resolver<'a> {
    name: String,
    modules: &'a BTreeMap<Vec<String>, Module>,
    macros: &'a BTreeMap<String, String>,
}

impl Resolver<'_> {
    /// The file that a path of the module `at` leads to; none for paths that are not arrows.
    fn resolve(&self, at: &[String], path: &[String], depth: usize) -> Option<String> {
        let (first, rest) = path.split_first()?;
        let mut rest = rest;
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
            if let Some(file) = self.macros.get(segment) {
                return Some(file.clone());
            }
            break;
        }
        self.modules.get(&at).map(|module| module.file.clone())
    }

    /// Where a name that the module `at` imports comes from; its own children count here.
    fn reexport(&self, at: &[String], path: &[String], depth: usize) -> Option<String> {
        self.resolve(at, path, depth).or_else(|| {
            let mut child = at.to_vec();
            child.push(path.first()?.clone());
            self.modules.contains_key(&child).then(|| self.descend(at.to_vec(), path, depth)).flatten()
        })
    }
}
