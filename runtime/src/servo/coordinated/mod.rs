//! Coordinated motion: several axes on one path, and the clock that runs along it.
//!
//! A path is a list of [`segment`]s in guest memory, put there by the PC or by the program itself. Every tick the path
//! time advances by the time base, whose ratio to a tick's length is the feed override; the segment at that time
//! determines the position of each axis. All of this is live in guest memory: a program may build the list and start it
//! by assignments alone. Only the last segment of a smoothed path is kept here.
//!
//! Source: `coordinated-motion.md`; where it differs from the recorded runs (`coord.jsonl`), the runs win.

pub(crate) mod board;
pub(crate) mod buffer;
pub(crate) mod download;
pub(crate) mod feedhold;
pub(crate) mod path;
pub(crate) mod rate;
#[cfg(test)]
mod recorded;
pub(crate) mod segment;
pub(crate) mod smoothing;
pub(crate) mod system;

use kmotiondef::Bit;
use vm::memory::GuestMemory;

/// The inputs and outputs that a path drives or waits for.
pub(crate) trait Bits {
    /// Returns whether a bit is high.
    fn is_high(&mut self, memory: &GuestMemory, bit: Bit) -> bool;

    /// Drives a bit.
    fn drive(&mut self, memory: &mut GuestMemory, bit: Bit, high: bool);
}

/// The state of coordinated motion between ticks, in addition to guest memory.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct CoordinatedMotion {
    /// The last segment of a smoothed path, while it lasts.
    spline: Option<smoothing::Spline>,
}
