//! What the linker asks of the firmware.

use kmotiondef::GuestAddr;
use kmotiondef::ValueClass;
use kmotiondef::firmware::{ABSENT, FIRMWARE_FUNCTIONS, function_named};
use kmotiondef::limits::VERSION_STAMP;
use kmotiondef::variables::variable_named;

use super::{BuiltIn, FirmwareNames};
use crate::ir::function::Signature;
use crate::ir::inst::Class;

/// A symbol of the firmware.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirmwareSymbol {
    /// Where it is.
    pub address: GuestAddr,
    /// What it is.
    pub kind: FirmwareKind,
}

/// What a symbol of the firmware is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum FirmwareKind {
    /// A variable.
    Variable,
    /// A function, with its signature if that is known.
    Function(Option<Signature>),
}

/// The symbols of a firmware.
pub trait FirmwareSymbols {
    /// The symbol of this name.
    fn find(&self, name: &str) -> Option<FirmwareSymbol>;

    /// Every name, for suggestions.
    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_>;

    /// The version of the firmware, as images state it.
    fn version_stamp(&self) -> i16 {
        VERSION_STAMP
    }
}

impl FirmwareSymbols for BuiltIn {
    fn find(&self, name: &str) -> Option<FirmwareSymbol> {
        if ABSENT.contains(&name) {
            return None;
        }
        if let Some(variable) = variable_named(name) {
            return Some(FirmwareSymbol { address: variable.address, kind: FirmwareKind::Variable });
        }
        let function = FIRMWARE_FUNCTIONS.get(function_named(name)?)?;
        // The variable arguments are passed as their address.
        let variable = function.is_variadic.then_some(Class::I32);
        let params = function.param_classes().map(class).chain(variable).collect();
        let signature = Signature { params, result: function.result.class().map(class) };
        Some(FirmwareSymbol { address: function.address, kind: FirmwareKind::Function(Some(signature)) })
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        FirmwareNames::names(self)
    }
}

const fn class(class: ValueClass) -> Class {
    match class {
        ValueClass::I32 => Class::I32,
        ValueClass::I64 => Class::I64,
        ValueClass::F32 => Class::F32,
        ValueClass::F64 => Class::F64,
    }
}
