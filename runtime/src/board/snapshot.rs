//! A board as it was at an instant between two ticks, to continue from there as often as one likes.

use std::fmt;
use std::sync::Arc;

use kmotiondef::Ticks;
use vm::engine::{Engine, Executor, ForeignSnapshot};
use vm::machine::Snapshot as MachineSnapshot;

use super::{Board, Programs};
use crate::kernel::Kernel;

/// Everything that a board holds except its settings.
///
/// Guest memory is shared with earlier snapshots in pages of 4 KiB, and the facts about programs are shared with the
/// board.
pub struct BoardSnapshot<E: Engine> {
    machine: MachineSnapshot<<E as Executor>::Snapshot>,
    kernel: Kernel,
    programs: Arc<Programs>,
}

// A derived implementation would require `Debug` of the engine.
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

    /// Bytes of guest memory that this snapshot does not share with `other`.
    #[must_use]
    pub fn bytes_beyond(&self, other: &Self) -> usize {
        self.machine.memory().bytes_beyond(other.machine.memory())
    }
}

impl<E: Engine> Board<E> {
    /// A snapshot of the board: guest memory, threads, servo, devices, the loads of the axes, the PC, console text and
    /// events that have not been received yet.
    ///
    /// For files that the PC keeps in a [directory](crate::Directory), it records only which are open and how much has
    /// been read; restoring the board does not change the files themselves.
    pub fn snapshot(&mut self) -> BoardSnapshot<E> {
        BoardSnapshot {
            machine: self.machine.snapshot(),
            kernel: self.machine.firmware().clone(),
            programs: Arc::clone(&self.programs),
        }
    }

    /// Restores the board from `snapshot`; it continues byte for byte as it did after the snapshot was taken.
    ///
    /// Snapshots may be restored in any order, any number of times. A snapshot of a board on the interpreter may also
    /// be restored in another board with the same settings.
    ///
    /// # Errors
    /// [`ForeignSnapshot`] for a snapshot of another board with native threads; nothing is changed in that case.
    pub fn restore(&mut self, snapshot: &BoardSnapshot<E>) -> Result<(), ForeignSnapshot> {
        let BoardSnapshot { machine, kernel, programs } = snapshot;
        self.machine.restore(machine)?;
        self.machine.firmware_mut().0.clone_from(kernel);
        self.programs.clone_from(programs);
        Ok(())
    }
}
