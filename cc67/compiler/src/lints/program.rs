//! The input of lints: the finished typed tree and the names of the board.

use kmotiondef::structs::Chan;

use crate::firmware::FirmwareNames;
use crate::names::Names;
use crate::source::SourceMap;
use crate::ty::TypeId;
use crate::typed::{ExprKind, Function, PlaceId, PlaceKind, SymbolId, Unit};

/// The structure with elements for programs and the PC.
pub(super) const PERSIST: &str = "persist";
/// The array of the axes.
pub(super) const CHANNELS: &str = "chan";

/// The number of the axis to which a variable of the board points, such as `ch3`.
pub(super) fn axis_of_pointer(name: &str) -> Option<u32> {
    name.strip_prefix("ch")?.parse().ok()
}

/// The field of an axis that a place is: `ch3->Vel`, `chan[3].Vel`.
pub(super) struct AxisField {
    pub(super) axis: u32,
    /// Bytes from the start of `CHAN`.
    pub(super) field: u32,
}

/// A program after analysis.
#[derive(Clone, Copy)]
pub(super) struct AnalysedProgram<'a> {
    /// The typed tree.
    pub(super) unit: &'a Unit,
    /// The names in it.
    pub(super) names: &'a Names,
    /// The source text.
    pub(super) sources: &'a SourceMap,
    /// The board for which it is compiled.
    pub(super) firmware: &'a dyn FirmwareNames,
    /// The elements of `persist.UserData` in which a `float` is stored before it starts.
    pub(super) float_elements: &'a [u32],
}

impl<'a> AnalysedProgram<'a> {
    /// All functions; code with errors is left out of them.
    pub(super) fn functions(&self) -> impl Iterator<Item = &'a Function> + use<'a> {
        self.unit.functions.iter()
    }

    /// The functions without errors: for lints that report missing code.
    pub(super) fn whole_functions(&self) -> impl Iterator<Item = &'a Function> + use<'a> {
        self.functions().filter(|function| !function.has_errors)
    }

    /// The symbol with linkage that has this name.
    pub(super) fn symbol(&self, name: &str) -> Option<SymbolId> {
        self.unit.symbols.iter().find(|(_, symbol)| symbol.name == name).map(|(id, _)| id)
    }

    /// The name of a symbol.
    pub(super) fn name(&self, symbol: SymbolId) -> &'a str {
        &self.unit.symbols[symbol].name
    }

    /// The field of an axis that a place is, if the axis is named by its number.
    pub(super) fn axis_field(&self, function: &Function, place: PlaceId) -> Option<AxisField> {
        let (axis, field) = match function.places[place].kind {
            PlaceKind::Pointer(pointer, field) => {
                let ExprKind::Load(pointer) = function.exprs[pointer].kind else { return None };
                let PlaceKind::Symbol(symbol, 0) = function.places[pointer].kind else { return None };
                (axis_of_pointer(self.name(symbol))?, field)
            }
            PlaceKind::Symbol(symbol, offset) if self.name(symbol) == CHANNELS => {
                let size = Chan::STRUCTURE.size.cast_signed();
                (offset.div_euclid(size).try_into().ok()?, offset.rem_euclid(size))
            }
            _ => return None,
        };
        Some(AxisField { axis, field: field.try_into().ok()? })
    }

    /// A type as C spells it.
    pub(super) fn spell(&self, ty: TypeId) -> String {
        self.unit.types.spell(self.names, ty)
    }
}
