//! The signals of the scope: the values of the last minutes, one row per sample.

use std::sync::{Arc, Mutex};

use cc67_host::session::{SubscriptionId, expressions};
use cc67_host::{HostError, Session, Target, Watch};
use kmotiondef::Ticks;
use serde::Serialize;

use crate::hub::locked;

/// The number of values kept, for all signals together: 32 MiB.
const KEPT: usize = 4 << 20;
/// The maximum number of signals.
const SIGNALS: usize = 128;
/// The maximum number of rows in a frame.
const ROWS_AT_ONCE: usize = 4096;
/// The number of ticks between samples at real-time speed: 0.9 ms.
const EVERY: u64 = 10;
/// The number of ticks between samples of a connected controller: 50 ms, the interval at which its status record is
/// read.
const EVERY_STATUS: u64 = 555;

/// Rows of samples.
#[derive(Debug, Default)]
struct Rows {
    /// A tick, then the value of each signal; row after row.
    numbers: Vec<f64>,
    /// The number of rows that were dropped before the first one.
    dropped: u64,
    /// The last tick.
    last: Option<Ticks>,
    width: usize,
}

impl Rows {
    fn add(&mut self, tick: Ticks, values: &[f64]) {
        if self.last.is_some_and(|last| tick <= last) {
            // This tick was sampled before, with the same values.
            return;
        }
        self.last = Some(tick);
        self.numbers.push(tick.get() as f64);
        self.numbers.extend(values);
        if self.numbers.len() > KEPT {
            // Drops half at a time, so that each number is moved only once.
            let rows = self.count() / 2;
            self.numbers.drain(..rows * self.width);
            self.dropped += rows as u64;
        }
    }

    /// Drops the samples after a tick.
    fn truncate(&mut self, tick: Ticks) {
        let limit = tick.get() as f64;
        let is_later = |row: &[f64]| row.first().is_some_and(|at| *at > limit);
        let later = self.numbers.rchunks(self.width.max(1)).take_while(|row| is_later(row)).count();
        self.numbers.truncate(self.numbers.len() - later * self.width);
        self.last = self.last.min(Some(tick));
    }

    fn count(&self) -> usize {
        self.numbers.len() / self.width.max(1)
    }
}

/// A signal that cannot be sampled.
#[derive(Clone, Debug, Serialize)]
pub(super) struct WrongSignal {
    /// Its name in the list.
    pub(super) name: String,
    /// The reason.
    pub(super) text: String,
}

/// The sampled signals.
#[derive(Debug, Default)]
pub(super) struct Samples {
    names: Vec<String>,
    /// The signals of the list that cannot be sampled.
    wrong: Vec<WrongSignal>,
    list: String,
    /// The number of ticks between samples at real-time speed.
    interval: u64,
    every: u64,
    subscription: Option<SubscriptionId>,
    rows: Arc<Mutex<Rows>>,
    /// The number of the list, so that rows of another list are not mixed with these.
    pub(super) generation: u32,
}

impl Samples {
    /// Samples nothing yet.
    pub(super) fn new(is_real: bool) -> Self {
        Self { interval: if is_real { EVERY_STATUS } else { EVERY }, ..Self::default() }
    }

    /// Samples the signals of a list, except for the [invalid](Self::invalid_signals) ones.
    pub(super) fn follow<T: Target>(&mut self, session: &mut Session<T>, list: &str, speed: f64) {
        let (mut watched, mut wrong) = (Vec::new(), Vec::new());
        for name in expressions(unquoted(list)).into_iter().map(unquoted).flat_map(parts) {
            match session.watch(&name) {
                Ok(_) if watched.len() == SIGNALS => {
                    wrong.push(WrongSignal {
                        name,
                        text: format!("the scope shows {SIGNALS} signals at most"),
                    });
                }
                Ok(watch) => watched.push(watch),
                Err(error) => wrong.push(WrongSignal { name, text: error.to_string() }),
            }
        }
        self.wrong = wrong;
        self.names = watched.iter().map(ToString::to_string).collect();
        list.clone_into(&mut self.list);
        self.generation += 1;
        self.rows = Arc::new(Mutex::new(Rows { width: watched.len() + 1, ..Rows::default() }));
        self.subscribe(session, watched, speed);
    }

    /// The signals of the list that cannot be sampled.
    pub(super) fn invalid_signals(&self) -> &[WrongSignal] {
        &self.wrong
    }

    /// Samples less often when time passes faster, so that the number of samples per second stays the same.
    pub(super) fn at_speed<T: Target>(&mut self, session: &mut Session<T>, speed: f64) {
        if self.every_at(speed) != self.every {
            let watched = self.names.iter().filter_map(|name| session.watch(name).ok()).collect::<Vec<_>>();
            if watched.len() == self.names.len() {
                self.subscribe(session, watched, speed);
            }
        }
    }

    /// Makes a controller sample the signals, if it should and there are any; returns the number of samples per second.
    pub(super) fn on_target<T: Target>(
        &mut self,
        session: &mut Session<T>,
        is_wanted: bool,
    ) -> Result<Option<f64>, HostError> {
        match self.subscription.filter(|_| is_wanted) {
            Some(subscription) => session.sample_on_target(subscription).map(Some),
            None => {
                session.end_sampling_on_target();
                Ok(None)
            }
        }
    }

    fn subscribe<T: Target>(&mut self, session: &mut Session<T>, watched: Vec<Watch>, speed: f64) {
        if let Some(subscription) = self.subscription.take() {
            session.unsubscribe(subscription);
        }
        self.every = self.every_at(speed);
        if watched.is_empty() {
            return;
        }
        let rows = Arc::clone(&self.rows);
        let receive = move |tick: Ticks, values: &[f64]| locked(&rows).add(tick, values);
        self.subscription = Some(session.subscribe(watched, self.every, receive));
    }

    /// The number of ticks between samples at a speed.
    fn every_at(&self, speed: f64) -> u64 {
        (self.interval as f64 * speed.max(1.0)).round() as u64
    }

    /// Drops the samples after a tick; returns the number of rows up to then.
    pub(super) fn truncate(&self, tick: Ticks) -> u64 {
        let mut rows = locked(&self.rows);
        rows.truncate(tick);
        rows.dropped + rows.count() as u64
    }

    /// The names of the signals.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// The list of the signals.
    pub(super) fn list(&self) -> &str {
        &self.list
    }

    /// Appends the rows from `next` on to a frame, up to the maximum; returns their number, and the next row after
    /// them.
    pub(super) fn write(&self, next: u64, out: &mut Vec<u8>) -> (u32, u64) {
        let rows = locked(&self.rows);
        let first = next.max(rows.dropped);
        let skip = ((first - rows.dropped) as usize).min(rows.count());
        let count = (rows.count() - skip).min(ROWS_AT_ONCE);
        let numbers = rows.numbers.iter().skip(skip * rows.width).take(count * rows.width);
        out.extend(numbers.flat_map(|number| number.to_le_bytes()));
        (count as u32, first + count as u64)
    }
}

/// A name or list without the quotation marks that users copy from a shell command.
fn unquoted(text: &str) -> &str {
    let text = text.trim();
    let inner = text.strip_prefix('\'').and_then(|text| text.strip_suffix('\''));
    inner.filter(|inner| !inner.contains('\'')).unwrap_or(text).trim_matches('"').trim()
}

/// Returns the items for a name in a list: `axis0` is the commanded position, the position and the output of an axis.
fn parts(name: &str) -> Vec<String> {
    match name.strip_prefix("axis").filter(|number| number.parse::<u8>().is_ok()) {
        Some(number) => ["dest", "pos", "out"].map(|kind| format!("{kind}{number}")).to_vec(),
        None => vec![name.to_owned()],
    }
}
