//! Device registers: addresses where a read or write is an action.
//!
//! The machine does not know the devices; the kernel routes each access to its device. An eight-byte access reaches the
//! bus as two four-byte accesses, low half first.

use kmotiondef::{AccessSize, Cycles, GuestAddr};

/// The devices at the addresses that are not memory.
pub trait Bus {
    /// Reads a register; the value is zero-extended from `size`.
    fn read(&mut self, addr: GuestAddr, size: AccessSize, now: Cycles) -> u32;

    /// Writes a register or sends a command to the flash chip; the upper bits of `value` beyond `size` are zero.
    fn write(&mut self, addr: GuestAddr, size: AccessSize, value: u32, now: Cycles);

    /// Processor time that an access to this address takes beyond that of the instruction itself.
    fn access_cycles(&self, addr: GuestAddr) -> Cycles {
        let _ = addr;
        Cycles::new(0)
    }
}
