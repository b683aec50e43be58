//! `a = b; b = a;`: a swap without a third variable loses the first value.

use super::program::{AnalysedProgram, PERSIST};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Definition, ExprId, ExprKind, Function, PlaceId, PlaceKind, Stmt, StmtKind};

/// Reports an assignment that stores a value back where the assignment before it has read it.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        function.each_list(&mut |stmts| {
            for pair in stmts.windows(2) {
                if let [Stmt { kind: StmtKind::Expr(first), .. }, Stmt { kind: StmtKind::Expr(second), .. }] =
                    pair
                {
                    sink.report_if(finding(program, function, *first, *second));
                }
            }
        });
    }
}

fn finding(
    program: &AnalysedProgram<'_>,
    function: &Function,
    first: ExprId,
    second: ExprId,
) -> Option<Diagnostic> {
    let (to, from) = copy(program, function, first)?;
    let (back, again) = copy(program, function, second)?;
    if to == from || back != from || again != to {
        return None;
    }
    let [first, second] = [first, second].map(|expr| function.exprs[expr].span);
    let message = format!("`{from}` gets its own value back: the value of `{to}` is lost");
    Some(
        Diagnostic::warning(Lint::LostSwap, second, message)
            .at("stores the value that it has")
            .label(first, format!("`{to}` is overwritten here"))
            .help("to swap them, keep the first value in a third variable"),
    )
}

/// The target and the source of an assignment of one variable or element to another, as spelled.
fn copy(program: &AnalysedProgram<'_>, function: &Function, expr: ExprId) -> Option<(String, String)> {
    let ExprKind::Assign(to, value) = function.exprs[expr].kind else { return None };
    let ExprKind::Load(from) = function.exprs[function.unconverted(value)].kind else { return None };
    Some((variable(program, function, to)?, variable(program, function, from)?))
}

/// The spelling of a place that only programs change; the servo changes the fields of an axis.
fn variable(program: &AnalysedProgram<'_>, function: &Function, place: PlaceId) -> Option<String> {
    let text = String::from_utf8_lossy(program.sources.text(function.places[place].span));
    let text: String = text.chars().filter(|character| !character.is_whitespace()).collect();
    let is_kept = match function.places[place].kind {
        PlaceKind::Local(..) => true,
        PlaceKind::Symbol(symbol, _) => {
            let symbol = &program.unit.symbols[symbol];
            matches!(symbol.definition, Definition::Tentative | Definition::Data(_)) || symbol.name == PERSIST
        }
        // An element of an array, by an index without effects.
        PlaceKind::Pointer(..) => {
            text.ends_with(']') && !text.contains(['(', '=']) && !text.contains("++") && !text.contains("--")
        }
        PlaceKind::Bits(..) => false,
    };
    is_kept.then_some(text)
}
