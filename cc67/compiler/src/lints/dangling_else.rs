//! An `else` that is indented like an outer `if`, but belongs to the inner one.

use crate::ast::{Statement, StatementKind};
use crate::diag::{Diagnostic, Lint};
use crate::source::{ExpansionId, SourceMap, Span};

/// The word.
const ELSE: &[u8] = b"else";

/// The message for an `if` statement without `else` whose body is an `if` with an `else`. An `else` indented like the
/// inner `if`, further right than the outer one, is correct.
pub(crate) fn finding(sources: &SourceMap, outer: Span, then: &Statement) -> Option<Diagnostic> {
    let StatementKind::If { then: body, otherwise: Some(otherwise), .. } = &then.kind else { return None };
    let spans = [outer, then.span, body.span, otherwise.span];
    if spans.iter().any(|span| span.expansion != ExpansionId::NONE) {
        return None;
    }
    let between = Span { lo: body.span.hi, hi: otherwise.span.lo, ..outer };
    let at = sources.text(between).windows(ELSE.len()).position(|word| word == ELSE)?;
    let lo = body.span.hi + u32::try_from(at).ok()?;
    let word = Span { lo, hi: lo + ELSE.len() as u32, ..outer };
    let column = |span| sources.indentation(span).map(|(_, before)| before);
    let is_inner = column(then.span).is_some() && column(then.span) == column(word);
    (!is_inner).then(|| {
        Diagnostic::warning(Lint::DanglingElse, word, "this `else` belongs to the second `if`")
            .label(then.span.to(body.span), "to this one")
            .help("put the body of the first `if` in braces")
    })
}
