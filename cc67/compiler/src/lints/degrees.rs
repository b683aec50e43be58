//! `sin(90)`: the functions of angles take radians.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::ExprKind;

/// Functions that take an angle.
const FUNCTIONS: [&str; 6] = [
    Function::sin.name(),
    Function::cos.name(),
    Function::tan.name(),
    Function::sinf.name(),
    Function::cosf.name(),
    Function::tanf.name(),
];

/// Reports constant angles of more than a turn.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            let Some(name) = called_firmware(program.unit, call).filter(|name| FUNCTIONS.contains(name))
            else {
                continue;
            };
            let Some(&argument) = call.arguments.first() else { continue };
            let ExprKind::Float(angle) = function.exprs[argument].kind else { continue };
            if angle.abs() > std::f64::consts::TAU {
                let message = format!("`{name}` takes radians, and {angle} is more than a turn");
                sink.report(
                    Diagnostic::warning(Lint::Degrees, function.exprs[argument].span, message)
                        .at("these look like degrees")
                        .help(format!("write `{name}({angle} * PI / 180)`")),
                );
            }
        }
    }
}
