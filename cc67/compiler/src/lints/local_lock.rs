//! `int lock; MutexLock(&lock);`: no other thread can wait for a local, and each program has its own globals.

use kmotiondef::firmware::Function;

use super::format::called_firmware;
use super::program::AnalysedProgram;
use super::walk::{Extent, Walk};
use crate::diag::{Diagnostic, Lint, Sink};
use crate::source::Span;
use crate::typed::{Definition, ExprKind, PlaceKind, SymbolId};

/// The functions that take or free the lock at an address.
const TAKERS: [&str; 3] =
    [Function::MutexLock.name(), Function::MutexUnlock.name(), Function::TestAndSet.name()];

const HELP: &str = "use an element of `persist.UserData`, as in `MutexLock(&persist.UserData[50])`";

/// Reports locks that are locals or globals of one program, each once.
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
                    .help(HELP),
            );
        }
    }
    globals(program, sink);
}

/// Reports global locks whose address is used for nothing else: a program runs in one thread, and has its own copy.
fn globals(program: &AnalysedProgram<'_>, sink: &mut Sink) {
    let mut locks: Vec<(SymbolId, Span, u32)> = Vec::new();
    let mut addresses: Vec<SymbolId> = Vec::new();
    for function in program.functions() {
        let symbol_of = |place| match function.places[place].kind {
            PlaceKind::Symbol(symbol, _) => Some(symbol),
            _ => None,
        };
        Walk { function, extent: Extent::All }.stmts(&function.body, &mut |expr| match &function.exprs[expr]
            .kind
        {
            ExprKind::Address(place) => addresses.extend(symbol_of(*place)),
            ExprKind::Call(call)
                if called_firmware(program.unit, call).is_some_and(|name| TAKERS.contains(&name)) =>
            {
                let lock = call.arguments.first().and_then(|lock| match function.exprs[*lock].kind {
                    ExprKind::Address(place) => symbol_of(place),
                    _ => None,
                });
                match (lock, locks.iter_mut().find(|(symbol, ..)| Some(*symbol) == lock)) {
                    (_, Some((.., count))) => *count += 1,
                    (Some(lock), None) => locks.push((lock, function.exprs[expr].span, 1)),
                    (None, None) => {}
                }
            }
            _ => {}
        });
    }
    for (lock, span, count) in locks {
        let symbol = &program.unit.symbols[lock];
        let is_own = matches!(symbol.definition, Definition::Tentative | Definition::Data(_));
        let is_shared = addresses.iter().filter(|symbol| **symbol == lock).count() as u32 > count;
        if is_own && !is_shared {
            let message =
                format!("`{}` is a variable of this program, which no other thread can lock", symbol.name);
            sink.report(
                Diagnostic::warning(Lint::LocalLock, span, message)
                    .at("each program has its own")
                    .label(symbol.span, "here")
                    .help(HELP),
            );
        }
    }
}
