//! A source file without `main`: the reason, and a remedy.
//!
//! Most such files are helpers that other programs include, and were compiled by mistake. Others
//! have a `main` by another name, or are sketches for another board.

use crate::diag::Diagnostic;
use crate::object::{Definition, Object};
use crate::source::Span;
use crate::words::suggest;

/// Programs that are named; more are counted.
const NAMED: usize = 4;

/// The advice for a file that `includers` include.
const COMPILE_THAT: &str = "compile that program instead";

/// A remark on a file with errors that it is not a program, which may be their cause.
pub(crate) fn remark(includers: &[String]) -> Diagnostic {
    let message = format!("this file has no `main`; it is included by {}", list(includers));
    Diagnostic::remark(Span::new(0, 0), message).help(COMPILE_THAT)
}

/// Adds advice to the error that there is no `main`.
pub(crate) fn advise(error: Diagnostic, object: &Object, includers: &[String]) -> Diagnostic {
    if !includers.is_empty() {
        return error.note(format!("this file is included by {}", list(includers))).help(COMPILE_THAT);
    }
    let functions: Vec<&str> = object
        .symbols
        .values()
        .filter(|symbol| matches!(symbol.definition, Definition::Function(_)))
        .map(|symbol| symbol.name.as_str())
        .collect();
    if functions.contains(&"setup") && functions.contains(&"loop") {
        return error.help("write `main() { setup(); for (;;) loop(); }`");
    }
    match suggest("main", functions.iter().copied()) {
        Some(near) => error.help(format!("did you mean `main`, where you wrote `{near}`?")),
        None => error.help("compile the program that includes this file, or write a `main`"),
    }
}

/// `A.c, B.c and 3 more`
fn list(names: &[String]) -> String {
    let more = names.len().saturating_sub(NAMED);
    let named = names.get(..NAMED).unwrap_or(names).join(", ");
    if more == 0 { named } else { format!("{named} and {more} more") }
}
