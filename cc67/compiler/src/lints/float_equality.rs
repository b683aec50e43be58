//! `x += 0.1; … if (x == 1.0)`, and `float f = 0.1; if (f == 0.1)`: rounded numbers are hardly ever equal.

use std::collections::BTreeMap;

use super::loop_condition::steps_over;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceId, PlaceKind, StmtKind, Update};

/// Numbers that are a multiple of this part of 1 have exact sums.
const EXACT: f64 = 1_048_576.0;

/// Reports comparisons for equality of sums of rounded steps, and of a `float` with a constant that no `float` is.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let (told, updates) = (loops_that_step_over(function), updates(function));
        for (_, expr) in function.exprs.iter().filter(|(id, _)| !told.contains(id)) {
            let ExprKind::Compare(op @ (CompareOp::Equal | CompareOp::NotEqual), a, b) = expr.kind else {
                continue;
            };
            let result = op == CompareOp::NotEqual;
            let finding = [(a, b), (b, a)].into_iter().find_map(|(side, other)| {
                constant(function, side, other, (expr.span, result))
                    .or_else(|| sum(function, &updates, side, expr.span))
            });
            sink.report_if(finding);
        }
    }
}

/// The conditions of loops that are reported by another warning.
fn loops_that_step_over(function: &Function) -> Vec<ExprId> {
    let mut found = Vec::new();
    function.each_stmt(&mut |stmt| {
        if let StmtKind::Loop { condition: Some(condition), step: Some(step), .. } = stmt.kind
            && steps_over(function, condition, step).is_some()
        {
            found.push(condition);
        }
    });
    found
}

/// A `float` compared with a constant that no `float` is.
fn constant(
    function: &Function,
    side: ExprId,
    other: ExprId,
    (span, result): (Span, bool),
) -> Option<Diagnostic> {
    let ExprKind::Float(number) = function.exprs[other].kind else { return None };
    let ExprKind::Convert(inner) = function.exprs[side].kind else { return None };
    let is_float = function.exprs[inner].ty == Types::FLOAT && function.exprs[side].ty == Types::DOUBLE;
    let rounded = number as f32;
    (is_float && f64::from(rounded) != number).then(|| {
        Diagnostic::warning(Lint::FloatEquality, span, format!("no `float` is {number}"))
            .at(format!("always {result}: the nearest is {:.12}", f64::from(rounded)))
            .help(format!("write `{number}f`, or test whether the difference is small"))
    })
}

/// The updates of each variable, `x += step` for example, in the order of the program.
type Updates<'f> = BTreeMap<LocalId, Vec<(Span, &'f Update)>>;

fn updates(function: &Function) -> Updates<'_> {
    let mut found = Updates::new();
    for expr in function.exprs.values() {
        if let ExprKind::Update(update) = &expr.kind
            && let Some(local) = local(function, update.place)
        {
            found.entry(local).or_default().push((expr.span, update));
        }
    }
    found
}

/// A variable to which rounded steps are added.
fn sum(function: &Function, updates: &Updates<'_>, side: ExprId, span: Span) -> Option<Diagnostic> {
    let local = loaded(function, side).filter(|_| function.exprs[side].ty.is_floating())?;
    // Another loop may use the variable with other steps.
    let is_rounded = |update: &Update| {
        matches!(update.op, BinaryOp::Add | BinaryOp::Subtract) && is_rounded(function, update.operand)
    };
    let steps = updates.get(&local)?;
    if !steps.iter().all(|(_, update)| is_rounded(update)) {
        return None;
    }
    let (step, _) = steps.first()?;
    let name = &function.locals[local].name;
    Some(
        Diagnostic::warning(Lint::FloatEquality, span, format!("`{name}` is a sum of rounded steps"))
            .at("hardly ever exactly equal")
            .label(*step, "rounded here")
            .help("test whether the difference is small, or count with an `int`"),
    )
}

/// Returns whether a step is a constant that is rounded, or a variable that only ever holds one.
fn is_rounded(function: &Function, step: ExprId) -> bool {
    match function.exprs[step].kind {
        ExprKind::Float(number) => (number * EXACT).fract() != 0.0,
        ExprKind::Convert(inner) => is_rounded(function, inner),
        ExprKind::Load(place) => local(function, place).is_some_and(|step| {
            let mut values = function.exprs.values().filter_map(|expr| match expr.kind {
                ExprKind::Assign(place, value) if local(function, place) == Some(step) => Some(value),
                _ => None,
            });
            let is_constant = |value: ExprId| match function.exprs[value].kind {
                ExprKind::Float(number) => (number * EXACT).fract() != 0.0,
                _ => false,
            };
            values.next().is_some_and(is_constant) && values.all(is_constant)
        }),
        _ => false,
    }
}

fn loaded(function: &Function, expr: ExprId) -> Option<LocalId> {
    match function.exprs[expr].kind {
        ExprKind::Load(place) => local(function, place),
        ExprKind::Convert(inner) => loaded(function, inner),
        _ => None,
    }
}

fn local(function: &Function, place: PlaceId) -> Option<LocalId> {
    match function.places[place].kind {
        PlaceKind::Local(local, 0) => Some(local),
        _ => None,
    }
}
