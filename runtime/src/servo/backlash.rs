//! Backlash compensation: an offset that ramps with the direction of motion.

use kmotiondef::AxisId;
use kmotiondef::modes::BacklashMode;
use kmotiondef::structs::Chan;
use vm::memory::GuestMemory;

use super::TIMEBASE;
use crate::views::Typed;

/// Advances the offset by one tick.
pub(crate) fn advance(memory: &mut GuestMemory, axis: AxisId) {
    if BacklashMode::new(memory.axis(axis, Chan::BACKLASH_MODE)) != Some(BacklashMode::Linear) {
        memory.set_axis(axis, Chan::BACKLASH, 0.0);
        return;
    }
    let (dest, judged) = (memory.axis(axis, Chan::DEST) as f32, memory.axis(axis, Chan::PREV_BACKLASH_DEST));
    if dest != judged {
        memory.set_axis(axis, Chan::BACKLASH_DIRECTION, if dest > judged { 1 } else { -1 });
        memory.set_axis(axis, Chan::PREV_BACKLASH_DEST, dest);
    }
    let goal = match memory.axis(axis, Chan::BACKLASH_DIRECTION) {
        1 => memory.axis(axis, Chan::BACKLASH_AMOUNT),
        -1 => 0.0,
        _ => return,
    };
    let step = (f64::from(memory.axis(axis, Chan::BACKLASH_RATE)) * TIMEBASE) as f32;
    let offset = memory.axis(axis, Chan::BACKLASH);
    let offset = if goal > offset { (offset + step).min(goal) } else { (offset - step).max(goal) };
    memory.set_axis(axis, Chan::BACKLASH, offset);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Desk;

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
            advance(&mut desk.memory, axis);
            let found = memory_offset(&desk);
            assert!((found - offset).abs() < 1e-5, "{dest}: {found} {offset}");
        }
    }

    fn memory_offset(desk: &Desk) -> f32 {
        desk.memory.axis(AxisId::new(0).expect("0 is an axis"), Chan::BACKLASH)
    }
}
