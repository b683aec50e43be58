//! Writing to the person in front of the terminal.

use std::io::{self, IsTerminal, Write};

use crate::Compilation;
use crate::diag::Severity;
use crate::lints::levels::Levels;
use crate::render::{Color, Renderer};

/// Prints a message about the request or its inputs as one line.
pub(super) fn error(error: &anyhow::Error) {
    note(&format!("{error:#}"));
}

/// Prints a line of our own to stderr.
pub(super) fn note(message: &str) {
    // Nobody is left to be told when stderr is gone.
    let _ = writeln!(io::stderr(), "cc67: {message}");
}

/// Whether stderr shows colours.
fn color() -> Color {
    let shown = io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none();
    if shown { Color::Always } else { Color::Never }
}

/// Prints the diagnostics of a compilation; returns whether it has errors.
pub(super) fn report(compilation: &Compilation, levels: &Levels) -> bool {
    let mut has_errors = false;
    let mut renderer = Renderer::new(&compilation.sources, color());
    for diagnostic in compilation.diagnostics() {
        let Some(diagnostic) = levels.apply(diagnostic) else { continue };
        has_errors |= diagnostic.severity == Severity::Error;
        let _ = io::stderr().write_all(renderer.render(&diagnostic).as_bytes());
    }
    has_errors
}
