//! Text for events of the board.

use std::fmt;

use kmotiondef::variables::cell_name;
use kmotiondef::{Bit, CodeAddr};
use runtime::debug::{DebugInfo, SourcePlace};
use runtime::{Event, EventKind, Message, OtherPlace, Remark, Severity, Speaker};
use vm::trap::{Scene, Trap, TrapKind};

/// A position in a source.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SourceCall {
    /// The file.
    pub file: String,
    /// The line, from 1, if the image has it.
    pub line: Option<u32>,
    /// The column, from 1, if the compiler knows it.
    pub column: Option<u32>,
    /// The function that contains the position.
    pub function: String,
}

impl From<SourcePlace<'_>> for SourceCall {
    fn from(place: SourcePlace<'_>) -> Self {
        let (file, function) = (place.file.to_owned(), place.function.to_owned());
        Self { file, line: place.line, column: place.column, function }
    }
}

impl fmt::Display for SourceCall {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.file)?;
        if let Some(line) = self.line {
            write!(f, ":{line}")?;
        }
        if let Some(column) = self.column {
            write!(f, ":{column}")?;
        }
        write!(f, " in `{}`", self.function)
    }
}

/// Describes an event in a sentence; `None` for console text, which is shown unchanged.
pub fn describe(event: &Event, programs: &[DebugInfo]) -> Option<String> {
    match &event.kind {
        EventKind::ConsoleLine(_)
        | EventKind::Reply(_)
        | EventKind::Echo(_)
        | EventKind::UartSent(_)
        | EventKind::Trace(_)
        | EventKind::Loaded(..)
        | EventKind::Aborted => None,
        EventKind::Remark(remark) => {
            (remark.message.severity() > Severity::Detail).then(|| remark_text(remark, programs))
        }
        EventKind::Host(text) | EventKind::Unmet(text) => Some(text.clone()),
        EventKind::Halted(text) => Some(text.trim_end().to_owned()),
        EventKind::Trap(trap) => Some(describe_trap(trap, programs)),
    }
}

/// Registers and code around the position where code of the real processor stopped; `None` for other events.
pub fn scene(event: &Event) -> Option<&Scene> {
    match &event.kind {
        EventKind::Trap(trap) => trap.scene.as_deref(),
        _ => None,
    }
}

/// A remark with its subject and position: "thread 1 at home.c:12:5 in `main`: SetBit(3000): …".
#[must_use]
pub fn remark_text(remark: &Remark, programs: &[DebugInfo]) -> String {
    let who = subject_text(remark, programs);
    if let Some(other) = remark.message.other() {
        let text = remark.message.to_string().replace(&other.to_string(), &place_of(other, programs));
        // Most texts continue after the position; others begin with the function.
        let mark = if text.starts_with(char::is_uppercase) { ":" } else { "" };
        return format!("{who}{mark} {text}");
    }
    match &remark.message {
        // These messages continue a sentence with the thread as its subject.
        message @ (Message::UndrivenInput { .. } | Message::Assisted { .. } | Message::MovesAway { .. }) => {
            format!("{who} {message}")
        }
        message if who.is_empty() => message.to_string(),
        message => format!("{who}: {message}"),
    }
}

/// Names the subject and the position of a remark: "thread 1 at home.c:12:5 in `main`"; empty for the board.
#[must_use]
pub fn subject_text(remark: &Remark, programs: &[DebugInfo]) -> String {
    let who = match remark.speaker {
        Speaker::Board => String::new(),
        Speaker::Thread(thread) => format!("thread {thread}"),
        Speaker::CallBack => "the call-back".to_owned(),
        Speaker::Command => "command".to_owned(),
    };
    let place = remark.place.and_then(|place| source(place, programs));
    place.map_or(who.clone(), |place| format!("{who} at {place}"))
}

/// The second position of a remark: "thread 2 at b.c:7:3 in `main`".
fn place_of(other: OtherPlace, programs: &[DebugInfo]) -> String {
    let Some(place) = source(other.at, programs) else { return other.to_string() };
    other.thread.map_or(format!("the call-back at {place}"), |thread| format!("thread {thread} at {place}"))
}

/// One remark on undriven inputs: their levels, and the first reader of each.
pub fn undriven(inputs: &[(String, Bit, u8)]) -> String {
    if let [(reader, bit, level)] = inputs {
        let message = Message::UndrivenInput { bit: *bit, level: *level };
        return format!("{reader} {message}");
    }
    let places = inputs.chunk_by(|(one, ..), (other, ..)| one == other).map(|group| {
        let bits = group.iter().map(|(_, bit, _)| bit.to_string()).collect::<Vec<_>>().join(", ");
        let reader = group.first().map_or("", |(reader, ..)| reader);
        format!("\n  {bits}: {reader}")
    });
    let stay = match inputs {
        [(.., first), rest @ ..] if rest.iter().all(|(.., level)| level == first) => first.to_string(),
        _ => "as they are".to_owned(),
    };
    format!(
        "{} inputs that nothing drives are read; they stay {stay}:{}",
        inputs.len(),
        places.collect::<String>()
    )
}

/// "thread 1 stopped at home.c:12:5 in `main`: write of …".
fn describe_trap(trap: &Trap, programs: &[DebugInfo]) -> String {
    let who = trap.thread.map_or("call-back stopped".to_owned(), |thread| format!("thread {thread} stopped"));
    let place = source(trap.at, programs).unwrap_or_else(|| trap.at.to_string());
    let nearby = address(&trap.kind)
        .and_then(|address| programs.iter().find_map(|debug| debug.describe(address)))
        .or_else(|| odd_element(&trap.kind))
        .map_or(String::new(), |nearby| format!(" ({nearby})"));
    format!("{who} at {place}: {}{nearby}", trap.kind)
}

/// The elements of `persist.UserData` at which no `double` can be stored.
fn odd_element(kind: &TrapKind) -> Option<String> {
    let TrapKind::Misaligned { addr, size: 8, .. } = *kind else { return None };
    let name = cell_name(addr, 8);
    name.starts_with("persist.UserData")
        .then(|| format!("{name}; a `double` takes an even element and the next"))
}

/// The data address of a trap.
fn address(kind: &TrapKind) -> Option<kmotiondef::GuestAddr> {
    match kind {
        TrapKind::Unmapped { addr, .. }
        | TrapKind::WriteProtected { addr }
        | TrapKind::Misaligned { addr, .. }
        | TrapKind::NoJumpPlace { addr }
        | TrapKind::ForeignJumpPlace { addr }
        | TrapKind::JumpAfterReturn { addr } => Some(*addr),
        _ => None,
    }
}

/// File, line and function of a code address.
#[must_use]
pub fn place(address: CodeAddr, programs: &[DebugInfo]) -> Option<SourceCall> {
    programs.iter().find_map(|debug| debug.place(address)).map(SourceCall::from)
}

/// The source position of a code address, as text.
fn source(address: CodeAddr, programs: &[DebugInfo]) -> Option<String> {
    place(address, programs).map(|place| place.to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn undriven_inputs_are_reported_together() {
        let read = |reader: &str, bit| (reader.to_owned(), Bit::new(bit).expect("a bit"), 0);
        let (home, stop) = ("thread 1 at home.c:12 in `main`", "the call-back");
        assert_eq!(
            undriven(&[read(home, 20)]),
            "thread 1 at home.c:12 in `main` reads bit 20, an input that nothing drives; it stays 0"
        );
        assert_eq!(
            undriven(&[read(home, 20), read(home, 21), read(stop, 46)]),
            "3 inputs that nothing drives are read; they stay 0:\n  20, 21: thread 1 at home.c:12 in `main`\n  46: the call-back"
        );
    }
}
