//! `||` and `&&` with a number: bits are joined with `|`, and a second comparison needs its own left side.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for a constant side of `||` (`is_or`) or `&&`; 0 and 1 are switches that programs write on purpose.
pub(crate) fn finding(is_or: bool, value: i64, span: Span) -> Option<Diagnostic> {
    if matches!(value, 0 | 1) {
        return None;
    }
    let (operator, bits, comparison) = if is_or { ("||", "|", "==") } else { ("&&", "&", "!=") };
    Some(
        Diagnostic::warning(
            Lint::LogicalConstant,
            span,
            format!("`{operator}` only asks whether {value} is 0"),
        )
        .at("always true")
        .help(format!(
            "`a {bits} b` joins bits; two comparisons are `x {comparison} a {operator} x {comparison} b`"
        )),
    )
}
