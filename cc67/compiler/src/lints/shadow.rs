//! `int state = 5;` in a function, where the global `state` is meant.
//!
//! A local that is read as well has a use of its own, and often a short name; unless other functions read the global, which
//! then nothing sets.

use std::collections::BTreeSet;

use super::changes::{Changes, symbol};
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{Definition, ExprKind, Function, LocalId, PlaceId, PlaceKind, SymbolId};

/// Reports locals that have the name of a global of the program and are only assigned, or hide one that is read and that
/// nothing sets.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let changes = Changes::of(program);
    for function in program.whole_functions() {
        outer_locals(function, sink);
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
        for id in stored {
            let entry = &function.locals[id];
            let symbol = program.symbol(&entry.name).filter(|symbol| {
                let global = &program.unit.symbols[*symbol];
                matches!(global.definition, Definition::Tentative | Definition::Data(_))
            });
            let Some(symbol) = symbol.filter(|_| !entry.in_memory && !function.parameters.contains(&id))
            else {
                continue;
            };
            let global = program.unit.symbols[symbol].span;
            let message = format!("this `{0}` shadows the global `{0}`", entry.name);
            let finding = Diagnostic::warning(Lint::Shadow, entry.span, message);
            let finding = match read.contains(&id) {
                false => finding.at("it is assigned, but never read").label(global, "the global"),
                true => {
                    let Some(use_of) = use_of_zero(program, &changes, symbol) else { continue };
                    finding
                        .at("the values that are stored in it are not in the global")
                        .label(use_of, "the global is read here")
                        .label(global, "nothing sets it: it stays 0")
                }
            };
            sink.report(finding.help("leave out the type to assign to the global"));
        }
    }
}

/// Reports locals of an inner block that hide one of an outer block which keeps its constant first value and is read.
fn outer_locals(function: &Function, sink: &mut Sink) {
    let place = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Local(local, _) => Some(local),
        _ => None,
    };
    for (id, inner) in &function.locals {
        let outer = function
            .locals
            .iter()
            .find(|(other, outer)| *other != id && outer.name == inner.name && outer.span.lo < inner.span.lo);
        let Some((outer_id, outer)) = outer.filter(|_| !inner.name.is_empty()) else { continue };
        if function.parameters.contains(&outer_id) {
            continue;
        }
        let (mut is_stored, mut is_constant, mut read) = (false, true, None);
        for expr in function.exprs.values() {
            match &expr.kind {
                ExprKind::Assign(stored, value) if place(*stored) == Some(outer_id) => {
                    let is_first = expr.span.lo < inner.span.lo;
                    let value = &function.exprs[*value].kind;
                    is_constant &= is_first && matches!(value, ExprKind::Int(_) | ExprKind::Float(_));
                }
                // A counter has a use of its own.
                ExprKind::Assign(stored, value) => {
                    let is_constant =
                        matches!(function.exprs[*value].kind, ExprKind::Int(_) | ExprKind::Float(_));
                    is_stored |= place(*stored) == Some(id) && !is_constant;
                }
                ExprKind::Update(update) => is_constant &= place(update.place) != Some(outer_id),
                ExprKind::Address(taken) => is_constant &= place(*taken) != Some(outer_id),
                ExprKind::Load(loaded) if place(*loaded) == Some(outer_id) => {
                    read.get_or_insert(expr.span);
                }
                _ => {}
            }
        }
        let Some(read) = read.filter(|_| is_stored && is_constant && !outer.in_memory) else { continue };
        let message = format!("this `{0}` shadows the `{0}` of the block around it", inner.name);
        sink.report(
            Diagnostic::warning(Lint::Shadow, inner.span, message)
                .at("the values that are stored in it stay in its block")
                .label(outer.span, "this one keeps its first value")
                .label(read, "it is read here")
                .help("leave out the type to assign to the outer one"),
        );
    }
}

/// A read of a global that nothing sets, so that it stays 0.
fn use_of_zero(program: &AnalysedProgram<'_>, changes: &Changes, wanted: SymbolId) -> Option<Span> {
    let entry = &program.unit.symbols[wanted];
    let is_zero = match &entry.definition {
        Definition::Tentative => true,
        // An integer may be the number of something, such as an axis.
        Definition::Data(data) => entry.ty.is_floating() && data.bytes.iter().all(|byte| *byte == 0),
        Definition::None | Definition::Function => false,
    };
    if !is_zero || changes.set.contains(&wanted) || changes.counted.contains(&wanted) {
        return None;
    }
    program.functions().find_map(|function| {
        function.exprs.values().find_map(|expr| match expr.kind {
            ExprKind::Load(place) if symbol(function, place) == Some(wanted) => Some(expr.span),
            _ => None,
        })
    })
}
