//! Files that commands read.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, Result, anyhow};

use compiler::files::{self, reason};

/// Reads a whole file; a message names it.
pub(crate) fn read(path: &Path) -> Result<Vec<u8>> {
    files::read(path).map_err(|error| cannot_read(path, &error))
}

/// The message about a file that cannot be read.
pub(crate) fn cannot_read(path: &Path, error: &io::Error) -> anyhow::Error {
    if path.is_dir() {
        return anyhow!("{0} is a folder: name the files in it, as in `{0}/*.c`", path.display());
    }
    anyhow!("cannot read {}: {}", path.display(), reason(error))
}

/// Returns the C files of a folder and of those in it, in the order of names.
pub(crate) fn sources_below(folder: &Path) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    let mut sources = Vec::new();
    for path in paths {
        // A link to a folder may lead back here.
        if path.is_dir() && !path.is_symlink() {
            sources.extend(sources_below(&path)?);
        } else if is_source(&path) {
            sources.push(path);
        }
    }
    Ok(sources)
}

/// Returns whether a file is C, by its name.
pub(crate) fn is_source(path: &Path) -> bool {
    path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("c"))
}
