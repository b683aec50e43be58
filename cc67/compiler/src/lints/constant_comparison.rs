//! Comparisons whose result the types decide: `unsigned >= 0`, `char == 200`.

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::CompareOp;
use crate::ty::{TypeId, Types};
use crate::typed::{ExprId, ExprKind, Function};

/// Reports comparisons with a constant that no value of the other side's type decides differently.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Compare(op, a, b) = expr.kind else { continue };
            let sides = match (constant(function, a), constant(function, b)) {
                (None, Some(number)) => Some((op, a, number)),
                (Some(number), None) => Some((mirrored(op), b, number)),
                _ => None,
            };
            let Some((op, value, number)) = sides else { continue };
            let Some((ty, least, most)) = range(function, value) else { continue };
            let Some(result) = decided(op, least, most, number) else { continue };
            let message = format!("this comparison is always {result}");
            sink.report(
                Diagnostic::warning(Lint::ConstantComparison, expr.span, message)
                    .label(
                        function.exprs[value].span,
                        format!("`{}`, which is {least} to {most}", program.spell(ty)),
                    )
                    .help("use an `int`"),
            );
        }
    }
}

fn constant(function: &Function, expr: ExprId) -> Option<i64> {
    match function.exprs[expr].kind {
        ExprKind::Int(number) => Some(number),
        _ => None,
    }
}

const fn mirrored(op: CompareOp) -> CompareOp {
    match op {
        CompareOp::Equal => CompareOp::Equal,
        CompareOp::NotEqual => CompareOp::NotEqual,
        CompareOp::Less => CompareOp::Greater,
        CompareOp::LessEqual => CompareOp::GreaterEqual,
        CompareOp::Greater => CompareOp::Less,
        CompareOp::GreaterEqual => CompareOp::LessEqual,
    }
}

/// The type of a value before C widens it, and its range.
fn range(function: &Function, mut value: ExprId) -> Option<(TypeId, i64, i64)> {
    let is_plain = |ty: TypeId| ty.is_integer() && !ty.is_long_long();
    while let ExprKind::Convert(inner) = function.exprs[value].kind
        && is_plain(function.exprs[inner].ty)
        && range_of(function.exprs[inner].ty).is_some()
        && is_plain(function.exprs[value].ty)
    {
        value = inner;
    }
    let ty = function.exprs[value].ty;
    let (least, most) = range_of(ty)?;
    Some((ty, least, most))
}

/// The range of a type that is narrower than `int`, or unsigned.
const fn range_of(ty: TypeId) -> Option<(i64, i64)> {
    match ty {
        Types::CHAR | Types::SIGNED_CHAR => Some((i8::MIN as i64, i8::MAX as i64)),
        Types::UNSIGNED_CHAR => Some((0, u8::MAX as i64)),
        Types::SHORT => Some((i16::MIN as i64, i16::MAX as i64)),
        Types::UNSIGNED_SHORT => Some((0, u16::MAX as i64)),
        Types::UNSIGNED => Some((0, u32::MAX as i64)),
        _ => None,
    }
}

/// The result of a comparison that is the same for every value of a range.
fn decided(op: CompareOp, least: i64, most: i64, number: i64) -> Option<bool> {
    let is_outside = number < least || number > most;
    match op {
        CompareOp::Equal => is_outside.then_some(false),
        CompareOp::NotEqual => is_outside.then_some(true),
        CompareOp::Less => always(most < number, least >= number),
        CompareOp::LessEqual => always(most <= number, least > number),
        CompareOp::Greater => always(least > number, most <= number),
        CompareOp::GreaterEqual => always(least >= number, most < number),
    }
}

fn always(is_true: bool, is_false: bool) -> Option<bool> {
    (is_true || is_false).then_some(is_true)
}
