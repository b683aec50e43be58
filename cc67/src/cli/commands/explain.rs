//! `--explain NAME`: the page of a warning, of a remark of the board or of a language of its own; `warnings` and
//! `remarks` list them.

use std::fmt::Write as _;

use anyhow::Result;

use super::limits;
use crate::cli::io::exit::Exit;
use crate::cli::io::output;
use compiler::diag::{Lint, Preset};
use runtime::{REMARKS, RemarkRow};

/// What lists all warnings; no lint has this name.
const LIST: &str = "warnings";

/// What lists all limits.
const LIMITS: &str = "limits";

/// What lists all remarks of the board.
const REMARK_LIST: &str = "remarks";

/// Pages about other things than warnings.
const PAGES: &[(&str, &str)] =
    &[("stimulus", include_str!("pages/stimulus.md")), ("machine", include_str!("pages/machine.md"))];

/// Prints the page of the warning that a message, a switch or the user's memory names.
pub(super) fn explain(name: &str) -> Result<Exit> {
    if name == LIST {
        output::print(&list())?;
    } else if name == LIMITS {
        output::print(&limits::page())?;
    } else if name == REMARK_LIST {
        output::print(&remarks())?;
    } else if let Some(row) = REMARKS.iter().find(|row| row.code == name) {
        let RemarkRow { code, about, text, .. } = row;
        let off = format!(
            "`-R no-{code}` switches it off; so does `{code} = false` in `[remarks]` of the machine file."
        );
        output::print(&format!("# {code}\n\n{}\n\n    {text}\n\n{off}\n", about.trim()))?;
    } else if let Some((_, page)) = PAGES.iter().find(|(known, _)| *known == name) {
        output::print(page)?;
    } else {
        let lint = Lint::named(name)?;
        output::print(&format!("{}\n{}", lint.page(), lint.switches()))?;
    }
    Ok(Exit::Success)
}

/// Every remark of the board with what it is about.
fn remarks() -> String {
    REMARKS.iter().fold(String::new(), |mut rows, row| {
        let _ = writeln!(rows, "  {:<24}{}", row.code, row.about.trim());
        rows
    })
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

#[cfg(test)]
mod tests {
    use super::PAGES;

    #[test]
    fn every_action_of_a_stimulus_is_explained() {
        let (_, page) = PAGES.iter().find(|(name, _)| *name == "stimulus").expect("there is the page");
        for usage in runtime::stimulus::usages() {
            let words: Vec<_> =
                usage.split(' ').take_while(|word| word.chars().all(char::is_lowercase)).collect();
            assert!(page.contains(&format!("`{}", words.join(" "))), "{usage}");
        }
    }
}
