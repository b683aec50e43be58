//! `cc67 diff`: how two images differ.

use std::path::PathBuf;

use anyhow::Result;
use clap::Args;

use super::inspect;
use crate::cli::io::exit::Exit;
use crate::cli::io::output;
use compiler::inspect::Inspection;
use compiler::inspect::compare;

/// Arguments of `cc67 diff`.
#[derive(Debug, Args)]
pub(super) struct DiffArguments {
    /// An image
    #[arg(value_name = "A")]
    first: PathBuf,
    /// Another one
    #[arg(value_name = "B")]
    second: PathBuf,
}

/// Prints the differences; exit code 1 if there are any.
pub(super) fn diff(arguments: &DiffArguments) -> Result<Exit> {
    let first = Inspection::new(inspect::read_image(&arguments.first)?);
    let second = Inspection::new(inspect::read_image(&arguments.second)?);
    let differences = compare(&first, &second);
    if differences.is_empty() {
        return Ok(Exit::Success);
    }
    output::print(&(differences.join("\n") + "\n"))?;
    Ok(Exit::Failure)
}
