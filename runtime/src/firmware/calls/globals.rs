//! The initial data of programs, for boards that reinitialise globals at each start.
//!
//! On a real board only a load writes it: globals of a restarted program keep their values from the previous run.
//! `cpu.fresh_globals` in a machine file restores them instead.

use kmotiondef::{GuestAddr, ThreadId};
use vm::memory::GuestMemory;

/// The initial data of each program; empty unless programs get fresh globals at each start.
#[derive(Clone, Debug, Default)]
pub(crate) struct Globals {
    is_kept: bool,
    sections: [Vec<(GuestAddr, Vec<u8>)>; ThreadId::MAX as usize],
}

impl Globals {
    /// Keeps the data of programs that are loaded from now on.
    pub(crate) fn enable(&mut self) {
        self.is_kept = true;
    }

    /// Removes the program of a thread.
    pub(crate) fn remove(&mut self, thread: ThreadId) {
        self.sections[thread.index()].clear();
    }

    /// A section of data is loaded for a thread.
    pub(crate) fn record_section(&mut self, thread: ThreadId, address: GuestAddr, bytes: &[u8]) {
        if self.is_kept {
            self.sections[thread.index()].push((address, bytes.to_vec()));
        }
    }

    /// Restores the initial data of a thread's program.
    pub(crate) fn restore(&self, thread: ThreadId, memory: &mut GuestMemory) {
        for (address, bytes) in &self.sections[thread.index()] {
            let placed = memory.poke_bytes(*address, bytes);
            debug_assert!(placed.is_ok(), "it was loaded there");
        }
    }
}
