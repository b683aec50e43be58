//! The present moment: the time of a controller passes by itself.

use std::time::Instant;

/// Returns the present moment.
#[expect(clippy::disallowed_methods, reason = "the time of a real board is that of the clock")]
pub(crate) fn now() -> Instant {
    Instant::now()
}
