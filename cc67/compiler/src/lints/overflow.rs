//! `50000 * 50000`: a computation with `int` constants that leaves the range of `int`.

use crate::diag::{Diagnostic, Lint};
use crate::operators::BinaryOp;
use crate::source::Span;

/// The message for a computation of two signed constants of 32 bits.
pub(crate) fn finding(op: BinaryOp, a: i64, b: i64, span: Span) -> Option<Diagnostic> {
    let exact = op.exactly(a, b)?;
    let stored = exact as i32;
    (i64::from(stored) != exact).then(|| {
        Diagnostic::warning(Lint::Overflow, span, format!("{exact} does not fit in an `int`"))
            .at(format!("the result is {stored}"))
            .help("write one of the numbers with a decimal point, as in `50000.0`, and store the result in a `double`")
    })
}
