//! `#define MM(x) x * 200` used as `MM(a + b)`, and `#define SUM a + b` used as `2 * SUM`: an operator of the
//! surrounding text takes a part of an expression that was meant as one value.
//!
//! The tree shows this: an operator has operands from both texts, and the tree above it continues with one of them.

use crate::ast::{Expression, ExpressionKind, UnaryOperator};
use crate::diag::{Diagnostic, Lint};
use crate::operators::BinaryOperator;
use crate::source::{Expansion, ExpansionId, SourceMap, Span};

/// The message for `left operator right` if one side is torn out of a macro or of an argument of one.
pub(crate) fn finding(
    sources: &SourceMap,
    operator: BinaryOperator,
    left: &Expression,
    right: &Expression,
) -> Option<Diagnostic> {
    torn(sources, operator, left, right, Side::Left)
        .or_else(|| torn(sources, operator, left, right, Side::Right))
}

/// The side of an operator.
#[derive(Clone, Copy, PartialEq)]
enum Side {
    Left,
    Right,
}

/// Judges the operator on one side of `operator`.
fn torn(
    sources: &SourceMap,
    operator: BinaryOperator,
    left: &Expression,
    right: &Expression,
    side: Side,
) -> Option<Diagnostic> {
    // In `far op near operator beyond` or its mirror, `op` has taken `near` from `beyond`.
    let (inner, beyond) = match side {
        Side::Left => (left, first(right)),
        Side::Right => (right, last(left)),
    };
    let part = Part::of(inner, side)?;
    if part.is_harmless(operator) {
        return None;
    }
    let (far, near) = (part.far, part.near);
    expansions(sources, far)
        .find_map(|id| {
            let expansion = sources.expansion(id)?;
            let is_argument = |span| is_inside(sources, span, expansion);
            (is_argument(near) && is_argument(beyond))
                .then(|| argument(sources, expansion, part.spelling, operator))
        })
        .or_else(|| {
            expansions(sources, near).find_map(|id| {
                let expansion = sources.expansion(id)?;
                let is_of_body = |span: Span| expansions(sources, span).any(|other| other == id);
                let is_torn = is_of_body(beyond) && !is_of_body(far) && !is_inside(sources, far, expansion);
                is_torn.then(|| body(sources, expansion, part.spelling, operator))
            })
        })
}

/// An operator with its own operand and the operand that it may have taken.
struct Part {
    /// The operator as written; a cast without its type.
    spelling: &'static str,
    /// Its precedence.
    binding: u8,
    /// The operand, or the operator itself, away from the tree above.
    far: Span,
    /// The operand next to the tree above.
    near: Span,
    /// True for `-`, `/` and `%`, and for casts: their right side cannot be regrouped freely.
    is_strict: bool,
}

impl Part {
    fn of(expression: &Expression, side: Side) -> Option<Self> {
        const UNARY: u8 = 13;
        if let ExpressionKind::Cast(_, operand) = &expression.kind {
            let (far, near) = (expression.span, last(operand));
            return (side == Side::Left).then_some(Self {
                spelling: "(…)",
                binding: UNARY,
                far,
                near,
                is_strict: true,
            });
        }
        if let ExpressionKind::Unary(UnaryOperator::Minus, operand) = &expression.kind {
            // -a * b is the same as -(a * b).
            let (far, near) = (expression.span, last(operand));
            let binding = BinaryOperator::Subtract.binding();
            return (side == Side::Left).then_some(Self {
                spelling: "-",
                binding,
                far,
                near,
                is_strict: true,
            });
        }
        let ExpressionKind::Binary(operator, a, b) = &expression.kind else { return None };
        if is_parenthesized(expression, a) {
            return None;
        }
        let (far, near) = match side {
            Side::Left => (last(a), last(b)),
            Side::Right => (first(b), first(a)),
        };
        let is_strict = side == Side::Left
            && matches!(
                operator,
                BinaryOperator::Subtract | BinaryOperator::Divide | BinaryOperator::Remainder
            );
        Some(Self { spelling: operator.spelling(), binding: operator.binding(), far, near, is_strict })
    }

    /// Reports whether parentheses around the torn value would not change the result.
    fn is_harmless(&self, above: BinaryOperator) -> bool {
        self.binding < above.binding() || (self.binding == above.binding() && !self.is_strict)
    }
}

fn argument(sources: &SourceMap, expansion: &Expansion, taken: &str, operator: BinaryOperator) -> Diagnostic {
    let name = sources.macro_name(expansion);
    let operator = operator.spelling();
    let message =
        format!("the `{taken}` in the macro `{name}` is computed before the `{operator}` in its argument");
    // A macro of the board's header cannot be mended.
    let file = sources.file_at(expansion.definition.lo).map(|file| sources.file(file));
    let help = match file.is_some_and(|file| file.path.is_none()) {
        true => "write parentheses around the argument",
        false => "write parentheses around each parameter in the macro: `#define M(x) ((x) * 2)`",
    };
    Diagnostic::warning(Lint::MacroParentheses, expansion.call, message)
        .at("only a part of the argument is meant by it")
        .label(expansion.definition, "parameters without parentheses")
        .help(help)
}

fn body(sources: &SourceMap, expansion: &Expansion, taken: &str, operator: BinaryOperator) -> Diagnostic {
    let name = sources.macro_name(expansion);
    let operator = operator.spelling();
    let message =
        format!("the `{taken}` beside the macro `{name}` is computed before the `{operator}` in it");
    Diagnostic::warning(Lint::MacroParentheses, expansion.call, message)
        .at("only a part of the macro belongs to it")
        .label(expansion.definition, "a body without parentheses")
        .help("write parentheses around the body of the macro: `#define M (a + b)`")
}

/// The expansions from which a token comes, the innermost first.
fn expansions(sources: &SourceMap, span: Span) -> impl Iterator<Item = ExpansionId> {
    let next = |id: &ExpansionId| sources.expansion(*id).map(|expansion| expansion.call.expansion);
    std::iter::successors(Some(span.expansion), next).take_while(|id| *id != ExpansionId::NONE)
}

/// Reports whether a token is written in the call of a macro.
fn is_inside(sources: &SourceMap, mut span: Span, expansion: &Expansion) -> bool {
    let call = expansion.call;
    while span.expansion != call.expansion {
        let Some(outer) = sources.expansion(span.expansion) else { return false };
        if std::ptr::eq(outer, expansion) {
            return false;
        }
        span = outer.call;
    }
    call.lo <= span.lo && span.hi <= call.hi
}

/// Reports whether parentheses are around an operator, whose span then begins before its left side.
fn is_parenthesized(expression: &Expression, left: &Expression) -> bool {
    (expression.span.lo, expression.span.expansion) != (left.span.lo, left.span.expansion)
}

/// The first token of an expression.
fn first(expression: &Expression) -> Span {
    let span = expression.span;
    Span { hi: span.lo, ..span }
}

/// The last operand of an expression.
fn last(expression: &Expression) -> Span {
    match &expression.kind {
        ExpressionKind::Binary(_, left, right) if !is_parenthesized(expression, left) => last(right),
        ExpressionKind::Unary(_, operand) | ExpressionKind::Cast(_, operand)
            if operand.span.expansion != expression.span.expansion =>
        {
            last(operand)
        }
        _ => expression.span,
    }
}
