//! Elements that `persist.UserData` does not have.

use super::Lint;
use crate::diag::Diagnostic;
use crate::source::Span;

/// What is said of a constant index into `length` elements.
pub(crate) fn finding(length: u32, index: i64, span: Span) -> Option<Diagnostic> {
    (!(0..i64::from(length)).contains(&index)).then(|| {
        Diagnostic::warning(Lint::UserDataIndex, span, format!("`persist.UserData` has no element {index}"))
            .at(format!("it has 0 to {}", length.saturating_sub(1)))
    })
}
