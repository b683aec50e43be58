//! Plots: `cc67 run --plot FILE` of what moved, `cc67 plot` of saved data.
//!
//! The suffix of the picture decides: `.svg`, `.png`, or `.html` for a page with zoom and cursor.

pub(super) mod chart;
mod csv;
mod draw;
mod page;
pub(super) mod samples;
mod vcd;

use std::path::{Path, PathBuf};

use anyhow::{Context, Result, bail};
use clap::Args;

use super::run::cannot_read;
use super::{Exit, output};
use chart::Chart;
use compiler::files;

/// Arguments of `cc67 plot`.
#[derive(Debug, Args)]
pub(super) struct Arguments {
    /// Numbers in columns: a trace, or what a program has gathered and printed; or a value change dump (.vcd)
    #[arg(required_unless_present = "explain", value_name = "FILE")]
    data: Option<PathBuf>,
    /// The picture: .svg, .png, or .html for a page with zoom and cursor; else FILE.svg
    #[arg(short, long, value_name = "PICTURE")]
    output: Option<PathBuf>,
}

/// Draws saved data.
pub(super) fn plot(arguments: &Arguments) -> Result<Exit> {
    let Some(path) = &arguments.data else { return Ok(Exit::WrongInput) };
    let picture = arguments.output.clone().unwrap_or_else(|| path.with_extension("svg"));
    let form = Form::of(&picture)?;
    let bytes = files::read_up_to(path, files::DATA_BYTES).map_err(|error| cannot_read(path, &error))?;
    let text = String::from_utf8_lossy(&bytes).into_owned();
    let title = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let is_dump = path.extension().is_some_and(|suffix| suffix.eq_ignore_ascii_case("vcd"));
    let chart = if is_dump { vcd::chart(&title, &text) } else { csv::chart(&title, &text) };
    let chart = chart.with_context(|| path.display().to_string())?;
    write(&chart, form, &picture)?;
    Ok(Exit::Success)
}

/// Forms of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Form {
    Svg,
    Png,
    Html,
}

impl Form {
    /// The form that a file name asks for.
    pub(super) fn of(path: &Path) -> Result<Self> {
        let suffix = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        Ok(match suffix.as_str() {
            "svg" => Self::Svg,
            "png" => Self::Png,
            "html" | "htm" => Self::Html,
            _ => bail!("{} is no picture: its name must end in .svg, .png or .html", path.display()),
        })
    }
}

/// Writes the picture of a chart.
pub(super) fn write(chart: &Chart, form: Form, path: &Path) -> Result<()> {
    let bytes = match form {
        Form::Svg => draw::svg(chart)?,
        Form::Png => draw::png(chart)?,
        Form::Html => page::html(chart)?,
    };
    output::write(path, &bytes)
}
