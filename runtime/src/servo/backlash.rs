//! Backlash compensation: an offset that ramps with the direction of motion.

use kmotiondef::structs::Chan;

use super::TIMEBASE;
use crate::views::AxisView;

/// Advances the offset of an axis that has one by one tick.
pub(crate) fn advance(chan: &mut AxisView<'_>) {
    let (dest, judged) = (chan.get(Chan::DEST) as f32, chan.get(Chan::PREV_BACKLASH_DEST));
    if dest != judged {
        chan.set(Chan::BACKLASH_DIRECTION, if dest > judged { 1 } else { -1 });
        chan.set(Chan::PREV_BACKLASH_DEST, dest);
    }
    let goal = match chan.get(Chan::BACKLASH_DIRECTION) {
        1 => chan.get(Chan::BACKLASH_AMOUNT),
        -1 => 0.0,
        _ => return,
    };
    let step = (f64::from(chan.get(Chan::BACKLASH_RATE)) * TIMEBASE) as f32;
    let offset = chan.get(Chan::BACKLASH);
    let offset = if goal > offset { (offset + step).min(goal) } else { (offset - step).max(goal) };
    chan.set(Chan::BACKLASH, offset);
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;

    use super::*;
    use crate::testing::Desk;
    use crate::views::Typed;

    #[test]
    fn the_offset_ramps_as_recorded() {
        // `servo.jsonl`, kind "backlash", amount 5, rate 10000: destination and offset tick by tick.
        let rows =
            [(0.0, 0.0), (0.1, 0.9), (0.2, 1.8), (0.3, 2.7), (1.0, 3.6), (2.0, 4.5), (3.0, 5.0), (3.0, 5.0)];
        let falling = [(2.9, 4.1), (2.5, 3.2), (2.0, 2.3), (1.0, 1.4)];
        let mut desk = Desk::new();
        let axis = AxisId::new(0).expect("0 is an axis");
        desk.memory.set_axis(axis, Chan::BACKLASH_MODE, 1);
        desk.memory.set_axis(axis, Chan::BACKLASH_AMOUNT, 5.0);
        desk.memory.set_axis(axis, Chan::BACKLASH_RATE, 10000.0);
        for (dest, offset) in rows.into_iter().chain(falling) {
            desk.memory.set_axis(axis, Chan::DEST, dest);
            advance(&mut AxisView::of(&mut desk.memory, axis));
            let found = memory_offset(&desk);
            assert!((found - offset).abs() < 1e-5, "{dest}: {found} {offset}");
        }
    }

    fn memory_offset(desk: &Desk) -> f32 {
        desk.memory.axis(AxisId::new(0).expect("0 is an axis"), Chan::BACKLASH)
    }
}
