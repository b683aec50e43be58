//! `defualt:` in a `switch` is a label.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for a label that no `goto` names.
pub(crate) fn finding(name: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::UnusedLabel, span, format!("no `goto` names the label `{name}`"))
        .at("so it has no effect")
        .help("a `switch` goes to `case VALUE:` and to `default:`")
}
