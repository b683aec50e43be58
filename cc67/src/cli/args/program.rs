//! Program arguments: `[N:]FILE`, and the assignment of files to threads.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use kmotiondef::ThreadId;

#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct ProgramFile {
    pub(crate) thread: ThreadId,
    /// The source or image.
    pub(crate) path: PathBuf,
}

impl ProgramFile {
    /// Returns whether the file is an image rather than a source, by its name.
    pub(crate) fn is_image(&self) -> bool {
        self.path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("out"))
    }

    /// The file's name for messages.
    pub(crate) fn name(&self) -> std::path::Display<'_> {
        self.path.display()
    }
}

/// Assigns a thread to each argument: the one that it names, otherwise the lowest free one.
pub(crate) fn assign(arguments: &[impl AsRef<OsStr>]) -> Result<Vec<ProgramFile>> {
    let split: Vec<_> = arguments.iter().map(|argument| split(argument.as_ref())).collect::<Result<_>>()?;
    let mut taken: Vec<(ThreadId, &Path)> = Vec::new();
    for (thread, path) in &split {
        let Some(thread) = *thread else { continue };
        if let Some((_, other)) = taken.iter().find(|(taken, _)| *taken == thread) {
            bail!("two programs for thread {thread}: {} and {}", other.display(), path.display());
        }
        taken.push((thread, path));
    }
    let mut free = ThreadId::all().filter(|thread| taken.iter().all(|(taken, _)| taken != thread));
    split
        .iter()
        .map(|(thread, path)| {
            let Some(thread) = thread.or_else(|| free.next()) else {
                bail!("more programs than the {} user threads", ThreadId::MAX);
            };
            Ok(ProgramFile { thread, path: path.clone() })
        })
        .collect()
}

/// Returns whether an argument includes a thread number.
pub(crate) fn names_thread(argument: &OsStr) -> Result<bool> {
    Ok(split(argument)?.0.is_some())
}

/// Splits `N:FILE`. A drive letter is not a number, so Windows paths need no special case; a name that is not UTF-8 is
/// all FILE.
fn split(whole: &OsStr) -> Result<(Option<ThreadId>, PathBuf)> {
    let argument = whole.to_str().unwrap_or_default();
    if let Some((number, path)) = argument.split_once(':')
        && !number.is_empty()
        && number.bytes().all(|byte| byte.is_ascii_digit())
    {
        let Some(thread) = number.parse().ok().and_then(ThreadId::new) else {
            bail!("invalid thread number {number} in `{argument}`, valid range 1-{}", ThreadId::MAX);
        };
        if path.is_empty() {
            bail!("no file after the thread number in `{argument}`");
        }
        return Ok((Some(thread), PathBuf::from(path)));
    }
    Ok((None, PathBuf::from(whole)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(arguments: &[&str], expect: &str) {
        let result = match assign(arguments) {
            Ok(programs) => {
                programs.iter().map(|p| format!("{}={}", p.thread, p.name())).collect::<Vec<_>>().join(" ")
            }
            Err(error) => error.to_string(),
        };
        assert_eq!(result, expect);
    }

    #[test]
    fn files_take_the_thread_they_name_or_the_lowest_free_one() {
        check(&["a.c", "b.c"], "1=a.c 2=b.c");
        check(&["a.c", "1:b.c"], "2=a.c 1=b.c");
        check(&["7:C:\\x\\a.c", "C:\\b.c"], "7=C:\\x\\a.c 1=C:\\b.c");
    }

    #[test]
    fn impossible_threads_are_refused() {
        check(&["0:a.c"], "invalid thread number 0 in `0:a.c`, valid range 1-7");
        check(&["8:a.c"], "invalid thread number 8 in `8:a.c`, valid range 1-7");
        check(&["2:a.c", "2:b.c"], "two programs for thread 2: a.c and b.c");
        check(&["3:"], "no file after the thread number in `3:`");
        check(&["a", "b", "c", "d", "e", "f", "g", "h"], "more programs than the 7 user threads");
    }
}
