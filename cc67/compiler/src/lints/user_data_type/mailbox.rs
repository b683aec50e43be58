//! The elements through which a program and the PC exchange requests: the PC takes what it finds there as one.

use super::element;
use crate::diag::{Diagnostic, Lint};
use crate::lints::program::AnalysedProgram;
use crate::lints::user_data_index::MAILBOX;
use crate::lints::walk::{Extent, Walk};
use crate::source::Span;
use crate::typed::{ExprId, ExprKind, Function, PlaceId, PlaceKind, StmtKind};

/// The message on a `double` that reaches into the mailbox.
pub(super) fn double(element: i32, span: Span) -> Diagnostic {
    let message =
        format!("a `double` is stored in `persist.UserData[{element}]`, which is part of the PC's mailbox");
    Diagnostic::warning(Lint::UserDataType, span, message)
        .at(format!("elements {element} and {}", element + 1))
        .note("elements 100 to 107 hold requests to the PC: it takes what it finds in element 100 as the code of one")
        .help("use elements outside 100 to 107: `double` index 50 is element 100")
}

/// Returns whether a program makes no requests to the PC: it stores no parameters of any and reads no answers, and no loop of
/// it waits until the PC has taken one.
pub(super) fn makes_no_requests(program: &AnalysedProgram<'_>) -> bool {
    !program.functions().any(|function| {
        let others = *MAILBOX.start() + 1..=*MAILBOX.end();
        let has_parameters = |place: PlaceId| {
            element(program, function, place).is_some_and(|element| others.contains(&element))
        };
        function.places.keys().any(has_parameters) || waits_for_the_pc(program, function)
    })
}

/// Returns whether a store in the mailbox is one of a number for the program's own use, in a program without requests: it
/// names no request, and its value is not an argument.
pub(super) fn is_own_number(program: &AnalysedProgram<'_>, function: &Function, store: ExprId) -> bool {
    const REQUESTS: &[u8] = b"PC_COMM";
    let is_argument = |value: ExprId| match function.exprs[value].kind {
        ExprKind::Load(place) => matches!(function.places[place].kind,
            PlaceKind::Local(local, _) if function.parameters.contains(&local)),
        _ => false,
    };
    let text = program.sources.text(function.exprs[store].span);
    if text.windows(REQUESTS.len()).any(|word| word == REQUESTS) {
        return false;
    }
    match function.exprs[store].kind {
        ExprKind::Assign(_, value) => {
            !matches!(function.exprs[value].kind, ExprKind::Int(0)) && !is_argument(value)
        }
        _ => true,
    }
}

/// Returns whether a loop of a function looks at the mailbox.
fn waits_for_the_pc(program: &AnalysedProgram<'_>, function: &Function) -> bool {
    let mut waits = false;
    function.each_stmt(&mut |stmt| {
        let StmtKind::Loop { condition: Some(condition), .. } = stmt.kind else { return };
        Walk { function, extent: Extent::All }.expr(condition, &mut |expr| {
            waits |= matches!(function.exprs[expr].kind, ExprKind::Load(place)
                if element(program, function, place) == Some(*MAILBOX.start()));
        });
    });
    waits
}

/// The message on a number in the element of the code.
pub(super) fn own_number(span: Span) -> Diagnostic {
    let message = format!("`persist.UserData[{}]` is the PC's mailbox", MAILBOX.start());
    Diagnostic::warning(Lint::UserDataType, span, message)
        .at("the PC takes any number here as the code of a request")
        .note("elements 100 to 107 hold requests to the PC; they are written as `PC_COMM_…`")
        .help("use an element outside 100 to 107 for a number of your own")
}
