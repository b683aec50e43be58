//! Which programs are tests, and how each wants to be run.

use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};

use crate::cli::run::read;

/// What the first line of a program begins with that says how it is run.
const HEAD: &str = "// cc67: ";

/// Files beside a program that it is run with, and the options that take them.
const BESIDE: &[(&str, &str)] = &[("toml", "--machine"), ("stim", "--stim")];

/// A program with the console it should show.
#[derive(Debug)]
pub(super) struct Case {
    /// The program.
    pub(super) source: PathBuf,
    /// What it should show, or nothing if that was never written down.
    pub(super) expected: Option<String>,
    /// Arguments of `cc67 run` in front of the program.
    pub(super) options: Vec<String>,
    /// Programs for other threads, behind it.
    pub(super) also: Vec<String>,
}

impl Case {
    /// Where the expected console stands.
    pub(super) fn golden(&self) -> PathBuf {
        self.source.with_extension("expected")
    }

    /// The folder it is run in.
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

/// The tests among the paths: programs that are named, and those in folders, in the order of names.
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

/// Adds the tests of a folder and of those in it.
fn search(folder: &Path, cases: &mut Vec<Case>) -> Result<()> {
    let entries = fs::read_dir(folder).with_context(|| format!("cannot read {}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    for path in paths {
        // A link to a folder may lead back here.
        if path.is_dir() && !path.is_symlink() {
            search(&path, cases)?;
        } else if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("c")) {
            let head = Head::of(&path)?;
            let is_test = matches!(head, Head::Run { .. })
                || matches!(head, Head::None) && path.with_extension("expected").exists();
            if is_test {
                cases.push(case(&path, head)?);
            }
        }
    }
    Ok(())
}

fn case(path: &Path, head: Head) -> Result<Case> {
    let (mut options, also) = match head {
        Head::Run { options, also } => (options, also),
        Head::Part | Head::None => (Vec::new(), Vec::new()),
    };
    for (suffix, option) in BESIDE {
        let beside = path.with_extension(suffix);
        if beside.exists() && !options.iter().any(|given| given.starts_with(option)) {
            let name = beside.file_name().unwrap_or_default().to_string_lossy().into_owned();
            options.extend([(*option).to_owned(), name]);
        }
    }
    let golden = path.with_extension("expected");
    let expected = match golden.exists() {
        true => Some(String::from_utf8_lossy(&read(&golden)?).replace("\r\n", "\n")),
        false => None,
    };
    Ok(Case { source: path.to_owned(), expected, options, also })
}

/// What the first line of a program says about its test.
#[derive(Debug, PartialEq, Eq)]
enum Head {
    /// `// cc67: run OPTION … also N:FILE …`
    Run { options: Vec<String>, also: Vec<String> },
    /// `// cc67: part of FILE`: it only makes sense in that program's test.
    Part,
    /// Nothing.
    None,
}

impl Head {
    fn of(path: &Path) -> Result<Self> {
        let text = read(path)?;
        let line = text.split(|byte| *byte == b'\n').next().unwrap_or_default();
        let line = String::from_utf8_lossy(line);
        Self::parse(line.trim_end()).with_context(|| format!("{}, line 1", path.display()))
    }

    fn parse(line: &str) -> Result<Self> {
        let Some(line) = line.strip_prefix(HEAD) else { return Ok(Self::None) };
        let mut words = line.split_whitespace().map(str::to_owned);
        match words.next().as_deref() {
            Some("part") => return Ok(Self::Part),
            Some("run") => {}
            _ => {
                bail!("`{line}` does not say how a test is run; write `run` with options, or `part of FILE`")
            }
        }
        let (mut options, mut also) = (Vec::new(), Vec::new());
        while let Some(word) = words.next() {
            if word != "also" {
                options.push(word);
                continue;
            }
            let Some(program) = words.next() else { bail!("no program behind `also`") };
            also.push(program);
        }
        Ok(Self::Run { options, also })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn check(line: &str, expect: &str) {
        let text = match Head::parse(line) {
            Ok(Head::Run { options, also }) => format!("run {options:?} also {also:?}"),
            Ok(other) => format!("{other:?}"),
            Err(error) => error.to_string(),
        };
        assert_eq!(text, expect);
    }

    #[test]
    fn the_first_line_says_how_a_test_is_run() {
        check("// blink.c - blinks", "None");
        check("// cc67: run", "run [] also []");
        check(
            "// cc67: run --for 2 also 2:a.c --time also 3:b.c",
            r#"run ["--for", "2", "--time"] also ["2:a.c", "3:b.c"]"#,
        );
        check("// cc67: part of relay.c", "Part");
        check("// cc67: run also", "no program behind `also`");
        check(
            "// cc67: --for 2",
            "`--for 2` does not say how a test is run; write `run` with options, or `part of FILE`",
        );
    }
}
