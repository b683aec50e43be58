//! Finding files as Windows does: in some order of directories, ignoring letter case.

use std::collections::{BTreeMap, BTreeSet};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::names::Name;

use super::Files;

/// The result of searching a name.
pub(super) enum SearchResult {
    /// A file, possibly with another spelling than requested.
    File { path: PathBuf, text: Arc<Vec<u8>>, is_respelled: bool },
    /// Names that differ from the requested one, and from each other, only in letter case.
    Ambiguous(Vec<PathBuf>),
    /// A file that cannot be read.
    Unreadable(PathBuf, io::Error),
}

/// The file system, with a cache of all look-ups.
pub(super) struct FileReader<'a> {
    files: &'a dyn Files,
    texts: BTreeMap<PathBuf, Arc<Vec<u8>>>,
    listings: BTreeMap<PathBuf, Vec<String>>,
    guards: BTreeMap<PathBuf, Name>,
    once: BTreeSet<PathBuf>,
    /// Files that were opened, each time counted.
    pub(super) included: usize,
}

impl<'a> FileReader<'a> {
    pub(super) fn new(files: &'a dyn Files) -> Self {
        Self {
            files,
            texts: BTreeMap::new(),
            listings: BTreeMap::new(),
            guards: BTreeMap::new(),
            once: BTreeSet::new(),
            included: 0,
        }
    }

    /// Records that a file yields nothing while `guard` is defined.
    pub(super) fn set_guard(&mut self, path: PathBuf, guard: Name) {
        self.guards.insert(path, guard);
    }

    /// Records the `#pragma once` of a file.
    pub(super) fn set_once(&mut self, path: PathBuf) {
        self.once.insert(path);
    }

    /// Reports whether a file has a `#pragma once` and was read.
    pub(super) fn is_once(&self, path: &Path) -> bool {
        self.once.contains(path)
    }

    /// The macro that makes a second inclusion of a file empty.
    pub(super) fn guard(&self, path: &Path) -> Option<Name> {
        self.guards.get(path).copied()
    }

    /// Looks for `name`, with slashes, below a directory.
    pub(super) fn find_in(&mut self, directory: &Path, name: &str) -> Option<SearchResult> {
        let path = directory.join(name);
        match self.read(&path) {
            Ok(text) => return Some(SearchResult::File { path, text, is_respelled: false }),
            Err(error) if is_absence(&error) => {}
            Err(error) => return Some(SearchResult::Unreadable(path, error)),
        }
        let mut paths = self.spellings(directory, name);
        if paths.len() > 1 {
            return Some(SearchResult::Ambiguous(paths));
        }
        let path = paths.pop()?;
        match self.read(&path) {
            Ok(text) => Some(SearchResult::File { path, text, is_respelled: true }),
            Err(error) if is_absence(&error) => None,
            Err(error) => Some(SearchResult::Unreadable(path, error)),
        }
    }

    /// The names in a directory; none if it cannot be read.
    pub(super) fn list(&mut self, directory: &Path) -> &[String] {
        let files = self.files;
        self.listings.entry(directory.to_owned()).or_insert_with(|| {
            let mut names = files.list(directory).unwrap_or_default();
            names.sort_unstable();
            names
        })
    }

    fn read(&mut self, path: &Path) -> io::Result<Arc<Vec<u8>>> {
        if let Some(text) = self.texts.get(path) {
            return Ok(Arc::clone(text));
        }
        let text = Arc::new(self.files.read(path)?);
        self.texts.insert(path.to_owned(), Arc::clone(&text));
        Ok(text)
    }

    /// The paths that are `name` except for letter case, component by component.
    fn spellings(&mut self, directory: &Path, name: &str) -> Vec<PathBuf> {
        let mut paths = vec![directory.to_owned()];
        for component in name.split('/').filter(|component| !component.is_empty()) {
            let mut next = Vec::new();
            for path in paths {
                if matches!(component, "." | "..") {
                    next.push(path.join(component));
                    continue;
                }
                let entries = self.list(&path);
                let same = |entry: &&String| entry.eq_ignore_ascii_case(component);
                match entries.iter().find(|entry| *entry == component) {
                    Some(exact) => next.push(path.join(exact)),
                    None => next.extend(entries.iter().filter(same).map(|entry| path.join(entry))),
                }
            }
            paths = next;
        }
        paths
    }
}

/// Reports whether the search should continue after an error.
fn is_absence(error: &io::Error) -> bool {
    use io::ErrorKind::{InvalidFilename, InvalidInput, IsADirectory, NotADirectory, NotFound};
    matches!(error.kind(), NotFound | NotADirectory | IsADirectory | InvalidFilename | InvalidInput)
}
