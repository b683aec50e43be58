//! Statements after `return`, `break`, `continue`, `goto` or an endless loop, and statements before the first `case`.
//!
//! An unreachable jump is not reported: `return x; break;` is a common habit.

use super::missing_return::completes;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::{ExpansionId, Span};
use crate::typed::{Function, Stmt, StmtKind};

/// Reports the first statement of each unreachable block.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        each_block(function, &mut |stmts| sink.report_if(after_jump(program, stmts)));
        function.each_stmt(&mut |stmt| {
            if let StmtKind::Switch { body, .. } = &stmt.kind {
                sink.report_if(before_cases(body));
            }
        });
    }
}

/// Hands over every list of statements of a function.
fn each_block(function: &Function, visit: &mut dyn FnMut(&[Stmt])) {
    visit(&function.body);
    function.each_stmt(&mut |stmt| match &stmt.kind {
        StmtKind::Block(body) | StmtKind::Loop { body, .. } | StmtKind::Switch { body, .. } => visit(body),
        StmtKind::If { then, otherwise, .. } => {
            visit(then);
            visit(otherwise);
        }
        _ => {}
    });
}

fn after_jump(program: &AnalysedProgram<'_>, stmts: &[Stmt]) -> Option<Diagnostic> {
    let [before, stmt] = stmts.array_windows().find(|[before, stmt]| {
        // One macro may hold both.
        let is_written =
            stmt.span.expansion == ExpansionId::NONE || before.span.expansion == ExpansionId::NONE;
        is_written && !completes(before) && !is_jump(stmt) && !has_label(stmt)
    })?;
    let (start, reason) = cause(program, before)?;
    let finding = finding(stmt.span).label(start, reason);
    Some(match break_of_a_switch(before) {
        Some(leaves) => finding
            .label(leaves, "this `break` leaves the `switch`, not the loop")
            .help("to end the loop from inside of the `switch`, set a variable that its condition tests, or `return`"),
        None => finding.help("move it before that, or delete it"),
    })
}

/// The last `break` of a `switch` in an endless loop that no `break` leaves.
fn break_of_a_switch(endless: &Stmt) -> Option<Span> {
    let StmtKind::Loop { body, .. } = &endless.kind else { return None };
    let switch = unwrapped(body).filter_map(|stmt| match &stmt.kind {
        StmtKind::Switch { body, .. } => Some(body),
        _ => None,
    });
    let breaks = switch.flat_map(|body| unwrapped(body)).filter(|stmt| matches!(stmt.kind, StmtKind::Break));
    breaks.map(|stmt| stmt.span).last()
}

/// The statements of a body, with those of its blocks.
fn unwrapped(body: &[Stmt]) -> impl Iterator<Item = &Stmt> {
    body.iter().flat_map(|stmt| match &stmt.kind {
        StmtKind::Block(inner) => inner.as_slice(),
        _ => std::slice::from_ref(stmt),
    })
}

fn finding(span: Span) -> Diagnostic {
    Diagnostic::warning(Lint::UnreachableCode, span, "this statement is never executed")
}

/// The keyword of a statement after which control does not continue, and the reason.
fn cause<'a>(program: &AnalysedProgram<'_>, before: &'a Stmt) -> Option<(Span, &'a str)> {
    let reason = match &before.kind {
        StmtKind::Return(_) => "the function ends here",
        StmtKind::Break => "`break` leaves the loop or `switch` here",
        StmtKind::Continue => "`continue` begins the next iteration here",
        StmtKind::Goto(_) | StmtKind::GotoAddress(_) => "`goto` leaves this place",
        StmtKind::Loop { .. } => "this loop has no end",
        StmtKind::If { .. } | StmtKind::Switch { .. } => "every branch of this ends with a jump",
        StmtKind::Block(inner) => {
            return inner.iter().find(|stmt| !completes(stmt)).and_then(|stmt| cause(program, stmt));
        }
        _ => return None,
    };
    let text = program.sources.text(before.span);
    let word = text.iter().take_while(|byte| byte.is_ascii_alphabetic()).count() as u32;
    let hi = if word == 0 { before.span.hi } else { before.span.lo + word };
    Some((Span { hi, ..before.span }, reason))
}

/// A statement in a `switch` before its first `case`.
fn before_cases(body: &[Stmt]) -> Option<Diagnostic> {
    let first = match body {
        [Stmt { kind: StmtKind::Block(inner), .. }] => inner.first(),
        _ => body.first(),
    }?;
    let is_before = matches!(first.kind, StmtKind::Expr(_) | StmtKind::If { .. } | StmtKind::Loop { .. });
    (is_before && !has_label(first)).then(|| {
        finding(first.span)
            .at("a `switch` goes to a `case` or to `default`")
            .help("move it before the `switch`, or after a `case`")
    })
}

const fn is_jump(stmt: &Stmt) -> bool {
    matches!(
        stmt.kind,
        StmtKind::Return(_)
            | StmtKind::Break
            | StmtKind::Continue
            | StmtKind::Goto(_)
            | StmtKind::GotoAddress(_)
    )
}

/// Returns whether a jump can lead to a statement or into it.
fn has_label(stmt: &Stmt) -> bool {
    match &stmt.kind {
        StmtKind::Case(_) | StmtKind::DefaultCase | StmtKind::Label(_) => true,
        StmtKind::Block(body) | StmtKind::Loop { body, .. } | StmtKind::Switch { body, .. } => {
            let is_switch = matches!(stmt.kind, StmtKind::Switch { .. });
            body.iter().any(|stmt| if is_switch { has_goto_label(stmt) } else { has_label(stmt) })
        }
        StmtKind::If { then, otherwise, .. } => then.iter().chain(otherwise).any(has_label),
        _ => false,
    }
}

/// Returns whether a statement of a `switch` has a label in addition to its cases.
fn has_goto_label(stmt: &Stmt) -> bool {
    !matches!(stmt.kind, StmtKind::Case(_) | StmtKind::DefaultCase) && has_label(stmt)
}
