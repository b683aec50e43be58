//! The present moment, for time limits.

use std::time::Instant;

/// Returns the present moment.
#[expect(clippy::disallowed_methods, reason = "a link to real hardware has time limits")]
pub(crate) fn now() -> Instant {
    Instant::now()
}
