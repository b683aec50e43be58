//! `part = done / total` with integers: the quotient has lost its fraction before it becomes a floating-point number.
//!
//! Divisions of constants are found where they are folded. A program that also takes the remainder of the same number,
//! or multiplies by the divisor again, intends whole numbers.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::BinaryOp;
use crate::typed::{ExprId, ExprKind, Function, UnaryOp};

/// Reports quotients of integers that become floating-point numbers.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let search = Search { program, function, split: split(program, function) };
        let mut reported = BTreeSet::new();
        for expr in function.exprs.values() {
            let ExprKind::Convert(inner) = expr.kind else { continue };
            if !expr.ty.is_floating() || !function.exprs[inner].ty.is_integer() {
                continue;
            }
            if let Some(division) = search.division(inner)
                && reported.insert(function.exprs[division].span)
            {
                sink.report(finding(program, function, division, &program.spell(expr.ty)));
            }
        }
    }
}

/// The message for a division whose quotient is converted to the type `to`.
fn finding(program: &AnalysedProgram<'_>, function: &Function, division: ExprId, to: &str) -> Diagnostic {
    let division = &function.exprs[division];
    let text = String::from_utf8_lossy(program.sources.text(division.span)).into_owned();
    let message = format!("this division of integers drops the fraction before the result becomes a `{to}`");
    let help = if text.contains(['\n', '(']) {
        format!("write `({to})` before the first number")
    } else {
        format!("write `({to}){text}`")
    };
    Diagnostic::warning(Lint::IntegerDivision, division.span, message)
        .at(format!("computed as `{}`", program.spell(division.ty)))
        .help(format!("{help}; where whole numbers are meant, store the quotient in an `int` first"))
}

struct Search<'a> {
    program: &'a AnalysedProgram<'a>,
    function: &'a Function,
    /// The numbers that are divided into a quotient and a remainder, as written.
    split: BTreeSet<&'a [u8]>,
}

impl Search<'_> {
    /// The division by which a value has lost its fraction.
    fn division(&self, value: ExprId) -> Option<ExprId> {
        match self.function.exprs[value].kind {
            ExprKind::Binary(BinaryOp::Divide, a, b) => self.is_cut(a, b).then_some(value),
            ExprKind::Binary(BinaryOp::Multiply, a, b) if self.is_rounding(a, b) => None,
            ExprKind::Binary(BinaryOp::Add | BinaryOp::Subtract | BinaryOp::Multiply, a, b)
            | ExprKind::Conditional(_, a, b) => self.division(a).or_else(|| self.division(b)),
            ExprKind::Unary(UnaryOp::Negate, inner) => self.division(inner),
            ExprKind::Convert(inner) if self.function.exprs[inner].ty.is_integer() => self.division(inner),
            _ => None,
        }
    }

    /// Reports whether a quotient may lose a fraction that was not to be dropped.
    fn is_cut(&self, dividend: ExprId, divisor: ExprId) -> bool {
        let int = |expr| as_int(self.function, expr);
        let is_multiple = match (&self.function.exprs[dividend].kind, int(divisor)) {
            (_, Some(1 | -1)) => true,
            (ExprKind::Binary(BinaryOp::Multiply, a, b), Some(divisor)) => {
                let has = |factor: &ExprId| {
                    int(*factor).is_some_and(|factor| factor.checked_rem(divisor) == Some(0))
                };
                has(a) || has(b)
            }
            _ => false,
        };
        !is_multiple && !self.split.contains(unsigned(text(self.program, self.function, dividend)))
    }

    /// `a / b * b`
    fn is_rounding(&self, a: ExprId, b: ExprId) -> bool {
        let text = |expr| text(self.program, self.function, expr);
        let is_divisor = |division, factor| {
            matches!(self.function.exprs[division].kind, ExprKind::Binary(BinaryOp::Divide, _, divisor)
                if text(divisor) == text(factor))
        };
        is_divisor(a, b) || is_divisor(b, a)
    }
}

/// The dividends of every remainder in a function.
fn split<'a>(program: &'a AnalysedProgram<'_>, function: &Function) -> BTreeSet<&'a [u8]> {
    let dividends = function.exprs.values().filter_map(|expr| match expr.kind {
        ExprKind::Binary(BinaryOp::Remainder, dividend, _) => Some(dividend),
        _ => None,
    });
    dividends.map(|dividend| unsigned(text(program, function, dividend))).collect()
}

fn text<'a>(program: &'a AnalysedProgram<'_>, function: &Function, expr: ExprId) -> &'a [u8] {
    program.sources.text(function.exprs[expr].span)
}

fn unsigned(text: &[u8]) -> &[u8] {
    text.strip_prefix(b"-").unwrap_or(text)
}

fn as_int(function: &Function, expr: ExprId) -> Option<i64> {
    match function.exprs[expr].kind {
        ExprKind::Int(number) => Some(number),
        _ => None,
    }
}
