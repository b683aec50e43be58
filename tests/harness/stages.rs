//! Tests of the compiler's internal stages: an input text, and the expected output of a stage.
//!
//! A file contains both, separated by a line of hyphens; comments at the beginning describe the test. The input is C
//! for `lower/` and IR for `passes/NAME/`, `legalize/` and `bytecode/`; the output is IR, for `bytecode/` its
//! instructions. `cargo test --test filetests -- --bless` writes the present output.

use std::fs;
use std::path::{Path, PathBuf};

use compiler::{passes, pp, stages};

/// The line between input and output.
const BETWEEN: &str = "\n----\n";

/// A test of one stage.
#[derive(Debug)]
pub struct StageTest {
    path: PathBuf,
    /// The folders between `tests/filetests` and the file.
    stage: Vec<String>,
    input: String,
    expected: String,
}

impl StageTest {
    /// Reads the test at `path`, in the folder of all filetests.
    ///
    /// # Panics
    /// The file is not UTF-8.
    #[must_use]
    pub fn read(folder: &Path, path: &Path) -> Self {
        let text = fs::read_to_string(path).expect("tests are UTF-8");
        let (input, expected) = text.split_once(BETWEEN).unwrap_or((text.trim_end(), ""));
        let below = path.strip_prefix(folder).ok().and_then(Path::parent).unwrap_or(path);
        Self {
            path: path.to_owned(),
            stage: below.iter().map(|part| part.to_string_lossy().into_owned()).collect(),
            input: input.to_owned(),
            expected: expected.to_owned(),
        }
    }

    /// Returns the output of the stage for the input, or its diagnostics.
    fn run(&self) -> String {
        let folders: Vec<&str> = self.stage.iter().map(String::as_str).collect();
        let made = match folders[..] {
            ["lower"] => {
                stages::lower(&self.path, self.input.clone().into_bytes(), &pp::MemoryFiles::default())
            }
            ["passes", name] => stages::pass(name, &self.input),
            ["legalize"] => stages::legalize(&self.input),
            ["bytecode"] => stages::bytecode(&self.input),
            _ => Err(format!("there is no stage `{}`", folders.join("/"))),
        };
        made.unwrap_or_else(|error| format!("error: {error}\n"))
    }

    /// Compares the output; or writes it, if `is_blessed` is set.
    ///
    /// # Errors
    /// Both texts, if they differ.
    ///
    /// # Panics
    /// The file cannot be written.
    pub fn check(&self, is_blessed: bool) -> Result<(), String> {
        let found = self.run();
        if found == self.expected {
            return Ok(());
        }
        if is_blessed {
            let text = format!("{}{BETWEEN}{found}", self.input);
            fs::write(&self.path, text).expect("the test is writable");
            return Ok(());
        }
        Err(format!("{}:\n{found}---- expected\n{}", self.path.display(), self.expected))
    }
}

/// The stages with folders, each with the minimum number of its tests.
#[must_use]
pub fn folders() -> Vec<(String, usize)> {
    let passes = passes::ALL.iter().map(|(name, _)| (format!("passes/{name}"), 5));
    let others = [("lower", 20), ("legalize", 10), ("bytecode", 10)];
    others.iter().map(|(name, least)| ((*name).to_owned(), *least)).chain(passes).collect()
}
