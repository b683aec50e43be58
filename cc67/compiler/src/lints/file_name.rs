//! Single backslashes in the name of a file: `fopen("c:\temp\new.txt", "w")`.

use kmotiondef::ctype::Role;
use kmotiondef::firmware::row_named;

use super::format::{called_firmware, literal_argument};
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};

/// Looks at the names of the files that are opened.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        for (_, call) in function.calls() {
            let called = called_firmware(program.unit, call).and_then(row_named);
            let Some(argument) = called.and_then(|row| row.argument(|role| role == Role::FileName)) else {
                continue;
            };
            let name = literal_argument(program.unit, function, call, argument).unwrap_or_default();
            let Some(escape) = name.iter().find_map(|byte| escape(*byte)) else { continue };
            let span = function.exprs[call.arguments[argument]].span;
            sink.report(
                Diagnostic::warning(Lint::FileName, span, format!("`\\{escape}` in the name of a file"))
                    .at("no file has such a name")
                    .help("write `\\\\` for each backslash, or `/`"),
            );
        }
    }
}

/// The letter that gives a control character after a backslash.
fn escape(byte: u8) -> Option<char> {
    match byte {
        0x07 => Some('a'),
        0x08 => Some('b'),
        b'\t' => Some('t'),
        b'\n' => Some('n'),
        0x0B => Some('v'),
        0x0C => Some('f'),
        b'\r' => Some('r'),
        _ => None,
    }
}
