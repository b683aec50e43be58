//! `int i = -1; if (i < count)` with an unsigned `count`: converted to unsigned, -1 is the largest number.

use std::collections::BTreeMap;

use kmotiondef::structs::Chan;

use super::format::called_firmware;
use super::loop_condition::axis_place;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind, Function, LocalId, PlaceKind, UnaryOp};

/// Reports comparisons with an unsigned value of variables to which the function may assign negative values.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let negatives = negatives(program, function);
        for expr in function.exprs.values() {
            let ExprKind::Compare(op, a, b) = expr.kind else { continue };
            if matches!(op, CompareOp::Equal | CompareOp::NotEqual) {
                continue;
            }
            for (side, other) in [(a, b), (b, a)] {
                if let Some(local) = converted(function, (side, expr.span), other)
                    && let Some(stored) = negatives.get(&local)
                {
                    sink.report(finding(function, local, *stored, expr.span));
                }
            }
        }
    }
}

fn finding(function: &Function, local: LocalId, stored: Span, span: Span) -> Diagnostic {
    let name = &function.locals[local].name;
    let message = format!("`{name}` can be negative, and is compared with an unsigned value");
    Diagnostic::warning(Lint::NegativeComparison, span, message)
        .at("as unsigned: -1 counts as 4294967295")
        .label(stored, "can be negative")
        .note("the vendor's compiler compares them as signed")
        .help("make the other one an `int`, or write `(int)` before it")
}

/// The signed variable that C converts to unsigned for a comparison; an explicit cast is intended.
fn converted(function: &Function, (side, comparison): (ExprId, Span), other: ExprId) -> Option<LocalId> {
    let ExprKind::Convert(inner) = function.exprs[side].kind else { return None };
    let is_cast = function.exprs[side].span != comparison;
    let is_unsigned = function.exprs[side].ty == Types::UNSIGNED && function.exprs[inner].ty == Types::INT;
    // The other side is unsigned without a conversion.
    let is_mixed = match function.exprs[other].kind {
        ExprKind::Convert(other) => function.exprs[other].ty.is_unsigned(),
        _ => true,
    };
    let ExprKind::Load(place) = function.exprs[inner].kind else { return None };
    let PlaceKind::Local(local, 0) = function.places[place].kind else { return None };
    let is_named = !function.locals[local].name.is_empty();
    (is_unsigned && is_mixed && is_named && !is_cast).then_some(local)
}

/// The locals to which a function may assign negative values, each with the first such assignment.
fn negatives(program: &AnalysedProgram<'_>, function: &Function) -> BTreeMap<LocalId, Span> {
    let mut found = BTreeMap::new();
    for expr in function.exprs.values() {
        if let ExprKind::Assign(place, value) = expr.kind
            && let PlaceKind::Local(local, 0) = function.places[place].kind
            && can_be_negative(program, function, value)
        {
            found.entry(local).or_insert(function.exprs[value].span);
        }
    }
    found
}

/// A negative number, a number that is negated, a place of an axis, or an answer of the board from which a constant is
/// subtracted.
fn can_be_negative(program: &AnalysedProgram<'_>, function: &Function, value: ExprId) -> bool {
    match &function.exprs[value].kind {
        ExprKind::Int(number) => *number < 0,
        ExprKind::Float(number) => *number < 0.0,
        ExprKind::Unary(UnaryOp::Negate, _) => true,
        ExprKind::Convert(inner) => can_be_negative(program, function, *inner),
        ExprKind::Load(_) => {
            axis_place(program, function, value).is_some_and(|field| PLACES.contains(&field))
        }
        ExprKind::Binary(BinaryOp::Subtract, a, b) => {
            let is_answer = match &function.exprs[*a].kind {
                ExprKind::Call(call) => called_firmware(program.unit, call).is_some(),
                _ => false,
            };
            is_answer && matches!(function.exprs[*b].kind, ExprKind::Int(1..))
        }
        _ => false,
    }
}

/// The fields of an axis that are places on it.
const PLACES: [u32; 2] = [Chan::DEST.offset(), Chan::POSITION.offset()];
