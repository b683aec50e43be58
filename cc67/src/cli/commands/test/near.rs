//! Texts that are equal but for last digits.

use crate::cli::report::numbers::{Tolerance, deviation};

/// By how much printed numbers may differ.
const ALLOWED: Tolerance = Tolerance { seconds: 0.001, number: 0.001 };

/// Returns whether texts are equal but for numbers that may differ.
pub(super) fn is_near(expected: &str, shown: &str) -> bool {
    let mut lines = expected.lines().zip(shown.lines());
    expected.lines().count() == shown.lines().count()
        && lines.all(|(one, other)| one == other || deviation(one, other, ALLOWED).is_some())
}
