//! Which variables of a program are changed after their first values, and how.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use crate::typed::{ExprKind, Function, PlaceId, PlaceKind, SymbolId};

/// The variable of the program that a place is, as a whole.
pub(super) fn symbol(function: &Function, place: PlaceId) -> Option<SymbolId> {
    match function.places[place].kind {
        PlaceKind::Symbol(symbol, 0) => Some(symbol),
        _ => None,
    }
}

/// The variables that a program changes.
#[derive(Default)]
pub(super) struct Changes {
    /// By adding or subtracting.
    pub(super) counted: BTreeSet<SymbolId>,
    /// By storing a value, or through their address.
    pub(super) set: BTreeSet<SymbolId>,
}

impl Changes {
    pub(super) fn of(program: &AnalysedProgram<'_>) -> Self {
        let mut changes = Self::default();
        for function in program.functions() {
            for expr in function.exprs.values() {
                match &expr.kind {
                    ExprKind::Update(update) => changes.counted.extend(symbol(function, update.place)),
                    ExprKind::Assign(place, _)
                    | ExprKind::Address(place)
                    | ExprKind::Clear(place)
                    | ExprKind::Copy { to: place, .. } => changes.set.extend(symbol(function, *place)),
                    _ => {}
                }
            }
        }
        changes
    }
}
