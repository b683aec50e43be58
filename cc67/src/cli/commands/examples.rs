//! `cc67 examples`: the programs of `c-programs/`, which are embedded in the command, as self-contained programs.
//!
//! In a copy the included files are merged into the program, so that it needs no files other than its machine file and
//! stimulus.

use std::collections::BTreeSet;
use std::path::PathBuf;

use anyhow::{Context, Result, bail};
use clap::Args;
use compiler::words::suggest;

use crate::cli::args::sidecars::Head;
use crate::cli::io::exit::Exit;
use crate::cli::io::output;

/// The names and contents of all files.
const FILES: &[(&str, &[u8])] = include!(concat!(env!("OUT_DIR"), "/examples.rs"));

/// Arguments of `cc67 examples`.
#[derive(Debug, Args)]
pub(super) struct ExamplesArguments {
    /// Example to copy, with its files; without a name, list all
    #[arg(value_name = "NAME")]
    name: Option<String>,
    /// Folder for the copy
    #[arg(value_name = "DIR", default_value = ".")]
    folder: PathBuf,
    /// Print the program instead of copying it
    #[arg(long)]
    print: bool,
}

/// A file of a copy: its name and text.
pub(super) type Copy = (String, Vec<u8>);

/// Lists the examples, or copies one.
pub(super) fn examples(arguments: &ExamplesArguments) -> Result<Exit> {
    let Some(name) = &arguments.name else {
        output::print(&list())?;
        return Ok(Exit::Success);
    };
    let path = find(name)?;
    let stem = stem(path);
    if arguments.print {
        output::print(&inline_includes(path, &mut BTreeSet::new()))?;
        return Ok(Exit::Success);
    }
    let files: Vec<_> =
        copy(path, stem).into_iter().map(|(name, text)| (arguments.folder.join(name), text)).collect();
    if let Some((path, _)) = files.iter().find(|(path, _)| path.symlink_metadata().is_ok()) {
        bail!("{} already exists; nothing was written", path.display());
    }
    std::fs::create_dir_all(&arguments.folder)
        .with_context(|| format!("cannot make the folder {}", arguments.folder.display()))?;
    output::write_all(&files)?;
    let names: Vec<_> = files.iter().map(|(path, _)| path.display().to_string()).collect();
    let program = arguments.folder.join(format!("{stem}.c"));
    output::print(&format!("Wrote {}. Run it with\n  cc67 run {}\n", names.join(", "), program.display()))?;
    Ok(Exit::Success)
}

/// All examples with the first lines of their comments.
fn list() -> String {
    let mut text = "Copy one of these programs into the folder: cc67 examples NAME\n".to_owned();
    let mut folder = "";
    for (path, bytes) in FILES.iter().filter(|(path, _)| is_program(path)) {
        let (of, name) = path.rsplit_once('/').unwrap_or(("", path));
        if of != folder {
            text.push_str(&format!("\n{of}\n"));
            folder = of;
        }
        let source = String::from_utf8_lossy(bytes);
        let about = source.lines().find_map(|line| line.strip_prefix(&format!("// {name} - ")));
        text.push_str(&format!("  {:<24}{}\n", stem(path), about.unwrap_or_default()));
    }
    text
}

/// Returns the number of examples.
pub(super) fn count() -> usize {
    FILES.iter().filter(|(path, _)| is_program(path)).count()
}

/// Returns whether a file is a program with an expected output.
fn is_program(path: &str) -> bool {
    path.strip_suffix(".c").is_some_and(|stem| content(&format!("{stem}.expected")).is_some())
}

fn stem(path: &str) -> &str {
    let name = path.rsplit('/').next().unwrap_or(path);
    name.strip_suffix(".c").unwrap_or(name)
}

fn content(path: &str) -> Option<&'static [u8]> {
    FILES.iter().find(|(known, _)| *known == path).map(|(_, bytes)| *bytes)
}

/// Finds a program by its name: `homing/index`, or just `index`.
fn find(name: &str) -> Result<&'static str> {
    let wanted = name.trim_end_matches(".c").trim_start_matches("c-programs/");
    let mut programs = FILES.iter().map(|(path, _)| *path).filter(|path| is_program(path));
    let fits = |path: &&str| path.strip_suffix(".c") == Some(wanted) || stem(path) == wanted;
    let near =
        || suggest(wanted, FILES.iter().filter(|(path, _)| is_program(path)).map(|(path, _)| stem(path)));
    programs.find(fits).with_context(|| match near() {
        Some(near) => format!("there is no example `{name}`; did you mean `{near}`?"),
        None => format!("there is no example `{name}`; `cc67 examples` lists them"),
    })
}

/// The files of a copy with the name `name`: the program, its associated files, and the programs for other threads.
pub(super) fn copy(path: &str, name: &str) -> Vec<Copy> {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let own = path.strip_suffix(".c").unwrap_or(path);
    let renamed = |text: String| {
        let text = text.replace(&format!("c-programs/{own}"), name);
        text.replace(&format!("{}.c", stem(path)), &format!("{name}.c"))
            .replace(&format!("c-programs/{folder}/"), "")
    };
    let source = renamed(inline_includes(path, &mut BTreeSet::new()));
    let mut files = vec![(format!("{name}.c"), source.clone().into_bytes())];
    for suffix in ["toml", "stim", "expected"] {
        if let Some(bytes) = content(&format!("{own}.{suffix}")) {
            files.push((format!("{name}.{suffix}"), bytes.to_vec()));
        }
    }
    if let Ok(Head::Run { also, .. }) = Head::parse(source.lines().next().unwrap_or_default()) {
        for program in also {
            let file = program.rsplit(':').next().unwrap_or(&program).to_owned();
            let text = inline_includes(&join(folder, &file), &mut BTreeSet::new());
            files.push((file, text.into_bytes()));
        }
    }
    files
}

/// A statement of an example that calls a function, and the name of the example.
pub(super) fn call(function: &str) -> Option<(&'static str, &'static str)> {
    let programs = FILES.iter().filter(|(path, _)| is_program(path));
    programs
        .filter_map(|(path, bytes)| Some((path.strip_suffix(".c")?, std::str::from_utf8(bytes).ok()?)))
        .find_map(|(program, source)| {
            let calls = |line: &&str| {
                let at = line.find(&format!("{function}("));
                let before = at.and_then(|at| line.get(..at)).and_then(|before| before.chars().next_back());
                let is_name = before.is_none_or(|c| !(c.is_alphanumeric() || c == '_'));
                at.is_some() && is_name && line.ends_with(';') && !line.starts_with("//")
            };
            source.lines().map(str::trim).find(calls).map(|line| (program, line))
        })
}

/// An example as files of a project, named after the topic.
pub(super) fn topic(path: &str, name: &str) -> Result<Vec<Copy>> {
    let files = copy(path, name);
    if content(path).is_none() {
        bail!("this cc67 was built without its examples");
    }
    Ok(files)
}

/// A source with the contents of its includes, each file once; the board's header remains an include.
fn inline_includes(path: &str, seen: &mut BTreeSet<String>) -> String {
    let folder = path.rsplit_once('/').map_or("", |(folder, _)| folder);
    let source = String::from_utf8_lossy(content(path).unwrap_or_default()).into_owned();
    let mut text = String::new();
    for line in source.lines() {
        let included = line.trim().strip_prefix("#include \"").and_then(|rest| rest.strip_suffix('"'));
        let file = included.map(|name| join(folder, name));
        match file.filter(|file| content(file).is_some()) {
            Some(file) if seen.insert(file.clone()) => text.push_str(&inline_includes(&file, seen)),
            Some(_) => {}
            None => {
                text.push_str(line);
                text.push('\n');
            }
        }
    }
    text
}

/// A name relative to a folder, without `..`.
fn join(folder: &str, name: &str) -> String {
    let mut parts: Vec<&str> = folder.split('/').filter(|part| !part.is_empty()).collect();
    for part in name.split('/') {
        match part {
            ".." => {
                parts.pop();
            }
            "." => {}
            part => parts.push(part),
        }
    }
    parts.join("/")
}
