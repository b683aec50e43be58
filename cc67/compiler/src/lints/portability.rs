//! Functions that the simulation supplies and the firmware lacks.

use std::collections::BTreeSet;

use kmotiondef::firmware::Origin;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Callee, Definition};

/// Reports the first call of each such function.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let mut seen = BTreeSet::new();
    for (expr, call) in program.functions().flat_map(|function| function.calls()) {
        let Callee::Symbol(callee) = call.callee else { continue };
        let symbol = &program.unit.symbols[callee];
        let is_lacking = matches!(symbol.definition, Definition::None)
            && program.firmware.origin(&symbol.name) == Some(Origin::Library);
        if is_lacking && seen.insert(callee) {
            let message =
                format!("`{}` is not in firmware {}", symbol.name, program.firmware.board().number());
            sink.report(
                Diagnostic::warning(Lint::Portability, expr.span, message)
                    .at("supplied by the simulation only")
                    .help("define it in the program"),
            );
        }
    }
}
