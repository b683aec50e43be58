//! The coordinate system, feed override and feedhold. Source: coordinated-motion.md sections 1 and 4 to 5.

use kmotiondef::AxisId;
use kmotiondef::firmware::Function;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use kmotiondef::variables::CS0_STOPPING_STATE;
use vm::firmware::{Caller, Outcome, Wake};

use super::calls::Continuation;
use super::costs;
use super::motion::{PlanningStage, schedule};
use super::parts::Parts;
use crate::out::Message;
use crate::servo::coordinated::feedhold::HoldState;
use crate::servo::coordinated::system::{assign, first_disabled, members};
use crate::servo::coordinated::{buffer, feedhold, rate, system};
use crate::servo::independent::has_motion;
use crate::servo::{hold, moves, planning};
use crate::views::TypedAccess;

/// Assigns the letters from X on; the other letters are unchanged.
pub(crate) fn define(parts: &mut Parts, caller: &mut Caller<'_>, axes: &[i32]) {
    let valid = |&axis: &i32| axis == -1 || caller.memory.axes().get(axis).is_some();
    if !axes.iter().all(valid) {
        // The board takes any number; one that is not an axis is none.
        parts.out.diagnose(caller, Message::BadCoordSystem { axes: format!("{axes:?}") });
    }
    let mut named: Vec<i32> = axes.iter().copied().filter(|&axis| axis >= 0).collect();
    named.sort_unstable();
    if named.windows(2).any(|pair| pair[0] == pair[1]) {
        parts.out.diagnose(caller, Message::CoordSystemTwice { axes: format!("{axes:?}") });
    }
    assign(caller.memory, axes);
}

pub(crate) fn define_coord_system(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    x: i32,
    y: i32,
    z: i32,
    a: i32,
) {
    define(parts, caller, &[x, y, z, a]);
}

#[expect(clippy::too_many_arguments, reason = "the C function has six axes")]
pub(crate) fn define_coord_system6(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    x: i32,
    y: i32,
    z: i32,
    a: i32,
    b: i32,
    c: i32,
) {
    define(parts, caller, &[x, y, z, a, b, c]);
}

#[expect(clippy::too_many_arguments, reason = "the C function has eight axes")]
pub(crate) fn define_coord_system8(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    x: i32,
    y: i32,
    z: i32,
    a: i32,
    b: i32,
    c: i32,
    u: i32,
    v: i32,
) {
    define(parts, caller, &[x, y, z, a, b, c, u, v]);
}

/// −1 if an axis of the system is disabled, 0 while a buffer is executed, otherwise 1.
pub(crate) fn check_done_buf(parts: &mut Parts, caller: &mut Caller<'_>) -> i32 {
    let done = buffer::check_done(caller.memory);
    if let Some(letter) = first_disabled(caller.memory) {
        let cycles = costs::CHECK_BUF_DISABLED + costs::CHECK_BUF_LETTER * letter as i64;
        costs::spend(caller, cycles - Function::CheckDoneBuf.row().cost.get());
    }
    if let Some(thread) = caller.thread {
        parts.calls.motions.asked_path(thread, done, caller.at);
    }
    done
}

/// Reports axes that a feedhold does not stop on their way to a target.
fn note_others(parts: &mut Parts, caller: &Caller<'_>) {
    let memory = &*caller.memory;
    let goes_on = |axis: &AxisId| {
        let is_move = memory.axis(*axis, Chan::LAST_MOTION_TYPE) == LastMotion::Move.get();
        is_move && has_motion(memory, *axis) && !system::is_member(memory, *axis)
    };
    for axis in memory.axes().iter().filter(goes_on) {
        let target = memory.axis(axis, Chan::LAST_MOTION_DEST);
        let function = Function::StopCoordinatedMotion;
        parts.out.diagnose(caller, Message::StopLeaves { function, axis, target });
    }
}

/// Begins a feedhold. The board computes it in slices of the caller: one to begin, and one for each axis that moves
/// independently; the other axes continue to move meanwhile. Only a thread can wait for these slices.
pub(crate) fn stop_coordinated_motion(parts: &mut Parts, caller: &mut Caller<'_>) -> Outcome<()> {
    if caller.thread.is_none() {
        hold::ask(&mut parts.servo, caller.memory);
        return Outcome::Done(());
    }
    let mut left = match (caller.woken, parts.calls.take(caller)) {
        (Some(_), Some(Continuation::Stop(Some(left)))) => left,
        (Some(_), Some(Continuation::Stop(None))) => {
            costs::spend(caller, costs::STOP);
            if feedhold::stop(caller.memory) {
                return Outcome::Done(());
            }
            let mut moving = hold::moving_members(caller.memory);
            let is_moving = !moving.is_empty();
            // The motion of a disabled axis is unchanged, and takes no slice.
            moving.retain(|&axis| caller.memory.axis(axis, Chan::ENABLE) != 0);
            if is_moving && moving.is_empty() {
                caller.memory.set(CS0_STOPPING_STATE, HoldState::StoppingAxes.number());
            }
            moving.reverse();
            return stop_later(parts, caller, moving);
        }
        _ => {
            if !hold::may_stop(caller.memory) {
                return Outcome::Done(());
            }
            note_others(parts, caller);
            feedhold::note_time(caller.memory);
            costs::spend(caller, costs::BEFORE_A_WAIT - Function::StopCoordinatedMotion.row().cost.get());
            parts.calls.store(caller, Continuation::Stop(None));
            return Outcome::Wait(Wake::NextSlice);
        }
    };
    if let Some(axis) = left.pop() {
        if let Some(limits) = moves::limits(caller.memory, axis, Some(1.0)) {
            costs::spend(caller, costs::STOP_AXIS + planning::of_jog(caller.memory, axis, 0.0, &limits));
        }
        hold::stop_axis(&mut parts.servo, caller.memory, axis);
    }
    if left.is_empty() {
        caller.memory.set(CS0_STOPPING_STATE, HoldState::StoppingAxes.number());
    }
    stop_later(parts, caller, left)
}

/// Continues to stop axes in the next slice, the last one first.
fn stop_later(parts: &mut Parts, caller: &Caller<'_>, left: Vec<AxisId>) -> Outcome<()> {
    if left.is_empty() {
        return Outcome::Done(());
    }
    parts.calls.store(caller, Continuation::Stop(Some(left)));
    Outcome::Wait(Wake::NextSlice)
}

pub(crate) fn update_stopping_state(_: &mut Parts, caller: &mut Caller<'_>) {
    let cycles = match HoldState::of(caller.memory) {
        HoldState::Running => -40,
        HoldState::StoppingPath | HoldState::StoppingAxes => 0,
        HoldState::PathStopped | HoldState::AxesStopped => 195,
    };
    costs::spend(caller, cycles);
    hold::update_state(caller.memory);
}

/// Ends a feedhold: its axes continue one by one, each planned like a separate move.
pub(crate) fn resume_coordinated_motion(parts: &mut Parts, caller: &mut Caller<'_>) -> Outcome<()> {
    let (mut left, mut progress) = match (caller.woken, parts.calls.take(caller)) {
        (Some(_), Some(Continuation::Resume(left, progress))) => (left, progress),
        _ => {
            hold::update_state(caller.memory);
            if feedhold::resume(caller.memory) || HoldState::of(caller.memory) == HoldState::Running {
                return Outcome::Done(());
            }
            caller.memory.set(CS0_STOPPING_STATE, HoldState::Running.number());
            let held = |axis: &AxisId| parts.servo.axes[axis.index()].held.is_some();
            let mut left: Vec<AxisId> = members(caller.memory).filter(held).collect();
            left.reverse();
            (left, PlanningStage::Called)
        }
    };
    while let Some(&axis) = left.last() {
        let resumed = hold::resumed_move(&parts.servo, caller.memory, axis);
        if let Some((target, limits)) = resumed {
            let planning = |caller: &Caller<'_>| planning::of_move(caller.memory, axis, target, &limits);
            if let Some(pause) = schedule::plan(parts, caller, axis, progress, 0, planning) {
                parts.calls.store(caller, Continuation::Resume(left, pause.then));
                return Outcome::Wait(pause.wake);
            }
        }
        left.pop();
        hold::resume_axis(&mut parts.servo, caller.memory, axis);
        progress = PlanningStage::Called;
    }
    costs::spend(caller, costs::RESUME);
    Outcome::Done(())
}

pub(crate) fn clear_stop_immediately(parts: &mut Parts, caller: &mut Caller<'_>) {
    hold::clear(&mut parts.servo, caller.memory);
}

/// The nominal time of a change of the override, which the board computes axis by axis.
fn change_time(caller: &mut Caller<'_>) -> f32 {
    costs::spend_axes(caller, members(caller.memory).count(), costs::CHANGE_TIME);
    system::nominal_change_time(caller.memory)
}

pub(crate) fn get_nominal_fro_change_time(_: &mut Parts, caller: &mut Caller<'_>) -> f32 {
    change_time(caller)
}

pub(crate) fn open_buf(_: &mut Parts, caller: &mut Caller<'_>) {
    buffer::open(caller.memory);
}

pub(crate) fn exec_buf(_: &mut Parts, caller: &mut Caller<'_>) {
    buffer::execute(caller.memory);
}

/// Checks for an override that looks like a percentage.
fn check_override(parts: &mut Parts, caller: &Caller<'_>, function: Function, value: f32) {
    const MOST: f32 = 10.0;
    if value >= MOST {
        let percent = 100.0 * f64::from(value);
        parts.out.diagnose(caller, Message::OverrideFactor { function, value, percent });
    }
}

pub(crate) fn set_fro(parts: &mut Parts, caller: &mut Caller<'_>, value: f32) {
    check_override(parts, caller, Function::SetFRO, value);
    let time = change_time(caller);
    rate::set_feed(caller.memory, value, time);
}

pub(crate) fn set_rapid_fro(parts: &mut Parts, caller: &mut Caller<'_>, value: f32) {
    check_override(parts, caller, Function::SetRapidFRO, value);
    let time = change_time(caller);
    rate::set_rapid(caller.memory, value, time);
}

pub(crate) fn set_fro_temp(parts: &mut Parts, caller: &mut Caller<'_>, value: f32) {
    check_override(parts, caller, Function::SetFROTemp, value);
    let time = change_time(caller);
    rate::ramp_to_override(caller.memory, value, time);
}

pub(crate) fn set_fro_w_rate(parts: &mut Parts, caller: &mut Caller<'_>, value: f32, time: f32) {
    check_override(parts, caller, Function::SetFROwRate, value);
    rate::set_feed(caller.memory, value, time);
}

pub(crate) fn set_rapid_fro_w_rate(parts: &mut Parts, caller: &mut Caller<'_>, value: f32, time: f32) {
    check_override(parts, caller, Function::SetRapidFROwRate, value);
    rate::set_rapid(caller.memory, value, time);
}

pub(crate) fn set_fro_w_rate_temp(parts: &mut Parts, caller: &mut Caller<'_>, value: f32, time: f32) {
    check_override(parts, caller, Function::SetFROwRateTemp, value);
    rate::ramp_to_override(caller.memory, value, time);
}

/// Counts the entry just filled and advances to the next, which ends the buffer.
pub(crate) fn inc_parametric_index(parts: &mut Parts, caller: &mut Caller<'_>) {
    if let Err(text) = buffer::advance(caller.memory) {
        parts.out.diagnose(caller, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TestBench;

    #[test]
    fn the_nominal_change_time_is_that_of_the_slowest_axis() {
        let mut bench = TestBench::new();
        bench.call("DefineCoordSystem", &[0, u32::MAX.into(), u32::MAX.into(), u32::MAX.into()]);
        let axis = AxisId::new(0).expect("0 is an axis");
        for (v, a, j, expect) in [(40000.0, 200_000.0, 4e6, 0.482_842_7), (100.0, 1e5, 1e9, 0.001_894_427)] {
            bench.memory.set_axis(axis, Chan::VEL, v);
            bench.memory.set_axis(axis, Chan::ACCEL, a);
            bench.memory.set_axis(axis, Chan::JERK, j);
            let time = bench.call_f32("GetNominalFROChangeTime", &[]);
            assert!((time - expect).abs() < 1e-6, "{time}");
        }
    }

    #[test]
    fn a_held_move_resumes_and_a_jog_does_not() {
        for (name, resumes) in [("Move", true), ("Jog", false)] {
            let mut bench = TestBench::new();
            bench.call("EnableAxisDest", &[0, 0]);
            bench.call(name, &[0, 1000.0_f64.to_bits()]);
            bench.run(1000);
            bench.call_in_slices("StopCoordinatedMotion", &[]);
            assert_eq!(bench.memory.get(CS0_STOPPING_STATE), HoldState::StoppingAxes.number());
            bench.run(5000);
            bench.call("UpdateStoppingState", &[]);
            assert_eq!(bench.memory.get(CS0_STOPPING_STATE), HoldState::AxesStopped.number());
            bench.call("ResumeCoordinatedMotion", &[]);
            assert_eq!(bench.memory.get(CS0_STOPPING_STATE), HoldState::Running.number());
            assert_eq!(bench.call_i32("CheckDone", &[0]), i32::from(!resumes), "{name}");
        }
    }

    #[test]
    fn without_motion_there_is_no_feedhold() {
        let mut bench = TestBench::new();
        bench.call_in_slices("StopCoordinatedMotion", &[]);
        assert_eq!(bench.memory.get(CS0_STOPPING_STATE), HoldState::Running.number());
        assert_eq!(bench.call_i32("CheckDoneBuf", &[]), -1);
    }
}
