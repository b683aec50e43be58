//! Test programs, and the options of each.

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use compiler::words::suggest;

use crate::cli::args::sidecars::{Head, Project, SIDECARS};
use crate::cli::io::input::{files_below, read};
use crate::cli::io::terminal;

/// A program with its expected output.
#[derive(Debug)]
pub(super) struct Case {
    /// The program.
    pub(super) source: PathBuf,
    /// The expected output, if there is one.
    pub(super) expected: Option<String>,
    /// Arguments of `cc67 run` before the program.
    pub(super) options: Vec<String>,
    /// Programs for other threads, after it.
    pub(super) also: Vec<String>,
}

impl Case {
    /// Returns the path of its expected output.
    pub(super) fn golden(&self) -> PathBuf {
        self.source.with_extension("expected")
    }

    /// The folder in which it is run.
    pub(super) fn folder(&self) -> &Path {
        match self.source.parent() {
            Some(folder) if folder != Path::new("") => folder,
            _ => Path::new("."),
        }
    }

    /// The name for reports.
    pub(super) fn name(&self) -> String {
        let name = self.source.with_extension("").to_string_lossy().replace('\\', "/");
        name.strip_prefix("./").map_or(name.clone(), str::to_owned)
    }
}

/// The tests at the paths: programs that are named, and those in folders, in the order of names.
pub(super) fn find(paths: &[PathBuf]) -> Result<Vec<Case>> {
    let mut cases = Vec::new();
    for path in paths {
        if path.is_dir() {
            search(path, &mut cases)?;
        } else {
            let head = Head::of(path)?;
            if let Head::Part = head {
                bail!("{} says that it is a part of another program's test", path.display());
            }
            cases.push(case(path, head)?);
        }
    }
    Ok(cases)
}

/// Adds the tests in a folder and its subfolders.
fn search(folder: &Path, cases: &mut Vec<Case>) -> Result<()> {
    for path in files_below(folder, "c")? {
        let head = Head::of(&path)?;
        let is_test = matches!(head, Head::Run { .. })
            || matches!(head, Head::None) && path.with_extension("expected").exists();
        if is_test {
            cases.push(case(&path, head)?);
        }
    }
    note_orphans(folder)
}

/// Reports expected outputs that belong to no program.
fn note_orphans(folder: &Path) -> Result<()> {
    for golden in files_below(folder, "expected")? {
        let name = golden.file_stem().unwrap_or_default().to_string_lossy();
        if golden.with_extension("c").exists() || golden.with_extension("C").exists() {
            continue;
        }
        let beside = files_below(golden.parent().unwrap_or(folder), "c")?;
        let without = beside.iter().filter(|source| !source.with_extension("expected").exists());
        let names: Vec<_> =
            without.filter_map(|path| Some(path.file_stem()?.to_string_lossy().into_owned())).collect();
        let hint = match suggest(&name, names.iter().map(String::as_str)) {
            Some(near) => format!("; did you mean {near}.expected?"),
            None => String::new(),
        };
        terminal::note(&format!(
            "{} belongs to no program: there is no {name}.c beside it{hint}",
            golden.display()
        ));
    }
    Ok(())
}

/// Options of the project file for the programs of tests; files have absolute paths, as a test is run in its own
/// folder.
fn project(path: &Path) -> Result<Vec<String>> {
    let folder = path.parent().filter(|folder| *folder != Path::new("")).unwrap_or(Path::new("."));
    let folder = folder.canonicalize().with_context(|| format!("cannot read {}", folder.display()))?;
    let Some(project) = Project::find_above(&folder)? else { return Ok(Vec::new()) };
    let (_, options) = project.parted_options("test", |option| super::OWN_OPTIONS.contains(&option));
    Ok(options.into_iter().map(|word| word.to_string_lossy().into_owned()).collect())
}

fn case(path: &Path, head: Head) -> Result<Case> {
    let (mut options, also) = match head {
        Head::Run { options, also } => (options, also),
        Head::Part | Head::None => (Vec::new(), Vec::new()),
    };
    let project = project(path)?;
    for (suffix, option) in SIDECARS {
        let sidecar = path.with_extension(suffix);
        if sidecar.is_file() && !options.iter().any(|given| given.starts_with(option)) {
            let name = sidecar.file_name().unwrap_or_default().to_string_lossy().into_owned();
            options.extend([(*option).to_owned(), name]);
        }
    }
    // Options of files closer to the program come later, and take precedence.
    options.splice(0..0, project);
    let golden = path.with_extension("expected");
    let expected = match golden.exists() {
        true => Some(String::from_utf8_lossy(&read(&golden)?).replace("\r\n", "\n")),
        false => None,
    };
    Ok(Case { source: path.to_owned(), expected, options, also })
}
