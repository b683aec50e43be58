//! A small program of cc67 in a free thread of the board, for requests for which its firmware has no command: reading
//! memory, and pausing a thread.
//!
//! It runs only for the duration of a request. The request is stored in its memory in the manner of a download; its
//! answer comes in the last 258 words of the gather buffer, which a recording reaches only when it is nearly full.

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
/// The maximum number of memory words in an answer.
const ROOM: u32 = 256;
/// The answer in the gather buffer: the number of the request, a sum, the words.
pub(crate) const REPLY: u32 = 2 * MAX_GATHER_DATA as u32 - ROOM - 2;
/// The number of bytes that are read at once, and their alignment.
const BLOCK: u32 = 256;
/// The age up to which bytes are reused without reading them again.
const FRESH: Duration = Duration::from_millis(50);
/// The time limit of a request.
const WITHIN: Duration = Duration::from_secs(3);

/// A request, with its number in `monitor.c`.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Task {
    /// Reads words of memory.
    Read(GuestAddr, u32),
    /// Adds up bytes of memory.
    Sum(GuestAddr, u32),
    /// Pauses a thread.
    Pause(ThreadId),
    /// Resumes a thread.
    Resume(ThreadId),
}

impl Task {
    /// The request in the monitor's format: kind, address or thread, count.
    const fn words(self) -> [u32; 3] {
        match self {
            Self::Read(address, words) => [0, address.get(), words],
            Self::Sum(address, bytes) => [1, address.get(), bytes],
            Self::Pause(thread) => [2, thread.get() as u32, 0],
            Self::Resume(thread) => [3, thread.get() as u32, 0],
        }
    }

    /// The number of memory words in the answer.
    const fn room(self) -> u32 {
        if let Self::Read(_, words) = self { words } else { 0 }
    }
}

/// The monitor in its thread.
#[derive(Clone, Copy, Debug)]
struct ResidentMonitor {
    thread: ThreadId,
    /// The address of its request.
    request: u32,
    /// The number of the last request.
    serial: u32,
}

/// The monitor of a board; it is loaded for its first request.
#[derive(Debug)]
pub(crate) struct Monitor {
    /// The options with which it is compiled.
    options: Options,
    /// The version of the firmware for which it is linked.
    linked_for: String,
    /// True if a view has allowed it.
    is_allowed: bool,
    resident: Option<ResidentMonitor>,
    /// The thread into which it was last loaded, until that has been reported.
    announced: Option<ThreadId>,
    /// Recently read memory, in blocks.
    recent: BTreeMap<u32, (Instant, Vec<u8>)>,
}

impl Monitor {
    /// Creates a monitor that is not allowed yet and will be compiled with `options`.
    pub(crate) fn new(options: Options, linked_for: String) -> Self {
        let (resident, announced) = (None, None);
        Self { options, linked_for, is_allowed: false, resident, announced, recent: BTreeMap::new() }
    }

    /// Allows the monitor to be loaded.
    pub(crate) const fn allow(&mut self) {
        self.is_allowed = true;
    }

    /// The options for programs for this board, and the version of the firmware for which they are linked.
    pub(crate) fn options(&self) -> (&Options, &str) {
        (&self.options, &self.linked_for)
    }

    /// Returns whether the monitor may be used.
    pub(crate) const fn is_allowed(&self) -> bool {
        self.is_allowed
    }

    /// Notes that another program is loaded into its thread.
    pub(crate) fn invalidate(&mut self, thread: ThreadId) {
        self.resident = self.resident.filter(|resident| resident.thread != thread);
    }

    /// Returns once the thread into which it was loaded.
    pub(crate) const fn take_announced(&mut self) -> Option<ThreadId> {
        self.announced.take()
    }

    /// Reads memory; `free` are the threads that the monitor may use.
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

    /// Forgets the recently read memory, because it has changed.
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

    /// Pauses or resumes a thread.
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
        self.resident = Some(ResidentMonitor { serial, ..resident });
        let [kind, address, count] = request.words();
        let bytes: Vec<u8> = [serial, kind, address, count].into_iter().flat_map(u32::to_le_bytes).collect();
        let answer = exchange(board, resident, &bytes, request.room());
        let answer = answer.map_err(|error| HostError::Link(error.to_string()))?;
        if answer.serial == serial {
            return Ok(answer);
        }
        // The monitor was stopped, or another program was loaded into its thread.
        self.resident = None;
        Err(HostError::Link(format!("cc67's monitor in thread {} does not answer", resident.thread)))
    }

    /// Compiles and loads the monitor.
    fn load(&mut self, board: &mut Client, free: &[ThreadId]) -> Result<ResidentMonitor, HostError> {
        let Some(thread) = free.last().copied() else {
            return Err(HostError::Link(
                "no thread is free for cc67's monitor, which reads memory: all have programs or are active"
                    .to_owned(),
            ));
        };
        let request = PROGRAM.load(board, &self.options, &self.linked_for, thread)?;
        self.announced = Some(thread);
        Ok(ResidentMonitor { thread, request, serial: 0 })
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
    resident: ResidentMonitor,
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

/// Returns whether the monitor may read an address: not registers, where a read may have side effects, and not flash.
pub(crate) fn is_memory(address: GuestAddr) -> bool {
    [IRAM, SDRAM]
        .iter()
        .any(|region| address.get().checked_sub(region.base.get()).is_some_and(|offset| offset < region.size))
}
