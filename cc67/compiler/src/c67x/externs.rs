//! Symbols that generated code needs in addition to those of the source, and properties of symbols.

use std::collections::BTreeMap;

use cranelift_entity::{PrimaryMap, SecondaryMap};
use kmotiondef::firmware::{FirmwareFunction, Function as FirmwareCall, Origin, row_named};

use crate::typed::SymbolId;

/// The facts of the unit about a symbol.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SymbolFacts {
    pub(crate) align: u32,
    pub(crate) is_variadic: bool,
    pub(crate) is_external: bool,
    pub(crate) is_defined: bool,
}

/// The function of the board's firmware with this name.
fn in_firmware(name: &str) -> Option<&'static FirmwareFunction> {
    row_named(name).filter(|row| matches!(row.origin, Origin::Header | Origin::Firmware))
}

/// The symbols of a unit, as far as code cares.
#[derive(Debug, Default)]
pub(crate) struct Externs {
    aligns: PrimaryMap<SymbolId, u32>,
    variadic: SecondaryMap<SymbolId, bool>,
    /// Variadic functions of the firmware that take their variable arguments only from the stack.
    stack_alone: SecondaryMap<SymbolId, bool>,
    /// Functions of the firmware whose last result lands in the cycle after their return.
    late: SecondaryMap<SymbolId, bool>,
    /// Functions of the firmware that end the thread whose number is in [`super::abi::THREAD`].
    ends_thread: SecondaryMap<SymbolId, bool>,
    named: BTreeMap<String, SymbolId>,
    /// Names that were requested and are new, in the order of their numbers.
    added: Vec<&'static str>,
}

impl Externs {
    /// Takes a symbol of the unit, in the order of their numbers.
    pub(crate) fn push(&mut self, name: &str, about: SymbolFacts) {
        let SymbolFacts { align, is_variadic, is_external, is_defined } = about;
        let id = self.aligns.push(align);
        self.variadic[id] = is_variadic;
        let firmware = in_firmware(name).filter(|_| is_external && !is_defined);
        self.stack_alone[id] = is_variadic && firmware.is_some();
        self.late[id] = firmware.is_some_and(|row| row.attributes.returns_early);
        self.ends_thread[id] = firmware.is_some_and(|row| row.name == FirmwareCall::ThreadDone.name());
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

    /// Reports whether a symbol is a function with variable arguments.
    pub(super) fn is_variadic(&self, symbol: SymbolId) -> bool {
        self.variadic[symbol]
    }

    /// Reports whether a function does not use the address of its variable arguments.
    pub(super) fn takes_stack_alone(&self, symbol: SymbolId) -> bool {
        self.stack_alone[symbol]
    }

    /// Reports whether a function may still write [`super::abi::LATE`] in the cycle after its return.
    pub(super) fn is_late(&self, symbol: SymbolId) -> bool {
        self.late[symbol]
    }

    /// Reports whether a function ends the thread whose number is in [`super::abi::THREAD`].
    pub(super) fn ends_thread(&self, symbol: SymbolId) -> bool {
        self.ends_thread[symbol]
    }

    /// The names that the unit did not have.
    pub(crate) fn into_added(self) -> Vec<&'static str> {
        self.added
    }
}
