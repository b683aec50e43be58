//! Operators that take less than it seems: `a & b == c`, `a < b < c`, `!a == 3`, `a + b + c / 3`.

use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::{Diagnostic, Lint};
use crate::operators::{BinaryOperator, CompareOp, OperatorMeaning};

/// The finding in a condition; its parts, combined, compared or negated, are checked one by one.
pub(crate) fn finding(condition: &Expression) -> Option<Diagnostic> {
    let (operator, left, right) = match &condition.kind {
        ExpressionKind::Unary(UnaryOperator::Not, operand) => return finding(operand),
        ExpressionKind::Binary(operator, left, right) => (operator, left, right),
        _ => return None,
    };
    match operator.meaning() {
        OperatorMeaning::Logical(_) => finding(left).or_else(|| finding(right)),
        OperatorMeaning::Compare(_) => {
            chain(condition, *operator, left, right).or_else(|| finding(left)).or_else(|| finding(right))
        }
        OperatorMeaning::Bitwise(_) => mask(*operator, left, right),
        OperatorMeaning::Arithmetic(_) | OperatorMeaning::Shift(_) => None,
    }
}

/// `a + b + c / 3`: a sum of terms of one kind, of which only the last is divided by their number.
pub(crate) fn mean(sum: &Expression) -> Option<Diagnostic> {
    const LEAST: usize = 3;
    let (mut rest, last) = plain(sum, BinaryOperator::Add)?;
    let (last, number) = plain(last, BinaryOperator::Divide)?;
    let mut terms = vec![last];
    while let Some((before, term)) = plain(rest, BinaryOperator::Add) {
        terms.push(term);
        rest = before;
    }
    terms.push(rest);
    let count = match &number.kind {
        ExpressionKind::Integer(literal) => literal.value as f64,
        ExpressionKind::Floating(literal) => literal.value,
        _ => return None,
    };
    let is_mean = terms.len() >= LEAST && terms.len() as f64 == count;
    (is_mean && terms.iter().all(|term| is_like(term, last))).then(|| {
        Diagnostic::warning(
            Lint::Precedence,
            sum.span,
            format!("only the last of these {count} terms is divided by {count}"),
        )
        .label(last.span.to(number.span), "computed before the sum")
        .help(format!("for a mean, write the sum in parentheses: `( … ) / {count}`"))
    })
}

/// The sides of an operator that no parentheses are around.
fn plain(expression: &Expression, wanted: BinaryOperator) -> Option<(&Expression, &Expression)> {
    match &expression.kind {
        ExpressionKind::Binary(operator, left, right) if *operator == wanted => {
            (expression.span.lo == left.span.lo).then_some((left, right))
        }
        _ => None,
    }
}

/// Reports whether two terms are values of one kind: variables, elements of one array, results of one function, or the
/// same member of two structures.
fn is_like(term: &Expression, other: &Expression) -> bool {
    match (&term.kind, &other.kind) {
        (ExpressionKind::Identifier(_), ExpressionKind::Identifier(_)) => true,
        (ExpressionKind::Index(a, _), ExpressionKind::Index(b, _))
        | (ExpressionKind::Call(a, _), ExpressionKind::Call(b, _)) => is_same(a, b),
        (ExpressionKind::Member { member: a, .. }, ExpressionKind::Member { member: b, .. }) => a == b,
        _ => false,
    }
}

/// Reports whether two expressions are the same name, or members of that name.
fn is_same(a: &Expression, b: &Expression) -> bool {
    match (&a.kind, &b.kind) {
        (ExpressionKind::Identifier(a), ExpressionKind::Identifier(b)) => a == b,
        (ExpressionKind::Member { member: a, .. }, ExpressionKind::Member { member: b, .. }) => a == b,
        _ => false,
    }
}

/// `a & b == c`
fn mask(operator: BinaryOperator, left: &Expression, right: &Expression) -> Option<Diagnostic> {
    if operator == BinaryOperator::And && is_negated(left) && is_large(right) {
        return Some(
            Diagnostic::warning(Lint::Precedence, left.span, "`!` is computed before `&`")
                .at("this is 0 or 1, so the mask always gives 0")
                .help("write `!(a & b)`"),
        );
    }
    let (found, compare) = match (comparison(left), comparison(right)) {
        (None, Some(compare)) if !is_truth(left) => (right, compare),
        (Some(compare), None) if !is_truth(right) => (left, compare),
        _ => return None,
    };
    // `a & b == 1` has the same value if both are 0 or 1.
    if matches!(compare.meaning(), OperatorMeaning::Compare(CompareOp::Equal)) && is_one(found) {
        return None;
    }
    let spelling = compare.spelling();
    let operator = operator.spelling();
    let message = format!("`{spelling}` is computed before `{operator}`");
    Some(
        Diagnostic::warning(Lint::Precedence, found.span, message)
            .at("this is 0 or 1")
            .help(format!("write the `{operator}` in parentheses: `(a {operator} b) {spelling} c`")),
    )
}

/// `a < b < c`, `!a == 3`
fn chain(
    condition: &Expression,
    operator: BinaryOperator,
    left: &Expression,
    right: &Expression,
) -> Option<Diagnostic> {
    let spelling = operator.spelling();
    let help = if comparison(left).is_some_and(is_relation) && is_relation(operator) {
        format!("write both comparisons: `a {spelling} b && b {spelling} c`")
    } else if is_negated(left) && is_large(right) {
        "write `!=` in place of `==`, or `!( … )` around the comparison".to_owned()
    } else {
        return None;
    };
    Some(
        Diagnostic::warning(Lint::Precedence, condition.span, format!("`{spelling}` compares a 0 or 1 here"))
            .at(format!("what is before `{spelling}` is computed first"))
            .help(help),
    )
}

/// The operator of a comparison without parentheses around it, which its span would include.
fn comparison(expression: &Expression) -> Option<BinaryOperator> {
    match &expression.kind {
        ExpressionKind::Binary(operator, left, _) => {
            let is_comparison = matches!(operator.meaning(), OperatorMeaning::Compare(_));
            (is_comparison && expression.span.lo == left.span.lo).then_some(*operator)
        }
        _ => None,
    }
}

fn is_relation(operator: BinaryOperator) -> bool {
    let OperatorMeaning::Compare(compare) = operator.meaning() else { return false };
    !matches!(compare, CompareOp::Equal | CompareOp::NotEqual)
}

/// Reports whether a value is 0 or 1 by its form.
fn is_truth(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Unary(UnaryOperator::Not, _) => true,
        ExpressionKind::Binary(operator, ..) => {
            matches!(operator.meaning(), OperatorMeaning::Compare(_) | OperatorMeaning::Logical(_))
        }
        _ => false,
    }
}

/// A `!` that no parentheses are around.
fn is_negated(expression: &Expression) -> bool {
    match &expression.kind {
        ExpressionKind::Unary(UnaryOperator::Not, operand) => operand.span.lo > expression.span.lo,
        _ => false,
    }
}

/// A constant that no `!` gives.
fn is_large(expression: &Expression) -> bool {
    matches!(&expression.kind, ExpressionKind::Integer(literal) if literal.value > 1)
}

/// Reports whether a comparison is one with 1.
fn is_one(comparison: &Expression) -> bool {
    let ExpressionKind::Binary(_, _, right) = &comparison.kind else { return false };
    matches!(&right.kind, ExpressionKind::Integer(literal) if literal.value == 1)
}
