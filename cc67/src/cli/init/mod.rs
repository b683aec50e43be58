//! `cc67 init`: a project folder ready for an editor and for CI.
//!
//! The folder holds a first program with its test, the header of the board for editors, and what VS Code
//! and a CI service need to know. The files are those of `project/`, the headers those of the compiler.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use kmotiondef::headers::EMBEDDED;

use super::{Exit, output};

/// Arguments of `cc67 init`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// The folder; it is made if there is none
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
}

/// The files of a project beside the headers: name, text.
const PROJECT: &[(&str, &[u8])] = &[
    ("README.md", include_bytes!("project/README.md")),
    ("first.c", include_bytes!("project/first.c")),
    ("first.expected", include_bytes!("project/first.expected")),
    ("compile_flags.txt", include_bytes!("project/compile_flags.txt")),
    (".vscode/tasks.json", include_bytes!("project/.vscode/tasks.json")),
    (".github/workflows/test.yml", include_bytes!("project/.github/workflows/test.yml")),
];

/// The folder of the headers within a project.
const HEADERS: &str = "include";

/// Writes the files of a new project; nothing if one of them is there already.
pub(super) fn init(arguments: &Arguments) -> Result<Exit> {
    let folder = &arguments.folder;
    let files: Vec<(PathBuf, &[u8])> = PROJECT
        .iter()
        .map(|(name, text)| (folder.join(name), *text))
        .chain(EMBEDDED.iter().map(|(name, text)| (folder.join(HEADERS).join(name), *text)))
        .collect();
    if let Some((path, _)) = files.iter().find(|(path, _)| path.symlink_metadata().is_ok()) {
        bail!("{} is there already; nothing was written", path.display());
    }
    for (path, text) in &files {
        let parent = path.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(parent).with_context(|| format!("cannot make the folder {}", parent.display()))?;
        output::write(path, text)?;
    }
    output::print(&format!(
        "Made a project of {} files in {}. Go on with\n  cc67 run {first}\n  cc67 test {}\n",
        files.len(),
        folder.display(),
        folder.display(),
        first = folder.join("first.c").display(),
    ))?;
    Ok(Exit::Success)
}
