//! The coordinate system: the axes driven by its eight letters, and the time they need to change speed.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;
use kmotiondef::variables::{
    CS0_AXIS_A, CS0_AXIS_B, CS0_AXIS_C, CS0_AXIS_U, CS0_AXIS_V, CS0_AXIS_X, CS0_AXIS_Y, CS0_AXIS_Z,
};
use kmotiondef::{AxisId, Place};
use vm::memory::GuestMemory;

use crate::arithmetic::division::{divide_singles, square_root};
use crate::views::TypedAccess;

/// Letters of the coordinate system: x y z a b c u v.
pub(crate) const LETTERS: usize = 8;

const LETTER_AXES: [Place<i32>; LETTERS] =
    [CS0_AXIS_X, CS0_AXIS_Y, CS0_AXIS_Z, CS0_AXIS_A, CS0_AXIS_B, CS0_AXIS_C, CS0_AXIS_U, CS0_AXIS_V];

/// Seconds of an override change when the axes have no limits.
const DEFAULT_CHANGE_TIME: f32 = 1.0;

/// The axis of each letter, if it has one.
pub(crate) fn letters(memory: &GuestMemory) -> [Option<AxisId>; LETTERS] {
    LETTER_AXES.map(|letter| memory.axes().get(memory.get(letter)))
}

/// The axes of the coordinate system, in the order of their letters.
pub(crate) fn members(memory: &GuestMemory) -> impl Iterator<Item = AxisId> + use<> {
    letters(memory).into_iter().flatten()
}

/// Returns whether an axis belongs to the coordinate system.
pub(crate) fn is_member(memory: &GuestMemory, axis: AxisId) -> bool {
    letters(memory).contains(&Some(axis))
}

/// Assigns axis numbers to the first letters, -1 for none; the other letters are unchanged.
pub(crate) fn assign(memory: &mut GuestMemory, axes: &[i32]) {
    for (letter, &axis) in LETTER_AXES.into_iter().zip(axes) {
        memory.set(letter, axis);
    }
}

/// Returns the number of the first letter whose axis is disabled, counted from 0.
pub(crate) fn first_disabled(memory: &GuestMemory) -> Option<usize> {
    let is_disabled = |axis| memory.axis(axis, Chan::ENABLE) == 0;
    letters(memory).into_iter().position(|axis| axis.is_some_and(is_disabled))
}

/// Returns whether an axis of the system is disabled, so that no path can run.
pub(crate) fn is_disabled(memory: &GuestMemory) -> bool {
    members(memory).any(|axis| memory.axis(axis, Chan::ENABLE) == 0)
}

/// Seconds in which every axis of the system can change the override by 1.0 at its full speed; 0 without axes.
pub(crate) fn nominal_change_time(memory: &GuestMemory) -> f32 {
    if members(memory).next().is_none() {
        return 0.0;
    }
    let times = members(memory).map(|axis| change_time(memory, axis, memory.axis(axis, Chan::VEL)));
    longest(times).unwrap_or(DEFAULT_CHANGE_TIME)
}

/// Seconds in which every axis of the system can stop from its present speed; 0 at rest.
pub(crate) fn stopping_time(memory: &GuestMemory) -> f32 {
    let velocity = |axis| {
        // The board does not use `last_vel` here; it multiplies singles.
        let way = (memory.axis(axis, Chan::DEST) - memory.axis(axis, Chan::LAST_DEST)) as f32;
        way * TICKS_PER_SECOND
    };
    longest(members(memory).map(|axis| change_time(memory, axis, velocity(axis)))).unwrap_or(0.0)
}

/// Ticks in a second, as a single.
const TICKS_PER_SECOND: f32 = (1.0 / TIMEBASE) as f32;

/// The time that an axis needs between rest and a velocity, in seconds; the board's formula counts the jerk phases
/// twice.
fn change_time(memory: &GuestMemory, axis: AxisId, velocity: f32) -> f32 {
    let velocity = velocity.abs();
    let ramps = square_root(f64::from(divide_singles(2.0 * velocity, memory.axis(axis, Chan::JERK)))) as f32;
    divide_singles(velocity, memory.axis(axis, Chan::ACCEL)) + 2.0 * ramps
}

/// The longest of some times; limits of 0 give none.
fn longest(times: impl Iterator<Item = f32>) -> Option<f32> {
    times.filter(|time| time.is_finite()).reduce(f32::max)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::powered_memory;

    #[test]
    fn omitted_letters_keep_their_axes() {
        let mut memory = powered_memory();
        assign(&mut memory, &[5, 1, -1, -1, 7, -1]);
        assign(&mut memory, &[0, 1, 2, -1]);
        assert_eq!(members(&memory).map(AxisId::get).collect::<Vec<_>>(), [0, 1, 2, 7]);
        assert_eq!(letters(&memory)[4], AxisId::new(7));
    }

    #[test]
    fn change_time_is_that_of_the_slowest_axis() {
        let check = |limits: [f32; 3], expect: f32| {
            let mut memory = powered_memory();
            assign(&mut memory, &[0, 1, -1, -1]);
            for (axis, speed) in members(&memory).zip([1.0, 0.5]) {
                memory.set_axis(axis, Chan::VEL, speed * limits[0]);
                memory.set_axis(axis, Chan::ACCEL, limits[1]);
                memory.set_axis(axis, Chan::JERK, limits[2]);
            }
            assert_eq!(nominal_change_time(&memory), expect);
        };
        check([40_000.0, 200_000.0, 4e6], 0.482_842_7);
        check([1_000.0, 10_000.0, 100_000.0], 0.382_842_72);
        check([1_000.0, 0.0, 0.0], DEFAULT_CHANGE_TIME);
    }
}
