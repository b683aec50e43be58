//! Elements that `persist.UserData` does not have.

use std::ops::RangeInclusive;

use kmotiondef::limits::{N_PC_COMM_PERSIST, PC_COMM_PERSIST};
use kmotiondef::structs::Persist;

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The elements of requests to the PC: the code, its parameters and answers.
pub(crate) const MAILBOX: RangeInclusive<i32> =
    PC_COMM_PERSIST as i32..=(PC_COMM_PERSIST + N_PC_COMM_PERSIST) as i32 - 1;

/// The elements in which the PC stores a `float`: offset, factor, speed and limit of constant surface speed.
pub(crate) const PC_FLOATS: RangeInclusive<i32> = 111..=114;

/// Returns whether the PC uses an element: of the mailbox, or of constant surface speed, whose settings follow it.
pub(crate) fn is_of_the_pc(element: i32) -> bool {
    (*MAILBOX.start()..=*PC_FLOATS.end()).contains(&element)
}

/// The range of `UserData` in `persist`: the offset of its first byte and that after its last.
pub(crate) fn range() -> (i32, i32) {
    let field = Persist::STRUCTURE.fields.iter().find(|field| field.name == "UserData");
    field.map_or((0, 0), |field| (field.offset.cast_signed(), (field.offset + field.size).cast_signed()))
}

/// The message for an object of `size` bytes, reached from an address in `UserData` at byte `from` of `persist` and
/// lying at byte `to`.
pub(crate) fn finding(from: i32, to: i32, size: u32, span: Span) -> Option<Diagnostic> {
    const ELEMENT: i32 = 4;
    let (first, end) = range();
    let is_inside = |at: i32| (first..end).contains(&at);
    let last = to.saturating_add(i32::try_from(size.max(1)).ok()? - 1);
    if !is_inside(from) || (is_inside(to) && is_inside(last)) {
        return None;
    }
    let wrong = if is_inside(to) { last } else { to };
    let index = (wrong - first).div_euclid(ELEMENT);
    let at = format!("it has 0 to {}", (end - first) / ELEMENT - 1);
    let message = format!("`persist.UserData` has no element {index}");
    Some(Diagnostic::warning(Lint::UserDataIndex, span, message).at(at))
}
