//! The symbols of a unit and what sema knows about them beyond the typed tree.

use cranelift_entity::packed_option::PackedOption;
use cranelift_entity::{PrimaryMap, SecondaryMap};

use crate::names::Name;
use crate::source::Span;
use crate::ty::{FunctionType, TypeId};
use crate::typed::{Definition, Linkage, StaticData, Symbol, SymbolId};

/// The calling convention of a function that this unit defines.
#[derive(Clone, Debug)]
pub(super) struct CallingConvention {
    /// The type to which every call is converted; its parameters are always a prototype.
    pub(super) call: FunctionType,
    /// The type as declared, for comparison with other declarations.
    pub(super) declared: TypeId,
    /// The name in the definition.
    pub(super) span: Span,
    /// True if it is declared `void` but returns a value.
    pub(super) is_void_with_value: bool,
}

/// Facts about a symbol other than its typed form.
#[derive(Clone, Debug, Default)]
pub(super) struct SymbolFacts {
    /// For a function that this unit defines.
    pub(super) convention: Option<CallingConvention>,
    /// The undeclared use was reported.
    pub(super) is_reported: bool,
}

/// All symbols, by number and by name.
#[derive(Debug, Default)]
pub(super) struct Symbols {
    table: PrimaryMap<SymbolId, Symbol>,
    facts: SecondaryMap<SymbolId, SymbolFacts>,
    /// The symbol of a name with linkage.
    linked: SecondaryMap<Name, PackedOption<SymbolId>>,
    /// Number of the next symbol that no program can name.
    next: u32,
}

impl Symbols {
    /// The symbol of a name with linkage.
    pub(super) fn linked_symbol(&self, name: Name) -> Option<SymbolId> {
        self.linked[name].expand()
    }

    /// Adds a symbol that is only declared.
    pub(super) fn declare(
        &mut self,
        name: Name,
        spelling: &str,
        linkage: Linkage,
        ty: TypeId,
        span: Span,
    ) -> SymbolId {
        let symbol = self.push(spelling.to_owned(), linkage, ty, Definition::None, span);
        self.linked[name] = symbol.into();
        symbol
    }

    /// Adds a static object of a function, `name.3`, or an anonymous one, `L.3`.
    pub(super) fn internal(&mut self, name: &str, ty: TypeId, span: Span) -> SymbolId {
        let spelling = format!("{name}.{}", self.next);
        self.next += 1;
        self.push(spelling, Linkage::Internal, ty, Definition::Tentative, span)
    }

    /// Adds an anonymous object with a value.
    pub(super) fn anonymous(&mut self, ty: TypeId, data: StaticData, span: Span) -> SymbolId {
        let symbol = self.internal("L", ty, span);
        self.table[symbol].definition = Definition::Data(data);
        symbol
    }

    fn push(
        &mut self,
        name: String,
        linkage: Linkage,
        ty: TypeId,
        definition: Definition,
        span: Span,
    ) -> SymbolId {
        self.table.push(Symbol { name, linkage, ty, align: 1, definition, span, used_at: None })
    }

    /// A symbol.
    pub(super) fn get(&self, symbol: SymbolId) -> &Symbol {
        &self.table[symbol]
    }

    /// A symbol, to change it.
    pub(super) fn get_mut(&mut self, symbol: SymbolId) -> &mut Symbol {
        &mut self.table[symbol]
    }

    /// The further facts about a symbol.
    pub(super) fn facts(&self, symbol: SymbolId) -> &SymbolFacts {
        &self.facts[symbol]
    }

    /// The further facts about a symbol, mutable.
    pub(super) fn facts_mut(&mut self, symbol: SymbolId) -> &mut SymbolFacts {
        &mut self.facts[symbol]
    }

    /// Notes that code or data needs the address of a symbol.
    pub(super) fn mark_used(&mut self, symbol: SymbolId, span: Span) {
        self.table[symbol].used_at.get_or_insert(span);
    }

    /// Every symbol in the order of creation.
    pub(super) fn iter(&self) -> impl Iterator<Item = (SymbolId, &Symbol)> {
        self.table.iter()
    }

    /// The finished table.
    pub(super) fn finish(self) -> PrimaryMap<SymbolId, Symbol> {
        self.table
    }
}
