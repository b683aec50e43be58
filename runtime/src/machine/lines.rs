//! The board's lines, as seen by their drivers: devices that listen respond at once.

use kmotiondef::{Bit, Cycles};
use vm::memory::GuestMemory;

use super::Machine;
use crate::io::Io;
use crate::io::bits::{bit_state, write_bit};
use crate::out::Out;

/// The lines at one time.
#[derive(Debug)]
pub(crate) struct Lines<'a> {
    pub(crate) machine: &'a mut Machine,
    pub(crate) io: &'a mut Io,
    pub(crate) out: &'a mut Out,
    pub(crate) now: Cycles,
}

impl Lines<'_> {
    /// The level of a bit.
    pub(crate) fn level(&self, memory: &GuestMemory, bit: Bit) -> bool {
        bit_state(self.io, memory, bit).0
    }

    /// Writes a bit for the board.
    pub(crate) fn write(&mut self, memory: &mut GuestMemory, bit: Bit, level: bool) {
        write_bit(self.io, self.out, memory, bit, level, self.now);
        self.settle();
    }

    /// Drives an input from the world.
    pub(crate) fn drive(&mut self, bit: Bit, level: bool) {
        self.machine.pulses.drive(bit, level, self.now);
        self.io.pins.drive(bit, level, self.now);
        self.settle();
    }

    /// Lets the devices respond that listen to bits which may have changed.
    pub(crate) fn settle(&mut self) {
        self.machine.settle(self.io, self.out, self.now);
    }
}
