//! `cc67 check`: diagnostics only.
//!
//! Programs that run together are compared: those of a command line that names threads, a program and those of its first
//! line, the programs of a project file.

use std::ffi::{OsStr, OsString};
use std::iter::once;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;
use kmotiondef::ThreadId;
use kmotiondef::boards::TargetBoard;
use kmotiondef::timing::Timing;

use crate::cli::args::board::read_machine_file;
use crate::cli::args::compiler::SourceArguments;
use crate::cli::args::program::{ProgramFile, assign, names_thread};
use crate::cli::args::sidecars::{Head, PROJECT_FILE, Project, resolve_file};
use crate::cli::args::stimulus;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::{files_below, is_source, read};
use crate::cli::io::{output, terminal};
use crate::cli::report::diagnostics;
use compiler::driver::{SharingProgram, advise};
use compiler::image;
use compiler::inspect::Inspection;
use compiler::pp::Disk;
use compiler::target::Target;

/// Arguments of `cc67 check`.
#[derive(Debug, Args)]
pub(super) struct CheckArguments {
    /// Programs to check, or folders with programs; `N:FILE` is the program of thread N, and all of these are checked as running together; also machine files (.toml)
    /// and stimuli (.stim) [default: the programs of cc67.toml]
    #[arg(value_name = "[N:]FILE")]
    files: Vec<OsString>,
    /// Show the stack that each function needs on the controller, and the worst chain of calls
    #[arg(long)]
    stack: bool,
    #[command(flatten)]
    compiler: SourceArguments,
}

/// Compiles every program and reports what is wrong with it, and with programs that run together.
pub(super) fn check(arguments: &CheckArguments) -> Result<Exit> {
    let target = if arguments.stack { Target::C67x } else { Target::default() };
    let options = arguments.compiler.resolve(target, Timing::VENDOR)?;
    let levels = arguments.compiler.levels()?;
    let (descriptions, files): (Vec<_>, Vec<_>) = arguments.files.iter().cloned().partition(is_description);
    let (programs, groups) = match files.is_empty() && !descriptions.is_empty() {
        true => Default::default(),
        false => programs(files)?,
    };
    let mut has_errors = false;
    for description in descriptions {
        if let Err(error) = check_description(&description, options.firmware.board()) {
            terminal::error(&error);
            has_errors = true;
        }
    }
    for path in &programs {
        let text = read(path)?;
        let mut compilation = compiler::compile(path, text, &options, &Disk);
        if let Some(program) = compilation.included_by().iter().find(|name| is_beside(path, name, &programs))
        {
            terminal::note(&format!("{} is a part of {program}, which is checked", path.display()));
            continue;
        }
        // Which thread it would run in makes no difference to what can be wrong.
        let thread = ThreadId::all().next().context("the board has threads")?;
        let linked = compilation.link(thread, &options);
        has_errors |= diagnostics::report(&compilation, &levels, arguments.compiler.format());
        if let Some(linked) = linked.filter(|_| arguments.stack) {
            let name = if programs.len() > 1 { format!("{}\n", path.display()) } else { String::new() };
            output::print(&(name + &Inspection::read(&image::write(&linked)?)?.stack()))?;
        }
    }
    for group in groups {
        let read = |ProgramFile { thread, path }| Ok(SharingProgram { thread, text: read(&path)?, path });
        let group = group.into_iter().map(read).collect::<Result<_>>()?;
        has_errors |=
            diagnostics::report_all(&advise(group, &options, &Disk), &levels, arguments.compiler.format());
    }
    Ok(if has_errors { Exit::Failure } else { Exit::Success })
}

/// Returns whether a file describes a machine or what happens around it.
fn is_description(file: &OsString) -> bool {
    let path = Path::new(file);
    let suffix = path.extension().unwrap_or_default();
    let is_one = suffix.eq_ignore_ascii_case("toml") || suffix.eq_ignore_ascii_case("stim");
    is_one && !path.is_dir()
}

/// Reads a machine file, a project file or a stimulus.
fn check_description(file: &OsStr, board: &'static TargetBoard) -> Result<()> {
    let path = Path::new(file);
    if path.file_name() == Some(OsStr::new(PROJECT_FILE)) {
        return Project::find_above(path.parent().unwrap_or(Path::new(""))).map(|_| ());
    }
    if path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("stim")) {
        return stimulus::read(&[file.to_string_lossy().into_owned()]).map(|_| ());
    }
    read_machine_file(path, board).map(|_| ())
}

/// Returns whether the file of that name in the folder of `path` is among the programs.
fn is_beside(path: &Path, name: &str, programs: &[PathBuf]) -> bool {
    programs.iter().any(|program| *program == path.with_file_name(name))
}

impl CheckArguments {
    /// The first file that is named, with its thread.
    pub(super) fn first(&self) -> Option<&OsStr> {
        self.files.first().map(OsString::as_os_str)
    }
}

/// The programs to check, and those of them that run together; those of the project file if none is named.
fn programs(named: Vec<OsString>) -> Result<(Vec<PathBuf>, Vec<Vec<ProgramFile>>)> {
    let of_project = || -> Result<Vec<OsString>> {
        match Project::find_above(Path::new(""))? {
            Some(project) if !project.programs().is_empty() => Ok(project.programs().to_vec()),
            _ => {
                bail!("no FILE given, and no cc67.toml here or above with `programs = [\"1:main.c\", …]`")
            }
        }
    };
    let mut is_together = named.is_empty();
    let files = if is_together { of_project()? } else { named };
    for file in &files {
        is_together |= names_thread(file)?;
    }
    if is_together {
        let programs = assign(&files)?;
        return Ok((programs.iter().map(|program| program.path.clone()).collect(), vec![programs]));
    }
    let mut paths = Vec::new();
    for path in files.into_iter().map(PathBuf::from) {
        if path.is_dir() { add_programs(&path, &mut paths)? } else { paths.push(path) }
    }
    let groups = paths.iter().filter_map(|path| group_of(path).transpose()).collect::<Result<_>>()?;
    Ok((paths, groups))
}

/// Adds the programs of a folder and of those in it.
fn add_programs(folder: &Path, paths: &mut Vec<PathBuf>) -> Result<()> {
    let before = paths.len();
    for path in files_below(folder, "c")? {
        if has_main(&String::from_utf8_lossy(&read(&path)?)) {
            paths.push(path.strip_prefix(".").map_or(path.clone(), Path::to_owned));
        }
    }
    if paths.len() == before {
        bail!("no programs in {}: a program is a .c file with a function `main`", folder.display());
    }
    Ok(())
}

/// Returns whether a text has the word `main` before a parenthesis, as files that programs include do not.
fn has_main(text: &str) -> bool {
    let is_word = |character: char| character.is_ascii_alphanumeric() || character == '_';
    text.match_indices("main").any(|(at, word)| {
        let rest = text.get(at + word.len()..).unwrap_or_default();
        !text.get(..at).unwrap_or_default().ends_with(is_word) && rest.trim_start().starts_with('(')
    })
}

/// A program and those that its first line says run beside it; `None` if it is no source.
fn group_of(path: &Path) -> Result<Option<Vec<ProgramFile>>> {
    if !is_source(path) || !path.is_file() {
        return Ok(None);
    }
    let also = match Head::of(path)? {
        Head::Run { also, .. } => also,
        Head::Part | Head::None => Vec::new(),
    };
    let folder = path.parent().unwrap_or(Path::new(""));
    let also = also.iter().map(|program| resolve_file(folder, program));
    assign(&once(path.as_os_str().to_owned()).chain(also).collect::<Vec<_>>()).map(Some)
}
