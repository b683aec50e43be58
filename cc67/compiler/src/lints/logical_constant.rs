//! `||` and `&&` with a number: bits are combined with `|`, and a second comparison needs its own left side.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for a constant side of `||` (`is_or`) or `&&`; 0 and 1 are switches that programs write on purpose.
pub(crate) fn finding(is_or: bool, value: i64, span: Span) -> Option<Diagnostic> {
    if matches!(value, 0 | 1) {
        return None;
    }
    let (operator, bits, effect, comparison) =
        if is_or { ("||", "|", "combines", "==") } else { ("&&", "&", "masks", "!=") };
    Some(
        Diagnostic::warning(
            Lint::LogicalConstant,
            span,
            format!("`{operator}` only tests whether {value} is nonzero"),
        )
        .at("always true")
        .help(format!(
            "`a {bits} b` {effect} bits; two comparisons are `x {comparison} a {operator} x {comparison} b`"
        )),
    )
}
