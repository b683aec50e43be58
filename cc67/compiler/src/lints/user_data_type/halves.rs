//! Integers in the halves of a `double` of `persist.UserData`, and the other way around.

use std::collections::{BTreeMap, BTreeSet};

use super::{Elements, Stores};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::lints::program::AnalysedProgram;
use crate::ty::Types;
use crate::typed::{ExprId, ExprKind};

/// Reports stores in the second half of a `double`, unless the program uses its first half as an integer as well.
pub(super) fn stored_over(program: &AnalysedProgram<'_>, stores: &BTreeMap<i32, Stores>, sink: &mut Sink) {
    for (element, stored) in stores {
        let (Some((span, ty)), Some(double)) = (stored.begun, stored.second_half) else { continue };
        let first = stores.get(&(element - 1)).copied().unwrap_or_default();
        if first.has_others || ty == Types::DOUBLE && double == span {
            continue;
        }
        let message = format!("`persist.UserData[{element}]` is the second half of a `double`");
        sink.report(
            Diagnostic::warning(Lint::UserDataType, span, message)
                .at(format!("a `{}` overwrites it", program.spell(ty)))
                .label(double, format!("elements {} and {element} hold this one", element - 1))
                .help("a `double` takes two elements: use the next even index after it"),
        );
    }
}

/// Reports integers that are stored in one half of a `double` which the same program reads.
pub(super) fn integers_stored(
    program: &AnalysedProgram<'_>,
    stores: &BTreeMap<i32, Stores>,
    sink: &mut Sink,
) {
    let is_int = |element: i32| {
        stores.get(&element).is_some_and(|stored| stored.has_others && stored.floating.is_none())
    };
    let mut reported = BTreeSet::new();
    for function in program.functions() {
        let elements = Elements::of(program, function);
        for expr in function.exprs.values() {
            let ExprKind::Load(place) = expr.kind else { continue };
            if function.places[place].ty != Types::DOUBLE {
                continue;
            }
            let Some(first) = elements.element(place) else { continue };
            // Both halves together are a copy.
            let (half, which) = match (is_int(first), is_int(first + 1)) {
                (true, false) => (first, "first"),
                (false, true) => (first + 1, "second"),
                (true, true) | (false, false) => continue,
            };
            let Some((span, _)) = stores.get(&half).and_then(|stored| stored.begun.or(stored.zero)) else {
                continue;
            };
            if !reported.insert(half) {
                continue;
            }
            let message = format!("`persist.UserData[{half}]` is the {which} half of a `double`");
            sink.report(
                Diagnostic::warning(Lint::UserDataType, span, message)
                    .at("an `int` overwrites it")
                    .label(
                        expr.span,
                        format!("elements {first} and {} are read as a `double` here", first + 1),
                    )
                    .help(
                        "a `double` takes two elements: index N of the doubles is elements 2 N and 2 N + 1",
                    ),
            );
        }
    }
}

/// Reports an integer that is read from the second half of a `double`, where the first half is not one.
pub(super) fn integers_read(elements: &Elements<'_, '_>, stores: &BTreeMap<i32, Stores>, sink: &mut Sink) {
    let exprs = &elements.function.exprs;
    // A print may show the halves on purpose.
    let printed: BTreeSet<ExprId> =
        elements.function.calls().flat_map(|(_, call)| call.variable.iter().flatten().copied()).collect();
    let loads = exprs.iter().filter(|(id, _)| !printed.contains(id));
    let loads = loads.filter_map(|(id, expr)| Some((elements.integer_load(id)?, expr.span)));
    let loads: Vec<_> = loads.collect();
    let loaded: BTreeSet<i32> = loads.iter().map(|(element, _)| *element).collect();
    let is_double = |element: i32| {
        let first = stores.get(&(element - 1)).copied().unwrap_or_default();
        !first.has_others && !loaded.contains(&(element - 1))
    };
    let found = loads.iter().find_map(|(element, span)| {
        let double = stores.get(element)?.second_half.filter(|_| is_double(*element))?;
        Some((element, span, double))
    });
    let Some((element, span, double)) = found else { return };
    let message = format!("`persist.UserData[{element}]` is the second half of a `double`");
    sink.report(
        Diagnostic::warning(Lint::UserDataType, *span, message)
            .at("read as an integer")
            .label(double, format!("this `double` is in elements {} and {element}", element - 1))
            .help(
                "use an element that no `double` takes: index N of the doubles is elements 2 N and 2 N + 1",
            ),
    );
}
