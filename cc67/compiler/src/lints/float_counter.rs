//! `float n; … n += 1;` in a loop without an end: a `float` stops counting at 16777216, and far earlier in small steps.

use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function, PlaceId, PlaceKind, Stmt, StmtKind};

/// The number of equal steps after which a `float` does not change any more, at the most.
const STEPS: f64 = 16_777_216.0;

/// Reports `float` variables that a loop counts up without end, or towards an end that they never reach.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            let StmtKind::Loop { condition, body, step, .. } = &stmt.kind else { return };
            for counted in counted(function, body, *step) {
                sink.report_if(match *condition {
                    None if is_free(program, function, body, counted.place) => {
                        Some(finding(program, function, counted, None))
                    }
                    None => None,
                    Some(condition) => beyond(function, condition, counted).map(|end| {
                        finding(program, function, counted, Some((function.exprs[condition].span, end)))
                    }),
                });
            }
        });
    }
}

/// A step of a `float`.
#[derive(Clone, Copy)]
struct Counted {
    place: PlaceId,
    amount: f64,
    span: Span,
}

fn finding(
    program: &AnalysedProgram<'_>,
    function: &Function,
    counted: Counted,
    end: Option<(Span, f64)>,
) -> Diagnostic {
    let name = match function.places[counted.place].kind {
        PlaceKind::Local(local, _) => &function.locals[local].name,
        PlaceKind::Symbol(symbol, _) => program.name(symbol),
        PlaceKind::Pointer(..) | PlaceKind::Bits(..) => "",
    };
    let most = STEPS * counted.amount.abs();
    let message = format!("`{name}`, a `float`, stops counting at {most} or before");
    let found = Diagnostic::warning(Lint::FloatCounter, counted.span, message)
        .at("there a step is less than its last digit");
    let found = match end {
        Some((span, end)) => found.label(span, format!("so the loop never gets to {end}")),
        None => found.note("the loop has no end"),
    };
    found.help(match counted.amount.fract() == 0.0 {
        true => "use an `int`",
        false => "use a `double`, or count the steps with an `int` and multiply",
    })
}

/// The steps of `float` variables in a loop.
fn counted(function: &Function, body: &[Stmt], step: Option<ExprId>) -> Vec<Counted> {
    let mut found = Vec::new();
    each(function, body, step, &mut |expr| {
        let ExprKind::Update(update) = &function.exprs[expr].kind else { return };
        let is_float = function.places[update.place].ty == Types::FLOAT;
        let is_sum = matches!(update.op, BinaryOp::Add | BinaryOp::Subtract);
        let amount = match function.exprs[update.operand].kind {
            ExprKind::Int(number) => number as f64,
            ExprKind::Float(number) => number,
            _ => return,
        };
        if is_float && is_sum && amount != 0.0 && variable(function, update.place).is_some() {
            found.push(Counted { place: update.place, amount, span: function.exprs[expr].span });
        }
    });
    found
}

fn each(function: &Function, body: &[Stmt], step: Option<ExprId>, visit: &mut dyn FnMut(ExprId)) {
    let walk = Walk { function, extent: Extent::All };
    walk.stmts(body, visit);
    if let Some(step) = step {
        walk.expr(step, visit);
    }
}

/// The variable that a place is.
fn variable(function: &Function, place: PlaceId) -> Option<PlaceKind> {
    Some(function.places[place].kind)
        .filter(|kind| matches!(kind, PlaceKind::Local(_, 0) | PlaceKind::Symbol(_, 0)))
}

/// Returns whether the program only counts a variable: in the loop, it is neither stored elsewhere nor compared.
fn is_free(program: &AnalysedProgram<'_>, function: &Function, body: &[Stmt], place: PlaceId) -> bool {
    let wanted = variable(function, place);
    let is_it = |place: PlaceId| variable(function, place) == wanted;
    let is_global = matches!(wanted, Some(PlaceKind::Symbol(..)));
    let mut is_used = false;
    each(function, body, None, &mut |expr| {
        is_used |= match &function.exprs[expr].kind {
            ExprKind::Assign(place, _) | ExprKind::Address(place) => is_it(*place),
            ExprKind::Compare(_, a, b) => [*a, *b].into_iter().any(|side| loads(function, side, &is_it)),
            _ => false,
        };
    });
    // Another function can restart the counter.
    let functions = program.functions().filter(|other| is_global && other.symbol != function.symbol);
    let mut others = functions.flat_map(|other| other.places.values());
    !is_used && !others.any(|place| Some(place.kind) == wanted)
}

fn loads(function: &Function, expr: ExprId, is_it: &dyn Fn(PlaceId) -> bool) -> bool {
    match function.exprs[expr].kind {
        ExprKind::Load(place) => is_it(place),
        ExprKind::Convert(inner) => loads(function, inner, is_it),
        ExprKind::Binary(_, a, b) => loads(function, a, is_it) || loads(function, b, is_it),
        _ => false,
    }
}

/// The end of a loop that a variable does not reach in its steps.
fn beyond(function: &Function, condition: ExprId, counted: Counted) -> Option<f64> {
    let ExprKind::Compare(op, a, b) = function.exprs[condition].kind else { return None };
    let is_it = |place: PlaceId| variable(function, place) == variable(function, counted.place);
    if !loads(function, a, &is_it)
        || !matches!(op, CompareOp::Less | CompareOp::LessEqual | CompareOp::NotEqual)
    {
        return None;
    }
    let end = match function.exprs[b].kind {
        ExprKind::Int(number) => number as f64,
        ExprKind::Float(number) => number,
        _ => return None,
    };
    (counted.amount > 0.0 && end > STEPS * counted.amount).then_some(end)
}
