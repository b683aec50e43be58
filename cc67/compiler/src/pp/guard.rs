//! Include guards: files of which a second inclusion would give nothing.

use crate::names::Name;

/// The state of a file's include guard while it is read.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Guard {
    /// Nothing but comments so far.
    #[default]
    Unseen,
    /// The file begins with the `#ifndef` of this name, which is open.
    Open(Name),
    /// The matching `#endif` was met, and nothing behind it so far.
    Closed(Name),
    /// The file has no guard.
    Absent,
}

impl Guard {
    /// Text, or a directive outside all `#if`s, is met.
    pub(super) fn meet_text(&mut self) {
        if matches!(self, Self::Unseen | Self::Closed(_)) {
            *self = Self::Absent;
        }
    }

    /// An `#ifndef` outside all `#if`s is met.
    pub(super) fn meet_ifndef(&mut self, name: Name) {
        *self = if matches!(self, Self::Unseen) { Self::Open(name) } else { Self::Absent };
    }

    /// An `#else` or `#elif` of the outermost `#if` is met.
    pub(super) fn meet_alternative(&mut self) {
        *self = Self::Absent;
    }

    /// The `#endif` of the outermost `#if` is met.
    pub(super) fn meet_endif(&mut self) {
        *self = if let Self::Open(name) = *self { Self::Closed(name) } else { Self::Absent };
    }

    /// At the end of the file: the macro that guards it.
    pub(super) fn finish(self) -> Option<Name> {
        if let Self::Closed(name) = self { Some(name) } else { None }
    }
}
