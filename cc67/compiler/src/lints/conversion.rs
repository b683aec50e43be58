//! Conversions that C makes by itself and that may lose something.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;
use crate::ty::{TypeId, Types};

/// What is lost of a number of one type that is stored in another.
pub(crate) fn loss(types: &Types, from: TypeId, to: TypeId) -> Option<&'static str> {
    let is_narrower = || types.size_of(to) < types.size_of(from);
    match (from.is_floating(), to.is_floating()) {
        _ if to == Types::BOOL => None,
        (true, false) => Some("the fraction is cut off"),
        (true, true) if is_narrower() => Some("digits beyond the seventh are lost"),
        (false, false) if is_narrower() => Some("the upper bits are lost"),
        _ => None,
    }
}

/// What is said of such a conversion between types of these names.
pub(crate) fn finding(from: &str, to: &str, loss: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::Conversion, span, format!("a `{from}` becomes a `{to}`"))
        .at(loss)
        .help(format!("write `({to})` if this is meant"))
}
