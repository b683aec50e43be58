//! The first line of a program: `// cc67: run OPTION … also N:FILE …`, with words split as by a shell.

use std::path::Path;

use anyhow::{Context, Result, bail};

use super::words::split;
use crate::cli::io::input::read;
use crate::cli::io::terminal;

/// The beginning of a program's first line that says how it is run.
const HEAD: &str = "// cc67: ";

/// The lines in which one that should be the first is looked for.
const SEARCHED: usize = 20;

/// Returns whether a line is a comment with the words of a first line, however it is written.
fn is_like(line: &str) -> bool {
    let line = line.trim_start_matches('\u{feff}').trim_start();
    let comment = ["//", "/*"].into_iter().find_map(|mark| line.strip_prefix(mark)).map(str::trim_start);
    let Some(words) = comment.and_then(|comment| comment.strip_prefix("cc67")) else { return false };
    let (words, has_colon) = words.strip_prefix(':').map_or((words, false), |words| (words, true));
    let mut words = words.split_whitespace();
    match words.next() {
        Some("run") => has_colon || words.any(|word| word.starts_with("--")),
        Some("part") => has_colon,
        _ => false,
    }
}

/// The first line of a program.
#[derive(Debug, PartialEq, Eq)]
pub(crate) enum Head {
    /// `// cc67: run OPTION … also N:FILE …`
    Run { options: Vec<String>, also: Vec<String> },
    /// `// cc67: part of FILE`: it only makes sense in that program's test.
    Part,
    /// Nothing.
    None,
}

impl Head {
    /// Reads the first line of a file.
    ///
    /// # Errors
    /// It is not understood, or cannot be read.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let text = read(path)?;
        let lines: Vec<_> =
            text.split(|byte| *byte == b'\n').take(SEARCHED).map(String::from_utf8_lossy).collect();
        let first = lines.first().map_or("", |line| line.trim_start_matches('\u{feff}').trim_end());
        let head = Self::parse(first).with_context(|| format!("{}, line 1", path.display()))?;
        if head == Self::None
            && let Some(index) = lines.iter().position(|line| is_like(line))
        {
            let name = path.strip_prefix(".").unwrap_or(path);
            let place = format!("{}:{}", name.display(), index + 1);
            terminal::note(&match index {
                0 => format!("{place}: a first line that says how a program is run begins with `{HEAD}`"),
                _ => format!("{place}: `{HEAD}…` counts in the first line only: move it there"),
            });
        }
        Ok(head)
    }

    /// Parses a first line.
    ///
    /// # Errors
    /// It is not understood.
    pub(crate) fn parse(line: &str) -> Result<Self> {
        let Some(line) = line.strip_prefix(HEAD) else { return Ok(Self::None) };
        let mut words = split(line)?.into_iter();
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
            let Some(program) = words.next() else { bail!("no program after `also`") };
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
        check(
            "// cc67: run --stim \"at 1s bit 8 = 1\" also '2:a b.c'",
            r#"run ["--stim", "at 1s bit 8 = 1"] also ["2:a b.c"]"#,
        );
        for (line, expect) in [
            ("// cc67: run --for 2", true),
            ("  //cc67: run", true),
            ("/* cc67: part of a.c */", true),
            ("// as in cc67: run", false),
            ("// cc67: runs it", false),
            ("// cc67 run --machine mill.toml", true),
            ("// cc67 run says more", false),
            ("cc67: run", false),
        ] {
            assert_eq!(is_like(line), expect, "{line}");
        }
        check("// cc67: part of relay.c", "Part");
        check("// cc67: run also", "no program after `also`");
        check(
            "// cc67: --for 2",
            "`--for 2` does not say how a test is run; write `run` with options, or `part of FILE`",
        );
    }
}
