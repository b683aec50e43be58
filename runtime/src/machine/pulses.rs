//! Changes of inputs that the world drives: programs that poll too rarely miss pulses or see a change late, or begin to wait
//! after it.

use std::collections::BTreeMap;

use kmotiondef::{Bit, CodeAddr, Cycles};

/// A pulse between two reads of a program.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MissedPulse {
    /// Its length, and the time between the reads.
    pub(crate) width_ms: f64,
    pub(crate) gap_ms: f64,
}

/// The observation made by a read about the time since the previous one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum ReadNotice {
    /// A pulse came and went.
    Missed(MissedPulse),
    /// A guarded input fell this long ago, while the program waited for something else.
    Late { ms: f64 },
}

/// The latest changes of the inputs that the world drives.
#[derive(Clone, Debug, Default)]
pub(crate) struct Pulses(BTreeMap<Bit, InputHistory>);

#[derive(Clone, Debug, Default)]
struct InputHistory {
    level: bool,
    /// The times of the last changes, the latest first.
    changes: [Cycles; 3],
    count: u32,
    read: Option<LastRead>,
}

/// The last read of a bit.
#[derive(Clone, Copy, Debug)]
struct LastRead {
    site: Option<CodeAddr>,
    at: Cycles,
    level: bool,
    /// Changes up to the read.
    count: u32,
    /// Consecutive reads from the same place, and those among them that immediately followed the previous one.
    reads: u32,
    quick: u32,
}

/// Reads that follow each other this closely come from a loop that does little else.
const QUICK: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 100);

impl InputHistory {
    /// The pulse that has begun and ended since a read.
    fn missed_pulse(&self, before: &LastRead, level: bool, now: Cycles) -> Option<MissedPulse> {
        /// Shorter pulses are bounces, or meant for other hardware.
        const SHORTEST: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 1000);
        /// A program that reads less often does not poll.
        const RAREST: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 2);
        const POLLS: u32 = 3;
        /// Between two pulses is this many times their length: contacts that bounce have less.
        const APART: i64 = 5;
        let [end, begin, earlier] = self.changes;
        let (width, gap) = (end - begin, now - before.at);
        let is_pulse = self.count - before.count == 2 && before.level == level && width >= SHORTEST;
        let is_alone = self.count == 2 || (begin - earlier).get() >= APART * width.get();
        let is_polled = before.reads >= POLLS && gap <= RAREST;
        (is_pulse && is_alone && is_polled)
            .then(|| MissedPulse { width_ms: milliseconds(width), gap_ms: milliseconds(gap) })
    }

    /// Handles the first fall of an input that has been on from the start, as in a safety chain, while the loop that
    /// has always watched it waits for something else.
    fn late_read(&self, before: &LastRead, level: bool, now: Cycles) -> Option<ReadNotice> {
        const WATCHED: u32 = 100;
        const LATE: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 2);
        let fell = self.changes[0];
        let was_on = before.level && before.count <= 1;
        let has_fallen = was_on && !level && self.count - before.count == 1;
        let late = now - fell;
        (has_fallen && before.quick >= WATCHED && late >= LATE)
            .then(|| ReadNotice::Late { ms: milliseconds(late) })
    }
}

impl Pulses {
    /// Notes that an input is on while it is not driven.
    pub(crate) fn idle_high(&mut self, bit: Bit) {
        self.0.entry(bit).or_default().level = true;
    }

    /// The world drives an input to a level.
    pub(crate) fn drive(&mut self, bit: Bit, level: bool, now: Cycles) {
        let driven = self.0.entry(bit).or_default();
        if driven.level != level {
            driven.level = level;
            driven.changes = [now, driven.changes[0], driven.changes[1]];
            driven.count = driven.count.saturating_add(1);
        }
    }

    /// Notes that a program reads a bit; returns what has happened on it since the previous read from the same place.
    pub(crate) fn read(
        &mut self,
        bit: Bit,
        site: Option<CodeAddr>,
        level: bool,
        now: Cycles,
    ) -> Option<ReadNotice> {
        let driven = self.0.entry(bit).or_default();
        let before = driven.read.filter(|before| before.site == site);
        let is_quick = before.is_some_and(|before| now - before.at <= QUICK);
        let (reads, quick) = before.map_or((1, 0), |before| {
            (before.reads.saturating_add(1), before.quick.saturating_add(is_quick.into()))
        });
        driven.read = Some(LastRead { site, at: now, level, count: driven.count, reads, quick });
        let before = before?;
        let missed = driven.missed_pulse(&before, level, now).map(ReadNotice::Missed);
        missed.or_else(|| driven.late_read(&before, level, now))
    }

    /// The last pulse at an input, which ended before an instant: its beginning and its end.
    pub(crate) fn last_before(&self, bit: Bit, instant: Cycles) -> Option<(Cycles, Cycles)> {
        let driven = self.0.get(&bit)?;
        let [end, begin, _] = driven.changes;
        (driven.count >= 2 && end <= instant).then_some((begin, end))
    }
}

fn milliseconds(time: Cycles) -> f64 {
    1e3 * time.get() as f64 / Cycles::PER_SECOND.get() as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A millisecond.
    const MS: i64 = Cycles::PER_SECOND.get() / 1000;

    fn polled(changes: &[i64], every: i64) -> Option<ReadNotice> {
        let bit = Bit::new(136).expect("it is one");
        let mut pulses = Pulses::default();
        let (mut level, mut changes) = (false, changes.iter().peekable());
        (1..=10).find_map(|read| {
            let now = read * every;
            while let Some(change) = changes.next_if(|change| **change <= now) {
                level = !level;
                pulses.drive(bit, level, Cycles::new(change * MS));
            }
            pulses.read(bit, None, level, Cycles::new(now * MS))
        })
    }

    #[test]
    fn a_pulse_between_two_reads_is_missed_and_a_longer_one_is_not() {
        let missed = MissedPulse { width_ms: 5.0, gap_ms: 50.0 };
        assert_eq!(polled(&[320, 325], 50), Some(ReadNotice::Missed(missed)));
        assert_eq!(polled(&[320, 380], 50), None);
    }

    #[test]
    fn bounces_and_rare_reads_are_not_pulses() {
        assert_eq!(polled(&[301, 303, 306, 310, 320], 50), None);
        assert_eq!(polled(&[4320, 4325], 1000), None);
    }

    #[test]
    fn the_first_fall_of_a_watched_input_is_late_after_a_long_wait() {
        let bit = Bit::new(140).expect("it is one");
        let seen_after = |wait: i64| {
            let mut pulses = Pulses::default();
            pulses.drive(bit, true, Cycles::default());
            let watched = (0..200).find_map(|now| pulses.read(bit, None, true, Cycles::new(now * MS)));
            assert_eq!(watched, None);
            pulses.drive(bit, false, Cycles::new(250 * MS));
            pulses.read(bit, None, false, Cycles::new((250 + wait) * MS))
        };
        assert_eq!(seen_after(1500), Some(ReadNotice::Late { ms: 1500.0 }));
        assert_eq!(seen_after(100), None);
    }
}
