//! `cc67 init`: a project folder ready for an editor and for CI.
//!
//! The folder contains a first program with its test, the header of the board for editors, and the configuration for VS
//! Code and a CI service. The files come from `project/`, the headers from the compiler.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use clap::builder::PossibleValuesParser;
use kmotiondef::headers::EMBEDDED;

use super::examples;
use crate::cli::io::exit::Exit;
use crate::cli::io::output;

/// Arguments of `cc67 init`.
#[derive(Debug, Args)]
pub(super) struct InitArguments {
    /// Folder of the project; created if it does not exist
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
    /// Start with this example, its machine file, stimulus and expected output
    #[arg(long, value_name = "EXAMPLE", value_parser = topics())]
    example: Option<String>,
}

/// The examples for new projects: name, program, and a stimulus of its own.
const EXAMPLES: &[(&str, &str, Option<&[u8]>)] = &[
    ("homing", "homing/index.c", Some(include_bytes!("examples/homing.stim"))),
    ("probe", "probing/tool_length.c", None),
    ("spindle", "spindle/at_speed.c", None),
    ("toolchange", "toolchange/turret.c", None),
];

fn topics() -> PossibleValuesParser {
    EXAMPLES.iter().map(|(name, ..)| *name).collect::<Vec<_>>().into()
}

/// The files of an example.
fn example(name: &str) -> Result<Vec<(String, Vec<u8>)>> {
    let row = EXAMPLES.iter().find(|(known, ..)| *known == name);
    let (_, path, stimulus) = row.with_context(|| format!("there is no example `{name}`"))?;
    let mut files = examples::topic(path, name)?;
    files.extend(stimulus.map(|text| (format!("{name}.stim"), text.to_vec())));
    Ok(files)
}

/// The files of a project other than headers: name and text.
const PROJECT: &[(&str, &[u8])] = &[
    ("README.md", include_bytes!("project/README.md")),
    ("first.c", include_bytes!("project/first.c")),
    ("first.expected", include_bytes!("project/first.expected")),
    ("compile_flags.txt", include_bytes!("project/compile_flags.txt")),
    (".gitignore", include_bytes!("project/.gitignore")),
    (".vscode/tasks.json", include_bytes!("project/.vscode/tasks.json")),
    (".vscode/launch.json", include_bytes!("project/.vscode/launch.json")),
    (".vscode/extensions.json", include_bytes!("project/.vscode/extensions.json")),
    (".github/workflows/test.yml", include_bytes!("project/.github/workflows/test.yml")),
];

/// The folder of the headers within a project.
const HEADERS: &str = "include";

/// Writes the files of a new project; nothing if one of them already exists.
pub(super) fn init(arguments: &InitArguments) -> Result<Exit> {
    let folder = &arguments.folder;
    let example = arguments.example.as_deref().map(example).transpose()?.unwrap_or_default();
    let files: Vec<(PathBuf, &[u8])> = PROJECT
        .iter()
        .map(|(name, text)| (folder.join(name), *text))
        .chain(EMBEDDED.iter().map(|(name, text)| (folder.join(HEADERS).join(name), *text)))
        .chain(example.iter().map(|(name, text)| (folder.join(name), text.as_slice())))
        .collect();
    let first = arguments.example.as_ref().map_or("first.c".to_owned(), |name| format!("{name}.c"));
    if let Some((path, _)) = files.iter().find(|(path, _)| path.symlink_metadata().is_ok()) {
        bail!("{} already exists; nothing was written", path.display());
    }
    for (path, text) in &files {
        let parent = path.parent().unwrap_or(Path::new("."));
        fs::create_dir_all(parent).with_context(|| format!("cannot make the folder {}", parent.display()))?;
        output::write(path, text)?;
    }
    output::print(&format!(
        "Created a project with {} files in {}. Next:\n  cc67 run {first}\n  cc67 test {}\n",
        files.len(),
        folder.display(),
        folder.display(),
        first = folder.join(first).display(),
    ))?;
    Ok(Exit::Success)
}
