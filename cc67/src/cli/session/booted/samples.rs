//! What the processor of a booted board does, looked at again and again, for a profile.

use std::collections::BTreeMap;

use boot::{BootedBoard, Doing};
use kmotiondef::Cycles;

/// Cycles between two looks: a prime, so that no loop and no tick keeps step with them.
const PERIOD: u64 = 997;

/// How often the processor was seen at each place.
#[derive(Debug)]
pub(crate) struct Samples {
    /// The cycle of the next look.
    pub(super) next: u64,
    seen: BTreeMap<Doing, i64>,
}

impl Samples {
    /// None yet; the first look is a period after this cycle.
    pub(super) const fn new(now: u64) -> Self {
        Self { next: now + PERIOD, seen: BTreeMap::new() }
    }

    /// A look, the one that was due.
    pub(super) fn note(&mut self, board: &BootedBoard) {
        *self.seen.entry(board.doing()).or_default() += 1;
        self.next += PERIOD;
    }

    /// The places, and the time that each look stands for.
    pub(crate) fn seen(&self) -> impl Iterator<Item = (&Doing, Cycles)> {
        self.seen.iter().map(|(doing, count)| (doing, Cycles::new(count * PERIOD as i64)))
    }
}
