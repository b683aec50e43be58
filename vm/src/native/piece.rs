//! The data passed to a [`Piece`](super::code::Piece) of machine code, and returned by it.

use kmotiondef::map::{IRAM, SDRAM};

/// The limit of values that are passed besides registers.
pub(crate) const VALUES: usize = 128;

/// The bytes of RAM covered by one [mark](Places::marks), as a power of two.
pub(crate) const MARK_BITS: u32 = 5;

/// Lines of both RAMs.
pub(crate) const LINES: usize = ((SDRAM.size + IRAM.size) >> MARK_BITS) as usize;

/// A mark for each line.
pub(crate) type Marks = [u8; LINES];

/// The registers, clock and memory of a processor. Machine code depends on the layout.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Handover {
    /// The time.
    pub(crate) time: Time,
    /// The packets of the last two branches.
    pub(crate) branched_at: [u32; 2],
    /// The address at which the processor continues, if it is not a constant.
    pub(crate) target: u32,
    /// The watched stack.
    pub(crate) stack: StackBounds,
    /// Not 0 after a store to on-chip RAM.
    pub(crate) touched: u32,
    /// The destination of suppressed stores.
    pub(crate) scratch: u64,
    /// Values in flight.
    pub(crate) values: [u32; VALUES],
}

/// Pointers to registers and memory, for as long as a piece runs.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct Places {
    /// The registers.
    pub(crate) regs: *mut u32,
    /// The first byte of SDRAM.
    pub(crate) sdram: *mut u8,
    /// The first byte of on-chip RAM.
    pub(crate) iram: *mut u8,
    /// A byte for each line of SDRAM, then of on-chip RAM; not 0 if machine code must not store to the line.
    pub(crate) marks: *const u8,
}

/// Cycles and packets.
#[derive(Clone, Copy, Debug, Default)]
#[repr(C)]
pub(crate) struct Time {
    /// The present cycle.
    pub(crate) cycle: u64,
    /// The first cycle in which no packet may begin.
    pub(crate) deadline: u64,
    /// Packets executed.
    pub(crate) packets: u64,
    /// The first cycle in which an interrupt is possible again.
    pub(crate) shadow: u64,
}

/// Bounds of the stack pointer.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub(crate) struct StackBounds {
    /// The lowest allowed value.
    pub(crate) limit: u32,
    /// The highest allowed value.
    pub(crate) top: u32,
    /// The least it was.
    pub(crate) lowest: u32,
}

impl Default for Handover {
    fn default() -> Self {
        Self {
            time: Time::default(),
            branched_at: [0; 2],
            target: 0,
            stack: StackBounds { limit: 0, top: u32::MAX, lowest: u32::MAX },
            touched: 0,
            scratch: 0,
            values: [0; VALUES],
        }
    }
}
