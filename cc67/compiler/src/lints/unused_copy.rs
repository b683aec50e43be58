//! `CHAN c = chan[axis]; c.Vel = 1000;`: a store into a copy does not change the original.

use std::collections::BTreeMap;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{ExprKind, Function, LocalId, PlaceId, PlaceKind};

/// A local structure that is a copy.
struct Copied {
    /// The range of the original.
    original: Span,
    /// The first store in a part of the copy.
    stored: Option<Span>,
}

/// Reports copies of structures that are stored into but never read.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        for (local, Copied { original, stored }) in copies(function) {
            let Some(stored) = stored else { continue };
            let local = &function.locals[local];
            let name = &local.name;
            let original = String::from_utf8_lossy(program.sources.text(original));
            let message = format!("`{name}` is a copy of `{original}`: values stored in it stay in the copy");
            let ty = program.spell(local.ty);
            sink.report(
                Diagnostic::warning(Lint::UnusedCopy, stored, message)
                    .at("nothing reads the copy")
                    .label(local.span, "copied here")
                    .help(format!("use a pointer, `{ty} *{name} = &{original};`, and `{name}->`")),
            );
        }
    }
}

/// The copies that are never read.
fn copies(function: &Function) -> BTreeMap<LocalId, Copied> {
    let local = |place: PlaceId| local_of(function, place);
    let mut copies = BTreeMap::new();
    for expr in function.exprs.values() {
        if let ExprKind::Copy { to, from } = expr.kind
            && let Some(to) = local(to).filter(|to| !function.locals[*to].name.is_empty())
            && local(from).is_none()
        {
            copies.insert(to, Copied { original: function.places[from].span, stored: None });
        }
    }
    if copies.is_empty() {
        return copies;
    }
    for expr in function.exprs.values() {
        match &expr.kind {
            ExprKind::Load(place) | ExprKind::Address(place) | ExprKind::Copy { from: place, .. } => {
                if let Some(read) = local(*place) {
                    copies.remove(&read);
                }
            }
            ExprKind::Assign(place, _) => note_store(&mut copies, local(*place), expr.span),
            ExprKind::Update(update) => note_store(&mut copies, local(update.place), expr.span),
            _ => {}
        }
    }
    copies
}

fn note_store(copies: &mut BTreeMap<LocalId, Copied>, local: Option<LocalId>, span: Span) {
    if let Some(copied) = local.and_then(|local| copies.get_mut(&local)) {
        copied.stored = Some(copied.stored.filter(|first| first.lo <= span.lo).unwrap_or(span));
    }
}

/// The local to which a place belongs.
fn local_of(function: &Function, place: PlaceId) -> Option<LocalId> {
    match function.places[place].kind {
        PlaceKind::Local(local, _) => Some(local),
        PlaceKind::Bits(unit, _) => local_of(function, unit),
        PlaceKind::Symbol(..) | PlaceKind::Pointer(..) => None,
    }
}
