//! Samples the quantities that were requested.

use kmotiondef::structs::Chan;
use kmotiondef::{ThreadId, Ticks};

use super::{Packets, Quantity, Record, TraceRequest, View};
use crate::views::TypedAccess;

/// A recording in progress.
#[derive(Clone, Debug)]
pub(crate) struct Recorder {
    request: TraceRequest,
    /// The values as bits, so that a NaN equals itself, and the enabled axes.
    last: Option<(Vec<u64>, u16)>,
}

impl Recorder {
    pub(crate) fn new(request: TraceRequest) -> Self {
        Self { request, last: None }
    }

    /// Returns whether levels and slices are recorded.
    pub(crate) fn records_changes(&self) -> bool {
        self.request.changes
    }

    /// Returns whether the packets of a thread, or of the call-back for `None`, are recorded.
    pub(crate) fn records_packets(&self, thread: Option<ThreadId>) -> bool {
        self.request.packets.is_some_and(|packets| match packets {
            Packets::All => true,
            Packets::Of(one) => thread == Some(one),
        })
    }

    /// Returns whether an item is sampled.
    pub(crate) fn samples(&self, name: &str) -> bool {
        self.request.quantities.iter().filter_map(Quantity::item).any(|item| item.kind() == name)
    }

    /// The last sampled tick of the `count` ticks up to and including `tick`, if there is one.
    pub(crate) fn sampled_tick(&self, tick: Ticks, count: u64) -> Option<Ticks> {
        let sampled = tick.get() - tick.get() % self.request.every;
        (sampled + count > tick.get()).then_some(Ticks::new(sampled))
    }

    /// The values, if some of them have changed since the last call.
    pub(crate) fn sample(&mut self, view: &View<'_>) -> Option<Record> {
        let values: Vec<f64> = self.request.quantities.iter().map(|quantity| quantity.read(view)).collect();
        let enabled = view
            .memory
            .axes()
            .iter()
            .rev()
            .fold(0, |word, axis| word << 1 | u16::from(view.memory.axis(axis, Chan::ENABLE) != 0));
        let sample = Some((values.iter().map(|value| value.to_bits()).collect(), enabled));
        if sample == self.last {
            return None;
        }
        self.last = sample;
        Some(Record::Sample { values, enabled })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_sampled_at_multiples_even_when_they_are_skipped() {
        let recorder =
            Recorder::new(TraceRequest { quantities: Vec::new(), every: 10, changes: false, packets: None });
        for (tick, count, expect) in [(10, 1, Some(10)), (11, 1, None), (35, 20, Some(30)), (29, 9, None)] {
            let sampled = recorder.sampled_tick(Ticks::new(tick), count).map(Ticks::get);
            assert_eq!(sampled, expect, "{tick} {count}");
        }
    }
}
