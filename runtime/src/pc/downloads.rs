//! Programs downloaded into threads word by word.
//!
//! A download consists of bytes in memory and an entry point; nothing marks the end of a program's text. The ranges
//! that were stored are kept here, so that the board can find the text in them when the thread is started.

use kmotiondef::map::{MemoryMap, ProgramSpaces};
use kmotiondef::{GuestAddr, ThreadId};

/// The memory that downloads have stored since the threads were last started.
#[derive(Clone, Debug)]
pub(crate) struct Downloads {
    /// The spaces of the threads.
    pub(crate) spaces: ProgramSpaces,
    /// First address, and the address after the last.
    stored: Vec<(GuestAddr, GuestAddr)>,
}

impl Default for Downloads {
    fn default() -> Self {
        Self { spaces: MemoryMap::KFLOP.programs, stored: Vec::new() }
    }
}

/// The limit of ranges that are kept: no program needs as many.
const MOST_STRETCHES: usize = 1000;

impl Downloads {
    /// Bytes were stored from `start` to before `end`.
    pub(crate) fn record(&mut self, start: GuestAddr, end: GuestAddr) {
        self.stored.retain(|range| range.0 != start);
        if self.stored.len() < MOST_STRETCHES {
            self.stored.push((start, end));
        }
    }

    /// Returns whether something was stored in the space of a thread.
    pub(crate) fn has(&self, thread: ThreadId) -> bool {
        let space = self.spaces.space(thread);
        self.stored.iter().any(|(stored, _)| space.contains(&stored.get()))
    }

    /// Returns the possible ends of the text at the beginning of a thread's space: the ends of the adjacent ranges from
    /// there.
    pub(crate) fn ends(&self, thread: ThreadId) -> Vec<GuestAddr> {
        let mut ends = Vec::new();
        let mut place = self.spaces.start(thread);
        while let Some((_, end)) = self.stored.iter().find(|(start, _)| *start == place) {
            if *end == place {
                break;
            }
            ends.push(*end);
            place = *end;
        }
        ends
    }

    /// Drops the ranges in the space of a thread.
    pub(crate) fn forget(&mut self, thread: ThreadId) {
        let space = self.spaces.space(thread);
        self.stored.retain(|(stored, _)| !space.contains(&stored.get()));
    }
}
