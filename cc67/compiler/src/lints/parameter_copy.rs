//! `void swap(int a, int b) { int t = a; a = b; b = t; }`: a function that changes only its own copies, and
//! `void Probe(double edge) { …; edge = ch0->Position; }`: a result that stays in one.

use std::collections::{BTreeMap, BTreeSet};

use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{ExprKind, Function, LocalId, PlaceId, PlaceKind, StmtKind};

/// Reports functions that store in their parameters and do nothing else, and values that are stored in a parameter which
/// nothing reads.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        let Some(changed) = changed(function) else {
            lost(program, function, sink);
            continue;
        };
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

/// Reports the parameters that a function stores in and never reads.
fn lost(program: &AnalysedProgram<'_>, function: &Function, sink: &mut Sink) {
    // A parameter and the byte of it, for the members of a structure.
    let parameter = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Local(local, byte) => function.parameters.contains(&local).then_some((local, byte)),
        _ => None,
    };
    let (mut stored, mut read, mut whole) = (BTreeMap::new(), BTreeSet::new(), BTreeSet::new());
    for expr in function.exprs.values() {
        match &expr.kind {
            ExprKind::Assign(place, _) => {
                stored.extend(parameter(*place).map(|part| (part, (expr.span, *place))));
            }
            ExprKind::Update(update) => read.extend(parameter(update.place)),
            ExprKind::Load(place) => read.extend(parameter(*place)),
            ExprKind::Address(place) | ExprKind::Copy { from: place, .. } => {
                whole.extend(parameter(*place).map(|(local, _)| local));
            }
            _ => {}
        }
    }
    stored.retain(|part, _| !read.contains(part) && !whole.contains(&part.0));
    for ((local, _), (span, place)) in stored {
        let local = &function.locals[local];
        let (name, ty) = (&local.name, program.spell(local.ty));
        let message = format!(
            "`{name}` is a copy of the caller's value: what is stored in it stays in `{}`",
            program.name(function.symbol)
        );
        let is_member = function.places[place].ty != local.ty;
        let finding = Diagnostic::warning(Lint::ParameterCopy, span, message)
            .at("nothing reads the copy")
            .label(local.span, "arguments are copied in a call");
        sink.report(if program.unit.types.is_pointer(local.ty) {
            finding.help(format!("`*{name}` is what it points to"))
        } else if is_member {
            finding.help(format!(
                "take the address, `{ty} *{name}`, write `{name}->`, and call with `&` before the variable"
            ))
        } else {
            finding.help(format!(
                "take the address, `{ty} *{name}`, store in `*{name}`, and call with `&` before the variable"
            ))
        });
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
