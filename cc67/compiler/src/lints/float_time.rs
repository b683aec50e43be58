//! `float start = Time_sec();`: a `float` has seven digits, and the board's time soon needs more.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::ty::Types;
use crate::typed::ExprKind;

/// The function that returns the time since power-up.
const TIME: &str = Function::Time_sec.name();

/// Reports times that become a `float`.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for expr in function.exprs.values() {
            let ExprKind::Convert(inner) = expr.kind else { continue };
            let ExprKind::Call(call) = &function.exprs[inner].kind else { continue };
            if expr.ty == Types::FLOAT && called_firmware(program.unit, call) == Some(TIME) {
                sink.report(
                    Diagnostic::warning(
                        Lint::FloatTime,
                        function.exprs[inner].span,
                        format!("a `float` cannot hold the value of `{TIME}`"),
                    )
                    .at("seconds since power-up")
                    .note("a `float` has steps of 2 ms after 4.6 hours, and of 16 ms after 37 hours")
                    .help("use a `double`"),
                );
            }
        }
    }
}
