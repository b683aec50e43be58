//! The table of macros by name, and the tokens of their bodies.

use std::ops::Range;

use cranelift_entity::{PrimaryMap, SecondaryMap, entity_impl};

use crate::names::Name;
use crate::source::Span;

use super::token::Token;

/// A definition; redefining a name creates a new one.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(super) struct MacroId(u32);
entity_impl!(MacroId, "macro");

/// A definition.
#[derive(Debug)]
pub(super) struct Macro {
    /// The name at its definition.
    pub(super) definition: Span,
    /// The parameters of a function-like macro.
    pub(super) parameters: Option<Parameters>,
    /// The body, in [`Macros::body_token`].
    pub(super) body: Range<usize>,
    /// True if the body has no parameters and no `##`, so that it can be read in place.
    pub(super) is_plain: bool,
    /// The computation of the value in place of a body.
    pub(super) builtin: Option<Builtin>,
    /// True while its expansion is being read, so that its name is not expanded.
    pub(super) is_active: bool,
}

/// The parameters of a function-like macro.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub(super) struct Parameters {
    /// The parameter names; the last one of a variadic macro is `__VA_ARGS__` or the user's name for it.
    pub(super) names: Vec<Name>,
    /// The last parameter takes all remaining arguments.
    pub(super) is_variadic: bool,
}

/// Macros without a body.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Builtin {
    /// `__FILE__`
    File,
    /// `__LINE__`
    Line,
    /// `__COUNTER__`
    Counter,
}

/// The meaning of a name.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum MacroState {
    /// Not looked up yet: it may be the name of a predefined macro.
    #[default]
    Unknown,
    /// It is not defined in any text read so far.
    Free,
    /// It was undefined.
    Undefined,
    /// The definition in force.
    Defined(MacroId),
}

/// All definitions.
#[derive(Debug, Default)]
pub(super) struct Macros {
    macros: PrimaryMap<MacroId, Macro>,
    current: SecondaryMap<Name, MacroState>,
    /// The definitions saved by `#pragma push_macro`, the last one at the end.
    saved: Vec<(Name, MacroState)>,
    bodies: Vec<Token>,
}

impl Macros {
    /// The meaning of a name.
    pub(super) fn state(&self, name: Name) -> MacroState {
        self.current.get(name).copied().unwrap_or_default()
    }

    /// The definition in force for a name.
    pub(super) fn definition(&self, name: Name) -> Option<MacroId> {
        if let MacroState::Defined(id) = self.state(name) { Some(id) } else { None }
    }

    /// Notes that no text defines a name.
    pub(super) fn set_free(&mut self, name: Name) {
        *self.slot(name) = MacroState::Free;
    }

    /// Drops the knowledge of undefined names, because there are more texts now.
    pub(super) fn forget_free(&mut self) {
        for standing in self.current.values_mut().filter(|standing| **standing == MacroState::Free) {
            *standing = MacroState::Unknown;
        }
    }

    /// A definition; `None` never happens for an id from [`Self::definition`].
    pub(super) fn get(&self, id: MacroId) -> Option<&Macro> {
        self.macros.get(id)
    }

    /// Marks whether the expansion of a macro is being read.
    pub(super) fn set_active(&mut self, id: MacroId, is_active: bool) {
        if let Some(definition) = self.macros.get_mut(id) {
            definition.is_active = is_active;
        }
    }

    /// Makes the macro of a name compute its value.
    pub(super) fn set_builtin(&mut self, name: Name, builtin: Builtin) {
        if let Some(definition) = self.definition(name).and_then(|id| self.macros.get_mut(id)) {
            definition.builtin = Some(builtin);
        }
    }

    /// Puts a definition in force.
    pub(super) fn define(&mut self, name: Name, definition: Macro) {
        let id = self.macros.push(definition);
        *self.slot(name) = MacroState::Defined(id);
    }

    /// Ends the force of any definition.
    pub(super) fn undefine(&mut self, name: Name) {
        *self.slot(name) = MacroState::Undefined;
    }

    /// Saves the definition of a name, or the fact that there is none.
    pub(super) fn save(&mut self, name: Name) {
        self.saved.push((name, self.state(name)));
    }

    /// Restores the definition that was saved last, if there is one.
    pub(super) fn restore(&mut self, name: Name) {
        if let Some(at) = self.saved.iter().rposition(|(saved, _)| *saved == name) {
            *self.slot(name) = self.saved.remove(at).1;
        }
    }

    /// Adds a body.
    pub(super) fn add_body(&mut self, tokens: &[Token]) -> Range<usize> {
        let start = self.bodies.len();
        self.bodies.extend_from_slice(tokens);
        start..self.bodies.len()
    }

    /// A token of a body.
    pub(super) fn body_token(&self, at: usize) -> Option<Token> {
        self.bodies.get(at).copied()
    }

    /// The tokens of a body.
    pub(super) fn body(&self, range: Range<usize>) -> &[Token] {
        self.bodies.get(range).unwrap_or(&[])
    }

    #[expect(clippy::indexing_slicing, reason = "the map grows to hold every key")]
    fn slot(&mut self, name: Name) -> &mut MacroState {
        &mut self.current[name]
    }
}
