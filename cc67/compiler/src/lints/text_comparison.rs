//! `text == "abc"`, which compares addresses.

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::ty::Type;
use crate::typed::{ExprId, ExprKind, Function, PlaceId, PlaceKind};

/// An operand that is a text in memory.
#[derive(Clone, Copy, PartialEq)]
enum TextOperand {
    /// Written in quotes.
    Literal,
    /// The name of an array of characters.
    Array,
}

/// Reports comparisons with a text in quotes, and of two arrays of characters.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Compare(_, a, b) = expr.kind else { continue };
            let texts = [text(program, function, a), text(program, function, b)];
            if texts.contains(&Some(TextOperand::Literal)) || texts == [Some(TextOperand::Array); 2] {
                sink.report(
                    Diagnostic::warning(
                        Lint::TextComparison,
                        expr.span,
                        "two addresses are compared, not two texts",
                    )
                    .at("the same every time, whatever the texts contain")
                    .help("`strcmp(a, b) == 0` compares the characters"),
                );
            }
        }
    }
}

fn text(program: &AnalysedProgram<'_>, function: &Function, expr: ExprId) -> Option<TextOperand> {
    let ExprKind::Address(place) = function.exprs[function.unconverted(expr)].kind else { return None };
    match function.places[place].kind {
        PlaceKind::Symbol(symbol, 0) if program.unit.symbols[symbol].is_anonymous() => {
            is_character_array(program, function, place).then_some(TextOperand::Literal)
        }
        PlaceKind::Symbol(_, 0) | PlaceKind::Local(_, 0) => {
            is_character_array(program, function, place).then_some(TextOperand::Array)
        }
        _ => None,
    }
}

/// Reports whether a place is a whole array of characters.
fn is_character_array(program: &AnalysedProgram<'_>, function: &Function, place: PlaceId) -> bool {
    let ty = match function.places[place].kind {
        PlaceKind::Symbol(symbol, _) => program.unit.symbols[symbol].ty,
        PlaceKind::Local(local, _) => function.locals[local].ty,
        PlaceKind::Pointer(..) | PlaceKind::Bits(..) => return false,
    };
    matches!(program.unit.types.get(ty), Type::Array(element, _) if element.ty.is_character())
}
