//! `int lock; MutexLock(&lock);` in a function: nobody else can wait for a local.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use crate::diag::{Diagnostic, Lint, Sink};
use crate::typed::{ExprKind, PlaceKind};

/// The functions that take or free the lock whose address they get.
const TAKERS: [&str; 3] =
    [Function::MutexLock.name(), Function::MutexUnlock.name(), Function::TestAndSet.name()];

/// Reports locks that are locals, once each.
pub(super) fn check(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    for function in program.functions() {
        let mut reported = Vec::new();
        for (expr, call) in function.calls() {
            let Some(name) = called_firmware(program.unit, call).filter(|name| TAKERS.contains(name)) else {
                continue;
            };
            let Some(&argument) = call.arguments.first() else { continue };
            let ExprKind::Address(place) = function.exprs[argument].kind else { continue };
            let PlaceKind::Local(local, _) = function.places[place].kind else { continue };
            if reported.contains(&local) {
                continue;
            }
            reported.push(local);
            let lock = &function.locals[local];
            let message = format!("`{}` is a local variable, which no other thread can lock", lock.name);
            sink.report(
                Diagnostic::warning(Lint::LocalLock, expr.span, message)
                    .at(format!("`{name}` needs a lock that threads share"))
                    .label(lock.span, "here")
                    .help("use an element of `persist.UserData`, as in `MutexLock(&persist.UserData[50])`"),
            );
        }
    }
}
