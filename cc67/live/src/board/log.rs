//! Messages from, about and to the board. The last few thousand entries are kept for pages opened later.

use std::collections::{BTreeMap, VecDeque};

use cc67_host::{BranchId, Session, Target, remark};
use kmotiondef::{CodeAddr, Cycles, ThreadId, Ticks};
use runtime::{Event, EventKind, Remark, Speaker};
use serde::Serialize;

use crate::names::decode_text;

/// The number of entries kept.
const KEPT: usize = 5000;

/// The source of an entry.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(rename_all = "lowercase")]
pub(super) enum EntrySource {
    /// Console output of a program.
    Console,
    /// A reply of the board.
    Reply,
    /// A command from a page's user.
    Command,
    /// A remark of the simulation.
    Remark,
    /// A trap that stops a thread.
    Trap,
}

/// An access by one of two threads to the same object.
#[derive(Clone, Debug, Serialize)]
struct RaceAccess {
    /// The number of the thread; `None` for the call-back.
    thread: Option<u8>,
    file: String,
    line: u32,
}

#[derive(Clone, Debug, Serialize)]
pub(super) struct LogEntry {
    /// The time in ticks.
    tick: u64,
    /// The time in seconds, to a fraction of a tick.
    seconds: f64,
    voice: EntrySource,
    text: String,
    #[serde(skip_serializing_if = "Option::is_none")]
    file: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    line: Option<u32>,
    /// The accesses in a remark about two of them.
    #[serde(skip_serializing_if = "Option::is_none")]
    accesses: Option<[RaceAccess; 2]>,
}

#[derive(Debug, Default)]
pub(super) struct Log {
    entries: VecDeque<LogEntry>,
    /// The number of the latest entries that have not been sent to pages.
    fresh: usize,
    /// The entries of each line of history that was left, as of that time.
    pub(super) left: BTreeMap<BranchId, Vec<LogEntry>>,
}

impl Log {
    /// Adds a user's message.
    pub(super) fn add_message(&mut self, tick: Ticks, voice: EntrySource, text: String) {
        let seconds = tick.get() as f64 * kmotiondef::limits::TIMEBASE;
        self.add(LogEntry { tick: tick.get(), seconds, voice, text, file: None, line: None, accesses: None });
    }

    /// Adds an event of interest to users.
    pub(super) fn note<T: Target>(&mut self, session: &Session<T>, event: &Event) {
        let tick = u64::try_from(event.at.get() / Cycles::PER_TICK.get()).unwrap_or_default();
        let (voice, text, place) = match &event.kind {
            EventKind::ConsoleLine(line) => (EntrySource::Console, text(line), None),
            EventKind::Reply(line) => (EntrySource::Reply, text(line), None),
            EventKind::Trap(trap) => (EntrySource::Trap, event_text(session, event), Some(trap.at)),
            EventKind::Remark(remark) => (EntrySource::Remark, event_text(session, event), remark.place),
            EventKind::Host(_) | EventKind::Unmet(_) | EventKind::Halted(_) => {
                (EntrySource::Remark, event_text(session, event), None)
            }
            EventKind::Echo(_)
            | EventKind::Aborted
            | EventKind::Loaded(..)
            | EventKind::Trace(_)
            | EventKind::UartSent(_) => return,
        };
        // Minor events have no text.
        if text.is_empty() && !matches!(voice, EntrySource::Console | EntrySource::Reply) {
            return;
        }
        let place = place.and_then(|place: CodeAddr| session.source(place));
        let file = place.map(|place| place.file.to_owned());
        let line = place.and_then(|place| place.line);
        let seconds = event.at.get() as f64 / Cycles::PER_SECOND.get() as f64;
        let accesses = match &event.kind {
            EventKind::Remark(remark) => accesses(session, remark),
            _ => None,
        };
        self.add(LogEntry { tick, seconds, voice, text, file, line, accesses });
    }

    fn add(&mut self, entry: LogEntry) {
        if self.entries.len() == KEPT {
            self.entries.pop_front();
        }
        self.entries.push_back(entry);
        self.fresh = (self.fresh + 1).min(self.entries.len());
    }

    /// Drops the entries after a tick.
    pub(super) fn truncate(&mut self, tick: Ticks) {
        self.entries.retain(|entry| entry.tick <= tick.get());
        self.fresh = self.fresh.min(self.entries.len());
    }

    /// The entries in the order of time, for keeping: without those that were added later for an earlier time.
    pub(super) fn in_order(&self) -> Vec<LogEntry> {
        let mut last = 0;
        let is_later = |entry: &&LogEntry| {
            let is_later = entry.tick >= last;
            last = last.max(entry.tick);
            is_later
        };
        self.entries.iter().filter(is_later).cloned().collect()
    }

    /// Replaces the entries; pages receive the new ones separately.
    pub(super) fn replace(&mut self, entries: Vec<LogEntry>) {
        (self.entries, self.fresh) = (entries.into(), 0);
    }

    /// The entries after a tick.
    pub(super) fn entries_after(&self, tick: Ticks) -> Vec<&LogEntry> {
        self.entries.iter().filter(|entry| entry.tick > tick.get()).collect()
    }

    /// Returns the console output until a tick, as `cc67 run --time` shows it; `None` if some of it is not kept.
    pub(super) fn console(&self, until: Ticks) -> Option<String> {
        let is_printed = |entry: &&LogEntry| entry.voice == EntrySource::Console && entry.tick <= until.get();
        let printed = self.entries.iter().filter(is_printed);
        let lines = printed.map(|entry| format!("{:.6} {}\n", entry.seconds, entry.text)).collect();
        (self.entries.len() < KEPT).then_some(lines)
    }

    /// All entries, for a page that has just connected.
    pub(super) fn all(&self) -> Vec<&LogEntry> {
        self.entries.iter().collect()
    }

    /// Takes the entries since the last call.
    pub(super) fn take_fresh(&mut self) -> Vec<&LogEntry> {
        let fresh = std::mem::take(&mut self.fresh);
        self.entries.iter().skip(self.entries.len() - fresh).collect()
    }
}

/// The accesses of two threads in a remark.
fn accesses<T: Target>(session: &Session<T>, remark: &Remark) -> Option<[RaceAccess; 2]> {
    let access = |thread: Option<ThreadId>, at| {
        let place = session.source(at)?;
        Some(RaceAccess { thread: thread.map(ThreadId::get), file: place.file.to_owned(), line: place.line? })
    };
    let other = remark.other_thread()?;
    let thread = match remark.speaker {
        Speaker::Thread(thread) => Some(thread),
        Speaker::CallBack | Speaker::Board | Speaker::Command => None,
    };
    Some([access(thread, remark.place?)?, access(other.thread, other.at)?])
}

fn text(bytes: &[u8]) -> String {
    decode_text(bytes)
}

fn event_text<T: Target>(session: &Session<T>, event: &Event) -> String {
    let programs: Vec<_> = session.debug().into_iter().map(|(_, debug)| debug).collect();
    remark::describe(event, &programs).unwrap_or_default()
}
