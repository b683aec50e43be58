//! A `double` at an odd index of `persist.UserData`: the board loads it without the low
//! address bits (`dialect.md` 1.5).

use super::Lint;
use crate::diag::Diagnostic;
use crate::source::Span;

/// Where `UserData` begins in `persist`; at a multiple of 8, as `persist` does.
const USER_DATA_OFFSET: i32 = 32;

/// What is said of a `double` at a byte offset of `persist`.
pub(crate) fn finding(offset: i32, span: Span) -> Option<Diagnostic> {
    (offset % 8 != 0).then(|| {
        let message = "a `double` at an odd index of `persist.UserData` is not aligned";
        let index = (offset - USER_DATA_OFFSET) / 4;
        Diagnostic::warning(Lint::UserDataAlignment, span, message)
            .at(format!("index {index}: the board would load a wrong value"))
            .help(format!("use index {} or {}", index - 1, index + 1))
    })
}
