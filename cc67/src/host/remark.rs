//! Events of the board in words.

use kmotiondef::CodeAddr;
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind};
use vm::trap::{Trap, TrapKind};

/// What an event says; `None` for console text, which is not ours to word.
pub(crate) fn describe(event: &Event, programs: &[DebugInfo]) -> Option<String> {
    match &event.kind {
        EventKind::ConsoleLine(_)
        | EventKind::Reply(_)
        | EventKind::Echo(_)
        | EventKind::UartSent(_)
        | EventKind::Trace(_)
        | EventKind::Detail(_)
        | EventKind::Loaded(..)
        | EventKind::Aborted => None,
        EventKind::Diagnostic(text) | EventKind::Host(text) | EventKind::Unmet(text) => Some(text.clone()),
        EventKind::Trap(trap) => Some(describe_trap(trap, programs)),
        EventKind::UndrivenInput { bit, thread, place } => {
            let who = thread.map_or("the call-back".to_owned(), |thread| format!("thread {thread}"));
            let place =
                place.and_then(|place| source(place, programs)).map_or(String::new(), |s| format!(" at {s}"));
            Some(format!("{who} reads bit {bit}{place}, an input that nothing drives; it stays 0"))
        }
        EventKind::Assisted { bit, level, thread, place } => {
            let who = thread.map_or("the call-back".to_owned(), |thread| format!("thread {thread}"));
            let place =
                place.and_then(|place| source(place, programs)).map_or(String::new(), |s| format!(" at {s}"));
            let level = u8::from(*level);
            Some(format!("{who} waits{place}: bit {bit} is {level} for 0.1 s (--assist)"))
        }
    }
}

/// "thread 1 stopped at home.c:12 in `main`: write of …".
fn describe_trap(trap: &Trap, programs: &[DebugInfo]) -> String {
    let who = trap.thread.map_or("call-back stopped".to_owned(), |thread| format!("thread {thread} stopped"));
    let place = source(trap.at, programs).unwrap_or_else(|| trap.at.to_string());
    let nearby = address(&trap.kind)
        .and_then(|address| programs.iter().find_map(|debug| debug.describe(address)))
        .map_or(String::new(), |nearby| format!(" ({nearby})"));
    format!("{who} at {place}: {}{nearby}", trap.kind)
}

/// The data address that a trap is about.
fn address(kind: &TrapKind) -> Option<kmotiondef::GuestAddr> {
    match kind {
        TrapKind::Unmapped { addr, .. }
        | TrapKind::WriteProtected { addr }
        | TrapKind::Misaligned { addr, .. } => Some(*addr),
        _ => None,
    }
}

/// File, line and function of a code address.
fn source(address: CodeAddr, programs: &[DebugInfo]) -> Option<String> {
    let place = programs.iter().find_map(|debug| debug.place(address))?;
    let line = place.line.map_or(String::new(), |line| format!(":{line}"));
    Some(format!("{}{line} in `{}`", place.file, place.function))
}
