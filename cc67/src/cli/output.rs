//! Files that commands write: under a temporary name first, so that nobody meets half a file.
//!
//! A process that is killed leaves the old file or the new one. The disk is not waited for, as by
//! any compiler: it would take longer than the compilation.

use std::fs;
use std::io::{self, Write};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow};

use crate::reason::reason;

/// Writes a file and replaces what was there.
pub(super) fn write(path: &Path, bytes: &[u8]) -> Result<()> {
    let temporary = temporary(path);
    // Devices such as /dev/null take what is written to them; a file must not take their place.
    let is_device = fs::metadata(path).is_ok_and(|known| !known.is_file() && !known.is_dir());
    let written = if is_device {
        fs::write(path, bytes)
    } else {
        fs::File::create(&temporary)
            .and_then(|mut file| file.write_all(bytes))
            .and_then(|()| fs::rename(&temporary, path))
    };
    written.map_err(|error| {
        // What is left of it helps nobody.
        let _ = fs::remove_file(&temporary);
        anyhow!("cannot write {}: {}", path.display(), reason(&error))
    })
}

/// Writes several files.
pub(super) fn write_all(files: &[(PathBuf, Vec<u8>)]) -> Result<()> {
    files.iter().try_for_each(|(path, bytes)| write(path, bytes))
}

/// A name in the same folder, so that the file can be renamed.
fn temporary(path: &Path) -> PathBuf {
    let mut name = path.file_name().unwrap_or_default().to_owned();
    name.push(format!(".{}.tmp", std::process::id()));
    path.with_file_name(name)
}

/// Prints what a command answers.
pub(super) fn print(text: &str) -> Result<()> {
    match io::stdout().write_all(text.as_bytes()) {
        // A reader that has seen enough, as `head` has, is no failure.
        Err(error) if error.kind() != io::ErrorKind::BrokenPipe => Err(lost_output(&error)),
        _ => Ok(()),
    }
}

/// What is said when standard output takes no more.
pub(super) fn lost_output(error: &io::Error) -> anyhow::Error {
    anyhow!("cannot write to standard output: {}", reason(error))
}
