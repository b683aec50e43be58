//! `Delay_sec(3); while (Time_sec() < 2)` and `SetBit(46); WaitUntil(0.5);`: the time counts from power-up, not from the loop or the call.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::typed::{ExprId, ExprKind, Function as TypedFunction, Stmt, StmtKind};

/// The function that returns the time since power-up, and the one that waits.
const TIME: &str = Function::Time_sec.name();
const DELAY: &str = Function::Delay_sec.name();
const WAIT_UNTIL: &str = Function::WaitUntil.name();

/// Reports loops until a time that has already passed when they begin, and `WaitUntil` used as a delay.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        delays(program, function, sink);
        let mut passed = 0.0;
        for stmt in &function.body {
            search(program, function, stmt, &mut passed, sink);
        }
    }
}

/// Reports calls of `WaitUntil` with a constant, unless the program begins with the call in order to let the machine
/// power up.
fn delays(program: &AnalysedProgram<'_>, function: &TypedFunction, sink: &mut Sink) {
    let is_main = program.name(function.symbol) == MAIN;
    for (at, (expr, call)) in function.calls().enumerate() {
        let is_first = at == 0 && is_main;
        if called_firmware(program.unit, call) != Some(WAIT_UNTIL) || is_first {
            continue;
        }
        let Some(seconds) = call.arguments.first().and_then(|time| number(function, *time)) else { continue };
        let message =
            format!("`{WAIT_UNTIL}` takes a time since power-up: {seconds} s are over soon after it");
        sink.report(
            Diagnostic::warning(Lint::AbsoluteTime, expr.span, message)
                .at("does not wait once the board has been on for that long")
                .help(format!("write `{DELAY}({seconds})` to wait for {seconds} s")),
        );
    }
}

/// The function in which a program begins.
const MAIN: &str = "main";

/// Adds the minimum wait of a statement; reports it if it is such a loop.
fn search(
    program: &AnalysedProgram<'_>,
    function: &TypedFunction,
    stmt: &Stmt,
    passed: &mut f64,
    sink: &mut Sink,
) {
    match &stmt.kind {
        StmtKind::Expr(expr) => *passed += delay(program, function, *expr).unwrap_or(0.0),
        StmtKind::Block(body) => body.iter().for_each(|stmt| search(program, function, stmt, passed, sink)),
        StmtKind::Loop { condition: Some(condition), .. } => {
            let Some(end) = end(program, function, *condition).filter(|end| end <= passed) else { return };
            let message = format!("`{TIME}` is {passed} or more here, so this loop never runs");
            sink.report(
                Diagnostic::warning(Lint::AbsoluteTime, function.exprs[*condition].span, message)
                    .at("the time since power-up, not since the loop began")
                    .help(format!(
                        "keep the start, `double start = {TIME}();`, and write `{TIME}() - start < {end}`"
                    )),
            );
        }
        _ => {}
    }
}

/// The seconds of a constant wait.
fn delay(program: &AnalysedProgram<'_>, function: &TypedFunction, expr: ExprId) -> Option<f64> {
    let ExprKind::Call(call) = &function.exprs[expr].kind else { return None };
    if called_firmware(program.unit, call) != Some(DELAY) {
        return None;
    }
    number(function, *call.arguments.first()?)
}

/// The time until which a condition holds.
fn end(program: &AnalysedProgram<'_>, function: &TypedFunction, condition: ExprId) -> Option<f64> {
    match function.exprs[condition].kind {
        ExprKind::And(a, b) => end(program, function, a).or_else(|| end(program, function, b)),
        ExprKind::Compare(op, time, end) => {
            let ExprKind::Call(call) = &function.exprs[time].kind else { return None };
            let is_time = called_firmware(program.unit, call) == Some(TIME);
            let is_until = matches!(op, CompareOp::Less | CompareOp::LessEqual);
            number(function, end).filter(|_| is_time && is_until)
        }
        _ => None,
    }
}

/// The value of a constant.
pub(super) fn number(function: &TypedFunction, expr: ExprId) -> Option<f64> {
    match function.exprs[expr].kind {
        ExprKind::Float(number) => Some(number),
        ExprKind::Int(number) => Some(number as f64),
        _ => None,
    }
}
