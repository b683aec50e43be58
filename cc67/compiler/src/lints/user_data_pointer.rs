//! `*(float *)persist.UserData[10]`: the element is used as an address, and the element's own address is meant.

use super::program::{AnalysedProgram, PERSIST};
use super::user_data_index;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function, PlaceId, PlaceKind};

/// Reports elements through which a `float` is read, unless the program keeps addresses in elements.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    if program.functions().any(|function| keeps_addresses(program, function)) {
        return;
    }
    for function in program.functions() {
        for expr in function.exprs.values() {
            // Elements that hold addresses are passed to other programs, which access more than single floats.
            let ExprKind::Load(place) = expr.kind else { continue };
            let PlaceKind::Pointer(pointer, _) = function.places[place].kind else { continue };
            if expr.ty != Types::FLOAT {
                continue;
            }
            if let Some(element) = element(program, function, pointer) {
                let message = "the value of an element of `persist.UserData` is used as an address";
                sink.report(
                    Diagnostic::warning(Lint::UserDataPointer, function.exprs[element].span, message)
                        .at("its own address is meant")
                        .help("write `&` before it: `*(float *)&persist.UserData[…]`"),
                );
            }
        }
    }
}

/// The element whose value is used directly as an address.
fn element(program: &AnalysedProgram<'_>, function: &Function, pointer: ExprId) -> Option<ExprId> {
    match function.exprs[pointer].kind {
        ExprKind::Convert(inner) => element(program, function, inner),
        ExprKind::Load(place) => is_element(program, function, place).then_some(pointer),
        _ => None,
    }
}

/// Reports whether a place is an element of `persist.UserData` at a constant index.
fn is_element(program: &AnalysedProgram<'_>, function: &Function, place: PlaceId) -> bool {
    let PlaceKind::Symbol(symbol, offset) = function.places[place].kind else { return false };
    let (first, last) = user_data_index::range();
    program.name(symbol) == PERSIST && (first..last).contains(&offset)
}

/// Reports whether an address is stored in an element.
fn keeps_addresses(program: &AnalysedProgram<'_>, function: &Function) -> bool {
    let types = &program.unit.types;
    let is_address = |value: ExprId| types.is_pointer(function.exprs[function.unconverted(value)].ty);
    function.exprs.values().any(|expr| match expr.kind {
        ExprKind::Assign(place, value) => is_element(program, function, place) && is_address(value),
        _ => false,
    })
}
