//! Implicit conversions that may lose information.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;
use crate::ty::{TypeId, Types};

/// The loss when a number of one type is stored in another.
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

/// The message for such a conversion between types of these names.
pub(crate) fn finding(from: &str, to: &str, loss: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::Conversion, span, format!("a `{from}` becomes a `{to}`"))
        .at(loss)
        .help(format!("write `({to})` if this is meant"))
}

/// The message for a constant with a fraction that is stored in an integer.
pub(crate) fn lost_fraction(number: f64, to: &str, span: Span) -> Diagnostic {
    let whole = number.trunc();
    Diagnostic::warning(Lint::LostFraction, span, format!("the fraction of {number} is lost in a value of type `{to}`"))
        .at(format!("{whole} is stored"))
        .help("store it in a `double` or a `float`; an element of `persist.UserData` holds one as `*(float *)&persist.UserData[…]`")
}

/// The message for an integer quotient that was truncated before its use as a floating-point number.
pub(crate) fn division(dividend: i64, divisor: i64, span: Span) -> Diagnostic {
    let whole = dividend / divisor;
    Diagnostic::warning(
        Lint::IntegerDivision,
        span,
        format!("`{dividend}/{divisor}` is {whole}: integer division drops the fraction"),
    )
    .at("used as a floating-point number")
    .help(format!("write `{dividend}.0/{divisor}`"))
}
