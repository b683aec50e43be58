//! Schedules found by earlier attempts at the same function.
//!
//! Attempts differ in one loop or in the sides of some registers; the earlier stages yield most regions unchanged. A
//! region that equals an earlier one gets the same packets without a new search.

use super::expand::Region;
use super::modulo::{BudgetExceeded, Overlap};
use super::packets::{FETCH, ScheduledRegion};
use super::schedule::{self, Order};

/// The regions of all attempts at a function.
#[derive(Debug, Default)]
pub(super) struct Memo {
    /// The different regions with each label.
    labels: Vec<Vec<KnownRegion>>,
}

/// A region and its schedules.
#[derive(Debug)]
pub(super) struct KnownRegion {
    pub(super) region: Region,
    /// Its packets, by its starting word within a fetch packet.
    plain: Vec<(u32, ScheduledRegion)>,
    /// The overlap of its iterations, if it is a loop.
    plans: Vec<(OverlapKey, SearchedOverlap)>,
}

/// The result of a search for an overlap.
pub(super) type SearchedOverlap = Result<Option<Overlap>, BudgetExceeded>;

/// The facts, besides the region, on which the overlap depends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OverlapKey {
    /// The registers that are read after the loop, a bit each.
    pub(super) read_after: u64,
    /// The cycles of an iteration that does not overlap.
    pub(super) cycles: u32,
}

impl Memo {
    /// Returns the entry of a region that equals this one.
    pub(super) fn entry(&mut self, region: Region) -> &mut KnownRegion {
        let label = region.label as usize;
        if self.labels.len() <= label {
            self.labels.resize_with(label + 1, Vec::new);
        }
        let list = &mut self.labels[label];
        let index = list.iter().position(|known| known.region == region).unwrap_or_else(|| {
            list.push(KnownRegion { region, plain: Vec::new(), plans: Vec::new() });
            list.len() - 1
        });
        &mut list[index]
    }
}

impl KnownRegion {
    /// The packets of the region if it begins at the word `at`.
    pub(super) fn scheduled(&mut self, order: Order, at: u32) -> ScheduledRegion {
        let at = at % FETCH;
        if let Some((_, plain)) = self.plain.iter().find(|(own, _)| *own == at) {
            return plain.clone();
        }
        let plain = schedule::schedule(&self.region, order, at);
        self.plain.push((at, plain.clone()));
        plain
    }

    /// The overlap found by an earlier attempt.
    pub(super) fn plan(&self, question: OverlapKey) -> Option<&SearchedOverlap> {
        self.plans.iter().find(|(own, _)| *own == question).map(|(_, plan)| plan)
    }

    /// Keeps an overlap for later attempts.
    pub(super) fn store_overlap(&mut self, question: OverlapKey, plan: SearchedOverlap) {
        self.plans.push((question, plan));
    }
}
