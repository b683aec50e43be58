//! `TriggerGather(); x = gather_buffer[0];`: a recording takes time.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{ExprKind, PlaceKind};

/// The function that starts a recording, and the array that it fills.
const START: &str = Function::TriggerGather.name();
const BUFFER: &str = "gather_buffer";

/// Functions of the board during which no time passes.
const INSTANT: [&str; 4] = [
    Function::printf.name(),
    Function::sprintf.name(),
    Function::SetupGatherAllOnAxis.name(),
    Function::Time_sec.name(),
];

/// Reports reads of recorded values directly after the recording has begun.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let mut begun: Option<Span> = None;
        let mut reads = Vec::new();
        Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| {
            let expr = &function.exprs[expr];
            match &expr.kind {
                ExprKind::Call(call) => match called_firmware(program.unit, call) {
                    Some(START) => begun = Some(expr.span),
                    Some(name) if INSTANT.contains(&name) => {}
                    // It may wait.
                    _ => begun = None,
                },
                ExprKind::Load(place) => {
                    let is_buffer = matches!(
                        function.places[*place].kind,
                        PlaceKind::Symbol(symbol, _) if program.name(symbol) == BUFFER
                    );
                    if let Some(start) = begun.filter(|_| is_buffer) {
                        reads.push((start, expr.span));
                        begun = None;
                    }
                }
                _ => {}
            }
        });
        for (start, read) in reads {
            let message = format!("`{BUFFER}` is read while the recording has just begun");
            sink.report(
                Diagnostic::warning(Lint::GatherEarly, read, message)
                    .at("not recorded yet")
                    .label(start, "the recording begins here, with one sample in each servo tick")
                    .help("wait for its end: `while (!CheckDoneGather()) WaitNextTimeSlice();`"),
            );
        }
    }
}
