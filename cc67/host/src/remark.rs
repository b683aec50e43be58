//! Events of the board in words.

use kmotiondef::{Bit, CodeAddr, ThreadId};
use runtime::debug::DebugInfo;
use runtime::{Event, EventKind};
use vm::trap::{Trap, TrapKind};

/// What an event says; `None` for console text, which is not ours to word.
pub fn describe(event: &Event, programs: &[DebugInfo]) -> Option<String> {
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
            let reader = reader(*thread, *place, programs);
            Some(undriven(&[(reader, *bit)]))
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

/// Who reads an input, and where: "thread 1 at home.c:12 in `main`".
pub fn reader(thread: Option<ThreadId>, place: Option<CodeAddr>, programs: &[DebugInfo]) -> String {
    let who = thread.map_or("the call-back".to_owned(), |thread| format!("thread {thread}"));
    let place = place.and_then(|place| source(place, programs));
    place.map_or(who.clone(), |place| format!("{who} at {place}"))
}

/// One remark on inputs that nothing drives, and who read each of them first.
pub fn undriven(inputs: &[(String, Bit)]) -> String {
    if let [(reader, bit)] = inputs {
        return format!("{reader} reads bit {bit}, an input that nothing drives; it stays 0");
    }
    let places = inputs.chunk_by(|(one, _), (other, _)| one == other).map(|group| {
        let bits = group.iter().map(|(_, bit)| bit.to_string()).collect::<Vec<_>>().join(", ");
        let reader = group.first().map_or("", |(reader, _)| reader);
        format!("\n  {bits}: {reader}")
    });
    format!(
        "{} inputs are read that nothing drives; they stay 0:{}",
        inputs.len(),
        places.collect::<String>()
    )
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn inputs_that_nothing_drives_are_told_together() {
        let read = |reader: &str, bit| (reader.to_owned(), Bit::new(bit).expect("a bit"));
        let (home, stop) = ("thread 1 at home.c:12 in `main`", "the call-back");
        assert_eq!(
            undriven(&[read(home, 20)]),
            "thread 1 at home.c:12 in `main` reads bit 20, an input that nothing drives; it stays 0"
        );
        assert_eq!(
            undriven(&[read(home, 20), read(home, 21), read(stop, 46)]),
            "3 inputs are read that nothing drives; they stay 0:\n  20, 21: thread 1 at home.c:12 in `main`\n  46: the call-back"
        );
    }
}
