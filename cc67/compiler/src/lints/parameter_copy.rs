//! `void swap(int a, int b) { int t = a; a = b; b = t; }`: a function that changes only its own copies.

use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{ExprKind, Function, LocalId, PlaceKind, StmtKind};

/// Reports functions that store in their parameters and do nothing else.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        let Some(changed) = changed(function) else { continue };
        let spelled: Vec<_> =
            changed.iter().map(|local| format!("`{}`", function.locals[*local].name)).collect();
        let names = match spelled.split_last() {
            Some((last, before)) if !before.is_empty() => format!("{} and {last}", before.join(", ")),
            _ => spelled.concat(),
        };
        let name = program.name(function.symbol);
        let message = format!("`{name}` has no effect: it changes only its own copies of {names}");
        let first = &function.locals[changed[0]];
        let help = if program.unit.types.is_pointer(first.ty) {
            format!("`*{}` is what it points to", first.name)
        } else {
            let star = format!("{} *{}", program.spell(first.ty), first.name);
            format!(
                "take addresses, as in `{star}`, store in `*{}`, and call it with `&` before the variables",
                first.name
            )
        };
        sink.report(
            Diagnostic::warning(Lint::ParameterCopy, function.span, message)
                .at("arguments are copied in a call")
                .help(help),
        );
    }
}

/// The parameters in which a function stores, if it does nothing else.
fn changed(function: &Function) -> Option<Vec<LocalId>> {
    let mut is_idle = true;
    function.each_stmt(&mut |stmt| {
        is_idle &= match stmt.kind {
            // A loop may be there to take time.
            StmtKind::Loop { .. }
            | StmtKind::Return(Some(_))
            | StmtKind::Goto(_)
            | StmtKind::GotoAddress(_) => false,
            // `*p++;` is `unused-value`.
            StmtKind::Expr(expr) => !matches!(function.exprs[expr].kind, ExprKind::Load(_)),
            _ => true,
        };
    });
    let mut changed = Vec::new();
    Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
        let place = match &function.exprs[expr].kind {
            ExprKind::Assign(place, _) => *place,
            ExprKind::Update(update) => update.place,
            ExprKind::Call(_) | ExprKind::Copy { .. } | ExprKind::Statements(..) => return is_idle = false,
            _ => return,
        };
        match function.places[place].kind {
            PlaceKind::Local(local, _) if function.parameters.contains(&local) => {
                if !changed.contains(&local) {
                    changed.push(local);
                }
            }
            PlaceKind::Local(..) => {}
            PlaceKind::Symbol(..) | PlaceKind::Pointer(..) | PlaceKind::Bits(..) => is_idle = false,
        }
    });
    (is_idle && !changed.is_empty()).then_some(changed)
}
