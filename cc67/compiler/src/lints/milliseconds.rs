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

/// A common number of milliseconds, although it is whole minutes in seconds.
const COMMON: f64 = 300.0;

/// Reports constant times that are too long for seconds; a product such as `20 * 60` is meant.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            if called_firmware(program.unit, call) != Some(DELAY) {
                continue;
            }
            let Some(&argument) = call.arguments.first() else { continue };
            let ExprKind::Float(time) = function.exprs[argument].kind else { continue };
            let is_minutes = time % 60.0 == 0.0 && time != COMMON;
            let is_written = is_written(program.sources.text(function.exprs[argument].span), time);
            if time >= LONG && !is_minutes && is_written {
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

/// Returns whether a text is the number itself or a name for it, rather than a computation.
fn is_written(text: &[u8], time: f64) -> bool {
    let text = str::from_utf8(text).unwrap_or_default();
    let is_name = text.starts_with(|first: char| first.is_ascii_alphabetic() || first == '_');
    is_name || text.trim_end_matches(['f', 'F', 'l', 'L']).parse() == Ok(time)
}
