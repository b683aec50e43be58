//! Files and options beside a program: `NAME.toml`, `NAME.stim`, the options of its first line, and the project file
//! `cc67.toml` of its folder or one above.
//!
//! All of it becomes options before those of the command line, which win. One line reports what was taken.

mod head;
mod project;
mod words;

pub(crate) use head::Head;
pub(crate) use project::{NAME as PROJECT_FILE, Project};

use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::Result;
use clap::Args;

use super::heading;

/// Files beside a program that it is run with, and the options that take them.
pub(crate) const SIDECARS: &[(&str, &str)] = &[("toml", "--machine"), ("stim", "--stim")];

/// Options whose value names a file or a folder, or with `N:` in front a program.
const FILES: &[&str] = &[
    "--machine",
    "--stim",
    "--stimulus",
    "--host",
    "--flash",
    "--files",
    "--load",
    "--first",
    "--firmware",
    "-I",
    "--uart-input",
    "--uart-output",
    "--trace",
    "--trace-bits",
    "--plot",
];

/// Options for the files beside a program.
#[derive(Debug, Args)]
#[command(next_help_heading = heading::PROGRAMS)]
pub(crate) struct SidecarArguments {
    /// Run an initialisation program to its end before the others start
    #[arg(long, value_name = "[N:]FILE")]
    pub(crate) first: Vec<OsString>,
    /// Ignore NAME.toml, NAME.stim, the first line of NAME.c and the project file cc67.toml
    #[arg(long)]
    pub(crate) no_sidecar: bool,
}

/// The files and options found beside a program.
#[derive(Debug, Default, PartialEq, Eq)]
pub(crate) struct Sidecars {
    /// Options to put before those of the command line.
    pub(crate) options: Vec<OsString>,
    /// Programs to put after those of the command line.
    pub(crate) also: Vec<OsString>,
    /// The files that were used, for the line that names them.
    said: Vec<String>,
}

impl Sidecars {
    /// Looks for files beside the first program of a command whose arguments are `given`; of the first line, only
    /// options that the command has are taken.
    ///
    /// # Errors
    /// What is wrong with the first line or the project file.
    pub(crate) fn of(
        command: &str,
        programs: &[OsString],
        given: &[OsString],
        knows: impl Fn(&str) -> bool,
    ) -> Result<Self> {
        let mut sidecars = Self::default();
        let Some(program) = programs.first() else { return Ok(sidecars) };
        let program = file_of(program);
        let folder = program.parent().unwrap_or(Path::new(""));
        if let Some(project) = Project::find_above(folder)? {
            sidecars.take_project(command, &project);
        }
        let is_source = program.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("c"));
        let head = if is_source && program.is_file() { Head::of(&program)? } else { Head::None };
        let (options, also) = match head {
            // What `run` does not know is a mistake; other commands have fewer options.
            Head::Run { options, also } if command == "run" => (options, also),
            Head::Run { options, also } => (known_options(options, knows), also),
            Head::Part | Head::None => (Vec::new(), Vec::new()),
        };
        for (suffix, option) in SIDECARS {
            let path = program.with_extension(suffix);
            let is_project = path.file_name() == Some(OsStr::new(project::NAME));
            if path.is_file()
                && !is_project
                && !names(given, option)
                && !options.iter().any(|word| word.starts_with(option))
            {
                let replaced = value_of(&sidecars.options, option);
                let replaced = replaced
                    .map_or(String::new(), |file| format!(" in place of {}", Path::new(&file).display()));
                sidecars.said.push(format!("{}{replaced}", path.display()));
                sidecars.options.extend([OsString::from(option), path.into()]);
            }
        }
        sidecars.take_head(options, also, folder, programs.len() == 1);
        if names(given, "--json") {
            sidecars.options.retain(|option| option != "--time");
        }
        Ok(sidecars)
    }

    /// Returns the options with which a project's sources are compiled: folders of included files, and the board.
    ///
    /// # Errors
    /// The project file has a mistake.
    pub(crate) fn of_sources(first: Option<&OsStr>, knows: impl Fn(&str) -> bool) -> Result<Self> {
        let file = first.map(file_of).unwrap_or_default();
        let project = Project::find_above(file.parent().unwrap_or(Path::new("")))?;
        Ok(project.map(|project| project.common_options(knows)).unwrap_or_default().into())
    }

    /// Returns whether there is nothing.
    pub(crate) fn is_empty(&self) -> bool {
        self.options.is_empty() && self.also.is_empty()
    }

    fn take_project(&mut self, command: &str, project: &Project) {
        let options = project.options(command);
        if !options.is_empty() {
            self.said.push(project.path.display().to_string());
            self.options.extend(options);
        }
    }

    fn take_head(&mut self, options: Vec<String>, also: Vec<String>, folder: &Path, is_alone: bool) {
        let also = if is_alone { also } else { Vec::new() };
        if options.is_empty() && also.is_empty() {
            return;
        }
        let shown = options.iter().map(|option| words::quoted(option));
        let shown = shown.chain(also.iter().flat_map(|program| ["also".to_owned(), words::quoted(program)]));
        self.said.push(format!("its first line: {}", shown.collect::<Vec<_>>().join(" ")));
        self.options.extend(relative_to(folder, options));
        self.also.extend(also.into_iter().map(|program| resolve_file(folder, &program)));
    }

    /// The line that says what is used; `None` if it is nothing.
    pub(crate) fn line(&self, program: &OsStr) -> Option<String> {
        let name = file_of(program).display().to_string();
        (!self.said.is_empty())
            .then(|| format!("running {name} with {} (--no-sidecar ignores it)", self.said.join("; ")))
    }
}

impl From<Vec<OsString>> for Sidecars {
    fn from(options: Vec<OsString>) -> Self {
        Self { options, ..Self::default() }
    }
}

/// The options that a command knows, with their values.
fn known_options(options: Vec<String>, knows: impl Fn(&str) -> bool) -> Vec<String> {
    let mut is_known = true;
    let take = |option: &String| {
        if option.starts_with('-') && option.parse::<f64>().is_err() {
            is_known = knows(option.split('=').next().unwrap_or_default());
        }
        is_known
    };
    options.into_iter().filter(take).collect()
}

/// Returns whether an option is among arguments.
fn names(arguments: &[OsString], option: &str) -> bool {
    arguments.iter().filter_map(|argument| argument.to_str()).any(|argument| {
        argument.strip_prefix(option).is_some_and(|rest| rest.is_empty() || rest.starts_with('='))
    })
}

/// The last value of an option among words.
fn value_of(words: &[OsString], option: &str) -> Option<OsString> {
    words.iter().enumerate().rev().find_map(|(index, word)| {
        let rest = word.to_str()?.strip_prefix(option)?;
        match rest.strip_prefix('=') {
            Some(value) => Some(value.into()),
            None => words.get(index + 1).filter(|_| rest.is_empty()).cloned(),
        }
    })
}

/// The file of `[N:]FILE`.
fn file_of(program: &OsStr) -> PathBuf {
    let split = program.to_str().and_then(|text| text.split_once(':'));
    match split {
        Some((number, path)) if !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()) => {
            path.into()
        }
        _ => program.into(),
    }
}

/// Options whose files are relative to a folder.
fn relative_to(folder: &Path, options: Vec<String>) -> Vec<OsString> {
    let mut is_file = false;
    let mut all = Vec::new();
    for option in options {
        let joined = match option.split_once('=') {
            Some((name, value)) if FILES.contains(&name) => {
                let mut joined = OsString::from(format!("{name}="));
                joined.push(file_or_text(folder, value));
                joined
            }
            _ if is_file => file_or_text(folder, &option),
            _ => option.clone().into(),
        };
        is_file = FILES.contains(&option.as_str());
        all.push(joined);
    }
    all
}

/// A stimulus may be a text, which has spaces or signs in it.
fn file_or_text(folder: &Path, value: &str) -> OsString {
    let is_text = value.contains([' ', '=']) && !folder.join(value).exists();
    if is_text { value.into() } else { resolve_file(folder, value) }
}

/// `[N:]FILE` with a file relative to a folder.
pub(crate) fn resolve_file(folder: &Path, program: &str) -> OsString {
    let file = file_of(OsStr::new(program));
    let number = program.strip_suffix(&*file.to_string_lossy()).unwrap_or_default();
    let mut joined = OsString::from(number);
    joined.push(folder.join(file));
    joined
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_in_the_first_line_are_relative_to_the_program() {
        let options =
            ["--stim", "a.stim", "--stim", "bit 8 = 1", "--for", "2", "--machine=m.toml", "--load", "2:b.c"];
        let options = relative_to(Path::new("sub"), options.map(str::to_owned).into());
        let shown: Vec<_> =
            options.iter().map(|option| option.to_string_lossy().replace('\\', "/")).collect();
        assert_eq!(
            shown,
            [
                "--stim",
                "sub/a.stim",
                "--stim",
                "bit 8 = 1",
                "--for",
                "2",
                "--machine=sub/m.toml",
                "--load",
                "2:sub/b.c"
            ]
        );
    }

    #[test]
    fn an_option_is_found_with_and_without_its_value() {
        let given = ["run", "--machine=a.toml", "--stim", "x"].map(OsString::from);
        assert!(names(&given, "--machine") && names(&given, "--stim") && !names(&given, "--sti"));
    }
}
