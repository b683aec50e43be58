//! Parameters that the vendor's compiler handles wrongly: their addresses, and more parameters than it can pass.
//!
//! The list is from `c67-subset.md` section 9; cc67 translates all of this code as C requires.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{ExprKind, Function, LocalId, PlaceId, PlaceKind};

/// Parameters that it can pass.
const MAX_PARAMETERS: usize = 10;

/// Looks at every function.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        sink.report_if(many_parameters(program, function));
        addresses(function, sink);
    }
}

fn warning(span: Span, fault: &str) -> Diagnostic {
    Diagnostic::warning(Lint::VendorParameter, span, format!("the vendor's compiler {fault}"))
}

/// More parameters than there are registers for them.
fn many_parameters(program: &AnalysedProgram<'_>, function: &Function) -> Option<Diagnostic> {
    let count = function.parameters.len();
    let name = program.name(function.symbol);
    (count > MAX_PARAMETERS).then(|| {
        warning(function.span, &format!("cannot pass the {count} parameters of `{name}`"))
            .at(format!("it passes {MAX_PARAMETERS}"))
            .help("pass an array or a structure by its address")
    })
}

/// Addresses of parameters that are stored, passed on or indexed. `*(int *)&parameter` is the parameter itself, which
/// is translated correctly.
fn addresses(function: &Function, sink: &mut Sink) {
    let mut seen = BTreeSet::new();
    Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
        let place = match function.exprs[expr].kind {
            ExprKind::Address(place) => place,
            ExprKind::Load(place) | ExprKind::Assign(place, _) if is_inner_part(function, place) => place,
            _ => return,
        };
        let Some(local) = parameter_at(function, place) else { return };
        if seen.insert(place) {
            sink.report(address_of(&function.locals[local].name, function.exprs[expr].span));
        }
    });
}

/// Reports whether a place is a later part of a local, which an index or a member reaches.
fn is_inner_part(function: &Function, place: PlaceId) -> bool {
    matches!(function.places[place].kind, PlaceKind::Local(_, offset) if offset > 0)
}

fn address_of(name: &str, span: Span) -> Diagnostic {
    warning(span, &format!("takes a wrong address for the parameter `{name}`"))
        .at("an address in the caller's frame")
        .help(format!("copy it to a local first, and take the address of that: `x = {name}; … &x`"))
}

fn parameter_at(function: &Function, place: PlaceId) -> Option<LocalId> {
    let PlaceKind::Local(local, _) = function.places[place].kind else { return None };
    let is_written = function.parameters.contains(&local) && !function.locals[local].name.is_empty();
    // The vendor's compiler refuses structures as parameters.
    (is_written && !function.locals[local].by_pointer).then_some(local)
}
