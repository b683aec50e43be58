//! The project file `cc67.toml`: options shared by all programs of a folder and the folders below it.
//!
//! ```toml
//! machine = "mill.toml"
//! include = ["include"]
//! first = ["init.c"]
//! programs = ["1:main.c", "2:door.c"]
//!
//! [run]
//! for = 5
//! ```
//!
//! `[run]`, `[test]`, `[live]` and `[debug]` hold options of these commands by their long names. Files are relative to
//! the project file.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::path::{Path, PathBuf};

use anyhow::{Result, anyhow, bail};
use compiler::words::suggest;
use toml::de::{DeTable, DeValue};

use super::{file_or_text, resolve_file};
use crate::cli::io::input::read;

/// The name of the file.
pub(crate) const NAME: &str = "cc67.toml";

/// Keys that are lists or values of their own, and the option that each stands for.
const KEYS: &[(&str, &str)] = &[
    ("machine", "--machine"),
    ("board", "--board"),
    ("include", "-I"),
    ("first", "--first"),
    ("start", "--first"),
];

/// The key of the programs.
const PROGRAMS: &str = "programs";

/// Commands that have defaults here.
const COMMANDS: &[&str] = &["run", "test", "live", "debug"];

/// A project file.
#[derive(Debug)]
pub(crate) struct Project {
    /// Its path.
    pub(crate) path: PathBuf,
    /// Options of every command.
    common: Vec<[OsString; 2]>,
    /// The options of each command, as keys and values.
    of_commands: BTreeMap<String, Vec<(String, Vec<OsString>)>>,
    /// The programs of the threads, which `cc67 check` compares.
    programs: Vec<OsString>,
}

impl Project {
    /// The project file of a folder or of the nearest one above; a repository ends the search.
    ///
    /// # Errors
    /// What is wrong with it.
    pub(crate) fn find_above(folder: &Path) -> Result<Option<Self>> {
        let folder = if folder == Path::new("") { Path::new(".") } else { folder };
        let Ok(absolute) = folder.canonicalize() else { return Ok(None) };
        for above in absolute.ancestors() {
            let path = above.join(NAME);
            if path.is_file() {
                let shown = if above == absolute { folder.join(NAME) } else { path };
                let shown = shown.strip_prefix(".").map_or(shown.clone(), Path::to_owned);
                return Self::read(&shown).map(Some);
            }
            if above.join(".git").exists() {
                break;
            }
        }
        Ok(None)
    }

    fn read(path: &Path) -> Result<Self> {
        let Ok(text) = String::from_utf8(read(path)?) else { bail!("{} is not text", path.display()) };
        let wrong = |offset: usize, message: String| {
            let before = text.get(..offset).unwrap_or_default();
            let line = before.matches('\n').count() + 1;
            let column = before.chars().rev().take_while(|character| *character != '\n').count() + 1;
            anyhow!("{}:{line}:{column}: {message}", path.display())
        };
        let table = DeTable::parse(&text)
            .map_err(|error| wrong(error.span().map_or(0, |span| span.start), error.message().to_owned()))?;
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut project = Self {
            path: path.to_owned(),
            common: Vec::new(),
            of_commands: BTreeMap::new(),
            programs: Vec::new(),
        };
        for (key, value) in table.get_ref() {
            let name = key.get_ref().as_ref();
            let at = value.span().start;
            if name == PROGRAMS {
                let values = values(value.get_ref(), &|text| resolve_file(folder, text));
                project.programs =
                    values.ok_or_else(|| wrong(at, format!("`{name}` must be a text, or several")))?;
            } else if let Some((_, option)) = KEYS.iter().find(|(known, _)| *known == name) {
                let word =
                    |text: &str| if name == "board" { text.into() } else { resolve_file(folder, text) };
                let values = values(value.get_ref(), &word);
                for value in
                    values.ok_or_else(|| wrong(at, format!("`{name}` must be a text, or several")))?
                {
                    project.common.push([OsString::from(option), value]);
                }
            } else if COMMANDS.contains(&name) {
                let DeValue::Table(table) = value.get_ref() else {
                    return Err(wrong(at, format!("`{name}` must be a table of options")));
                };
                let mut options = Vec::new();
                for (key, value) in table {
                    let option = key.get_ref().as_ref();
                    let words = option_words(folder, option, value.get_ref());
                    let message = || {
                        wrong(
                            value.span().start,
                            format!("`{name}.{option}` must be a text, a number, true or false, or several"),
                        )
                    };
                    options.push((option.to_owned(), words.ok_or_else(message)?));
                }
                project.of_commands.insert(name.to_owned(), options);
            } else {
                let known =
                    KEYS.iter().map(|(key, _)| *key).chain([PROGRAMS]).chain(COMMANDS.iter().copied());
                let hint = match suggest(name, known) {
                    Some(near) => format!("; did you mean `{near}`?"),
                    None => {
                        "; known: machine, board, include, first, programs, [run], [test], [live] and [debug]"
                            .to_owned()
                    }
                };
                return Err(wrong(key.span().start, format!("unknown key `{name}`{hint}")));
            }
        }
        Ok(project)
    }

    /// All options for a command.
    pub(crate) fn options(&self, command: &str) -> Vec<OsString> {
        let own = self.of_commands.get(command).into_iter().flatten();
        self.common.iter().flatten().cloned().chain(own.flat_map(|(_, words)| words.clone())).collect()
    }

    /// The options of every command that one knows.
    pub(super) fn common_options(&self, knows: impl Fn(&str) -> bool) -> Vec<OsString> {
        let is_known = |[option, _]: &&[OsString; 2]| option.to_str().is_some_and(&knows);
        self.common.iter().filter(is_known).flatten().cloned().collect()
    }

    /// The programs of the threads, `[N:]FILE` each.
    pub(crate) fn programs(&self) -> &[OsString] {
        &self.programs
    }

    /// The options for a command that it knows itself, and those that the programs it runs are run with.
    pub(crate) fn parted_options(
        &self,
        command: &str,
        knows: impl Fn(&str) -> bool,
    ) -> (Vec<OsString>, Vec<OsString>) {
        let own = self.of_commands.get(command).into_iter().flatten();
        let (known, others): (Vec<_>, Vec<_>) = own.partition(|(option, _)| knows(option));
        let words = |options: Vec<&(String, Vec<OsString>)>| {
            options.into_iter().flat_map(|(_, words)| words.clone()).collect::<Vec<_>>()
        };
        (words(known), self.common.iter().flatten().cloned().chain(words(others)).collect())
    }
}

/// One text, or several.
fn values(value: &DeValue<'_>, word: &dyn Fn(&str) -> OsString) -> Option<Vec<OsString>> {
    match value {
        DeValue::String(text) => Some(vec![word(text)]),
        DeValue::Integer(number) => Some(vec![word(number.as_str())]),
        DeValue::Float(number) => Some(vec![word(number.as_str())]),
        DeValue::Array(parts) => {
            let parts: Option<Vec<_>> = parts.iter().map(|part| values(part.get_ref(), word)).collect();
            parts.map(|parts| parts.concat())
        }
        DeValue::Boolean(_) | DeValue::Datetime(_) | DeValue::Table(_) => None,
    }
}

/// An option and its values as words of a command line.
fn option_words(folder: &Path, name: &str, value: &DeValue<'_>) -> Option<Vec<OsString>> {
    let option = if name.chars().count() == 1 { format!("-{name}") } else { format!("--{name}") };
    if let DeValue::Boolean(is_on) = value {
        return Some(if *is_on { vec![option.into()] } else { Vec::new() });
    }
    let is_file = super::FILES.contains(&option.as_str());
    let values = values(value, &|text| if is_file { file_or_text(folder, text) } else { text.into() })?;
    let joined = |value: OsString| {
        let mut word =
            OsString::from(if name.chars().count() == 1 { option.clone() } else { format!("{option}=") });
        word.push(OsStr::new(&value));
        word
    };
    Some(values.into_iter().map(joined).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn project(text: &str) -> Result<Project> {
        let folder = std::env::temp_dir().join(format!("cc67-project-{}-{}", std::process::id(), text.len()));
        std::fs::create_dir_all(&folder).expect("a folder");
        std::fs::write(folder.join(NAME), text).expect("a file");
        let project = Project::find_above(&folder);
        std::fs::remove_dir_all(&folder).expect("it is there");
        project.map(|project| project.expect("it was there"))
    }

    #[test]
    fn keys_become_options() {
        let text = "machine = \"m.toml\"\ninclude = [\"inc\"]\nfirst = \"2:init.c\"\n[run]\nfor = 2.5\ntime = true\nassist = false\nset = [\"persist.1=2\"]\n[test]\njobs = 2\nfor = 3\n";
        let project = project(text).expect("it is right");
        let folder = project.path.parent().expect("a folder").to_string_lossy().into_owned();
        let shown = |options: Vec<OsString>| -> Vec<String> {
            options
                .iter()
                .map(|word| word.to_string_lossy().replace(&folder, "F").replace('\\', "/"))
                .collect()
        };
        let common = ["--first", "2:F/init.c", "-I", "F/inc", "--machine", "F/m.toml"];
        assert_eq!(
            shown(project.options("run")),
            [&common[..], &["--for=2.5", "--set=persist.1=2", "--time"]].concat()
        );
        let (known, others) = project.parted_options("test", |option| option == "jobs");
        assert_eq!(shown(known), ["--jobs=2"]);
        assert_eq!(shown(others), [&common[..], &["--for=3"]].concat());
    }

    #[test]
    fn mistakes_are_reported_with_their_place() {
        for (text, expect) in [
            ("machin = 5", "cc67.toml:1:1: unknown key `machin`; did you mean `machine`?"),
            ("\nmachine = true", "cc67.toml:2:11: `machine` must be a text, or several"),
            ("run = 5", "cc67.toml:1:7: `run` must be a table of options"),
            (
                "[run]\nfor = {}",
                "cc67.toml:2:7: `run.for` must be a text, a number, true or false, or several",
            ),
        ] {
            let error = project(text).expect_err(text).to_string();
            assert!(error.ends_with(expect), "{error}");
        }
    }
}
