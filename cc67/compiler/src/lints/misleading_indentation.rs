//! Indentation that contradicts the grammar.

use crate::ast::{Statement, StatementKind};
use crate::diag::{Diagnostic, Lint};
use crate::source::{ExpansionId, SourceMap};

/// The message if `next` is indented like the body of the `if`, `for` or `while` before it.
pub(crate) fn finding(sources: &SourceMap, guard: &Statement, next: &Statement) -> Option<Diagnostic> {
    let body = unbraced_body(guard)?;
    let spans = [guard.span, body.span, next.span];
    if matches!(next.kind, StatementKind::Empty)
        || spans.iter().any(|span| span.expansion != ExpansionId::NONE)
    {
        return None;
    }
    let [Some((guard_line, outer)), Some((body_line, inner)), Some((next_line, following))] =
        spans.map(|span| sources.indentation(span))
    else {
        return None;
    };
    let is_below = guard_line < body_line && body_line < next_line;
    let misleads = is_below && inner == following && outer != inner && inner.starts_with(outer);
    misleads.then(|| {
        Diagnostic::warning(Lint::MisleadingIndentation, next.span, "this statement is always executed")
            .at("indented as if it depended on the condition above")
            .label(body.span, "only this one does")
            .help("put both in braces, or move this one to the left")
    })
}

/// The last body without braces of a statement with a condition.
pub(super) fn unbraced_body(statement: &Statement) -> Option<&Statement> {
    let body = match &statement.kind {
        StatementKind::If { otherwise: Some(otherwise), .. } => otherwise,
        StatementKind::If { then: body, .. }
        | StatementKind::While { body, .. }
        | StatementKind::For { body, .. } => body,
        _ => return None,
    };
    match body.kind {
        StatementKind::Block(_) | StatementKind::Empty => None,
        StatementKind::If { .. } | StatementKind::While { .. } | StatementKind::For { .. } => {
            unbraced_body(body)
        }
        _ => Some(body),
    }
}
