//! Thread switches at accesses to shared memory, according to a schedule.
//!
//! Accesses of threads are counted, except for those of a loop that loads the same cell repeatedly, because the length
//! of such a wait varies. The count depends only on the programs and on earlier switches.

use std::collections::BTreeSet;

use kmotiondef::variables::cell_name;
use kmotiondef::{CodeAddr, GuestAddr, ThreadId};
use vm::firmware::{NextAccess, SwitchPoint};

use super::Actor;
use crate::out::{Message, Out, Speaker};

/// The switches of a schedule, and the progress in it.
#[derive(Clone, Debug)]
pub(crate) struct Switches {
    /// The numbers of the accesses before which a thread is switched, from 1.
    numbers: BTreeSet<u64>,
    /// The number of accesses so far.
    count: u64,
    threads: [ThreadAccesses; ThreadId::MAX as usize],
}

/// The accesses of a thread.
#[derive(Clone, Copy, Debug, Default)]
struct ThreadAccesses {
    /// The access that has been counted and not yet made.
    next: Option<(CodeAddr, GuestAddr)>,
    /// The last one.
    last: Option<(CodeAddr, GuestAddr)>,
}

impl Switches {
    /// Those with these numbers.
    pub(crate) fn new(numbers: BTreeSet<u64>) -> Self {
        Self { numbers, count: 0, threads: Default::default() }
    }

    /// The point at which a thread is switched at an access that it is about to make; an eight-byte store has two
    /// points.
    pub(crate) fn switch_point(&mut self, access: &NextAccess, out: &mut Out) -> Option<SwitchPoint> {
        let NextAccess { thread, at, address, size, is_store, now } = *access;
        let accesses = &mut self.threads[thread.index()];
        let this = Some((at, address));
        let is_waiting = !is_store && accesses.last == this;
        if accesses.next == this || is_waiting {
            return None;
        }
        accesses.next = this;
        let has_loaded = is_store && accesses.last.is_some_and(|(_, last)| last == address);
        let is_before = self.count();
        let is_between = is_store && size == 8 && self.count();
        let (point, does) = match (is_before, is_between, is_store, has_loaded) {
            (false, false, ..) => return None,
            (false, true, ..) => (SwitchPoint::BetweenWords, "between the two words that this one stores to"),
            (true, _, true, true) => (SwitchPoint::Before, "between the load and the store by this one of"),
            (true, _, true, false) => (SwitchPoint::Before, "before this one stores to"),
            (true, _, false, _) => (SwitchPoint::Before, "before this one loads"),
        };
        let message = Message::Switched { does, cell: cell_name(address, size) };
        out.remark_of(now, Speaker::from(Some(thread)), Some(at), message);
        Some(point)
    }

    /// Returns whether a thread is switched after it has taken a lock.
    pub(crate) fn after_lock(&mut self, actor: Actor, lock: GuestAddr, out: &mut Out) -> bool {
        let is_switched = self.count();
        if is_switched {
            let message = Message::Switched { does: "after this one has taken", cell: cell_name(lock, 4) };
            out.remark_of(actor.now, Speaker::from(actor.thread), Some(actor.at), message);
        }
        is_switched
    }

    /// Counts a point; returns whether a thread is switched there.
    fn count(&mut self) -> bool {
        self.count += 1;
        self.numbers.contains(&self.count)
    }

    /// Notes that a thread has made an access.
    pub(crate) fn record_access(&mut self, thread: ThreadId, at: CodeAddr, address: GuestAddr) {
        let accesses = &mut self.threads[thread.index()];
        accesses.next = None;
        accesses.last = Some((at, address));
    }
}
