//! Files that commands read.

use std::path::{Path, PathBuf};
use std::{fs, io};

use anyhow::{Context, Result, anyhow};

use compiler::files::{self, reason};

/// Reads a whole file; the error message names it.
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

/// Returns the files with a suffix in a folder and its subfolders, in the order of names.
pub(crate) fn files_below(folder: &Path, suffix: &str) -> Result<Vec<PathBuf>> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    let mut files = Vec::new();
    for path in paths {
        // A link to a folder may lead back here.
        if path.is_dir() && !path.is_symlink() {
            files.extend(files_below(&path, suffix)?);
        } else if has_suffix(&path, suffix) {
            files.push(path);
        }
    }
    Ok(files)
}

/// Returns whether a file is C, judged by its name.
pub(crate) fn is_source(path: &Path) -> bool {
    has_suffix(path, "c")
}

fn has_suffix(path: &Path, suffix: &str) -> bool {
    path.extension().is_some_and(|own| own.eq_ignore_ascii_case(suffix))
}
