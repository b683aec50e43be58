//! The token and the port of a project's page, stored so that an open page can reconnect to the next run of the
//! command.
//!
//! One file contains the projects shown last, one per line: token, port, folder. Only its owner can read it. If the
//! file cannot be read or written, the only consequence is that pages must be opened again.

use std::env;
use std::fs::{self, File, OpenOptions};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::process;

use crate::cli::io::state;

/// The maximum number of projects in the file.
const MOST: usize = 50;

/// The access to the page of a project.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) struct KeptAccess {
    /// The token in its URL.
    pub(super) token: String,
    /// The port in its URL.
    pub(super) port: u16,
}

/// The access of the last run in this folder, if known.
pub(super) fn read() -> Option<KeptAccess> {
    let (file, project) = (record()?, project()?);
    let text = fs::read_to_string(file).ok()?;
    text.lines()
        .find_map(|line| parsed(line).filter(|(folder, _)| *folder == project))
        .map(|(_, access)| access)
}

/// Stores the access for the next run in this folder.
pub(super) fn write(access: &KeptAccess) {
    let (Some(file), Some(project)) = (record(), project()) else { return };
    let known = fs::read_to_string(&file).unwrap_or_default();
    let others = known.lines().filter(|line| parsed(line).is_some_and(|(folder, _)| folder != project));
    let line = format!("{} {} {project}", access.token, access.port);
    let lines: Vec<&str> = std::iter::once(&*line).chain(others.take(MOST - 1)).collect();
    // Without this file pages must be opened again, which is not an error of this run.
    let _ = replace(&file, &(lines.join("\n") + "\n"));
}

/// Writes a file that only its owner can read, in one step.
fn replace(file: &Path, text: &str) -> io::Result<()> {
    let folder = file.parent().unwrap_or(Path::new(""));
    fs::create_dir_all(folder)?;
    let new = folder.join(format!("pages.{}", process::id()));
    private(&new)?.write_all(text.as_bytes())?;
    fs::rename(&new, file)
}

#[cfg(unix)]
fn private(file: &Path) -> io::Result<File> {
    use std::os::unix::fs::OpenOptionsExt;
    OpenOptions::new().write(true).create(true).truncate(true).mode(0o600).open(file)
}

/// Creates the file: the folder is in the user's profile, which others cannot read.
#[cfg(not(unix))]
fn private(file: &Path) -> io::Result<File> {
    OpenOptions::new().write(true).create(true).truncate(true).open(file)
}

/// The folder in a line, and the access to its page.
fn parsed(line: &str) -> Option<(&str, KeptAccess)> {
    let (token, rest) = line.split_once(' ')?;
    let (port, folder) = rest.split_once(' ')?;
    Some((folder, KeptAccess { token: token.to_owned(), port: port.parse().ok()? }))
}

/// The name of this folder; `None` if it does not fit in a line.
fn project() -> Option<String> {
    let folder = fs::canonicalize(env::current_dir().ok()?).ok()?;
    folder.to_str().filter(|name| !name.contains(['\n', '\r'])).map(str::to_owned)
}

fn record() -> Option<PathBuf> {
    Some(state::folder()?.join("pages"))
}
