//! The names that are types in the current scope.
//!
//! C cannot be parsed without them: `a * b;` declares `b` if `a` is a type. A name is looked up for every identifier
//! token, so each name has a single entry with its current meaning, and blocks keep a list of entries to restore at
//! their end.

use cranelift_entity::SecondaryMap;

use crate::names::Name;

/// The meaning of a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum NameMeaning {
    /// Nothing declared it.
    #[default]
    Unknown,
    /// A variable, function or enumerator.
    Ordinary,
    /// A `typedef` name.
    Type,
    /// Used as a type without being one, which was reported.
    MissingType,
}

/// The scopes that are open.
#[derive(Debug, Default)]
pub(super) struct Scopes {
    meanings: SecondaryMap<Name, NameMeaning>,
    /// The meanings of names before the declarations of the open scopes.
    hidden: Vec<(Name, NameMeaning)>,
    /// The start of each open scope in `hidden`.
    starts: Vec<usize>,
}

impl Scopes {
    /// The meaning of a name in the current scope.
    pub(super) fn meaning(&self, name: Name) -> NameMeaning {
        self.meanings.get(name).copied().unwrap_or_default()
    }

    /// Declares a name in the innermost scope.
    pub(super) fn declare(&mut self, name: Name, meaning: NameMeaning) {
        let before = std::mem::replace(self.entry(name), meaning);
        if !self.starts.is_empty() {
            self.hidden.push((name, before));
        }
    }

    /// Makes a name a missing type in all scopes, so that it is reported once.
    pub(super) fn set_missing_type(&mut self, name: Name) {
        *self.entry(name) = NameMeaning::MissingType;
    }

    /// Reports whether only the file scope is open.
    pub(super) fn is_outermost(&self) -> bool {
        self.starts.is_empty()
    }

    /// Opens a scope.
    pub(super) fn enter(&mut self) {
        self.starts.push(self.hidden.len());
    }

    /// Closes the innermost scope.
    pub(super) fn leave(&mut self) {
        let start = self.starts.pop().unwrap_or(0);
        while self.hidden.len() > start {
            if let Some((name, before)) = self.hidden.pop() {
                *self.entry(name) = before;
            }
        }
    }

    #[expect(clippy::indexing_slicing, reason = "the map grows to hold every key")]
    fn entry(&mut self, name: Name) -> &mut NameMeaning {
        &mut self.meanings[name]
    }
}
