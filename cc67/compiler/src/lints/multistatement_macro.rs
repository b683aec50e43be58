//! `#define BOTH() SetBit(40); SetBit(41)` used as `if (on) BOTH();`: the condition only applies to the first
//! statement.

use super::misleading_indentation::unbraced_body;
use crate::ast::{Statement, StatementKind};
use crate::diag::{Diagnostic, Lint};
use crate::source::{ExpansionId, SourceMap, Span};

/// The message if `next` comes from the same macro as the body of the `if`, `for` or `while` before it.
pub(crate) fn finding(sources: &SourceMap, guard: &Statement, next: &Statement) -> Option<Diagnostic> {
    let body = unbraced_body(guard)?;
    if guard.span.expansion != ExpansionId::NONE || matches!(next.kind, StatementKind::Empty) {
        return None;
    }
    let [first, second] = [body.span, next.span].map(|span| outermost(sources, span));
    let (expansion, call) = first.or(second)?;
    let is_inside = |found: Option<(Span, Span)>, span: Span| match found {
        Some((_, other)) => other == call,
        // An argument of the macro, written in its call.
        None => call.lo <= span.lo && span.lo < call.hi,
    };
    (is_inside(first, body.span) && is_inside(second, next.span)).then(|| {
        let name = String::from_utf8_lossy(sources.text(expansion)).into_owned();
        let message = format!("only the first statement of the macro `{name}` depends on the condition");
        Diagnostic::warning(Lint::MultistatementMacro, call, message)
            .at("the others are always executed")
            .label(expansion, "several statements")
            .help(format!(
                "write `{{ {name}… }}` here, or `do {{ … }} while (0)` around the body of the macro"
            ))
    })
}

/// The name of the macro from which a token comes, at its definition, and the call in the source.
fn outermost(sources: &SourceMap, span: Span) -> Option<(Span, Span)> {
    let mut expansion = sources.expansion(span.expansion)?;
    while let Some(outer) = sources.expansion(expansion.call.expansion) {
        expansion = outer;
    }
    Some((expansion.definition, expansion.call))
}
