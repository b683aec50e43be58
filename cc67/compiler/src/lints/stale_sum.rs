//! `for (…) { for (i = 0; i < 10; i++) sum += …; mean = sum / 10; }`, where `sum` begins at 0 only once.

use super::changes::Changes;
use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::operators::{BinaryOp, CompareOp};
use crate::source::Span;
use crate::typed::{ExprId, ExprKind, Function, PlaceId, PlaceKind, Stmt, StmtKind};

/// The name of the function that runs once.
const MAIN: &str = "main";

/// Reports means whose sum still has the values of earlier means.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let changes = Changes::of(program);
    for function in program.functions() {
        function.each_stmt(&mut |stmt| {
            if let StmtKind::Loop { body, .. } = &stmt.kind {
                let stale =
                    means(function, body).into_iter().filter(|mean| !is_set(function, body, mean.sum));
                stale.for_each(|mean| sink.report(mean.finding(program)));
            }
        });
        if program.name(function.symbol) != MAIN {
            let is_never_set = |mean: &Mean| match mean.sum {
                PlaceKind::Symbol(symbol, 0) => !changes.set.contains(&symbol),
                _ => false,
            };
            let stale = means(function, &function.body).into_iter().filter(is_never_set);
            stale.for_each(|mean| sink.report(mean.finding(program)));
        }
    }
}

/// A sum over a loop with a fixed number of iterations, divided by that number.
struct Mean {
    sum: PlaceKind,
    added: Span,
    divided: Span,
}

impl Mean {
    fn finding(&self, program: &AnalysedProgram<'_>) -> Diagnostic {
        let name = String::from_utf8_lossy(program.sources.text(self.added)).into_owned();
        let message = format!("`{name}` still has its last sum when it is added up for this mean");
        Diagnostic::warning(Lint::StaleSum, self.divided, message)
            .at("from the second time on, too large")
            .label(self.added, format!("nothing sets `{name}` to 0 again before this loop"))
            .help(format!("set `{name} = 0;` before the loop that adds"))
    }
}

/// The means that a list of statements computes.
fn means(function: &Function, stmts: &[Stmt]) -> Vec<Mean> {
    let mut means = Vec::new();
    for (index, stmt) in stmts.iter().enumerate() {
        let Some((count, body)) = counted_loop(function, stmt) else { continue };
        let sums: Vec<PlaceId> = body.iter().flat_map(|stmt| added(function, stmt)).collect();
        if sums.is_empty() {
            continue;
        }
        Walk { function, extent: Extent::All }.stmts(&stmts[index + 1..], &mut |expr| {
            let Some(place) = divided_by(function, expr, count) else { return };
            let kind = function.places[place].kind;
            let sum = sums.iter().find(|sum| function.places[**sum].kind == kind);
            means.extend(sum.map(|sum| Mean {
                sum: kind,
                added: function.places[*sum].span,
                divided: function.exprs[expr].span,
            }));
        });
    }
    means
}

/// The number of iterations of a loop `i < number`, and its body.
fn counted_loop<'f>(function: &Function, stmt: &'f Stmt) -> Option<(i64, &'f [Stmt])> {
    match &stmt.kind {
        StmtKind::Block(inner) => counted_loop(function, inner.last()?),
        StmtKind::Loop { condition: Some(condition), body, .. } => match function.exprs[*condition].kind {
            ExprKind::Compare(CompareOp::Less, _, count) => Some((constant(function, count)?, body)),
            _ => None,
        },
        _ => None,
    }
}

/// The variables to which a statement adds.
fn added(function: &Function, stmt: &Stmt) -> Vec<PlaceId> {
    match &stmt.kind {
        StmtKind::Block(inner) => inner.iter().flat_map(|stmt| added(function, stmt)).collect(),
        StmtKind::Expr(expr) => match &function.exprs[*expr].kind {
            ExprKind::Update(update) if update.op == BinaryOp::Add => vec![update.place],
            ExprKind::Assign(place, value) if adds_to(function, *place, *value) => vec![*place],
            _ => Vec::new(),
        },
        _ => Vec::new(),
    }
}

/// Returns whether a value is the sum of a variable and another value.
fn adds_to(function: &Function, variable: PlaceId, value: ExprId) -> bool {
    let ExprKind::Binary(BinaryOp::Add, a, b) = function.exprs[function.unconverted(value)].kind else {
        return false;
    };
    [a, b].into_iter().any(|part| match function.exprs[function.unconverted(part)].kind {
        ExprKind::Load(place) => function.places[place].kind == function.places[variable].kind,
        _ => false,
    })
}

/// The variable that an expression divides by a number.
fn divided_by(function: &Function, expr: ExprId, number: i64) -> Option<PlaceId> {
    let ExprKind::Binary(BinaryOp::Divide, sum, count) = function.exprs[expr].kind else { return None };
    let ExprKind::Load(place) = function.exprs[function.unconverted(sum)].kind else { return None };
    (constant(function, count)? == number).then_some(place)
}

/// The value of a whole constant.
fn constant(function: &Function, expr: ExprId) -> Option<i64> {
    match function.exprs[function.unconverted(expr)].kind {
        ExprKind::Int(value) => Some(value),
        #[expect(clippy::cast_possible_truncation, reason = "a number with a fraction fails the comparison")]
        ExprKind::Float(value) if (value as i64) as f64 == value => Some(value as i64),
        _ => None,
    }
}

/// Returns whether statements set a variable.
fn is_set(function: &Function, stmts: &[Stmt], variable: PlaceKind) -> bool {
    let mut is_set = false;
    Walk { function, extent: Extent::All }.stmts(stmts, &mut |expr| {
        let set = match function.exprs[expr].kind {
            ExprKind::Assign(place, value) if !adds_to(function, place, value) => place,
            ExprKind::Address(place) => place,
            _ => return,
        };
        is_set |= function.places[set].kind == variable;
    });
    is_set
}
