//! Variables of a function that are never mentioned.

use std::collections::BTreeSet;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::PlaceKind;

/// Reports every such variable; parameters are often there for the caller's sake.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.whole_functions() {
        let mentioned: BTreeSet<_> = function
            .places
            .values()
            .filter_map(|place| match place.kind {
                PlaceKind::Local(local, _) => Some(local),
                _ => None,
            })
            .collect();
        for (id, local) in &function.locals {
            if local.name.is_empty() || mentioned.contains(&id) || function.parameters.contains(&id) {
                continue;
            }
            let message = format!("`{}` is never used", local.name);
            sink.report(Diagnostic::warning(Lint::UnusedVariable, local.span, message).help("remove it"));
        }
    }
}
