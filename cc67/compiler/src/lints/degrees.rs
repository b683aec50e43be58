//! `sin(90)`, `sin(i * 60.0)`: the functions of angles take radians.

use std::f64::consts::TAU;

use kmotiondef::firmware::Function as Firmware;

use super::absolute_time::number;
use super::format::called_firmware;
use super::program::AnalysedProgram;
use super::value_range::single_stores;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function, PlaceKind, Stmt, StmtKind};

/// Functions that take an angle.
const FUNCTIONS: [&str; 6] = [
    Firmware::sin.name(),
    Firmware::cos.name(),
    Firmware::tan.name(),
    Firmware::sinf.name(),
    Firmware::cosf.name(),
    Firmware::tanf.name(),
];

/// Degrees of a turn; people count in steps that divide it.
const TURN: f64 = 360.0;

/// Reports constant angles of more than a turn, and those that a loop counts in degrees.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let multiples = single_stores(function, |value| multiple(function, value));
        for (_, call) in function.calls() {
            let Some(name) = called_firmware(program.unit, call).filter(|name| FUNCTIONS.contains(name))
            else {
                continue;
            };
            let Some(&argument) = call.arguments.first() else { continue };
            let span = function.exprs[argument].span;
            if let ExprKind::Float(angle) = function.exprs[argument].kind
                && angle.abs() > TAU
            {
                let message = format!("`{name}` takes radians, and {angle} is more than a turn");
                sink.report(
                    Diagnostic::warning(Lint::Degrees, span, message)
                        .at("these look like degrees")
                        .help(format!("write `{name}({angle} * PI / 180)`")),
                );
            }
            let variable = match loaded(function, argument) {
                Some(PlaceKind::Local(local, _)) => multiples.get(&local).copied(),
                _ => None,
            };
            if let Some((step, at)) = variable.or_else(|| multiple(function, argument)) {
                let text = String::from_utf8_lossy(program.sources.text(span));
                let message = format!("`{name}` takes radians, and `{text}` is a multiple of {step}");
                let finding = Diagnostic::warning(Lint::Degrees, span, message).at("this looks like degrees");
                let finding = if at == span { finding } else { finding.label(at, "computed here") };
                sink.report(finding.help(format!("write `{name}({text} * PI / 180)`")));
            }
        }
        function.each_stmt(&mut |stmt| {
            if let Some(counted) = Counted::of(function, stmt) {
                counted.report(program, function, sink);
            }
        });
    }
}

/// A variable that a loop counts in steps of whole degrees to at least a quarter of a turn.
struct Counted<'a> {
    variable: PlaceKind,
    end: f64,
    condition: Span,
    body: &'a [Stmt],
}

impl<'a> Counted<'a> {
    fn of(function: &Function, stmt: &'a Stmt) -> Option<Self> {
        let StmtKind::Loop { condition: Some(condition), body, step: Some(step), .. } = &stmt.kind else {
            return None;
        };
        let ExprKind::Compare(CompareOp::Less | CompareOp::LessEqual, value, end) =
            function.exprs[*condition].kind
        else {
            return None;
        };
        let ExprKind::Update(update) = &function.exprs[*step].kind else { return None };
        let (end, step) = (number(function, end)?, number(function, update.operand)?);
        let variable = function.places[update.place].kind;
        let is_counted = update.op == BinaryOp::Add && loaded(function, value) == Some(variable);
        // Small steps are those of an angle in radians or of a time.
        let is_degrees = step >= 1.0 && TURN % step == 0.0 && end >= TURN / 4.0;
        (is_counted && is_degrees).then(|| Self {
            variable,
            end,
            condition: function.exprs[*condition].span,
            body,
        })
    }

    /// Reports the calls that are given the variable as it is.
    fn report(&self, program: &AnalysedProgram<'_>, function: &Function, sink: &mut Sink) {
        let mut calls = Vec::new();
        Walk { function, extent: Extent::All }.stmts(self.body, &mut |expr| {
            if let ExprKind::Call(call) = &function.exprs[expr].kind {
                calls.push(call);
            }
        });
        for call in calls {
            let Some(name) = called_firmware(program.unit, call).filter(|name| FUNCTIONS.contains(name))
            else {
                continue;
            };
            let Some(&argument) = call.arguments.first() else { continue };
            if loaded(function, argument) != Some(self.variable) {
                continue;
            }
            let span = function.exprs[argument].span;
            let text = String::from_utf8_lossy(program.sources.text(span));
            let message = format!("`{name}` takes radians, and `{text}` counts up to {}", self.end);
            sink.report(
                Diagnostic::warning(Lint::Degrees, span, message)
                    .at("this looks like degrees")
                    .label(self.condition, "counted here")
                    .help(format!("write `{name}({text} * PI / 180)`")),
            );
        }
    }
}

/// The number of degrees of which an expression is a whole multiple, as `i * 60.0` is, and its place.
fn multiple(function: &Function, expr: ExprId) -> Option<(f64, Span)> {
    /// Fewer are steps of something else, such as seconds.
    const LEAST: f64 = 5.0;
    let (a, b) = match function.exprs[expr].kind {
        ExprKind::Binary(BinaryOp::Multiply, a, b) => (a, b),
        ExprKind::Binary(BinaryOp::Divide, turns, parts) => {
            let (turn, span) = multiple(function, turns)?;
            let parts = number(function, parts)?;
            return (turn == TURN && parts > 1.0).then_some((turn / parts, span));
        }
        _ => return None,
    };
    let is_count = |side: ExprId| match function.exprs[side].kind {
        ExprKind::Convert(inner) => {
            function.exprs[inner].ty == Types::INT && loaded(function, inner).is_some()
        }
        _ => false,
    };
    let step = if is_count(a) { number(function, b) } else { number(function, a).filter(|_| is_count(b)) }?;
    (step >= LEAST && TURN % step == 0.0).then_some((step, function.exprs[expr].span))
}

/// The variable whose value an expression is.
fn loaded(function: &Function, expr: ExprId) -> Option<PlaceKind> {
    match function.exprs[expr].kind {
        ExprKind::Load(place) => Some(function.places[place].kind)
            .filter(|kind| matches!(kind, PlaceKind::Local(_, 0) | PlaceKind::Symbol(_, 0))),
        ExprKind::Convert(inner) => loaded(function, inner),
        _ => None,
    }
}
