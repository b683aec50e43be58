//! A `double` at an odd index of `persist.UserData`: the board loads it without the low
//! address bits (`dialect.md` 1.5).

use super::user_data_index;
use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The last index with room for a `double`.
const LAST: i32 = 198;

/// The message for a `double` at a byte offset of `persist`.
pub(crate) fn finding(offset: i32, span: Span) -> Option<Diagnostic> {
    // `persist` and `UserData` begin at multiples of 8.
    (offset % 8 != 0).then(|| {
        let message = "a `double` at an odd index of `persist.UserData` is not aligned";
        let index = (offset - user_data_index::range().0) / 4;
        Diagnostic::warning(Lint::UserDataAlignment, span, message)
            .at(format!("index {index}: the board would load a wrong value"))
            .help(neighbours(index))
    })
}

/// The indexes next to this one that hold a `double`.
fn neighbours(index: i32) -> String {
    match [index - 1, index + 1].map(|index| Some(index).filter(|index| (0..=LAST).contains(index))) {
        [Some(below), Some(above)] => format!("use index {below} or {above}"),
        [Some(index), None] | [None, Some(index)] => format!("use index {index}"),
        [None, None] => format!("use an even index from 0 to {LAST}"),
    }
}
