//! `cc67 plot`: pictures of saved data.

use std::path::PathBuf;

use anyhow::{Context, Result};
use clap::Args;

use compiler::files;

use crate::cli::io::exit::Exit;
use crate::cli::io::input::cannot_read;
use crate::cli::report::plot;

/// Arguments of `cc67 plot`.
#[derive(Debug, Args)]
pub(crate) struct PlotArguments {
    /// Columns of numbers, such as a trace or a program's output, or a value change dump (.vcd)
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    data: Option<PathBuf>,
    /// Picture to write: .svg, .png, or .html for a page with zoom and cursor [default: FILE.svg]
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
}

/// Draws saved data.
pub(crate) fn plot(arguments: &PlotArguments) -> Result<Exit> {
    let Some(path) = &arguments.data else { return Ok(Exit::WrongInput) };
    let picture = arguments.output.clone().unwrap_or_else(|| path.with_extension("svg"));
    let form = plot::Form::of(&picture)?;
    let bytes = files::read_up_to(path, files::DATA_BYTES).map_err(|error| cannot_read(path, &error))?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let title = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let is_dump = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("vcd"));
    let chart = plot::chart_of(&title, &text, is_dump).with_context(|| path.display().to_string())?;
    plot::write(&chart, form, &picture)?;
    Ok(Exit::Success)
}
