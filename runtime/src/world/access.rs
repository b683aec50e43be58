//! Access of the world to the board.

use kmotiondef::Cycles;
use vm::memory::GuestMemory;
use vm::scheduler::SliceOwner;

use crate::io::Io;
use crate::machine::attached::AttachedDevice;
use crate::machine::{Lines, Machine};
use crate::out::Out;
use crate::pc::Pc;

/// The parts of the board that the world can access at one time.
#[derive(Debug)]
pub(crate) struct WorldAccess<'a> {
    pub(crate) machine: &'a mut Machine,
    pub(crate) io: &'a mut Io,
    pub(crate) pc: &'a mut Pc,
    pub(crate) out: &'a mut Out,
    pub(crate) now: Cycles,
}

impl WorldAccess<'_> {
    /// The board's lines.
    pub(crate) fn lines(&mut self) -> Lines<'_> {
        Lines { machine: self.machine, io: self.io, out: self.out, now: self.now }
    }

    /// Attaches a device.
    pub(crate) fn attach(&mut self, device: Box<dyn AttachedDevice>, memory: &GuestMemory) {
        self.machine.attach(device, self.io, self.out, memory, self.now);
    }
}

/// The owner of the processor, and the start of its slice.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Moment {
    pub(crate) turn: SliceOwner,
    pub(crate) slice_start: Cycles,
}
