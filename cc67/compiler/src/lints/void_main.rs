//! `void main`, which every KFLOP compiler accepts and no C standard allows.

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};

/// Reports a `main` without a result.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        if program.name(function.symbol) == "main" && function.ty.result.is_void() {
            sink.report(
                Diagnostic::warning(Lint::VoidMain, function.span, "`main` is declared `void`")
                    .at("the standard's `main` returns `int`")
                    .help("write `int main(void)`, or just `main()`"),
            );
        }
    }
}
