//! Plots: `cc67 run --plot FILE` for motion, `cc67 plot` for saved data.
//!
//! The suffix of the file determines the format: `.svg`, `.png`, or `.html` for a page with zoom and cursor.

pub(crate) mod chart;
mod csv;
mod draw;
mod letters;
mod page;
mod responses;
pub(crate) mod samples;
mod vcd;

use std::path::Path;

use anyhow::{Result, bail};

use crate::cli::io::output;
use chart::Chart;

/// The chart for saved data: columns of numbers, or a value change dump.
pub(crate) fn chart_of(title: &str, text: &str, is_dump: bool) -> Result<Chart> {
    if is_dump { vcd::chart(title, text) } else { csv::chart(title, text) }
}

/// The format of a picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Form {
    Svg,
    Png,
    Html,
}

impl Form {
    /// The format for a file name.
    pub(crate) fn of(path: &Path) -> Result<Self> {
        let suffix = path.extension().unwrap_or_default().to_string_lossy().to_lowercase();
        Ok(match suffix.as_str() {
            "svg" => Self::Svg,
            "png" => Self::Png,
            "html" | "htm" => Self::Html,
            _ => bail!("{} is not a picture: its name must end in .svg, .png or .html", path.display()),
        })
    }
}

/// Writes a chart as a picture.
///
/// # Errors
/// There is nothing to draw, or the file cannot be written.
pub(crate) fn write(chart: &Chart, form: Form, path: &Path) -> Result<()> {
    if chart.panels.is_empty() && chart.strips.is_empty() {
        bail!(
            "{} would be empty: no axis was enabled, no bit changed, and no value was recorded",
            path.display()
        );
    }
    let bytes = match form {
        Form::Svg => draw::svg(chart)?,
        Form::Png => draw::png(chart)?,
        Form::Html => page::html(chart)?,
    };
    output::write(path, &bytes)
}
