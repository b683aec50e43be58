//! A signed and an unsigned value compared: a negative value becomes a very large one.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for such a comparison.
pub(crate) fn finding(span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::SignCompare, span, "a signed and an unsigned value are compared")
        .at("as unsigned: a negative value counts as a very large one")
        .note("the vendor's compiler compares them as signed")
        .help("cast one of them")
}
