//! Values over time, in columns: one block of memory for each, as NumPy has them.

use cc67_host::{Session, Target, Watch, WatchError};
use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

/// Samples that are being taken.
pub(crate) struct Recorder {
    watched: Vec<Watch>,
    every: u64,
    end: Ticks,
    columns: Columns,
}

/// Samples that were taken.
pub(crate) struct Columns {
    /// Seconds of board time since power-up, at the end of the sampled ticks.
    pub(crate) time: Vec<f64>,
    /// The names, and the values of each.
    pub(crate) named: Vec<(String, Vec<f64>)>,
}

/// Most values of a trace: 4 GiB of them.
pub(crate) const MOST_VALUES: usize = 1 << 29;

impl Recorder {
    /// For `samples` samples, one every `every` ticks, from now on; `axis0` is all of an axis.
    pub(crate) fn new<T: Target>(
        session: &Session<T>,
        items: &[String],
        every: u64,
        samples: usize,
    ) -> Result<Self, WatchError> {
        let mut watched = Vec::new();
        for item in items {
            for name in names(item) {
                watched.push(session.watch(&name)?);
            }
        }
        let named = watched.iter().map(|watch| (watch.to_string(), Vec::with_capacity(samples))).collect();
        let columns = Columns { time: Vec::with_capacity(samples), named };
        let end = Ticks::new(session.tick().get().saturating_add(every.saturating_mul(samples as u64)));
        Ok(Self { watched, every, end, columns })
    }

    /// The tick of the next sample; `None` after the last.
    pub(crate) fn next(&self, now: Ticks) -> Option<Ticks> {
        let left = self.end.get().checked_sub(now.get()).filter(|left| *left > 0)?;
        Some(Ticks::new(now.get() + (left - 1) % self.every + 1))
    }

    /// Takes a sample.
    pub(crate) fn sample<T: Target>(&mut self, session: &Session<T>) {
        self.columns.time.push(session.tick().get() as f64 * TIMEBASE);
        for (watch, (_, column)) in self.watched.iter().zip(&mut self.columns.named) {
            column.push(session.value(watch));
        }
    }

    /// Returns the samples.
    pub(crate) fn finish(self) -> Columns {
        self.columns
    }
}

/// The items of a name: `axis0` is its destination, position and output.
fn names(item: &str) -> Vec<String> {
    match item.trim().strip_prefix("axis") {
        Some(number) if !number.is_empty() && number.bytes().all(|byte| byte.is_ascii_digit()) => {
            ["dest", "pos", "out"].map(|kind| format!("{kind}{number}")).to_vec()
        }
        _ => vec![item.trim().to_owned()],
    }
}
