//! A board as it was at an instant between two ticks, to continue from there as often as one likes.

use std::fmt;
use std::sync::Arc;

use kmotiondef::Ticks;
use vm::engine::{Engine, Executor, ForeignSnapshot};
use vm::machine::Snapshot as MachineSnapshot;

use super::{Board, Programs};
use crate::kernel::Kernel;

/// Everything that a board holds besides its settings.
///
/// Guest memory is shared with earlier snapshots in pages of 4 KiB, and what is known about programs with the board.
pub struct BoardSnapshot<E: Engine> {
    machine: MachineSnapshot<<E as Executor>::Snapshot>,
    kernel: Kernel,
    programs: Arc<Programs>,
}

// Derived, it would ask the same of the engine.
impl<E: Engine> fmt::Debug for BoardSnapshot<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BoardSnapshot").field("machine", &self.machine).finish_non_exhaustive()
    }
}

impl<E: Engine> BoardSnapshot<E> {
    /// Number of servo interrupts until the instant.
    #[must_use]
    pub const fn tick(&self) -> Ticks {
        self.machine.tick()
    }

    /// Returns whether a program holds the tick in progress.
    #[must_use]
    pub const fn is_held(&self) -> bool {
        self.machine.is_held()
    }

    /// Bytes of guest memory that this snapshot has beside those that it shares with `other`.
    #[must_use]
    pub fn bytes_beyond(&self, other: &Self) -> usize {
        self.machine.memory().bytes_beyond(other.machine.memory())
    }
}

impl<E: Engine> Board<E> {
    /// The board as it is: guest memory, threads, servo, devices, the loads of the axes, the PC, console text and events
    /// that nobody has received yet.
    ///
    /// Of files that the PC keeps in a [directory](crate::Directory) it has only which are open and what of them is read
    /// already; the files themselves stay as they are when the board goes back.
    pub fn snapshot(&mut self) -> BoardSnapshot<E> {
        BoardSnapshot {
            machine: self.machine.snapshot(),
            kernel: self.machine.firmware().clone(),
            programs: Arc::clone(&self.programs),
        }
    }

    /// Makes the board what it was when `snapshot` was taken; it continues from there byte for byte as it continued then.
    ///
    /// Snapshots may be restored in any order, each as often as one likes. One of a board on the interpreter may also be
    /// restored in another board with the same settings.
    ///
    /// # Errors
    /// [`ForeignSnapshot`] for a snapshot of another board with native threads; nothing has changed then.
    pub fn restore(&mut self, snapshot: &BoardSnapshot<E>) -> Result<(), ForeignSnapshot> {
        let BoardSnapshot { machine, kernel, programs } = snapshot;
        self.machine.restore(machine)?;
        self.machine.firmware_mut().0.clone_from(kernel);
        self.programs.clone_from(programs);
        Ok(())
    }
}
