//! Elements that `persist.UserData` does not have.

use kmotiondef::structs::Persist;

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

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
