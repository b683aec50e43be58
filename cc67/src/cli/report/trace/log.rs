//! The recording in memory from which plots are made.
//!
//! A plot of a longer run is no larger, and neither is this recording: if it grows too large, only the later one of
//! every two samples is kept, and spans with short gaps are merged.

use std::collections::{BTreeMap, BTreeSet};

use kmotiondef::{Bit, CodeAddr, Cycles, ThreadId};
use runtime::Remark;
use runtime::trace::{Quantity, TraceRequest};

use super::TraceEntry;
use super::columns::Columns;

/// The maximum number of samples.
pub(crate) const SAMPLES: usize = 200_000;
/// The maximum number of spans for bits, and for threads.
const SPANS: usize = 500_000;
/// The maximum number of interruptions of threads.
const INTERRUPTIONS: usize = 200_000;
/// The maximum number of remarks on accesses of two threads.
const RACES: usize = 100;

/// A recording in memory.
#[derive(Debug)]
pub(super) struct Log {
    columns: Columns,
    pub(super) samples: Vec<(Cycles, Vec<f64>)>,
    /// The time that a sample represents.
    pub(super) step: Cycles,
    /// The intervals in which bits were high.
    bits: Spans<Bit>,
    /// The bits that are high, and the times since when.
    high: BTreeMap<Bit, Cycles>,
    /// The bits that have changed.
    changed: BTreeSet<Bit>,
    /// The intervals in which threads had the processor.
    pub(super) threads: Spans<ThreadId>,
    /// The first interruptions of threads at instructions.
    pub(super) interruptions: Vec<Interruption>,
    /// The first remarks on accesses of two threads, each with its time.
    pub(super) races: Vec<(Cycles, Remark)>,
}

/// The end of a slice before an instruction.
#[derive(Clone, Copy, Debug)]
pub(super) struct Interruption {
    pub(super) thread: ThreadId,
    pub(super) at: Cycles,
    /// The instruction.
    pub(super) before: CodeAddr,
}

impl Log {
    /// Creates an empty recording for a request.
    pub(super) fn new(request: &TraceRequest) -> Self {
        let every = i64::try_from(request.every).unwrap_or(i64::MAX);
        Self {
            columns: Columns::new(request),
            samples: Vec::new(),
            step: Cycles::new(Cycles::PER_TICK.get().saturating_mul(every)),
            bits: Spans::new(SPANS),
            high: BTreeMap::new(),
            changed: BTreeSet::new(),
            threads: Spans::new(SPANS),
            interruptions: Vec::new(),
            races: Vec::new(),
        }
    }

    /// Adds an entry.
    pub(super) fn note(&mut self, at: Cycles, entry: TraceEntry) {
        match entry {
            TraceEntry::Bit { bit, level, .. } => self.note_bit(bit, level, at),
            TraceEntry::Slice { thread, end, interrupted_at } => {
                self.threads.add(thread, at, end);
                let interruption = interrupted_at.map(|before| Interruption { thread, at: end, before });
                self.interruptions.extend(interruption.filter(|_| self.interruptions.len() < INTERRUPTIONS));
            }
            TraceEntry::Race(remark) if self.races.len() < RACES => self.races.push((at, remark)),
            TraceEntry::Sample { values, enabled } => {
                self.columns.note(enabled);
                keep(&mut self.samples, self.step, (at, values));
                if self.samples.len() > SAMPLES {
                    self.thin();
                }
            }
            TraceEntry::Line(_) | TraceEntry::Sent(_) | TraceEntry::Packet { .. } | TraceEntry::Race(_) => {}
        }
    }

    fn note_bit(&mut self, bit: Bit, level: bool, at: Cycles) {
        let is_first = self.changed.insert(bit);
        if level {
            self.high.entry(bit).or_insert(at);
        } else if let Some(since) = self.high.remove(&bit) {
            self.bits.add(bit, since, at);
        } else if is_first {
            self.bits.add(bit, Cycles::default(), at);
        }
    }

    /// Doubles the time represented by a sample, until a quarter of the samples are removed.
    fn thin(&mut self) {
        while self.samples.len() > SAMPLES / 4 * 3 {
            self.step = self.step + self.step;
            let mut thin = Vec::new();
            for sample in self.samples.drain(..) {
                keep(&mut thin, self.step, sample);
            }
            self.samples = thin;
        }
    }

    /// Returns the quantities to show, each with its index in a sample; for axes that are not measured, the positions
    /// of the loads.
    pub(super) fn columns(&self, is_measured: impl Fn(usize) -> bool) -> Vec<(usize, &Quantity)> {
        self.columns.plot_columns(is_measured)
    }

    /// The bits that have changed, in ascending order.
    pub(super) fn changed_bits(&self) -> impl Iterator<Item = Bit> {
        self.changed.iter().copied()
    }

    /// The intervals in which a bit that has changed was high, up to `end`.
    pub(super) fn spans_of(&self, bit: Bit, end: Cycles) -> Vec<(Cycles, Cycles)> {
        let last = self.high.get(&bit).map(|since| (*since, end));
        self.bits.of(bit).chain(last).collect()
    }

    /// Returns whether a bit has changed.
    pub(super) fn has_changed(&self, bit: Bit) -> bool {
        self.changed.contains(&bit)
    }
}

/// Adds a sample; in each interval of `step`, only the last one is kept: the values at the interval's end.
fn keep(samples: &mut Vec<(Cycles, Vec<f64>)>, step: Cycles, sample: (Cycles, Vec<f64>)) {
    let interval = |at: Cycles| (at.get() - 1).div_euclid(step.get());
    match samples.last_mut() {
        Some(last) if interval(last.0) == interval(sample.0) => *last = sample,
        _ => samples.push(sample),
    }
}

/// Intervals of time in which a state held.
#[derive(Debug)]
pub(super) struct Spans<K> {
    list: Vec<(K, Cycles, Cycles)>,
    limit: usize,
    /// Spans with a shorter gap are merged.
    gap: Cycles,
}

impl<K: Copy + Ord> Spans<K> {
    fn new(limit: usize) -> Self {
        Self { list: Vec::new(), limit, gap: Cycles::PER_TICK }
    }

    /// Adds a span; the spans of one key come in the order of time.
    fn add(&mut self, key: K, from: Cycles, to: Cycles) {
        self.list.push((key, from, to));
        if self.list.len() > self.limit {
            self.join();
        }
    }

    /// Merges close spans until half of them are gone.
    fn join(&mut self) {
        while self.list.len() > self.limit / 2 {
            let mut last: BTreeMap<K, usize> = BTreeMap::new();
            let mut joined: Vec<(K, Cycles, Cycles)> = Vec::new();
            for (key, from, to) in self.list.drain(..) {
                match last.get(&key).and_then(|index| joined.get_mut(*index)) {
                    Some(span) if from - span.2 < self.gap => span.2 = span.2.max(to),
                    _ => {
                        last.insert(key, joined.len());
                        joined.push((key, from, to));
                    }
                }
            }
            self.list = joined;
            self.gap = self.gap + self.gap;
        }
    }

    /// The spans of one key.
    pub(super) fn of(&self, key: K) -> impl Iterator<Item = (Cycles, Cycles)> {
        self.list.iter().filter(move |(other, _, _)| *other == key).map(|(_, from, to)| (*from, *to))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn ticks(ticks: i64) -> Cycles {
        Cycles::new(ticks * Cycles::PER_TICK.get())
    }

    #[test]
    fn a_long_run_takes_no_more_memory_than_a_picture_needs() {
        let mut log =
            Log::new(&TraceRequest { quantities: Vec::new(), every: 1, changes: true, packets: None });
        let count = 5 * SAMPLES as i64;
        for tick in 1..=count {
            log.note(ticks(tick), TraceEntry::Sample { values: vec![tick as f64], enabled: 0 });
        }
        assert_eq!(log.step, ticks(8));
        assert!((SAMPLES / 2..=SAMPLES).contains(&log.samples.len()), "{}", log.samples.len());
        // The remaining samples are at the ends of intervals of eight ticks.
        assert!(
            log.samples
                .iter()
                .all(|(at, values)| at.get() % log.step.get() == 0 && ticks(values[0] as i64) == *at)
        );
        assert_eq!(log.samples.last(), Some(&(ticks(count), vec![count as f64])));
    }

    #[test]
    fn close_spans_are_merged_when_there_are_too_many() {
        let mut spans = Spans::new(100);
        for index in 0..101 {
            spans.add(index % 2, ticks(4 * index), ticks(4 * index + 1));
        }
        assert_eq!(spans.of(0).collect::<Vec<_>>(), [(ticks(0), ticks(401))]);
        assert_eq!(spans.of(1).collect::<Vec<_>>(), [(ticks(4), ticks(397))]);
        let mut few = Spans::new(100);
        few.add((), ticks(0), ticks(1));
        few.add((), ticks(1), ticks(2));
        assert_eq!(few.of(()).count(), 2);
    }
}
