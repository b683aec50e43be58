//! A variable where its address is needed: the `&` is missing.

use crate::diag::{Diagnostic, Lint};
use crate::source::{SourceMap, Span};

/// The message for an argument that is a variable of the parameter's pointee type.
pub(crate) fn finding(sources: &SourceMap, subject: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::MissingAddress, span, format!("{subject} must be the address of a variable"))
        .at("its value is passed, and used as an address")
        .help(help(sources, span))
}

/// The advice for the variable at `span`.
pub(crate) fn help(sources: &SourceMap, span: Span) -> String {
    format!("write `&{}`", String::from_utf8_lossy(sources.text(span)))
}
