//! `abs(error)` of a number with a fraction: `abs` takes an `int`.
//!
//! Constants with a fraction are found where they are converted.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::ExprKind;

/// The function that takes an `int` and is used for every number.
const ABS: &str = Function::abs.name();

/// Reports floating-point numbers that are passed to `abs`.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            if called_firmware(program.unit, call) != Some(ABS) {
                continue;
            }
            let Some(&argument) = call.arguments.first() else { continue };
            let expr = &function.exprs[argument];
            if let ExprKind::Convert(inner) = expr.kind
                && function.exprs[inner].ty.is_floating()
                && expr.ty.is_integer()
            {
                sink.report(
                    Diagnostic::warning(
                        Lint::LostFraction,
                        expr.span,
                        "`abs` takes an `int`: the fraction is lost",
                    )
                    .at(format!("this is `{}`", program.spell(function.exprs[inner].ty)))
                    .help("write `fast_fabs(x)`, or `fast_fabsf(x)` for a `float`"),
                );
            }
        }
    }
}
