//! `--explain NAME`: the page of a warning or of a language of its own; `--explain warnings` lists the warnings.

use std::fmt::Write as _;

use anyhow::Result;

use super::{Exit, output};
use crate::limits;
use compiler::diag::{Lint, Preset};

/// What lists all warnings; no lint has this name.
const LIST: &str = "warnings";

/// What lists all limits.
const LIMITS: &str = "limits";

/// Pages about other things than warnings.
const PAGES: &[(&str, &str)] =
    &[("stimulus", include_str!("pages/stimulus.md")), ("machine", include_str!("pages/machine.md"))];

/// Prints the page of the warning that a message, a switch or the user's memory names.
pub(super) fn explain(name: &str) -> Result<Exit> {
    if name == LIST {
        output::print(&list())?;
    } else if name == LIMITS {
        output::print(&limits::page())?;
    } else if let Some((_, page)) = PAGES.iter().find(|(known, _)| *known == name) {
        output::print(page)?;
    } else {
        let lint = Lint::named(name)?;
        output::print(&format!("{}\n{}", lint.page(), lint.switches()))?;
    }
    Ok(Exit::Success)
}

/// Every warning with what it reports.
fn list() -> String {
    let mut text = String::new();
    for (preset, title) in [
        (Preset::On, "On by default, also named by -Wall:"),
        (Preset::All, "Switched on by -Wall:"),
        (Preset::Extra, "Switched on by -Wextra:"),
    ] {
        let lints = Lint::ALL.iter().filter(|lint| lint.preset() == preset);
        let rows = lints.fold(String::new(), |mut rows, lint| {
            let _ = writeln!(rows, "  {:<24}{}", lint.name(), lint.summary());
            rows
        });
        let separator = if text.is_empty() { "" } else { "\n" };
        let _ = write!(text, "{separator}{title}\n{rows}");
    }
    text
}
