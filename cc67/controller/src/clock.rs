//! The time of a controller, which passes by itself.

use std::time::{Duration, Instant};

use kmotiondef::Ticks;

/// The length of a tick in nanoseconds: 90 µs.
const TICK_NANOSECONDS: u128 = 90_000;

/// Returns the present time.
#[expect(clippy::disallowed_methods, reason = "the time of a real board is that of the clock")]
pub(crate) fn now() -> Instant {
    Instant::now()
}

/// Board time, which passes by itself.
#[derive(Debug)]
pub(crate) struct PassingTime {
    /// The time of tick 0.
    pub(crate) origin: Instant,
    /// The last tick that was complete at the end of the last call.
    pub(crate) tick: Ticks,
    /// The time at which the status record is due.
    pub(crate) next_status: Instant,
    /// The time of the last console line.
    pub(crate) heard: Instant,
}

impl PassingTime {
    pub(crate) fn new() -> Self {
        let now = now();
        Self { origin: now, tick: Ticks::new(0), next_status: now, heard: now }
    }

    /// The time at which a tick is complete.
    pub(crate) fn moment_of(&self, tick: Ticks) -> Option<Instant> {
        let nanoseconds = u128::from(tick.get()) * TICK_NANOSECONDS;
        self.origin.checked_add(Duration::from_nanos(u64::try_from(nanoseconds).ok()?))
    }

    /// Updates the present tick.
    pub(crate) fn note(&mut self) {
        let ticks = now().duration_since(self.origin).as_nanos() / TICK_NANOSECONDS;
        self.tick = Ticks::new(u64::try_from(ticks).unwrap_or(u64::MAX));
    }
}
