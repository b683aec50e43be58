//! The machine as it was at an instant, between two ticks or where one is held, to continue from there as often as one
//! likes.

use kmotiondef::{Cycles, ThreadId, Ticks};

use super::Machine;
use super::engines::EnginesSnapshot;
use super::held::HoldPoint;
use crate::engine::{Engine, ForeignSnapshot};
use crate::firmware::Firmware;
use crate::loaded::LoadedCode;
use crate::memory::snapshot::MemorySnapshot;
use crate::scheduler::{SliceOwner, ThreadSet};
use crate::thread::Threads;

/// Everything that a machine holds except its settings and its firmware; `S` is the snapshot of its engine.
#[derive(Debug)]
pub struct Snapshot<S> {
    memory: MemorySnapshot,
    threads: Threads,
    loaded: [Option<LoadedCode>; ThreadId::MAX as usize],
    longest_steps: [Cycles; ThreadId::MAX as usize],
    engines: EnginesSnapshot<S>,
    tick: Ticks,
    turn: SliceOwner,
    stack_reported: ThreadSet,
    held: Option<HoldPoint>,
    shadow: Option<Cycles>,
}

impl<S> Snapshot<S> {
    /// Number of servo interrupts until the instant.
    #[must_use]
    pub const fn tick(&self) -> Ticks {
        self.tick
    }

    /// Reports whether a tick is held.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.held.is_some()
    }

    /// Guest memory at the instant.
    #[must_use]
    pub const fn memory(&self) -> &MemorySnapshot {
        &self.memory
    }
}

impl<F: Firmware, E: Engine> Machine<F, E> {
    /// Saves the machine without its firmware, which its owner must copy.
    ///
    /// Memory is shared with earlier snapshots page by page, and so is the code of programs.
    pub fn snapshot(&mut self) -> Snapshot<E::Snapshot> {
        Snapshot {
            memory: self.memory.snapshot(),
            threads: self.threads.clone(),
            loaded: self.loaded.clone(),
            longest_steps: self.longest_steps,
            engines: self.engines.snapshot(),
            tick: self.tick,
            turn: self.turn,
            stack_reported: self.stack_reported,
            held: self.held,
            shadow: self.shadow,
        }
    }

    /// Restores the machine from `snapshot`; it continues exactly as it did after the snapshot was taken.
    ///
    /// The firmware must be restored as well. Snapshots may be restored in any order, any number of times. A snapshot
    /// of a bytecode machine may also be restored in another machine with the same settings.
    ///
    /// # Errors
    /// [`ForeignSnapshot`] for a snapshot of another machine with native threads; nothing is changed in that case.
    pub fn restore(&mut self, snapshot: &Snapshot<E::Snapshot>) -> Result<(), ForeignSnapshot> {
        let Snapshot {
            memory,
            threads,
            loaded,
            longest_steps,
            engines,
            tick,
            turn,
            stack_reported,
            held,
            shadow,
        } = snapshot;
        self.engines.restore(engines)?;
        self.memory.restore(memory);
        self.threads.clone_from(threads);
        self.loaded.clone_from(loaded);
        self.longest_steps = *longest_steps;
        self.tick = *tick;
        self.turn = *turn;
        self.stack_reported = *stack_reported;
        self.held = *held;
        self.shadow = *shadow;
        Ok(())
    }
}
