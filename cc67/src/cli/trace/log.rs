//! What pictures are made of: everything that was recorded, in memory.

use kmotiondef::{Bit, Cycles, ThreadId};
use runtime::trace::{Quantity, Request};

use super::Entry;
use super::columns::Columns;

/// A change of a bit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Change {
    pub(super) at: Cycles,
    pub(super) bit: Bit,
    pub(super) level: bool,
}

/// Everything that was recorded.
#[derive(Debug)]
pub(super) struct Log {
    columns: Columns,
    pub(super) changes: Vec<Change>,
    pub(super) slices: Vec<(ThreadId, Cycles, Cycles)>,
    pub(super) samples: Vec<(Cycles, Vec<f64>)>,
}

impl Log {
    /// Nothing yet, of what was asked for.
    pub(super) fn new(request: &Request) -> Self {
        Self { columns: Columns::new(request), changes: Vec::new(), slices: Vec::new(), samples: Vec::new() }
    }

    /// Keeps an entry.
    pub(super) fn note(&mut self, at: Cycles, entry: Entry) {
        match entry {
            Entry::Bit { bit, level, .. } => self.changes.push(Change { at, bit, level }),
            Entry::Slice { thread, end } => self.slices.push((thread, at, end)),
            Entry::Sample { values, enabled } => {
                self.columns.note(enabled);
                self.samples.push((at, values));
            }
            Entry::Line(_) | Entry::Sent(_) => {}
        }
    }

    /// What to show, and where each stands in a sample.
    pub(super) fn columns(&self) -> Vec<(usize, &Quantity)> {
        self.columns.shown().collect()
    }

    /// Bits that have changed, in ascending order, each with its level before.
    pub(super) fn bits(&self) -> Vec<(Bit, bool)> {
        let mut bits: Vec<(Bit, bool)> = Vec::new();
        for change in &self.changes {
            if bits.iter().all(|(bit, _)| *bit != change.bit) {
                bits.push((change.bit, !change.level));
            }
        }
        bits.sort_unstable();
        bits
    }
}
