//! `char c = 300;`: a constant that loses its upper bits where it is stored.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for a number stored in `bytes` bytes of a type with this name. Negative numbers in unsigned types and
/// bit patterns in signed types are intentional.
pub(crate) fn finding(
    number: i64,
    to: &str,
    bytes: u32,
    is_unsigned: bool,
    span: Span,
) -> Option<Diagnostic> {
    let bits = bytes.checked_mul(8).filter(|bits| *bits < 32)?;
    let (least, most) = (-(1_i64 << (bits - 1)), (1_i64 << bits) - 1);
    if (least..=most).contains(&number) {
        return None;
    }
    let low = number & most;
    let stored = if !is_unsigned && low > most / 2 { low - most - 1 } else { low };
    Some(
        Diagnostic::warning(
            Lint::ConstantConversion,
            span,
            format!("{number} does not fit in a value of type `{to}`"),
        )
        .at(format!("{stored} is stored")),
    )
}
