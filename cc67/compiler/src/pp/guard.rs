//! Include guards: files whose second inclusion yields nothing.

use crate::names::Name;

/// The state of a file's include guard while it is read.
#[derive(Clone, Copy, Debug, Default)]
pub(super) enum Guard {
    /// Only comments so far.
    #[default]
    Unseen,
    /// The file begins with the `#ifndef` of this name, which is open.
    Open(Name),
    /// The matching `#endif` was read, with nothing after it so far.
    Closed(Name),
    /// The file has no guard.
    Absent,
}

impl Guard {
    /// Handles text, or a directive outside of all `#if`s.
    pub(super) fn meet_text(&mut self) {
        if matches!(self, Self::Unseen | Self::Closed(_)) {
            *self = Self::Absent;
        }
    }

    /// Handles an `#ifndef` outside of all `#if`s.
    pub(super) fn meet_ifndef(&mut self, name: Name) {
        *self = if matches!(self, Self::Unseen) { Self::Open(name) } else { Self::Absent };
    }

    /// Handles an `#else` or `#elif` of the outermost `#if`.
    pub(super) fn meet_alternative(&mut self) {
        *self = Self::Absent;
    }

    /// Handles the `#endif` of the outermost `#if`.
    pub(super) fn meet_endif(&mut self) {
        *self = if let Self::Open(name) = *self { Self::Closed(name) } else { Self::Absent };
    }

    /// At the end of the file: the macro that guards it.
    pub(super) fn finish(self) -> Option<Name> {
        if let Self::Closed(name) = self { Some(name) } else { None }
    }
}
