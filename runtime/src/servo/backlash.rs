//! Backlash compensation: an offset that ramps with the direction of motion.
//!
//! The offset runs between 0 and the amount. An offset above the amount jumps to the amount, for instance when a
//! program reduces the amount; with a negative amount, the offset is always either above the amount or below 0, and
//! flips between the two while the axis moves backwards. The board does so, too.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;

use crate::views::AxisView;

/// The change of the destination that counts as a change of direction, as a fraction of the amount.
const LEAST_CHANGE: f32 = 0.005;

/// Advances the offset of an axis that has one by one tick.
pub(crate) fn advance(chan: &mut AxisView<'_>) {
    let (dest, judged) = (chan.get(Chan::DEST) as f32, chan.get(Chan::PREV_BACKLASH_DEST));
    let (offset, amount) = (chan.get(Chan::BACKLASH), chan.get(Chan::BACKLASH_AMOUNT));
    let is_above = offset > amount;
    if (dest - judged).abs() > LEAST_CHANGE * amount.abs() {
        chan.set(Chan::BACKLASH_DIRECTION, if dest > judged { 1 } else { -1 });
        chan.set(Chan::PREV_BACKLASH_DEST, dest);
    } else if is_above {
        chan.set(Chan::BACKLASH_DIRECTION, 1);
    }
    let step = f64::from(chan.get(Chan::BACKLASH_RATE)) * TIMEBASE;
    let after = |step: f64| (f64::from(offset) + step) as f32;
    let offset = match chan.get(Chan::BACKLASH_DIRECTION) {
        _ if is_above => amount,
        1 => after(step).min(amount),
        -1 => after(-step).max(0.0),
        _ => return,
    };
    chan.set(Chan::BACKLASH, offset);
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;

    use super::*;
    use crate::testing::TestBench;
    use crate::views::TypedAccess;

    #[test]
    fn the_offset_ramps_as_recorded() {
        // `servo.jsonl`, kind "backlash", amount 5, rate 10000: destination and offset tick by tick.
        let rows =
            [(0.0, 0.0), (0.1, 0.9), (0.2, 1.8), (0.3, 2.7), (1.0, 3.6), (2.0, 4.5), (3.0, 5.0), (3.0, 5.0)];
        let falling = [(2.9, 4.1), (2.5, 3.2), (2.0, 2.3), (1.0, 1.4)];
        let mut bench = TestBench::new();
        let axis = AxisId::new(0).expect("0 is an axis");
        bench.memory.set_axis(axis, Chan::BACKLASH_MODE, 1);
        bench.memory.set_axis(axis, Chan::BACKLASH_AMOUNT, 5.0);
        bench.memory.set_axis(axis, Chan::BACKLASH_RATE, 10000.0);
        for (dest, offset) in rows.into_iter().chain(falling) {
            bench.memory.set_axis(axis, Chan::DEST, dest);
            advance(&mut AxisView::of(&mut bench.memory, axis));
            let found = memory_offset(&bench);
            assert!((found - offset).abs() < 1e-5, "{dest}: {found} {offset}");
        }
    }

    fn memory_offset(bench: &TestBench) -> f32 {
        bench.memory.axis(AxisId::new(0).expect("0 is an axis"), Chan::BACKLASH)
    }
}
