//! Servers that must answer at once, tested on machines that may be busy.

use std::time::{Duration, Instant};

/// The time limit for a server to answer a new client.
const AT_ONCE: Duration = Duration::from_secs(1);

/// The number of trials: a busy machine delays some of them, a server that makes clients wait delays all.
const TRIALS: usize = 3;

/// Asserts that one of several trials takes at most a second. Each starts its own server, and returns the time that
/// [`timed`] measured for the answer.
///
/// # Panics
///
/// All trials took longer.
pub fn answers_at_once(what: &str, mut trial: impl FnMut() -> Duration) {
    let mut times = Vec::new();
    while times.len() < TRIALS {
        let time = trial();
        if time < AT_ONCE {
            return;
        }
        times.push(time);
    }
    panic!("{what}: a new client waited {times:?}");
}

/// The time that an answer takes on the host.
#[expect(clippy::disallowed_methods, reason = "the limit is one of the host's time")]
pub fn timed(ask: impl FnOnce()) -> Duration {
    let started = Instant::now();
    ask();
    started.elapsed()
}
