//! Runs at the speed of the clock: a completed tick waits until its time has come.
//!
//! Board time is counted, not measured: the events of a run and their board times are the same at any speed. A computer
//! that is slower than the board falls behind, and catches up as soon as it can.

use std::thread;
use std::time::{Duration, Instant};

use kmotiondef::Ticks;
use kmotiondef::limits::TIMEBASE;

/// A clock that starts with the board.
#[derive(Debug)]
pub(crate) struct Pace {
    start: Instant,
    origin: Ticks,
    /// Seconds of board time per second.
    speed: f64,
}

impl Pace {
    /// Starts the clock at a tick of the board.
    pub(crate) fn new(origin: Ticks) -> Self {
        Self::with_speed(origin, 1.0)
    }

    /// Starts a clock for a board that is `speed` times as fast as the real one.
    pub(crate) fn with_speed(origin: Ticks, speed: f64) -> Self {
        Self { start: now(), origin, speed }
    }

    /// The tick that the clock has reached.
    pub(crate) fn due(&self) -> Ticks {
        Ticks::new(self.origin.get() + (self.start.elapsed().as_secs_f64() * self.speed / TIMEBASE) as u64)
    }

    /// Waits until the clock reaches a tick.
    pub(crate) fn wait(&self, tick: Ticks) {
        let ticks = tick.get().saturating_sub(self.origin.get());
        let end = Duration::from_secs_f64(ticks as f64 * TIMEBASE / self.speed);
        thread::sleep(end.saturating_sub(self.start.elapsed()));
    }
}

/// The present time.
#[expect(clippy::disallowed_methods, reason = "a run is paced by the clock here; what happens in it is not")]
pub(crate) fn now() -> Instant {
    Instant::now()
}
