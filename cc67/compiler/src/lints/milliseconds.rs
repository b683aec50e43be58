//! `Delay_sec(500)`: the functions that wait take seconds.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::ExprKind;

/// The function that waits for a time.
const DELAY: &str = Function::Delay_sec.name();

/// Seconds from which on a constant is probably one of milliseconds.
const LONG: f64 = 100.0;

/// Reports constant times of minutes.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            if called_firmware(program.unit, call) != Some(DELAY) {
                continue;
            }
            let Some(&argument) = call.arguments.first() else { continue };
            let ExprKind::Float(time) = function.exprs[argument].kind else { continue };
            if time >= LONG {
                let message = format!("`{DELAY}` waits {time} seconds here");
                sink.report(
                    Diagnostic::warning(Lint::Milliseconds, function.exprs[argument].span, message)
                        .at("these look like milliseconds")
                        .help(format!("write `{DELAY}({})` for {time} milliseconds", time / 1000.0)),
                );
            }
        }
    }
}
