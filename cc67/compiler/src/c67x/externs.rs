//! Symbols that generated code needs besides those of the source, and what is known about symbols.

use std::collections::BTreeMap;

use cranelift_entity::{PrimaryMap, SecondaryMap};

use crate::typed::SymbolId;

/// The symbols of a unit, as far as code cares.
#[derive(Debug, Default)]
pub(crate) struct Externs {
    aligns: PrimaryMap<SymbolId, u32>,
    variadic: SecondaryMap<SymbolId, bool>,
    named: BTreeMap<String, SymbolId>,
    /// Names that were asked for and are new, in the order of their numbers.
    added: Vec<&'static str>,
}

impl Externs {
    /// Takes a symbol of the unit, in the order of their numbers.
    pub(crate) fn push(&mut self, name: &str, align: u32, is_variadic: bool, is_external: bool) {
        let id = self.aligns.push(align);
        self.variadic[id] = is_variadic;
        if is_external {
            self.named.insert(name.to_owned(), id);
        }
    }

    /// The symbol with a name, new if the unit does not have it.
    pub(super) fn symbol(&mut self, name: &'static str) -> SymbolId {
        if let Some(id) = self.named.get(name) {
            return *id;
        }
        let id = self.aligns.push(1);
        self.named.insert(name.to_owned(), id);
        self.added.push(name);
        id
    }

    /// The alignment of an object.
    pub(super) fn align(&self, symbol: SymbolId) -> u32 {
        self.aligns.get(symbol).copied().unwrap_or(1)
    }

    /// Whether a symbol is a function with variable arguments.
    pub(super) fn is_variadic(&self, symbol: SymbolId) -> bool {
        self.variadic[symbol]
    }

    /// The names that the unit did not have.
    pub(crate) fn into_added(self) -> Vec<&'static str> {
        self.added
    }
}
