//! `int state = 5;` in a function, where the global `state` is meant.
//!
//! A local that is read as well has a use of its own, and often a short name; unless other functions read the global, which
//! then nothing sets.

use std::collections::{BTreeMap, BTreeSet};

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

/// The use of a local in its function.
#[derive(Clone, Copy, Default)]
struct LocalUse {
    /// True if something else than a constant is stored.
    has_values: bool,
    /// True if it is changed by adding, or its address is taken.
    is_changed: bool,
    /// The place of the last store in the text.
    last_store: u32,
    /// The last read in the text.
    read: Option<Span>,
}

/// Reports locals of an inner block that hide one of an outer block which keeps its constant first value and is read
/// afterwards.
fn outer_locals(function: &Function, sink: &mut Sink) {
    let mut first: BTreeMap<&str, LocalId> = BTreeMap::new();
    for (id, local) in &function.locals {
        let outer = first.entry(&local.name).or_insert(id);
        if local.span.lo < function.locals[*outer].span.lo {
            *outer = id;
        }
    }
    let hides = |id: LocalId, name: &str| first.get(name).is_some_and(|outer| *outer != id);
    if !function.locals.iter().any(|(id, local)| !local.name.is_empty() && hides(id, &local.name)) {
        return;
    }
    let uses = uses(function);
    let use_of = |id: LocalId| uses.get(&id).copied().unwrap_or_default();
    for (id, inner) in &function.locals {
        let Some(&outer_id) = first.get(inner.name.as_str()).filter(|outer| **outer != id) else { continue };
        let (outer, kept) = (&function.locals[outer_id], use_of(outer_id));
        let is_kept = !kept.has_values && !kept.is_changed && kept.last_store <= inner.span.lo;
        // A counter of the inner block has a use of its own.
        let is_doubtful = is_kept && use_of(id).has_values && !outer.in_memory;
        // What is read after the inner block belongs to one around it.
        let read = kept.read.filter(|read| read.lo > inner.span.lo && is_doubtful && !inner.name.is_empty());
        let Some(read) = read else { continue };
        if function.parameters.contains(&outer_id) {
            continue;
        }
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

/// The uses of the locals of a function.
fn uses(function: &Function) -> BTreeMap<LocalId, LocalUse> {
    let mut uses: BTreeMap<LocalId, LocalUse> = BTreeMap::new();
    let local = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Local(local, _) => Some(local),
        _ => None,
    };
    for expr in function.exprs.values() {
        let (place, note): (_, &dyn Fn(&mut LocalUse)) = match &expr.kind {
            ExprKind::Assign(place, value) => {
                let is_constant =
                    matches!(function.exprs[*value].kind, ExprKind::Int(_) | ExprKind::Float(_));
                (place, &move |one| {
                    one.has_values |= !is_constant;
                    one.last_store = one.last_store.max(expr.span.lo);
                })
            }
            ExprKind::Update(update) => (&update.place, &|one| one.is_changed = true),
            ExprKind::Address(place) => (place, &|one| one.is_changed = true),
            ExprKind::Load(place) => {
                (place, &|one| one.read = one.read.filter(|read| read.lo > expr.span.lo).or(Some(expr.span)))
            }
            _ => continue,
        };
        if let Some(local) = local(*place) {
            note(uses.entry(local).or_default());
        }
    }
    uses
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
