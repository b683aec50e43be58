//! The clock of a shown board: the tick that is due, at an adjustable speed.

use std::time::{Duration, Instant};

use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

/// The slowest and the fastest speed, in seconds of board time per second.
pub(super) const SPEEDS: (f64, f64) = (0.01, 100.0);
/// The delay in seconds beyond which a board does not catch up.
const PATIENCE: f64 = 0.25;
/// The time over which the speed is measured, in seconds.
const MEASURE: f64 = 0.5;

/// The present time.
#[expect(
    clippy::disallowed_methods,
    reason = "the clock paces the board; what happens on it does not depend on it"
)]
pub(super) fn now() -> Instant {
    Instant::now()
}

#[derive(Debug)]
pub(super) struct Clock {
    speed: f64,
    is_running: bool,
    /// A reference time, and the tick that was due then.
    since: (Instant, Ticks),
    /// The time of the last speed measurement, the tick then, and the result.
    measured: (Instant, Ticks, f64),
}

impl Clock {
    /// Creates a clock at a tick.
    pub(super) fn new(tick: Ticks, speed: f64, is_running: bool) -> Self {
        let moment = now();
        let speed = speed.clamp(SPEEDS.0, SPEEDS.1);
        Self { speed, is_running, since: (moment, tick), measured: (moment, tick, 0.0) }
    }

    pub(super) const fn speed(&self) -> f64 {
        self.speed
    }

    /// Returns whether it runs.
    pub(super) const fn is_running(&self) -> bool {
        self.is_running
    }

    /// Starts the clock at a tick.
    pub(super) fn run(&mut self, tick: Ticks, speed: Option<f64>) {
        if let Some(speed) = speed.filter(|speed| speed.is_finite()) {
            self.speed = speed.clamp(SPEEDS.0, SPEEDS.1);
        }
        self.is_running = true;
        self.since = (now(), tick);
    }

    pub(super) fn pause(&mut self) {
        self.is_running = false;
    }

    /// The tick that is due while the board is at `tick`. If the board cannot keep up, the clock is set
    /// back to it.
    pub(super) fn due(&mut self, tick: Ticks) -> Ticks {
        if !self.is_running {
            return tick;
        }
        let elapsed = self.since.0.elapsed().as_secs_f64();
        let due = self.since.1.get() + (elapsed * self.speed / TIMEBASE) as u64;
        let behind = due.saturating_sub(tick.get()) as f64 * TIMEBASE;
        if behind > PATIENCE * self.speed.max(1.0) {
            self.since = (now(), tick);
            return tick.next();
        }
        Ticks::new(due.max(tick.get()))
    }

    /// The speed over the last interval.
    pub(super) fn measured(&mut self, tick: Ticks) -> f64 {
        let elapsed = self.measured.0.elapsed();
        if elapsed >= Duration::from_secs_f64(MEASURE) {
            let passed = tick.get().saturating_sub(self.measured.1.get()) as f64 * TIMEBASE;
            self.measured = (now(), tick, passed / elapsed.as_secs_f64());
        }
        self.measured.2
    }
}
