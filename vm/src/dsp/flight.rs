//! Effects in flight: results, branches, and double instructions that have not read all of their sources.
//!
//! Results wait in sixteen slots; the slot of a cycle is its number modulo 16. The cycles in which an effect may land
//! are kept in a separate mask, so that cycles without one pass quickly.

use super::decode::MicroOp;

/// Slots; more than the longest latency.
pub(super) const SLOTS: usize = 16;
/// All possible delays.
pub(super) const ANY: u32 = (1 << SLOTS) - 2;

/// A double instruction that has not read all of its sources.
#[derive(Clone, Copy, Debug)]
pub(super) struct PendingDouble {
    /// The cycle of its next read.
    pub(super) due: u64,
    /// The cycle of its issue.
    pub(super) issued: u64,
    /// The instruction.
    pub(super) micro: MicroOp,
    /// Low word of s1; all of a single.
    pub(super) low1: u32,
    /// Low word of s2.
    pub(super) low2: u32,
    /// High word of s2, once it has been read.
    pub(super) high2: Option<u32>,
}

/// The effects in flight: results, branches, double instructions that have more to read.
#[derive(Clone, Debug)]
pub(super) struct InFlightEffects {
    /// The cycles in which an effect may land, relative to the present one: bit k for k cycles; bit 0 is meaningless.
    ///
    /// The effects that a packet may issue are known when it is decoded, so this changes once per packet rather than
    /// with each result; a bit may be set for an instruction that was not executed.
    pub(super) due: u32,
    pub(super) masks: [u64; SLOTS],
    pub(super) values: Box<[[u32; 64]; SLOTS]>,
    pub(super) branches: u16,
    pub(super) targets: [u32; SLOTS],
    pub(super) late: Vec<PendingDouble>,
}

impl InFlightEffects {
    /// Reports whether nothing is in flight.
    pub(super) const fn is_empty(&self) -> bool {
        self.due >> 1 == 0
    }

    /// Notes that an effect may land after each of these delays.
    #[inline(always)]
    pub(super) const fn expect(&mut self, delays: u32) {
        self.due |= delays;
    }
}

impl Default for InFlightEffects {
    fn default() -> Self {
        Self {
            due: 0,
            masks: [0; SLOTS],
            values: Box::new([[0; 64]; SLOTS]),
            branches: 0,
            targets: [0; SLOTS],
            late: Vec::new(),
        }
    }
}
