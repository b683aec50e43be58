//! `float start = Time_sec();`: a `float` has seven digits, and the board's time soon needs more; an `int` has no
//! fraction.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function as TypedFunction, LocalId, PlaceKind};

/// The function that returns the time since power-up.
const TIME: &str = Function::Time_sec.name();

/// Reports times that become a `float`, and times that lose their fraction before a computation.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        whole_seconds(program, function, sink);
        for expr in function.exprs.values() {
            let ExprKind::Convert(inner) = expr.kind else { continue };
            let ExprKind::Call(call) = &function.exprs[inner].kind else { continue };
            if expr.ty == Types::FLOAT && called_firmware(program.unit, call) == Some(TIME) {
                sink.report(
                    Diagnostic::warning(
                        Lint::FloatTime,
                        function.exprs[inner].span,
                        format!("a `float` cannot hold the value of `{TIME}`"),
                    )
                    .at("seconds since power-up")
                    .note("a `float` has steps of 2 ms after 4.6 hours, and of 16 ms after 37 hours")
                    .help("use a `double`"),
                );
            }
        }
    }
}

/// Reports times in an `int` that is used as a floating-point number later, as in `Time_sec() - start`.
fn whole_seconds(program: &AnalysedProgram<'_>, function: &TypedFunction, sink: &mut Sink) {
    let is_time = |expr: ExprId| match &function.exprs[expr].kind {
        ExprKind::Call(call) => called_firmware(program.unit, call) == Some(TIME),
        _ => false,
    };
    let local = |place| match function.places[place].kind {
        PlaceKind::Local(local, 0) => Some(local),
        _ => None,
    };
    let is_computed_with = |wanted: LocalId| {
        function.exprs.values().filter(|expr| expr.ty.is_floating()).any(|expr| match expr.kind {
            ExprKind::Convert(inner) => match function.exprs[inner].kind {
                ExprKind::Load(place) => local(place) == Some(wanted),
                _ => false,
            },
            _ => false,
        })
    };
    for expr in function.exprs.values() {
        let ExprKind::Assign(place, value) = expr.kind else { continue };
        let ExprKind::Convert(inner) = function.exprs[value].kind else { continue };
        let Some(local) = local(place).filter(|_| is_time(inner) && function.exprs[value].ty.is_integer())
        else {
            continue;
        };
        if is_computed_with(local) {
            let name = &function.locals[local].name;
            let message = format!("`{name}` holds whole seconds: the fraction of `{TIME}` is lost");
            sink.report(
                Diagnostic::warning(Lint::FloatTime, function.exprs[inner].span, message)
                    .at("a difference to this is wrong by up to a second")
                    .help("use a `double`"),
            );
        }
    }
}
