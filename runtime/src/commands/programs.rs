//! Programs: downloading them word by word, and starting and stopping threads.
//!
//! A download is bytes in memory and an entry point; nothing says where the text of a program ends. [`Downloads`]
//! keeps what was stored in one go, so that the board can find the text among it when the thread is started.

use kmotiondef::map::{FLASH, PROGRAM_SIZE, REGIONS, RegionKind, program_base};
use kmotiondef::structs::Persist;
use kmotiondef::variables::PERSIST;
use kmotiondef::{GuestAddr, ThreadId};
use vm::memory::GuestMemory;
use vm::thread::Threads;

use super::arguments::Values;
use super::data::{Data, Kind};
use super::session::{Answer, Session};
use crate::kernel::{Kernel, Request};
use crate::views::Typed;

/// What downloads have stored since the threads were last started.
#[derive(Clone, Debug, Default)]
pub(crate) struct Downloads {
    /// First address, and the one behind the last.
    stored: Vec<(GuestAddr, GuestAddr)>,
}

/// Stretches that are kept: no program needs as many.
const MOST_STRETCHES: usize = 1000;

impl Downloads {
    /// Bytes were stored from `start` to before `end`.
    pub(super) fn record(&mut self, start: GuestAddr, end: GuestAddr) {
        self.stored.retain(|stretch| stretch.0 != start);
        if self.stored.len() < MOST_STRETCHES {
            self.stored.push((start, end));
        }
    }

    /// Whether something was stored in the space of a thread.
    pub(crate) fn has(&self, thread: ThreadId) -> bool {
        let start = program_base(thread).get();
        self.stored.iter().any(|(stored, _)| (start..start + PROGRAM_SIZE).contains(&stored.get()))
    }

    /// Where the text at the beginning of a thread's space may end: the stretches that follow each other from there.
    pub(crate) fn ends(&self, thread: ThreadId) -> Vec<GuestAddr> {
        let mut ends = Vec::new();
        let mut place = program_base(thread);
        while let Some((_, end)) = self.stored.iter().find(|(start, _)| *start == place) {
            if *end == place {
                break;
            }
            ends.push(*end);
            place = *end;
        }
        ends
    }

    /// Forgets what was stored in the space of a thread.
    pub(crate) fn forget(&mut self, thread: ThreadId) {
        let start = program_base(thread).get();
        self.stored.retain(|(stored, _)| !(start..start + PROGRAM_SIZE).contains(&stored.get()));
    }
}

/// The entry point that a thread is started at.
fn entry(memory: &GuestMemory, thread: ThreadId) -> GuestAddr {
    GuestAddr::new(memory.get(PERSIST.field(Persist::ENTRY_POINTS).element(thread.index())))
}

/// Starts a thread at its entry point; the board first looks at what was downloaded. `false` if there is nothing.
pub(crate) fn start(
    kernel: &mut Kernel,
    memory: &GuestMemory,
    threads: &mut Threads,
    thread: ThreadId,
) -> bool {
    let (base, entry) = (program_base(thread), entry(memory, thread));
    let is_new = kernel.downloads.has(thread) || threads.entry(thread) != entry;
    if is_new && memory.peek::<u32>(base) == 0 {
        return false;
    }
    if is_new {
        threads.set_entry(thread, entry);
        kernel.ask(Request::Load(thread));
    }
    threads.start(thread).is_ok()
}

pub(super) fn execute(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    start(session.kernel, session.context.memory, session.context.threads, values.thread());
    Answer::Nothing
}

pub(super) fn kill(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    session.context.threads.pause(values.thread());
    Answer::Nothing
}

pub(super) fn check_thread(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    i32::from(session.context.threads.state(values.thread()).is_active()).into()
}

pub(super) fn entry_point(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let place = PERSIST.field(Persist::ENTRY_POINTS).element(values.thread().index());
    session.memory().set(place, values.word(1));
    Answer::Nothing
}

/// Whether a thread starts at power-up.
pub(super) fn set_startup(session: &mut Session<'_, '_>, values: &Values) -> Answer {
    let place = PERSIST.field(Persist::RUN_ON_START_UP);
    let bit = 1 << values.integer(0);
    let bits = session.memory().get(place);
    let bits = if values.integer(1) == 0 { bits & !bit } else { bits | bit };
    session.memory().set(place, bits);
    Answer::Nothing
}

/// Takes data lines, unless the bytes would lie outside of memory: the released firmware does not check that.
pub(super) fn load_data(_: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (start, count) = (values.word(0), values.word(1));
    let end = u64::from(start) + u64::from(count);
    let is_inside = REGIONS.iter().any(|region| {
        let base = region.base.get();
        region.kind == RegionKind::Ram && start >= base && end <= u64::from(base) + u64::from(region.size)
    });
    if !is_inside {
        return Answer::Refused("invalid address");
    }
    data(Kind::Program, start, count)
}

/// Takes the data lines of a new firmware; there is nothing to do with them.
pub(super) fn load_flash(_: &mut Session<'_, '_>, values: &Values) -> Answer {
    let (start, count) = (values.word(0), values.word(1));
    let end = u64::from(start) + u64::from(count);
    let limit = u64::from(FLASH.base.get()) + u64::from(FLASH.size);
    if start < FLASH.base.get() || end > limit {
        return Answer::Refused("invalid address");
    }
    data(Kind::Firmware, start, count)
}

fn data(kind: Kind, start: u32, count: u32) -> Answer {
    if count == 0 {
        return Answer::Nothing;
    }
    Answer::Data(Data::new(kind, GuestAddr::new(start), count as usize))
}
