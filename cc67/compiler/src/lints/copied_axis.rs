//! `ch1->Vel = …; ch0->Accel = …; ch1->Jerk = …;`: one line of a copied block still names the original axis.
//!
//! The block never sets that field of its own axis, so the line is not one of an intentional pair.

use super::program::{AnalysedProgram, AxisField};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{ExprKind, Function, Stmt, StmtKind};

/// A field of an axis that a statement sets.
#[derive(Clone, Copy)]
struct Setting {
    axis: u32,
    field: u32,
    /// The range of the assignment, and of its target.
    span: Span,
    place: Span,
}

/// The number of assignments to one axis that form a block.
const BLOCK: usize = 3;

/// Reports single assignments to another axis in blocks that set up one.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let mut all = Vec::new();
        function.each_stmt(&mut |stmt| all.extend(setting(program, function, stmt)));
        block(program, function, &function.body, &all, sink);
        function.each_stmt(&mut |stmt| match &stmt.kind {
            StmtKind::Block(body) | StmtKind::Loop { body, .. } | StmtKind::Switch { body, .. } => {
                block(program, function, body, &all, sink);
            }
            StmtKind::If { then, otherwise, .. } => {
                block(program, function, then, &all, sink);
                block(program, function, otherwise, &all, sink);
            }
            _ => {}
        });
    }
}

fn block(
    program: &AnalysedProgram<'_>,
    function: &Function,
    stmts: &[Stmt],
    all: &[Setting],
    sink: &mut Sink,
) {
    let settings: Vec<_> = stmts.iter().map(|stmt| setting(program, function, stmt)).collect();
    for run in settings.split(Option::is_none) {
        let run: Vec<_> = run.iter().flatten().copied().collect();
        for (before, rest) in (1..run.len()).map(|at| run.split_at(at)) {
            let (Some(previous), [odd, after @ ..]) = (before.last(), rest) else { continue };
            let axis = previous.axis;
            let own = [before, after].concat();
            // More than one line in a row may name the old axis, but not a block.
            let others = after.iter().take_while(|next| next.axis == odd.axis).count();
            let next = after.get(others);
            if others + 1 >= BLOCK {
                continue;
            }
            // At the end of a block, the field is set a second time, or another block begins.
            let is_inside = next.is_some_and(|next| next.axis == axis);
            let is_repeated = || {
                next.is_none()
                    && all
                        .iter()
                        .any(|it| it.axis == odd.axis && it.field == odd.field && it.span.lo < odd.span.lo)
            };
            let is_odd = odd.axis != axis && (is_inside || is_repeated());
            let is_missing = || !all.iter().any(|it| it.axis == axis && it.field == odd.field);
            if is_odd && own.iter().filter(|it| it.axis == axis).count() >= BLOCK && is_missing() {
                let written = String::from_utf8_lossy(program.sources.text(odd.place));
                sink.report_if(finding(*odd, axis, previous.span, &written));
            }
        }
    }
}

fn finding(odd: Setting, axis: u32, previous: Span, written: &str) -> Option<Diagnostic> {
    let other = odd.axis.to_string();
    let (head, field) = written.split_once("->").or_else(|| written.split_once('.'))?;
    let mark = written.get(head.len()..written.len() - field.len())?;
    let own = format!("{}{mark}{field}", head.replace(&other, &axis.to_string()));
    let message = format!("`{written}` is set among the settings of axis {axis}");
    Some(
        Diagnostic::warning(Lint::CopiedAxis, odd.span, message)
            .at(format!("`{own}` is never set"))
            .label(previous, format!("axis {axis}"))
            .help(format!("write `{own}` if the line was copied from axis {other}")),
    )
}

/// The field of an axis that is assigned by a statement.
fn setting(program: &AnalysedProgram<'_>, function: &Function, stmt: &Stmt) -> Option<Setting> {
    let StmtKind::Expr(expr) = stmt.kind else { return None };
    let ExprKind::Assign(place, _) = function.exprs[expr].kind else { return None };
    let span = function.exprs[expr].span;
    let AxisField { axis, field } = program.axis_field(function, place)?;
    Some(Setting { axis, field, span, place: function.places[place].span })
}
