//! Sorts entries by time: a slice is reported at its end, an edge with the next tick.

use std::collections::BTreeMap;

use kmotiondef::Cycles;

use super::TraceEntry;

/// The largest delay with which an event may be reported.
const WINDOW: Cycles = Cycles::new(4 * Cycles::PER_TICK.get());

/// Entries that wait for earlier ones.
#[derive(Debug, Default)]
pub(super) struct Order {
    waiting: BTreeMap<(Cycles, u64), TraceEntry>,
    count: u64,
    newest: Cycles,
    /// The time of the last entry that was taken.
    last: Cycles,
}

impl Order {
    /// Adds an entry; entries with the same time stay in the order of arrival.
    pub(super) fn add(&mut self, at: Cycles, entry: TraceEntry) {
        self.newest = self.newest.max(at);
        self.waiting.insert((at, self.count), entry);
        self.count += 1;
    }

    /// The next entry, once no earlier one can arrive any more; at the end, simply the next one.
    pub(super) fn take(&mut self, is_over: bool) -> Option<(Cycles, TraceEntry)> {
        let next = self.waiting.first_entry()?;
        let at = next.key().0;
        if !is_over && at > self.newest - WINDOW {
            return None;
        }
        self.last = self.last.max(at);
        Some((self.last, next.remove()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn entries_are_ordered_by_time() {
        let mut order = Order::default();
        let tick = |ticks: i64| Cycles::new(ticks * Cycles::PER_TICK.get());
        for (at, byte) in [(5, b'b'), (4, b'a'), (5, b'c')] {
            order.add(tick(at), TraceEntry::Sent(byte));
        }
        assert_eq!(order.take(false), None);
        order.add(tick(9), TraceEntry::Sent(b'd'));
        let taken: Vec<_> = std::iter::from_fn(|| order.take(false)).map(|(_, entry)| entry).collect();
        assert_eq!(taken, [b'a', b'b', b'c'].map(TraceEntry::Sent));
        assert_eq!(order.take(true), Some((tick(9), TraceEntry::Sent(b'd'))));
    }
}
