//! Temporary files: their names, and the removal of those left by killed processes.
//!
//! A process holds a lock on each file that it writes, and the operating system releases the lock with the process. So
//! a temporary file without a lock is no longer in use, and is removed when the same file is written again.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// The suffix of all temporary names.
const SUFFIX: &str = ".tmp";

/// The temporary files that were in each folder when the process first wrote there: usually none.
static FOUND: Mutex<BTreeMap<PathBuf, Vec<OsString>>> = Mutex::new(BTreeMap::new());

/// Returns a temporary name for a file, in the same folder, so that it can be renamed; removes files left by killed
/// processes that wrote the same file.
pub(super) fn clean(path: &Path, suffix: &str) -> PathBuf {
    let file = path.file_name().unwrap_or_default();
    let folder = path.parent().unwrap_or(Path::new(""));
    let mut found = FOUND.lock().unwrap_or_else(PoisonError::into_inner);
    let there = found.entry(folder.to_owned()).or_insert_with(|| temporary_files(folder));
    for name in there.extract_if(.., |name| file.to_str().is_some_and(|file| is_of(name, file))) {
        remove(&folder.join(name));
    }
    drop(found);
    let mut name = file.to_owned();
    name.push(format!(".{}.{suffix}", std::process::id()));
    path.with_file_name(name)
}

/// Locks a temporary file, which shows other processes that it is in use.
pub(super) fn mark(file: &File) {
    // Without locks, as on some network drives, nothing is removed.
    let _ = file.lock();
}

/// The temporary files of a folder.
fn temporary_files(folder: &Path) -> Vec<OsString> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let names = fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.file_name());
    names.filter(|name| name.to_str().is_some_and(|name| name.ends_with(SUFFIX))).collect()
}

/// Reports whether a name is `FILE.PROCESS.tmp` or `FILE.PROCESS.body.tmp`.
fn is_of(name: &OsString, file: &str) -> bool {
    let number = name
        .to_str()
        .and_then(|name| name.strip_prefix(file)?.strip_prefix('.')?.strip_suffix(SUFFIX))
        .map(|rest| rest.strip_suffix(".body").unwrap_or(rest));
    number.is_some_and(|number| !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()))
}

/// Removes a temporary file, unless a process holds its lock.
fn remove(path: &Path) {
    if fs::symlink_metadata(path).is_ok_and(|known| known.is_file())
        && let Ok(file) = File::options().write(true).open(path)
        && file.try_lock().is_ok()
    {
        // Another process may have removed it at the same time.
        let _ = fs::remove_file(path);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_temporary_names_of_the_same_file_count() {
        let is_of = |name: &str| is_of(&OsString::from(name), "a.out");
        assert!(is_of("a.out.123.tmp") && is_of("a.out.4.body.tmp"));
        for name in ["a.out", "a.out.tmp", "a.out..tmp", "a.out.x.tmp", "b.out.1.tmp", "a.out.1.tmp2"] {
            assert!(!is_of(name), "{name}");
        }
    }
}
