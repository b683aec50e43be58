//! The time base: the rate of path time, and the target rate of its ramp.
//!
//! An override of 1.0 advances the path by a tick's length every tick. Two overrides are kept, one of them for rapids.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::variables::{
    CS0_DOING_RAPID, CS0_FLUSHED, CS0_LAST_FRO, CS0_LAST_RAPID_FRO, CS0_NOM_DECEL_2TB2, CS0_STOPPING_STATE,
    CS0_T, CS0_TIME_BASE, CS0_TIME_BASE_DELTA, CS0_TIME_BASE_DESIRED, CS0_TIME_DOWNLOADED, CS0_TIME_EXECUTED,
    CS0_TIME_LOST, PARAMETRIC_INDEX_WRAPPED,
};
use vm::memory::GuestMemory;

use super::feedhold::HoldState;
use crate::views::TypedAccess;

/// The square of a tick's length, s².
const TIMEBASE_SQUARED: f64 = 8.1e-9;
/// Seconds of path that are left untouched when data runs out.
const RESERVE: f64 = 0.001;

/// The override that applies at the present position of the path.
pub(crate) fn current_override(memory: &GuestMemory) -> f32 {
    if memory.get(CS0_DOING_RAPID) != 0 { memory.get(CS0_LAST_RAPID_FRO) } else { memory.get(CS0_LAST_FRO) }
}

/// Sets the feed override and ramps to the override that applies, with `time` seconds for a change of 1.0.
pub(crate) fn set_feed(memory: &mut GuestMemory, fro: f32, time: f32) {
    memory.set(CS0_LAST_FRO, fro);
    aim_unless_held(memory, time);
}

/// Sets the override of rapids and ramps to the override that applies, with `time` seconds for a change of 1.0.
pub(crate) fn set_rapid(memory: &mut GuestMemory, fro: f32, time: f32) {
    memory.set(CS0_LAST_RAPID_FRO, fro);
    aim_unless_held(memory, time);
}

/// Ramps to an override even in feedhold; a resume does not restore the previous one.
pub(crate) fn ramp_to_override(memory: &mut GuestMemory, fro: f32, time: f32) {
    memory.set(CS0_TIME_BASE_DESIRED, f64::from(fro) * TIMEBASE);
    memory.set(CS0_TIME_BASE_DELTA, change_per_tick(time));
}

/// Ramps to the override that applies; in a feedhold, only the rate of the change is updated.
fn aim_unless_held(memory: &mut GuestMemory, time: f32) {
    if HoldState::of(memory) == HoldState::Running {
        ramp_to_override(memory, current_override(memory), time);
    } else {
        memory.set(CS0_TIME_BASE_DELTA, change_per_tick(time));
    }
}

/// The change of the time base per tick when a change of 1.0 takes `time` seconds. For a time of 0 it is NaN, which
/// limits nothing because comparisons with it are false.
fn change_per_tick(time: f32) -> f64 {
    if time > 0.0 { TIMEBASE_SQUARED / f64::from(time) } else { f64::from_bits(u64::MAX >> 1) }
}

/// Starts a path at the override that applies, without a ramp.
pub(crate) fn start(memory: &mut GuestMemory, change_time: f32) {
    memory.set(CS0_NOM_DECEL_2TB2, (f64::from(change_time) / (2.0 * TIMEBASE_SQUARED)) as f32);
    memory.set(CS0_TIME_BASE_DELTA, change_per_tick(change_time));
    jump(memory, f64::from(current_override(memory)) * TIMEBASE);
}

/// Sets a time base without a ramp.
fn jump(memory: &mut GuestMemory, time_base: f64) {
    memory.set(CS0_TIME_BASE, time_base);
    memory.set(CS0_TIME_BASE_DESIRED, time_base);
}

/// Begins or ends a rapid in the path.
pub(crate) fn set_doing_rapid(memory: &mut GuestMemory, doing: bool) {
    memory.set(CS0_DOING_RAPID, i32::from(doing));
    // A hold in progress is stronger: the resume finds the override.
    if HoldState::of(memory) == HoldState::Running {
        jump(memory, f64::from(current_override(memory)) * TIMEBASE);
    }
}

/// One tick of the ramp, after the advance of the path time.
pub(crate) fn ramp(memory: &mut GuestMemory) {
    let (now, delta) = (memory.get(CS0_TIME_BASE), memory.get(CS0_TIME_BASE_DELTA));
    // The board computes the aim as a single.
    let aim = f64::from(aim_within_data(memory, now) as f32);
    let next = if aim > now + delta {
        now + delta
    } else if aim < now - delta {
        now - delta
    } else {
        aim
    };
    memory.set(CS0_TIME_BASE, next);
    // Board quirk: a path that runs backwards stops without a change of the state.
    if HoldState::of(memory) == HoldState::StoppingPath && next == 0.0 && now > 0.0 {
        memory.set(CS0_STOPPING_STATE, HoldState::PathStopped.number());
    }
}

/// Returns whether a path at the rate `now` must stop for lack of segments: more may come, as `CS0_Flushed` is 0.
pub(crate) fn is_starved(memory: &GuestMemory, now: f64) -> bool {
    let desired = memory.get(CS0_TIME_BASE_DESIRED);
    let position = memory.get(CS0_TIME_EXECUTED) + memory.get(CS0_T);
    let stopping = f64::from(memory.get(CS0_NOM_DECEL_2TB2)) * now * now;
    let ahead = memory.get(CS0_TIME_DOWNLOADED) - position;
    memory.get(CS0_FLUSHED) == 0 && desired > 0.0 && now >= 0.0 && ahead - RESERVE < stopping
}

/// Returns the target rate of the ramp: 0 as soon as the remaining segments are needed for stopping.
fn aim_within_data(memory: &GuestMemory, now: f64) -> f64 {
    let desired = memory.get(CS0_TIME_BASE_DESIRED);
    let position = memory.get(CS0_TIME_EXECUTED) + memory.get(CS0_T);
    let stopping = f64::from(memory.get(CS0_NOM_DECEL_2TB2)) * now * now;
    let lost = memory.get(CS0_TIME_LOST);
    let starves = is_starved(memory, now);
    let has_wrapped = memory.get(PARAMETRIC_INDEX_WRAPPED) != 0;
    let starves_behind = has_wrapped && desired < 0.0 && now <= 0.0 && position - lost - RESERVE < stopping;
    if starves || starves_behind { 0.0 } else { desired }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::powered_memory;

    #[test]
    fn an_override_that_does_not_apply_yet_is_kept() {
        let mut memory = powered_memory();
        set_rapid(&mut memory, 0.25, 1.0);
        assert_eq!(memory.get(CS0_LAST_RAPID_FRO), 0.25);
        assert_eq!(memory.get(CS0_TIME_BASE_DESIRED), TIMEBASE);
        memory.set(CS0_STOPPING_STATE, HoldState::PathStopped.number());
        set_feed(&mut memory, 0.5, 1.0);
        assert_eq!(memory.get(CS0_LAST_FRO), 0.5);
        assert_eq!(memory.get(CS0_TIME_BASE_DESIRED), TIMEBASE);
        ramp_to_override(&mut memory, -0.5, 1.0);
        assert_eq!(memory.get(CS0_TIME_BASE_DESIRED), -0.5 * TIMEBASE);
        assert_eq!(memory.get(CS0_LAST_FRO), 0.5);
    }

    #[test]
    fn a_rate_change_without_time_is_immediate() {
        for time in [0.0, -1.0, f32::NAN] {
            let mut memory = powered_memory();
            memory.set(CS0_FLUSHED, 1);
            set_feed(&mut memory, 0.5, time);
            ramp(&mut memory);
            assert_eq!(memory.get(CS0_TIME_BASE) as f32, (0.5 * TIMEBASE) as f32);
        }
    }

    #[test]
    fn a_change_of_nothing_per_tick_changes_nothing() {
        let mut memory = powered_memory();
        memory.set(CS0_FLUSHED, 1);
        set_feed(&mut memory, 0.5, 1.0);
        memory.set(CS0_TIME_BASE_DELTA, 0.0);
        ramp(&mut memory);
        assert_eq!(memory.get(CS0_TIME_BASE), TIMEBASE);
    }

    #[test]
    fn overwritten_segments_stop_reverse_motion() {
        let mut memory = powered_memory();
        set_feed(&mut memory, -1.0, 0.0);
        memory.set(CS0_TIME_BASE, 0.0);
        memory.set(CS0_TIME_LOST, 2.0);
        memory.set(PARAMETRIC_INDEX_WRAPPED, 1);
        for (position, moves) in [(2.0005, false), (2.5, true)] {
            memory.set(CS0_TIME_EXECUTED, position);
            memory.set(CS0_TIME_BASE, 0.0);
            ramp(&mut memory);
            assert_eq!(memory.get(CS0_TIME_BASE) < 0.0, moves, "{position}");
        }
    }
}
