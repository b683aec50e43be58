//! Texts that are equal except for the last digits of numbers.

use crate::cli::report::numbers::{Tolerance, deviation};

/// The allowed difference of printed numbers.
const ALLOWED: Tolerance = Tolerance { seconds: 0.001, number: 0.001 };

/// Returns whether texts are equal except for allowed differences of numbers.
pub(super) fn is_near(expected: &str, shown: &str) -> bool {
    let mut lines = expected.lines().zip(shown.lines());
    expected.lines().count() == shown.lines().count()
        && lines.all(|(one, other)| one == other || deviation(one, other, ALLOWED).is_some())
}
