//! Schedules: timing that the board leaves open, fixed so that a run can be repeated.
//!
//! On the board, programs that a PC starts together begin some ticks apart, an operator does not press a switch at an
//! exact tick, and a servo interrupt can fall between any two accesses to shared memory. A schedule fixes these:
//! offsets of starts, an offset of the stimulus, and the accesses before which a thread is switched. A seed results in
//! a schedule with few switches, as in probabilistic concurrency testing (Burckhardt and others, 2010): most errors
//! need only one or two.

use std::collections::{BTreeMap, BTreeSet};
use std::fmt;
use std::str::FromStr;

use kmotiondef::{Cycles, ThreadId};
use runtime::stimulus::{Stimulus, Trigger};
use vm::engine::{ObservedAccesses, Preemption};

use crate::{HostError, Setup};

/// The offsets and switches of a run.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Schedule {
    /// The delay of each thread's start, in ticks.
    starts: BTreeMap<ThreadId, u64>,
    /// The delay of stimulus statements with a time after the start, in ticks; negative for early.
    input: i64,
    /// The accesses to shared memory before which a thread is switched, numbered from 1.
    switches: BTreeSet<u64>,
}

/// The longest delay of a start that a seed selects, in ticks.
const MAX_START: u64 = 40;

/// The largest shift of the stimulus that a seed selects, in ticks.
const MAX_INPUT: u64 = 20;

/// A seed selects accesses up to a power of 2 with at most this exponent.
const MAX_EXPONENT: u64 = 14;

impl Schedule {
    /// The schedule for a seed; seed 0 is the plain run.
    #[must_use]
    pub fn from_seed(seed: u64) -> Self {
        let mut schedule = Self::default();
        if seed == 0 {
            return schedule;
        }
        let mut numbers = RandomNumbers(seed);
        for _ in 0..numbers.below(4) {
            let exponent = 3 + numbers.below(MAX_EXPONENT - 2);
            schedule.switches.insert(1 + numbers.below(1 << exponent));
        }
        if numbers.below(2) == 0 {
            for thread in ThreadId::all() {
                let ticks = numbers.below(MAX_START + 1);
                if numbers.below(2) == 0 && ticks > 0 {
                    schedule.starts.insert(thread, ticks);
                }
            }
        }
        if numbers.below(2) == 0 {
            schedule.input = numbers.below(2 * MAX_INPUT + 1).cast_signed() - MAX_INPUT.cast_signed();
        }
        schedule
    }

    /// The schedules with one part less than this one has.
    pub fn smaller(&self) -> impl Iterator<Item = Self> + '_ {
        let without_switch = self.switches.iter().map(|number| {
            let mut smaller = self.clone();
            smaller.switches.remove(number);
            smaller
        });
        let without_start = self.starts.keys().map(|thread| {
            let mut smaller = self.clone();
            smaller.starts.remove(thread);
            smaller
        });
        let without_input = (self.input != 0).then(|| Self { input: 0, ..self.clone() });
        without_input.into_iter().chain(without_start).chain(without_switch)
    }

    /// The number of switches.
    #[must_use]
    pub fn switches(&self) -> usize {
        self.switches.len()
    }
}

impl Setup {
    /// Makes the board run by a schedule.
    ///
    /// # Errors
    /// The stimulus cannot be combined with the delayed starts.
    pub fn schedule(&mut self, schedule: &Schedule) -> Result<(), HostError> {
        for rule in &mut self.stimulus.rules {
            // A rule that holds from the start is not an event.
            if let Trigger::At(time) = &mut rule.trigger
                && *time > Cycles::default()
            {
                let shifted = *time + Cycles::new(schedule.input * Cycles::PER_TICK.get());
                *time = shifted.max(Cycles::default());
            }
        }
        let mut starts = String::new();
        for program in self.programs.iter_mut().filter(|program| program.starts) {
            if let Some(ticks) = schedule.starts.get(&program.thread) {
                program.starts = false;
                let seconds = *ticks as f64 * kmotiondef::limits::TIMEBASE;
                starts.push_str(&format!("t={seconds:.5} start thread {}\n", program.thread));
            }
        }
        self.stimulus.extend(Stimulus::parse(&starts, "--schedule")?);
        self.config.machine.preemption = Preemption::Instructions;
        self.config.machine.observed = ObservedAccesses::All;
        self.config.switches.clone_from(&schedule.switches);
        Ok(())
    }
}

/// A schedule as text: `start2+7,input-3,switch57`, or `plain` for one without parts.
impl fmt::Display for Schedule {
    fn fmt(&self, formatter: &mut fmt::Formatter<'_>) -> fmt::Result {
        let starts = self.starts.iter().map(|(thread, ticks)| format!("start{thread}+{ticks}"));
        let input = (self.input != 0).then(|| format!("input{:+}", self.input));
        let switches = self.switches.iter().map(|number| format!("switch{number}"));
        let parts: Vec<_> = starts.chain(input).chain(switches).collect();
        formatter.write_str(if parts.is_empty() { "plain".into() } else { parts.join(",") }.as_str())
    }
}

/// Reads a seed, or the text that [`fmt::Display`] writes.
impl FromStr for Schedule {
    type Err = String;

    fn from_str(text: &str) -> Result<Self, String> {
        if let Ok(seed) = text.parse() {
            return Ok(Self::from_seed(seed));
        }
        let mut schedule = Self::default();
        for part in text.split(',').filter(|part| *part != "plain") {
            schedule.take(part).ok_or_else(|| {
                format!("`{part}` is not a part of a schedule: a seed, or parts such as start2+7, input-3, switch57 with commas between them")
            })?;
        }
        Ok(schedule)
    }
}

impl Schedule {
    fn take(&mut self, part: &str) -> Option<()> {
        if let Some(number) = part.strip_prefix("switch") {
            self.switches.insert(number.parse().ok()?);
        } else if let Some(ticks) = part.strip_prefix("input") {
            self.input = ticks.parse().ok()?;
        } else {
            let (thread, ticks) = part.strip_prefix("start")?.split_once('+')?;
            self.starts.insert(ThreadId::new(thread.parse().ok()?)?, ticks.parse().ok()?);
        }
        Some(())
    }
}

/// A small random number generator (Steele and others, splitmix64).
struct RandomNumbers(u64);

impl RandomNumbers {
    fn below(&mut self, limit: u64) -> u64 {
        self.0 = self.0.wrapping_add(0x9E37_79B9_7F4A_7C15);
        let mut number = self.0;
        number = (number ^ (number >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        number = (number ^ (number >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        (number ^ (number >> 31)) % limit.max(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_text_of_a_schedule_is_read_back() {
        for seed in 0..500 {
            let schedule = Schedule::from_seed(seed);
            assert_eq!(schedule.to_string().parse(), Ok(schedule.clone()), "{seed}");
            assert!(schedule.switches() <= 3);
        }
        assert_eq!("7".parse(), Ok(Schedule::from_seed(7)));
        assert_eq!("plain".parse(), Ok(Schedule::default()));
        for wrong in ["switch", "start9+1", "start1", "input", "x"] {
            assert!(wrong.parse::<Schedule>().is_err(), "{wrong}");
        }
    }

    #[test]
    fn smaller_schedules_lack_one_part_each() {
        let schedule: Schedule = "start2+7,input-3,switch5,switch57".parse().expect("it is one");
        let smaller: Vec<_> = schedule.smaller().map(|smaller| smaller.to_string()).collect();
        assert_eq!(
            smaller,
            [
                "start2+7,switch5,switch57",
                "input-3,switch5,switch57",
                "start2+7,input-3,switch57",
                "start2+7,input-3,switch5"
            ]
        );
    }
}
