//! The interface between linker and firmware.

use kmotiondef::boards::TargetBoard;
use kmotiondef::firmware::{ABSENT, row_named};
use kmotiondef::variables::variable_named;
use kmotiondef::{CType, GuestAddr, ValueClass};

use super::{BuiltIn, FirmwareNames};
use crate::ir::function::Signature;
use crate::ir::inst::Class;

/// A symbol of the firmware.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FirmwareSymbol {
    /// Its address.
    pub address: GuestAddr,
    /// Its kind.
    pub kind: FirmwareKind,
}

/// The kind of a symbol of the firmware.
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

    /// The board for which programs are linked; for an unknown firmware, the board whose tables are used instead.
    fn board(&self) -> &'static TargetBoard {
        TargetBoard::default_board()
    }

    /// The version of the firmware, as images state it.
    fn version_stamp(&self) -> i16 {
        self.board().version_stamp()
    }

    /// The time stamp of the firmware file, as recorded in images; 0 if unknown.
    fn time_stamp(&self) -> u32 {
        0
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
        let function = row_named(name)?;
        let signature = signature(function.param_classes(), function.result, function.is_variadic);
        Some(FirmwareSymbol { address: function.address, kind: FirmwareKind::Function(Some(signature)) })
    }

    fn symbol_names(&self) -> Box<dyn Iterator<Item = &str> + '_> {
        FirmwareNames::names(self)
    }
}

/// The signature of a function; variable arguments are passed as their address.
pub(super) fn signature(
    params: impl Iterator<Item = ValueClass>,
    result: CType,
    is_variadic: bool,
) -> Signature {
    let variable = is_variadic.then_some(Class::I32);
    Signature { params: params.map(class).chain(variable).collect(), result: result.class().map(class) }
}

const fn class(class: ValueClass) -> Class {
    match class {
        ValueClass::I32 => Class::I32,
        ValueClass::I64 => Class::I64,
        ValueClass::F32 => Class::F32,
        ValueClass::F64 => Class::F64,
    }
}
