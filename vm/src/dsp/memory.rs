//! The interface between processor and memory.

#[cfg(feature = "native")]
use crate::memory::GuestMemory;
use crate::trap::TrapKind;

/// Cycles that have passed, and cycles that are left.
///
/// An access that stalls the processor reduces the cycles that are left.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Clock {
    /// Packet cycles since the start, by which results land.
    pub(super) cycle: u64,
    /// The packet cycle in which no time is left.
    pub(super) deadline: u64,
    /// Cycles since the start that the processor waited for memory.
    pub(super) stalled: u64,
}

impl Clock {
    /// Cycles since the start.
    #[must_use]
    pub const fn cycle(&self) -> u64 {
        self.cycle + self.stalled
    }

    /// Stalls the processor: time passes, and results in flight are delayed as well.
    pub const fn stall(&mut self, cycles: u64) {
        self.stalled += cycles;
        self.deadline = self.deadline.wrapping_sub(cycles);
    }

    /// Sets the cycle since the start in which no time is left.
    pub(super) const fn set_end(&mut self, end: u64) {
        self.deadline = end.wrapping_sub(self.stalled);
    }

    /// Cycles left; below zero when more were spent.
    #[must_use]
    pub const fn left(&self) -> i64 {
        self.deadline.wrapping_sub(self.cycle).cast_signed()
    }

    /// Sets the cycles that are left.
    pub const fn set_left(&mut self, left: i64) {
        self.deadline = self.cycle.wrapping_add_signed(left);
    }

    /// Reports whether no cycles are left.
    #[inline(always)]
    pub(super) const fn is_over(&self) -> bool {
        self.left() <= 0
    }
}

/// Memory and registers of devices, as the processor reaches them.
///
/// Addresses are multiples of the size of the access: the processor ignores the low bits.
pub trait Memory {
    /// The number of accesses so far that reached a device in a way that may matter; a loop without such an access can
    /// be skipped.
    fn touches(&self) -> u64 {
        0
    }

    /// Both RAMs, if accesses to their addresses have no other effect: then hot code is translated.
    #[cfg(feature = "native")]
    fn ram(&mut self) -> Option<&mut GuestMemory> {
        None
    }

    /// The word at `addr` as an instruction; `None` where the context has no code, so that it leaves the core.
    fn fetch(&self, addr: u32) -> Option<u32>;

    /// Loads a byte, zero-extended.
    ///
    /// # Errors
    /// Nothing is there.
    fn load8(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind>;

    /// Loads two bytes, zero-extended.
    ///
    /// # Errors
    /// Nothing is there.
    fn load16(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind>;

    /// Loads a word.
    ///
    /// # Errors
    /// Nothing is there.
    fn load32(&mut self, addr: u32, clock: &mut Clock) -> Result<u32, TrapKind>;

    /// Loads two words, the first in the low half.
    ///
    /// # Errors
    /// Nothing is there.
    fn load64(&mut self, addr: u32, clock: &mut Clock) -> Result<u64, TrapKind>;

    /// Stores the low byte of `value`.
    ///
    /// # Errors
    /// Nothing is there, or it must not be changed.
    fn store8(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind>;

    /// Stores the low two bytes of `value`.
    ///
    /// # Errors
    /// Nothing is there, or it must not be changed.
    fn store16(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind>;

    /// Stores a word.
    ///
    /// # Errors
    /// Nothing is there, or it must not be changed.
    fn store32(&mut self, addr: u32, value: u32, clock: &mut Clock) -> Result<(), TrapKind>;
}
