//! Writing to the person in front of the terminal.

use std::io::{self, IsTerminal, Write};

use compiler::Compilation;
use compiler::diag::Severity;
use compiler::diag::levels::Levels;
use compiler::render::human::Color;
use compiler::render::{self, Format};

/// Prints a message about the request or its inputs as one line.
pub(super) fn error(error: &anyhow::Error) {
    note(&format!("{error:#}"));
}

/// Prints a line of our own to stderr.
pub(super) fn note(message: &str) {
    // Nobody is left to be told when stderr is gone.
    let _ = writeln!(io::stderr(), "cc67: {message}");
}

/// Prints a text of our own to stderr, apart from the console.
pub(super) fn aside(text: &str) {
    // Nobody is left to be told when stderr is gone.
    let _ = io::stderr().write_all(text.as_bytes());
}

/// Whether a stream shows colours.
pub(super) fn color(stream: &impl IsTerminal) -> Color {
    let shown = stream.is_terminal() && std::env::var_os("NO_COLOR").is_none();
    if shown { Color::Always } else { Color::Never }
}

/// Prints the diagnostics of several units; returns whether one of them has errors.
pub(super) fn report_all(units: &[Compilation], levels: &Levels, format: Format) -> bool {
    units.iter().filter(|unit| report(unit, levels, format)).count() > 0
}

/// How many warnings of a unit are shown.
pub(super) fn warnings(unit: &Compilation, levels: &Levels) -> usize {
    let shown = unit.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic));
    shown.filter(|diagnostic| diagnostic.severity == Severity::Warning).count()
}

/// Prints the diagnostics of a compilation; returns whether it has errors.
pub(super) fn report(compilation: &Compilation, levels: &Levels, format: Format) -> bool {
    let shown: Vec<_> =
        compilation.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic)).collect();
    let text = render::render(&shown, &compilation.sources, format, color(&io::stderr()));
    // Nobody is left to be told when stderr is gone.
    let _ = io::stderr().write_all(text.as_bytes());
    shown.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
}
