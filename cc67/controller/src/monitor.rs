//! A small program of cc67 in a free thread of the board, for requests for which its firmware has no command: reading
//! memory, and pausing a thread.
//!
//! It runs for the time of a request alone. The request is stored in its memory, as a download is; its answer comes in
//! the last 258 words of the gather buffer, which a recording reaches when it is nearly full.

use std::collections::BTreeMap;
use std::time::{Duration, Instant};

use cc67_host::HostError;
use cc67_wire::{Client, WireError};
use compiler::Options;
use kmotiondef::limits::MAX_GATHER_DATA;
use kmotiondef::map::{IRAM, SDRAM};
use kmotiondef::{GuestAddr, ThreadId};

use crate::clock::now;
use crate::resident::ResidentProgram;

const PROGRAM: ResidentProgram =
    ResidentProgram { name: "cc67-monitor.c", source: include_str!("monitor.c"), title: "cc67's monitor" };
/// Words of memory for which one answer has room.
const ROOM: u32 = 256;
/// The answer in the gather buffer: the number of the request, a sum, the words.
pub(crate) const REPLY: u32 = 2 * MAX_GATHER_DATA as u32 - ROOM - 2;
/// Bytes of memory that are read at once, and their alignment.
const BLOCK: u32 = 256;
/// The age up to which bytes that were read are shown again.
const FRESH: Duration = Duration::from_millis(50);
/// The longest time of a request.
const WITHIN: Duration = Duration::from_secs(3);

/// The request of a task, with the number by which `monitor.c` knows it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Task {
    /// Reads words of memory.
    Read(GuestAddr, u32),
    /// Adds up bytes of memory.
    Sum(GuestAddr, u32),
    /// Pauses a thread.
    Pause(ThreadId),
    /// Lets it continue.
    Resume(ThreadId),
}

impl Task {
    /// The request as the monitor reads it: kind, address or thread, count.
    const fn words(self) -> [u32; 3] {
        match self {
            Self::Read(address, words) => [0, address.get(), words],
            Self::Sum(address, bytes) => [1, address.get(), bytes],
            Self::Pause(thread) => [2, thread.get() as u32, 0],
            Self::Resume(thread) => [3, thread.get() as u32, 0],
        }
    }

    /// Words of memory in the answer.
    const fn room(self) -> u32 {
        if let Self::Read(_, words) = self { words } else { 0 }
    }
}

/// The monitor in its thread.
#[derive(Clone, Copy, Debug)]
struct Resident {
    thread: ThreadId,
    /// The address of its request.
    request: u32,
    /// The number of the last request.
    serial: u32,
}

/// The monitor of a board, which is loaded for its first request.
#[derive(Debug)]
pub(crate) struct Monitor {
    /// The options of its compilation.
    options: Options,
    /// The version of the firmware that it is linked for.
    linked_for: String,
    /// A view has allowed it.
    is_allowed: bool,
    resident: Option<Resident>,
    /// The thread that it was loaded into last, once for a message.
    announced: Option<ThreadId>,
    /// Memory that was read a moment ago, in blocks.
    recent: BTreeMap<u32, (Instant, Vec<u8>)>,
}

impl Monitor {
    /// A monitor that is not allowed yet, compiled with `options`.
    pub(crate) fn new(options: Options, linked_for: String) -> Self {
        let (resident, announced) = (None, None);
        Self { options, linked_for, is_allowed: false, resident, announced, recent: BTreeMap::new() }
    }

    /// Allows it to be loaded.
    pub(crate) const fn allow(&mut self) {
        self.is_allowed = true;
    }

    /// The options of programs for this board, and the version of the firmware that they are linked for.
    pub(crate) fn options(&self) -> (&Options, &str) {
        (&self.options, &self.linked_for)
    }

    /// Returns whether it may be used.
    pub(crate) const fn is_allowed(&self) -> bool {
        self.is_allowed
    }

    /// Its thread gets another program.
    pub(crate) fn forget(&mut self, thread: ThreadId) {
        self.resident = self.resident.filter(|resident| resident.thread != thread);
    }

    /// Returns the thread into which it was just loaded, once.
    pub(crate) const fn take_announced(&mut self) -> Option<ThreadId> {
        self.announced.take()
    }

    /// Reads memory; `free` are the threads that it may use.
    pub(crate) fn read(
        &mut self,
        board: &mut Client,
        free: &[ThreadId],
        address: GuestAddr,
        bytes: &mut [u8],
    ) -> Result<(), HostError> {
        for (at, byte) in (address.get()..).zip(bytes) {
            let base = at - at % BLOCK;
            let known = self.recent.get(&base).filter(|(moment, _)| now().duration_since(*moment) < FRESH);
            if known.is_none() {
                let words = BLOCK / 4;
                let words = self.execute(board, free, Task::Read(GuestAddr::new(base), words))?.words;
                let block = words.into_iter().flat_map(u32::to_le_bytes).collect();
                self.recent.insert(base, (now(), block));
            }
            let block = self.recent.get(&base).and_then(|(_, block)| block.get((at - base) as usize));
            *byte = block.copied().unwrap_or_default();
        }
        Ok(())
    }

    /// Forgets what was read: the memory has changed.
    pub(crate) fn note_change(&mut self) {
        self.recent.clear();
    }

    /// Compares bytes with the memory of the board.
    pub(crate) fn verify(
        &mut self,
        board: &mut Client,
        free: &[ThreadId],
        address: GuestAddr,
        bytes: &[u8],
    ) -> Result<bool, HostError> {
        let request = Task::Sum(address, bytes.len() as u32);
        Ok(self.execute(board, free, request)?.sum == sum_of(bytes))
    }

    /// Pauses a thread, or lets it continue.
    pub(crate) fn pause(
        &mut self,
        board: &mut Client,
        free: &[ThreadId],
        thread: ThreadId,
        is_paused: bool,
    ) -> Result<(), HostError> {
        let request = if is_paused { Task::Pause(thread) } else { Task::Resume(thread) };
        self.execute(board, free, request).map(drop)
    }

    /// Executes a request.
    fn execute(
        &mut self,
        board: &mut Client,
        free: &[ThreadId],
        request: Task,
    ) -> Result<MonitorReply, HostError> {
        let resident = match self.resident {
            Some(resident) => resident,
            None => self.load(board, free)?,
        };
        let serial = resident.serial.wrapping_add(1);
        self.resident = Some(Resident { serial, ..resident });
        let [kind, address, count] = request.words();
        let bytes: Vec<u8> = [serial, kind, address, count].into_iter().flat_map(u32::to_le_bytes).collect();
        let answer = exchange(board, resident, &bytes, request.room());
        let answer = answer.map_err(|error| HostError::Link(error.to_string()))?;
        if answer.serial == serial {
            return Ok(answer);
        }
        // Somebody has stopped it, or has loaded another program there.
        self.resident = None;
        Err(HostError::Link(format!("cc67's monitor in thread {} does not answer", resident.thread)))
    }

    /// Compiles and loads it.
    fn load(&mut self, board: &mut Client, free: &[ThreadId]) -> Result<Resident, HostError> {
        let Some(thread) = free.last().copied() else {
            return Err(HostError::Link(
                "no thread is free for cc67's monitor, which reads memory: all have programs or are active"
                    .to_owned(),
            ));
        };
        let request = PROGRAM.load(board, &self.options, &self.linked_for, thread)?;
        self.announced = Some(thread);
        Ok(Resident { thread, request, serial: 0 })
    }
}

/// An answer of the monitor.
#[derive(Debug)]
struct MonitorReply {
    serial: u32,
    sum: u32,
    words: Vec<u32>,
}

/// Stores a request, starts the monitor, and reads its answer when it has ended.
fn exchange(
    board: &mut Client,
    resident: Resident,
    request: &[u8],
    room: u32,
) -> Result<MonitorReply, WireError> {
    board.store(resident.request, request)?;
    board.execute(&[resident.thread])?;
    let end = now() + WITHIN;
    while board.is_active(resident.thread)? {
        if now() >= end {
            return Err(WireError::DoesNotStop(resident.thread));
        }
    }
    let mut words = board.gather(REPLY, 2 + room)?;
    let data = words.split_off(2);
    let number = |index: usize| words.get(index).copied().unwrap_or_default();
    Ok(MonitorReply { serial: number(0), sum: number(1), words: data })
}

/// The sum of bytes as `monitor.c` computes it.
fn sum_of(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |sum, byte| sum.wrapping_mul(31).wrapping_add(u32::from(*byte)))
}

/// Returns whether the monitor may read an address: registers, whose reading may do something, and flash are left out.
pub(crate) fn is_memory(address: GuestAddr) -> bool {
    [IRAM, SDRAM]
        .iter()
        .any(|region| address.get().checked_sub(region.base.get()).is_some_and(|offset| offset < region.size))
}
