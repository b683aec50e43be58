//! The present time, for time limits.

use std::time::Instant;

/// Returns the present time.
#[expect(clippy::disallowed_methods, reason = "a link to real hardware has time limits")]
pub(crate) fn now() -> Instant {
    Instant::now()
}
