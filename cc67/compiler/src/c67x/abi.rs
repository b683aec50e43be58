//! The roles of registers: the calling convention of the board's firmware (`c67x.md` section 6.1).

pub(super) use c67x::convention::{ARGUMENTS, LINK, RESULT, STACK};
use c67x::{Reg, Side};

/// The register for the address of an indirect call: no argument is passed in it.
pub(super) const TARGET: Reg = Reg::b(0);

/// The register that contains a thread's number at its start, and from which `ThreadDone` takes it.
pub(super) const THREAD: Reg = Reg::a(14);

/// The register for the address of further arguments if there are more arguments than registers; our own convention.
pub(super) const REST: Reg = Reg::a(3);

/// The register that `sin` and `cos` of the firmware may still write in the cycle after their return.
pub(super) const LATE: Reg = Reg::a(7);

/// The bit of a register in a set.
pub(super) const fn bit(reg: Reg) -> u64 {
    1 << reg.index()
}

/// The registers that a call of any function may change: A0 to A9, B0 to B9.
pub(super) const CHANGED: u64 = 0x3FF | 0x3FF << 32;

/// The callee-saved registers: A10 to A15, B10 to B14.
pub(super) const KEPT: u64 = 0xFC00 | 0x7C00 << 32;

/// The registers available for values. Registers 16 to 31 do not survive a thread switch (`c67x.md` 6.2); B3 and B15
/// have special uses.
pub(super) const USABLE: u64 = (CHANGED | KEPT) & !bit(LINK);

/// The registers that can be a condition.
pub(super) const CONDITIONS: u64 = 0b111 | 0b111 << 32;

/// The registers of one file.
pub(super) const fn file(side: Side) -> u64 {
    match side {
        Side::A => 0xFFFF_FFFF,
        Side::B => 0xFFFF_FFFF << 32,
    }
}

/// The registers of a set.
pub(super) fn registers(set: u64) -> impl Iterator<Item = Reg> {
    (0..Reg::COUNT).filter(move |index| set >> index & 1 != 0).filter_map(Reg::from_index)
}
