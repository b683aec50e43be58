//! Where the time of real images went: for each packet, and for each call of the firmware, what it took.
//!
//! Nothing is sampled: packets are executed one at a time, and a run is the same, cycle by cycle, as without an account.

use std::collections::BTreeMap;

use kmotiondef::{CodeAddr, Cycles, GuestAddr};

use crate::engine::ContextId;

/// What time was spent on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Spender {
    /// The thread or the call-back.
    pub context: ContextId,
    /// The packet.
    pub at: CodeAddr,
    /// The firmware function that it calls, if the time was spent there.
    pub firmware: Option<GuestAddr>,
}

/// What was spent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Time {
    /// Processor time.
    pub computing: Cycles,
    /// Time in which a firmware function made the thread wait.
    pub waiting: Cycles,
}

/// Where the time went.
#[derive(Clone, Debug, Default)]
pub struct Account {
    spent: BTreeMap<Spender, Time>,
    /// What each waiting context waits in, and since when.
    waits: [Option<(Spender, Cycles)>; ContextId::COUNT],
}

impl Account {
    /// All that has spent time, in their order.
    pub fn spent(&self) -> impl Iterator<Item = (Spender, Time)> {
        self.spent.iter().map(|(spender, time)| (*spender, *time))
    }

    pub(super) fn compute(&mut self, spender: Spender, computing: Cycles) {
        self.spent.entry(spender).or_default().computing += computing;
    }

    /// A context begins to wait.
    pub(super) fn wait(&mut self, spender: Spender, now: Cycles) {
        self.waits[spender.context.index()] = Some((spender, now));
    }

    /// A context continues.
    pub(super) fn resume(&mut self, context: ContextId, now: Cycles) {
        if let Some((spender, since)) = self.waits[context.index()].take() {
            self.spent.entry(spender).or_default().waiting += now - since;
        }
    }
}
