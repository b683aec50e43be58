//! Functions and variables of the program that have a name of the firmware: the program's own are used.

use kmotiondef::firmware::Origin;

use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{Definition, Linkage, Symbol};

/// Reports every definition that is visible to other units and also exists in the firmware.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for symbol in program.unit.symbols.values() {
        if let Some(lint) = lint_for(program, symbol) {
            let message = format!("the firmware already has a `{}`", symbol.name);
            sink.report(
                Diagnostic::warning(lint, symbol.span, message)
                    .at("this one is used in the program")
                    .note("the vendor's linker refuses it: `defined twice`")
                    .help("choose another name, or make it `static`"),
            );
        }
    }
}

/// The lint for a name. The vendor's linker refuses names that the header declares or that are reserved for the
/// firmware; functions of the C library in a program are only a matter of portability.
fn lint_for(program: &AnalysedProgram<'_>, symbol: &Symbol) -> Option<Lint> {
    if matches!(symbol.definition, Definition::None) || symbol.linkage == Linkage::Internal {
        return None;
    }
    // The entry of a firmware has this name, too, and no program is linked against it.
    if symbol.name == "main" {
        return None;
    }
    match program.firmware.origin(&symbol.name) {
        Some(Origin::Header) => Some(Lint::Redeclared),
        None if program.firmware.is_variable(&symbol.name) => Some(Lint::Redeclared),
        Some(Origin::Firmware) => Some(Lint::Portability),
        None if program.firmware.is_hidden(&symbol.name) => Some(Lint::Redeclared),
        Some(Origin::Library) | None => None,
    }
}
