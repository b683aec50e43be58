//! The compiler's messages about a program, on stderr.

use std::io;

use compiler::Compilation;
use compiler::diag::Severity;
use compiler::diag::levels::Levels;
use compiler::render::{self, Format};

use crate::cli::io::terminal;

/// Prints the diagnostics of several units; returns whether one of them has errors.
pub(crate) fn report_all(units: &[Compilation], levels: &Levels, format: Format) -> bool {
    units.iter().filter(|unit| report(unit, levels, format)).count() > 0
}

/// Returns the number of a unit's warnings that are not suppressed.
pub(crate) fn warnings(unit: &Compilation, levels: &Levels) -> usize {
    let shown = unit.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic));
    shown.filter(|diagnostic| diagnostic.severity == Severity::Warning).count()
}

/// Prints the diagnostics of a compilation; returns whether it has errors.
pub(crate) fn report(compilation: &Compilation, levels: &Levels, format: Format) -> bool {
    let shown: Vec<_> =
        compilation.diagnostics().into_iter().filter_map(|diagnostic| levels.apply(diagnostic)).collect();
    let text = render::render(&shown, &compilation.sources, format, terminal::color(&io::stderr()));
    terminal::print_separated(&text);
    shown.iter().any(|diagnostic| diagnostic.severity == Severity::Error)
}
