//! `ch2->InputMode = NO_INPUT_MODE; … touched = ch2->Position;`: without an input the position of an axis stays as it is.

use std::collections::BTreeSet;

use kmotiondef::modes::InputMode;
use kmotiondef::structs::Chan;

use super::program::{AnalysedProgram, CHANNELS, axis_of_pointer};
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
            let Some(Axis::Number(axis)) = axis_of(program, function, place, POSITION) else { continue };
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

/// The arguments of calls: whoever prints a position, or enables an axis at it, asks nothing of it.
fn passed(function: &Function) -> BTreeSet<ExprId> {
    let unconverted = |mut expr: ExprId| {
        while let ExprKind::Convert(inner) = function.exprs[expr].kind {
            expr = inner;
        }
        expr
    };
    let arguments = |call: &Call| -> Vec<ExprId> {
        call.arguments.iter().chain(call.variable.iter().flatten()).copied().map(unconverted).collect()
    };
    function.calls().flat_map(|(_, call)| arguments(call)).collect()
}

const POSITION: i32 = Chan::POSITION.offset().cast_signed();
const INPUT_MODE: i32 = Chan::INPUT_MODE.offset().cast_signed();

/// The axis that a place belongs to.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Axis {
    Number(u32),
    /// One that a pointer names.
    Pointed,
}

/// The axis of a place that is a field at `offset`.
fn axis_of(program: &AnalysedProgram<'_>, function: &Function, place: PlaceId, offset: i32) -> Option<Axis> {
    match function.places[place].kind {
        PlaceKind::Pointer(pointer, at) if at == offset => {
            let ExprKind::Load(pointer) = function.exprs[pointer].kind else { return None };
            match function.places[pointer].kind {
                PlaceKind::Symbol(symbol, 0) => axis_of_pointer(program.name(symbol)).map(Axis::Number),
                PlaceKind::Local(..) => Some(Axis::Pointed),
                _ => None,
            }
        }
        PlaceKind::Symbol(symbol, at) if program.name(symbol) == CHANNELS => {
            let size = Chan::STRUCTURE.size.cast_signed();
            let axis = at.div_euclid(size).try_into().ok()?;
            (at.rem_euclid(size) == offset).then_some(Axis::Number(axis))
        }
        _ => None,
    }
}

/// The axes whose only input mode in the program is none, set by number or in a function that is called with their number.
fn axes_without_input(program: &AnalysedProgram<'_>) -> BTreeSet<u32> {
    let mut without = BTreeSet::new();
    let mut setters: BTreeSet<SymbolId> = BTreeSet::new();
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Assign(place, value) = expr.kind else { continue };
            let Some(axis) = axis_of(program, function, place, INPUT_MODE) else { continue };
            if !matches!(function.exprs[value].kind, ExprKind::Int(mode) if mode == i64::from(InputMode::None.get()))
            {
                return BTreeSet::new();
            }
            match axis {
                Axis::Number(axis) => _ = without.insert(axis),
                Axis::Pointed => _ = setters.insert(function.symbol),
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
