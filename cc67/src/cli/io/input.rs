//! Files that commands read.

use std::io;
use std::path::Path;

use anyhow::{Result, anyhow};

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
