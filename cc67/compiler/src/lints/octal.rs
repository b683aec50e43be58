//! `SetBit(045)`: a number that begins with 0 is octal.

use crate::ast::IntegerLiteral;
use crate::diag::{Diagnostic, Lint};
use crate::source::{SourceMap, Span};

/// The message for an integer constant that would be another number without its zeros.
pub(crate) fn finding(sources: &SourceMap, literal: IntegerLiteral, span: Span) -> Option<Diagnostic> {
    /// Below this, both are the same.
    const BASE: u64 = 8;
    if literal.is_decimal || literal.value < BASE {
        return None;
    }
    let text = String::from_utf8_lossy(sources.text(span)).into_owned();
    let digits = text.strip_prefix('0').filter(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))?;
    let decimal = digits.trim_start_matches('0');
    Some(
        Diagnostic::warning(Lint::Octal, span, format!("`{text}` is octal and means {}", literal.value))
            .at("a number that begins with 0 is octal")
            .help(format!("write `{decimal}`")),
    )
}
