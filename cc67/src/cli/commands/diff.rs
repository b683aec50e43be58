//! `cc67 diff`: the differences of two images, or of two boards for a program that is moved from one to the other.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::{Result, bail};
use clap::Args;
use kmotiondef::boards::TargetBoard;

use super::inspect;
use crate::cli::args::compiler::board;
use crate::cli::io::exit::Exit;
use crate::cli::io::input::read;
use crate::cli::io::output;
use compiler::inspect::Inspection;
use compiler::inspect::compare;

/// Arguments of `cc67 diff`.
#[derive(Debug, Args)]
pub(super) struct DiffArguments {
    /// Compare two boards: their names, constants and structures
    #[arg(long, num_args = 2, value_names = ["A", "B"], value_parser = board)]
    boards: Vec<&'static TargetBoard>,
    /// Two images; with --boards, sources: only the names in them are compared
    #[arg(value_name = "FILE")]
    files: Vec<PathBuf>,
}

/// Prints the differences; exit code 1 if there are any.
pub(super) fn diff(arguments: &DiffArguments) -> Result<Exit> {
    let text = match (arguments.boards.as_slice(), arguments.files.as_slice()) {
        ([first, second], sources) => of_boards(first, second, sources)?,
        (_, [first, second]) => of_images(first, second)?,
        _ => bail!("two images are compared, or two boards with `--boards A B`"),
    };
    if text.is_empty() {
        return Ok(Exit::Success);
    }
    output::print(&text)?;
    Ok(Exit::Failure)
}

fn of_images(first: &Path, second: &Path) -> Result<String> {
    let first = Inspection::new(inspect::read_image(first)?);
    let second = Inspection::new(inspect::read_image(second)?);
    Ok(compare(&first, &second).into_iter().map(|line| line + "\n").collect())
}

/// A line for each name that differs between two boards; with sources, only for names in them.
fn of_boards(first: &TargetBoard, second: &TargetBoard, sources: &[PathBuf]) -> Result<String> {
    let mut words = BTreeSet::new();
    for path in sources {
        let text = String::from_utf8_lossy(&read(path)?).into_owned();
        words.extend(text.split(|c: char| c != '_' && !c.is_ascii_alphanumeric()).map(str::to_owned));
    }
    let mut out = String::new();
    let differences = first.differences(second).into_iter();
    for difference in differences.filter(|one| sources.is_empty() || words.contains(one.name)) {
        // Writing to a string cannot fail.
        let _ = writeln!(out, "{:<28} {}", difference.name, difference.change);
    }
    Ok(out)
}
