//! `int state = 5;` in a function, where the global `state` is meant.
//!
//! A local that is read as well has a use of its own, and often a short name.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Definition, ExprKind, LocalId, PlaceKind};

/// Reports locals that have the name of a global of the program and are only assigned.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        let local = |place| match function.places[place].kind {
            PlaceKind::Local(local, _) => Some(local),
            _ => None,
        };
        let (mut stored, mut read): (BTreeSet<LocalId>, BTreeSet<LocalId>) = Default::default();
        for expr in function.exprs.values() {
            match &expr.kind {
                ExprKind::Assign(place, _) => stored.extend(local(*place)),
                ExprKind::Update(update) => read.extend(local(update.place)),
                ExprKind::Load(place) | ExprKind::Address(place) => read.extend(local(*place)),
                _ => {}
            }
        }
        for id in stored.difference(&read) {
            let entry = &function.locals[*id];
            let global = program
                .symbol(&entry.name)
                .map(|symbol| &program.unit.symbols[symbol])
                .filter(|global| matches!(global.definition, Definition::Tentative | Definition::Data(_)));
            let Some(global) = global.filter(|_| !entry.in_memory && !function.parameters.contains(id))
            else {
                continue;
            };
            let message = format!("this `{0}` shadows the global `{0}`", entry.name);
            sink.report(
                Diagnostic::warning(Lint::Shadow, entry.span, message)
                    .at("it is assigned, but never read")
                    .label(global.span, "the global")
                    .help("leave out the type to assign to the global"),
            );
        }
    }
}
