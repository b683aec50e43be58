//! `if (x) ;` on one line: the `;` ends the `if`. The same for a loop, if the following statement looks like its body.
//!
//! A plain `while (x) ;` is the usual way to wait in programs for this board, and is never reported.

use crate::ast::{Expression, ExpressionKind, Statement, StatementKind};
use crate::diag::{Diagnostic, Lint};
use crate::operators::OperatorMeaning;
use crate::source::{ExpansionId, SourceMap};

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

/// The message for a loop that ends in a `;`, if `next` is a block or indented like its body.
pub(crate) fn loop_finding(
    sources: &SourceMap,
    statement: &Statement,
    next: &Statement,
) -> Option<Diagnostic> {
    let (keyword, body) = match &statement.kind {
        StatementKind::While { body, .. } => ("while", body),
        StatementKind::For { body, .. } => ("for", body),
        _ => return None,
    };
    let spans = [statement.span, body.span, next.span];
    if !matches!(body.kind, StatementKind::Empty) || spans.iter().any(|it| it.expansion != ExpansionId::NONE)
    {
        return None;
    }
    if is_for_next(sources, statement, next) {
        return Some(loop_warning(keyword, body, next));
    }
    // A `;` on its own line is intended.
    let [Some((_, outer)), None, Some((next_line, inner))] = spans.map(|span| sources.indentation(span))
    else {
        return None;
    };
    let is_below = sources.place(body.span).is_some_and(|end| end.line + 1 == next_line);
    let looks_like_body = match next.kind {
        StatementKind::Block(_) => inner.starts_with(outer),
        StatementKind::Empty => false,
        _ => inner.starts_with(outer) && inner.len() > outer.len(),
    };
    (is_below && looks_like_body).then(|| loop_warning(keyword, body, next))
}

fn loop_warning(keyword: &str, body: &Statement, next: &Statement) -> Diagnostic {
    Diagnostic::warning(Lint::EmptyBody, body.span, format!("`{keyword}` with an empty body"))
        .at(format!("this `;` ends the `{keyword}`"))
        .label(next.span, "so this is executed once, after it")
        .help("remove the `;`, or move it to a line of its own if the loop is only to wait")
}

/// Reports whether a `for` that only counts is followed, on the same line, by a use of its counter.
fn is_for_next(sources: &SourceMap, statement: &Statement, next: &Statement) -> bool {
    let StatementKind::For { condition: Some(condition), body, .. } = &statement.kind else { return false };
    let ExpressionKind::Binary(operator, left, right) = &condition.kind else { return false };
    let is_plain =
        |side: &Expression| matches!(side.kind, ExpressionKind::Identifier(_) | ExpressionKind::Integer(_));
    if !matches!(operator.meaning(), OperatorMeaning::Compare(_))
        || !matches!(left.kind, ExpressionKind::Identifier(_))
        || !is_plain(right)
        || !matches!(next.kind, StatementKind::Expression(_) | StatementKind::Block(_))
    {
        return false;
    }
    let line = |span| sources.place(span).map(|place| (place.file, place.line));
    let (Some((file, end)), Some((next_file, begin))) = (line(body.span), line(next.span)) else {
        return false;
    };
    let counter = sources.text(left.span);
    let is_word = |byte: &u8| byte.is_ascii_alphanumeric() || *byte == b'_';
    let uses_counter = || sources.text(next.span).split(|byte| !is_word(byte)).any(|word| word == counter);
    file == next_file && begin == end && uses_counter()
}
