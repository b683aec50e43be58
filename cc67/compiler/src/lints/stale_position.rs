//! `ch2->InputMode = NO_INPUT_MODE; … touched = ch2->Position;`: without an input the position of an axis does not
//! change.

use std::collections::BTreeSet;

use kmotiondef::modes::InputMode;
use kmotiondef::structs::Chan;

use super::program::{AnalysedProgram, AxisField};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Call, Callee, ExprId, ExprKind, Function, PlaceId, PlaceKind, SymbolId};

/// Reports reads of `Position` of an axis to which the program gives no input.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let without = axes_without_input(program);
    if without.is_empty() {
        return;
    }
    for function in program.functions() {
        let passed = passed(function);
        for (id, expr) in &function.exprs {
            let ExprKind::Load(place) = expr.kind else { continue };
            if passed.contains(&id) {
                continue;
            }
            let Some(AxisField { axis, field: POSITION }) = program.axis_field(function, place) else {
                continue;
            };
            if !without.contains(&axis) {
                continue;
            }
            let written = String::from_utf8_lossy(program.sources.text(function.places[place].span));
            let message = format!("`{written}` does not follow axis {axis}, which has no input");
            sink.report(
                Diagnostic::warning(Lint::StalePosition, expr.span, message)
                    .at("NO_INPUT_MODE: it stays as it is")
                    .help(format!("`ch{axis}->Dest` is the commanded position")),
            );
        }
    }
}

/// The arguments of calls: printing a position, or enabling an axis at it, does not rely on its value.
fn passed(function: &Function) -> BTreeSet<ExprId> {
    let arguments = |call: &Call| -> Vec<ExprId> {
        call.arguments
            .iter()
            .chain(call.variable.iter().flatten())
            .map(|argument| function.unconverted(*argument))
            .collect()
    };
    function.calls().flat_map(|(_, call)| arguments(call)).collect()
}

const POSITION: u32 = Chan::POSITION.offset();
const INPUT_MODE: u32 = Chan::INPUT_MODE.offset();

/// Returns whether a place is the input mode of an axis through a pointer variable.
fn is_pointed_mode(function: &Function, place: PlaceId) -> bool {
    let PlaceKind::Pointer(pointer, field) = function.places[place].kind else { return false };
    let ExprKind::Load(pointer) = function.exprs[pointer].kind else { return false };
    u32::try_from(field) == Ok(INPUT_MODE) && matches!(function.places[pointer].kind, PlaceKind::Local(..))
}

/// The axes whose input mode is always none in the program, set by number or in a function called with their number.
fn axes_without_input(program: &AnalysedProgram<'_>) -> BTreeSet<u32> {
    let mut without = BTreeSet::new();
    let mut setters: BTreeSet<SymbolId> = BTreeSet::new();
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Assign(place, value) = expr.kind else { continue };
            let named = program.axis_field(function, place).filter(|named| named.field == INPUT_MODE);
            if named.is_none() && !is_pointed_mode(function, place) {
                continue;
            }
            if !matches!(function.exprs[value].kind, ExprKind::Int(mode) if mode == i64::from(InputMode::None.get()))
            {
                return BTreeSet::new();
            }
            match named {
                Some(AxisField { axis, .. }) => _ = without.insert(axis),
                None => _ = setters.insert(function.symbol),
            }
        }
    }
    for function in program.functions() {
        for (_, call) in function.calls() {
            let Callee::Symbol(callee) = call.callee else { continue };
            if setters.contains(&callee)
                && let Some(first) = call.arguments.first()
                && let ExprKind::Int(axis) = function.exprs[*first].kind
            {
                without.extend(u32::try_from(axis));
            }
        }
    }
    without
}
