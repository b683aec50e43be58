//! `if (x) ;` on one line: the `;` ends the `if`.
//!
//! `while (x) ;` is how programs for this board wait, and is never mentioned.

use crate::ast::{Expression, Statement, StatementKind};
use crate::diag::{Diagnostic, Lint};
use crate::source::SourceMap;

/// The message for an `if` with this condition and body.
pub(crate) fn finding(
    sources: &SourceMap,
    condition: &Expression,
    then: &Statement,
    otherwise: Option<&Statement>,
) -> Option<Diagnostic> {
    if !matches!(then.kind, StatementKind::Empty) || otherwise.is_some() {
        return None;
    }
    let line = |span| sources.place(span).map(|place| (place.file, place.line));
    (line(condition.span) == line(then.span)).then(|| {
        Diagnostic::warning(Lint::EmptyBody, then.span, "`if` with an empty body")
            .at("this `;` ends the `if`")
            .help("remove the `;`, or write `{}` if nothing should be done")
    })
}
