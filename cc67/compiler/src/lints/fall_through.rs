//! A `case` that continues into the next one because its `break` is missing.
//!
//! Programs for this board hardly ever do so on purpose; a comment such as `// fall through` silences it.

use super::missing_return::completes;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{Stmt, StmtKind};

/// Reports labels of a `switch` that are reached from the statement before them.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        function.each_stmt(&mut |stmt| {
            if let StmtKind::Switch { body, .. } = &stmt.kind {
                labels(program, body, sink);
            }
        });
    }
}

fn labels(program: &AnalysedProgram<'_>, stmts: &[Stmt], sink: &mut Sink) {
    // Nothing reaches the statements in front of the first label.
    let first = stmts.iter().position(is_label).unwrap_or(stmts.len());
    for [before, label] in stmts[first..].array_windows() {
        if is_label(label) && !is_label(before) && completes(before) && !is_announced(program, before, label)
        {
            sink.report(
                Diagnostic::warning(
                    Lint::FallThrough,
                    label.span,
                    "the `case` before continues into this one",
                )
                .label(before.span, "no `break` after this")
                .help("write `break;` before this `case`, or `// fall through` if this is meant"),
            );
        }
    }
    for stmt in stmts {
        if let StmtKind::Block(inner) = &stmt.kind {
            labels(program, inner, sink);
        }
    }
}

const fn is_label(stmt: &Stmt) -> bool {
    matches!(stmt.kind, StmtKind::Case(_) | StmtKind::DefaultCase)
}

/// Reports whether a comment between two statements announces the fall-through.
fn is_announced(program: &AnalysedProgram<'_>, before: &Stmt, label: &Stmt) -> bool {
    const WORDS: [&str; 5] = ["fall", "no break", "continue", "also", "too"];
    let between = Span { lo: before.span.hi, hi: label.span.lo, ..label.span };
    let text = String::from_utf8_lossy(program.sources.text(between)).to_lowercase();
    WORDS.iter().any(|word| text.contains(word))
}
