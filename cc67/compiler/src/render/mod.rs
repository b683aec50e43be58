//! Diagnostics as text, with one file for each reader.
//!
//! | format | reader | file |
//! |---|---|---|
//! | `human` | a person at a terminal: source lines, ranges, suggestions | [`human`] |
//! | `short` | an editor: `file:line:column: error: message [code]`, one line each | [`short`] |
//! | `json` | a program: one JSON object a line | [`json`] |
//! | `vendor` | the controller's own PC software: `file:line: message`, little of it | [`vendor`] |
//!
//! All say the same, in the order of the program; only the vendor's format puts errors before warnings.

mod colors;
pub mod human;
pub mod json;
mod marks;
pub mod short;
pub mod vendor;

use crate::diag::{Diagnostic, Severity};
use crate::source::SourceMap;
use human::Color;

/// The format of diagnostics, by their reader.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Format {
    /// A person.
    #[default]
    Human,
    /// An editor.
    Short,
    /// A program.
    Json,
    /// The vendor's PC software.
    Vendor,
}

/// Renders the diagnostics of one compilation, which are in the order of the program.
#[must_use]
pub fn render(diagnostics: &[Diagnostic], sources: &SourceMap, format: Format, color: Color) -> String {
    match format {
        Format::Human => {
            let mut renderer = human::Renderer::new(sources, color);
            diagnostics.iter().map(|diagnostic| renderer.render(diagnostic)).collect()
        }
        Format::Short => {
            diagnostics.iter().map(|diagnostic| short::render(diagnostic, sources) + "\n").collect()
        }
        Format::Json => {
            let mut renderer = json::Renderer::new(sources);
            diagnostics.iter().map(|diagnostic| renderer.render(diagnostic) + "\n").collect()
        }
        Format::Vendor => vendor::render(diagnostics, sources),
    }
}

/// A severity as messages spell it.
const fn severity_name(severity: Severity) -> &'static str {
    match severity {
        Severity::Error => "error",
        Severity::Warning => "warning",
        Severity::Note => "note",
    }
}
