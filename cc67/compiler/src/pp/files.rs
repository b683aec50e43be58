//! The preprocessor's access to files.
//!
//! All reads go through [`Files`], so that tests, editors and tools that list dependencies can intercept them.

use std::collections::BTreeMap;
use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use super::limits;

/// A file system, as far as includes need one.
pub trait Files {
    /// The bytes of a file.
    ///
    /// # Errors
    /// The file system's error; after `NotFound` the search continues silently.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// The names of the entries of a directory, in any order.
    ///
    /// # Errors
    /// The error of the file system; the directory then counts as empty.
    fn list(&self, directory: &Path) -> io::Result<Vec<String>>;
}

/// The file system of the computer.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let file = File::open(path)?;
        if file.metadata()?.is_dir() {
            return Err(io::ErrorKind::IsADirectory.into());
        }
        // One byte more than allowed shows that the file is too large without reading all of it.
        let mut bytes = Vec::new();
        file.take(u64::from(limits::FILE_BYTES) + 1).read_to_end(&mut bytes)?;
        Ok(bytes)
    }

    fn list(&self, directory: &Path) -> io::Result<Vec<String>> {
        let directory = if directory.as_os_str().is_empty() { Path::new(".") } else { directory };
        let names = fs::read_dir(directory)?.filter_map(|entry| entry.ok()?.file_name().into_string().ok());
        Ok(names.collect())
    }
}

/// Files in memory.
#[derive(Clone, Debug, Default)]
pub struct MemoryFiles {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl MemoryFiles {
    /// Makes an empty file system.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Adds a file.
    #[must_use]
    pub fn with(mut self, path: impl AsRef<Path>, text: impl Into<Vec<u8>>) -> Self {
        self.files.insert(normalized(path.as_ref()), text.into());
        self
    }
}

impl Files for MemoryFiles {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.get(&normalized(path)).cloned().ok_or_else(|| io::ErrorKind::NotFound.into())
    }

    fn list(&self, directory: &Path) -> io::Result<Vec<String>> {
        let directory = normalized(directory);
        let entry = |path: &PathBuf| {
            let first = path.strip_prefix(&directory).ok()?.components().next()?;
            Some(first.as_os_str().to_string_lossy().into_owned())
        };
        let mut names: Vec<_> = self.files.keys().filter_map(entry).collect();
        names.dedup();
        Ok(names)
    }
}

/// The path with `.` and `..` resolved.
fn normalized(path: &Path) -> PathBuf {
    let mut result = PathBuf::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if result.file_name().is_some() => {
                result.pop();
            }
            other => result.push(other),
        }
    }
    result
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn memory_files_list_the_entries_of_a_directory() {
        let files = MemoryFiles::new().with("a/x.h", "").with("a/b/y.h", "").with("./z.c", "");
        assert_eq!(files.list(Path::new("a")).unwrap(), ["b", "x.h"]);
        assert_eq!(files.list(Path::new("")).unwrap(), ["a", "z.c"]);
        assert!(files.read(Path::new("a/b/../x.h")).is_ok());
    }
}
