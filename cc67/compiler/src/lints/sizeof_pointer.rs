//! `sizeof(text)` where `text` is a pointer: the size of an address, not of the text.

use crate::diag::{Diagnostic, Lint};
use crate::source::Span;

/// The message for `sizeof` of a variable of pointer type.
pub(crate) fn finding(name: &str, ty: &str, span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::SizeofPointer, span, format!("`sizeof({name})` is the size of a pointer"))
        .at(format!("`{name}` is `{ty}`, so this is 4"))
        .help("pass the number of elements beside the pointer, or apply `sizeof` to the array itself")
}
