//! `int state = 5;` in a function, where the global `state` is meant.
//!
//! A local that is read as well has a use of its own, and often a short name; unless other functions read the global, which
//! then nothing sets.

use std::collections::BTreeMap;

use super::changes::{Changes, symbol};
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{Definition, ExprKind, Function, LocalId, PlaceId, PlaceKind, SymbolId};

/// Reports locals that hide a variable in which their values are missing: a global, or a local of a block around theirs.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let globals = Globals::of(program);
    for function in program.whole_functions() {
        let uses = uses(function);
        hidden_locals(function, &uses, sink);
        hidden_globals(function, &uses, &globals, sink);
    }
}

/// The use of a local in its function.
#[derive(Clone, Copy, Default)]
struct LocalUse {
    /// The place of the last store in the text.
    last_store: Option<u32>,
    /// True if something else than a constant is stored.
    has_values: bool,
    /// True if it is changed by adding, or its address is taken.
    is_changed: bool,
    /// The last read in the text.
    read: Option<Span>,
}

/// The uses of the locals of a function.
fn uses(function: &Function) -> BTreeMap<LocalId, LocalUse> {
    let mut uses: BTreeMap<LocalId, LocalUse> = BTreeMap::new();
    let local = |place: PlaceId| match function.places[place].kind {
        PlaceKind::Local(local, _) => Some(local),
        _ => None,
    };
    for expr in function.exprs.values() {
        let (ExprKind::Assign(place, _) | ExprKind::Load(place) | ExprKind::Address(place)) = expr.kind
        else {
            if let ExprKind::Update(update) = &expr.kind
                && let Some(local) = local(update.place)
            {
                uses.entry(local).or_default().is_changed = true;
            }
            continue;
        };
        let Some(local) = local(place) else { continue };
        let used = uses.entry(local).or_default();
        match expr.kind {
            ExprKind::Assign(_, value) => {
                let value = &function.exprs[value].kind;
                used.has_values |= !matches!(value, ExprKind::Int(_) | ExprKind::Float(_));
                used.last_store = used.last_store.max(Some(expr.span.lo));
            }
            ExprKind::Load(_) => {
                used.read = used.read.filter(|read| read.lo > expr.span.lo).or(Some(expr.span));
            }
            _ => used.is_changed = true,
        }
    }
    uses
}

/// The globals of a program by name, and what happens to them.
struct Globals<'a> {
    program: &'a AnalysedProgram<'a>,
    by_name: BTreeMap<&'a str, SymbolId>,
    changes: Changes,
    /// The first read of each.
    reads: BTreeMap<SymbolId, Span>,
}

impl<'a> Globals<'a> {
    fn of(program: &'a AnalysedProgram<'_>) -> Self {
        let symbols = program.unit.symbols.iter();
        let defined = symbols
            .filter(|(_, entry)| matches!(entry.definition, Definition::Tentative | Definition::Data(_)));
        let mut reads = BTreeMap::new();
        for function in program.functions() {
            for expr in function.exprs.values() {
                if let ExprKind::Load(place) = expr.kind
                    && let Some(read) = symbol(function, place)
                {
                    reads.entry(read).or_insert(expr.span);
                }
            }
        }
        let by_name = defined.map(|(id, entry)| (entry.name.as_str(), id)).collect();
        Self { program, by_name, changes: Changes::of(program), reads }
    }

    /// A read of a global that nothing sets, so that it stays 0.
    fn read_of_zero(&self, global: SymbolId) -> Option<Span> {
        let entry = &self.program.unit.symbols[global];
        let is_zero = match &entry.definition {
            Definition::Tentative => true,
            // An integer may be the number of something, such as an axis.
            Definition::Data(data) => entry.ty.is_floating() && data.bytes.iter().all(|byte| *byte == 0),
            Definition::None | Definition::Function => false,
        };
        let is_set = self.changes.set.contains(&global) || self.changes.counted.contains(&global);
        self.reads.get(&global).copied().filter(|_| is_zero && !is_set)
    }
}

/// Reports locals that are only assigned, or have values that are missing in a global which is read and which nothing sets.
fn hidden_globals(
    function: &Function,
    uses: &BTreeMap<LocalId, LocalUse>,
    globals: &Globals<'_>,
    sink: &mut Sink,
) {
    for (id, used) in uses.iter().filter(|(_, used)| used.last_store.is_some()) {
        let local = &function.locals[*id];
        let Some(&global) = globals.by_name.get(local.name.as_str()) else { continue };
        if local.in_memory || function.parameters.contains(id) {
            continue;
        }
        let span = globals.program.unit.symbols[global].span;
        let message = format!("this `{0}` shadows the global `{0}`", local.name);
        let finding = Diagnostic::warning(Lint::Shadow, local.span, message);
        let finding = if used.read.is_none() && !used.is_changed {
            finding.at("it is assigned, but never read").label(span, "the global")
        } else {
            let Some(read) = globals.read_of_zero(global) else { continue };
            finding
                .at("the values that are stored in it are not in the global")
                .label(read, "the global is read here")
                .label(span, "nothing sets it: it stays 0")
        };
        sink.report(finding.help("leave out the type to assign to the global"));
    }
}

/// Reports locals of an inner block that hide one of an outer block which keeps its constant first value and is read
/// afterwards.
fn hidden_locals(function: &Function, uses: &BTreeMap<LocalId, LocalUse>, sink: &mut Sink) {
    let mut first: BTreeMap<&str, LocalId> = BTreeMap::new();
    for (id, local) in function.locals.iter().filter(|(_, local)| !local.name.is_empty()) {
        let outer = first.entry(&local.name).or_insert(id);
        if local.span.lo < function.locals[*outer].span.lo {
            *outer = id;
        }
    }
    let use_of = |id: LocalId| uses.get(&id).copied().unwrap_or_default();
    for (id, inner) in &function.locals {
        let Some(&outer_id) = first.get(inner.name.as_str()).filter(|outer| **outer != id) else { continue };
        let (outer, kept) = (&function.locals[outer_id], use_of(outer_id));
        let is_kept = !kept.has_values && !kept.is_changed && kept.last_store <= Some(inner.span.lo);
        // A counter of the inner block has a use of its own.
        let is_doubtful = is_kept && use_of(id).has_values && !outer.in_memory;
        // What is read after the inner block belongs to one around it.
        let Some(read) = kept.read.filter(|read| read.lo > inner.span.lo && is_doubtful) else { continue };
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
