//! The coordinate system, feed override and feedhold. Source: coordinated-motion.md sections 1 and 4 to 5.

use kmotiondef::AxisId;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use kmotiondef::variables::CS0_STOPPING_STATE;
use vm::firmware::{Caller, Outcome, Wake};
use vm::memory::GuestMemory;

use super::motion::{limits, start_move_to};
use crate::kernel::{Continuation, Kernel};
use crate::servo::coordinated::feedhold::State;
use crate::servo::coordinated::system::{assign, nominal_change_time};
use crate::servo::coordinated::{buffer, feedhold, path, rate};
use crate::servo::independent::{has_motion, is_moving, present, run};
use crate::servo::{profile, spindle};
use crate::views::Typed;

pub(crate) use crate::servo::coordinated::system::{is_member, letters, members};

/// Ends a buffer that an axis takes part in.
pub(crate) fn abort_if_member(memory: &mut GuestMemory, axis: AxisId) {
    if is_member(memory, axis) {
        path::abort(memory);
    }
}

/// Assigns the letters from X on; the others keep theirs.
pub(crate) fn define(kernel: &mut Kernel, caller: &mut Caller<'_>, axes: &[i32]) {
    let valid = |&axis: &i32| axis == -1 || AxisId::new(axis).is_some();
    if !axes.iter().all(valid) {
        kernel.diagnose(caller, format!("DefineCoordSystem: {axes:?} must be axes 0 to 7 or -1"));
        return;
    }
    let mut named: Vec<i32> = axes.iter().copied().filter(|&axis| axis >= 0).collect();
    named.sort_unstable();
    if named.windows(2).any(|pair| pair[0] == pair[1]) {
        kernel.diagnose(caller, format!("DefineCoordSystem: {axes:?} names an axis twice"));
    }
    assign(caller.memory, axes);
}

pub(crate) fn define_coord_system(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    x: i32,
    y: i32,
    z: i32,
    a: i32,
) {
    define(kernel, caller, &[x, y, z, a]);
}

#[expect(clippy::too_many_arguments, reason = "the C function has six axes")]
pub(crate) fn define_coord_system6(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    x: i32,
    y: i32,
    z: i32,
    a: i32,
    b: i32,
    c: i32,
) {
    define(kernel, caller, &[x, y, z, a, b, c]);
}

#[expect(clippy::too_many_arguments, reason = "the C function has eight axes")]
pub(crate) fn define_coord_system8(
    kernel: &mut Kernel,
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
    define(kernel, caller, &[x, y, z, a, b, c, u, v]);
}

/// −1 if an axis of the system is disabled, 0 while a buffer is executed, else 1.
pub(crate) fn check_done_buf(_: &mut Kernel, caller: &mut Caller<'_>) -> i32 {
    buffer::check_done(caller.memory)
}

/// Begins a feedhold. The board computes it in slices of the caller: one to begin, one for each axis that moves by
/// itself; the others run on meanwhile. Only a thread can wait for them.
pub(crate) fn stop_coordinated_motion(kernel: &mut Kernel, caller: &mut Caller<'_>) -> Outcome<()> {
    if caller.thread.is_none() {
        prepare_stop(caller.memory);
        stop(kernel, caller.memory);
        return Outcome::Done(());
    }
    let mut left = match (caller.woken, kernel.take(caller)) {
        (Some(_), Some(Continuation::Stop(Some(left)))) => left,
        (Some(_), Some(Continuation::Stop(None))) => {
            if feedhold::stop(caller.memory) {
                return Outcome::Done(());
            }
            let mut moving = moving_members(caller.memory);
            moving.reverse();
            return stop_later(kernel, caller, moving);
        }
        _ => {
            if !may_stop(caller.memory) {
                return Outcome::Done(());
            }
            feedhold::note_time(caller.memory);
            kernel.keep(caller, Continuation::Stop(None));
            return Outcome::Wait(Wake::NextSlice);
        }
    };
    if let Some(axis) = left.pop() {
        stop_axis(kernel, caller.memory, axis);
    }
    if left.is_empty() {
        caller.memory.set(CS0_STOPPING_STATE, State::StoppingAxes.number());
    }
    stop_later(kernel, caller, left)
}

/// Goes on with stopping axes in the next slice, the last one first.
fn stop_later(kernel: &mut Kernel, caller: &Caller<'_>, left: Vec<AxisId>) -> Outcome<()> {
    if left.is_empty() {
        return Outcome::Done(());
    }
    kernel.keep(caller, Continuation::Stop(Some(left)));
    Outcome::Wait(Wake::NextSlice)
}

/// Whether there is something for a feedhold to stop. Nothing but its end holds a path that the spindle drives.
fn may_stop(memory: &GuestMemory) -> bool {
    State::of(memory) == State::Running && !spindle::is_threading(memory)
}

/// Computes how long a stop takes, for [`stop`].
pub(crate) fn prepare_stop(memory: &mut GuestMemory) {
    if may_stop(memory) {
        feedhold::note_time(memory);
    }
}

/// Begins a feedhold that was prepared, if something in the coordinate system moves; whether it does.
pub(crate) fn stop(kernel: &mut Kernel, memory: &mut GuestMemory) -> bool {
    if !may_stop(memory) {
        return false;
    }
    if feedhold::stop(memory) {
        return true;
    }
    let moving = moving_members(memory);
    moving.iter().for_each(|&axis| stop_axis(kernel, memory, axis));
    if !moving.is_empty() {
        memory.set(CS0_STOPPING_STATE, State::StoppingAxes.number());
    }
    !moving.is_empty()
}

/// The axes of the coordinate system that move by themselves.
fn moving_members(memory: &GuestMemory) -> Vec<AxisId> {
    members(memory).filter(|&axis| is_moving(memory, axis)).collect()
}

/// Decelerates an axis to rest.
fn stop_axis(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId) {
    if let Some(limits) = limits(memory, axis, Some(1.0)) {
        let states = profile::jog(present(memory, axis), 0.0, &limits);
        run(memory, axis, &states);
        kernel.servo.axes[axis.index()].is_held = true;
    }
}

/// Ends the second phase of a feedhold when the axes have stopped.
pub(crate) fn update_state(memory: &mut GuestMemory) {
    let stopped = members(memory).all(|axis| !has_motion(memory, axis));
    if State::of(memory) == State::StoppingAxes && stopped {
        memory.set(CS0_STOPPING_STATE, State::AxesStopped.number());
    }
}

pub(crate) fn update_stopping_state(_: &mut Kernel, caller: &mut Caller<'_>) {
    update_state(caller.memory);
}

/// Ends a feedhold. A thread waits for a slice in front of each axis but the first, and of that if it still moves: the
/// board plans there.
pub(crate) fn resume_coordinated_motion(kernel: &mut Kernel, caller: &mut Caller<'_>) -> Outcome<()> {
    let (mut left, mut has_planned) = match (caller.woken, kernel.take(caller)) {
        (Some(_), Some(Continuation::Resume(mut left))) => {
            if let Some(axis) = left.pop() {
                resume_axis(kernel, caller.memory, axis);
            }
            (left, true)
        }
        _ => {
            update_state(caller.memory);
            if feedhold::resume(caller.memory) || State::of(caller.memory) == State::Running {
                return Outcome::Done(());
            }
            caller.memory.set(CS0_STOPPING_STATE, State::Running.number());
            let held = |axis: &AxisId| kernel.servo.axes[axis.index()].is_held;
            let mut left: Vec<AxisId> = members(caller.memory).filter(held).collect();
            left.reverse();
            (left, false)
        }
    };
    while let Some(&axis) = left.last() {
        if caller.thread.is_some() && (has_planned || has_motion(caller.memory, axis)) {
            kernel.keep(caller, Continuation::Resume(left));
            return Outcome::Wait(Wake::NextSlice);
        }
        left.pop();
        resume_axis(kernel, caller.memory, axis);
        has_planned = true;
    }
    Outcome::Done(())
}

/// Restarts what a feedhold interrupted. A jog is not resumed; an exponential approach becomes a move.
fn resume_axis(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId) {
    let was_held = std::mem::take(&mut kernel.servo.axes[axis.index()].is_held);
    let kind = LastMotion::new(memory.axis(axis, Chan::LAST_MOTION_TYPE));
    let Some(kind) = kind.filter(|&kind| was_held && kind != LastMotion::Jog) else { return };
    let target = memory.axis(axis, Chan::LAST_MOTION_DEST);
    if let Some(limits) = limits(memory, axis, None) {
        start_move_to(memory, axis, target, &limits, kind);
    }
}

pub(crate) fn clear_stop_immediately(kernel: &mut Kernel, caller: &mut Caller<'_>) {
    let memory = &mut *caller.memory;
    if !feedhold::clear(memory) {
        memory.set(CS0_STOPPING_STATE, State::Running.number());
    }
    kernel.servo.axes.iter_mut().for_each(|axis| axis.is_held = false);
}

pub(crate) fn get_nominal_fro_change_time(_: &mut Kernel, caller: &mut Caller<'_>) -> f32 {
    nominal_change_time(caller.memory)
}

pub(crate) fn set_fro(_: &mut Kernel, caller: &mut Caller<'_>, value: f32) {
    let time = nominal_change_time(caller.memory);
    rate::set_feed(caller.memory, value, time);
}

pub(crate) fn set_rapid_fro(_: &mut Kernel, caller: &mut Caller<'_>, value: f32) {
    let time = nominal_change_time(caller.memory);
    rate::set_rapid(caller.memory, value, time);
}

pub(crate) fn set_fro_temp(_: &mut Kernel, caller: &mut Caller<'_>, value: f32) {
    let time = nominal_change_time(caller.memory);
    rate::aim(caller.memory, value, time);
}

pub(crate) fn set_fro_w_rate(_: &mut Kernel, caller: &mut Caller<'_>, value: f32, time: f32) {
    rate::set_feed(caller.memory, value, time);
}

pub(crate) fn set_rapid_fro_w_rate(_: &mut Kernel, caller: &mut Caller<'_>, value: f32, time: f32) {
    rate::set_rapid(caller.memory, value, time);
}

pub(crate) fn set_fro_w_rate_temp(_: &mut Kernel, caller: &mut Caller<'_>, value: f32, time: f32) {
    rate::aim(caller.memory, value, time);
}

/// Counts the entry just filled and goes to the next, which ends the buffer.
pub(crate) fn inc_parametric_index(kernel: &mut Kernel, caller: &mut Caller<'_>) {
    if let Err(text) = buffer::advance(caller.memory) {
        kernel.diagnose(caller, text);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Desk;

    #[test]
    fn the_nominal_change_time_is_that_of_the_slowest_axis() {
        let mut desk = Desk::new();
        desk.call("DefineCoordSystem", &[0, u32::MAX.into(), u32::MAX.into(), u32::MAX.into()]);
        let axis = AxisId::new(0).expect("0 is an axis");
        for (v, a, j, expect) in [(40000.0, 200_000.0, 4e6, 0.482_842_7), (100.0, 1e5, 1e9, 0.001_894_427)] {
            desk.memory.set_axis(axis, Chan::VEL, v);
            desk.memory.set_axis(axis, Chan::ACCEL, a);
            desk.memory.set_axis(axis, Chan::JERK, j);
            let time = desk.call_f32("GetNominalFROChangeTime", &[]);
            assert!((time - expect).abs() < 1e-6, "{time}");
        }
    }

    #[test]
    fn a_held_move_resumes_and_a_jog_does_not() {
        for (name, resumes) in [("Move", true), ("Jog", false)] {
            let mut desk = Desk::new();
            desk.call("EnableAxisDest", &[0, 0]);
            desk.call(name, &[0, 1000.0_f64.to_bits()]);
            desk.run(1000);
            desk.call_in_slices("StopCoordinatedMotion", &[]);
            assert_eq!(desk.memory.get(CS0_STOPPING_STATE), State::StoppingAxes.number());
            desk.run(5000);
            desk.call("UpdateStoppingState", &[]);
            assert_eq!(desk.memory.get(CS0_STOPPING_STATE), State::AxesStopped.number());
            desk.call("ResumeCoordinatedMotion", &[]);
            assert_eq!(desk.memory.get(CS0_STOPPING_STATE), State::Running.number());
            assert_eq!(desk.call_i32("CheckDone", &[0]), i32::from(!resumes), "{name}");
        }
    }

    #[test]
    fn without_motion_there_is_no_feedhold() {
        let mut desk = Desk::new();
        desk.call_in_slices("StopCoordinatedMotion", &[]);
        assert_eq!(desk.memory.get(CS0_STOPPING_STATE), State::Running.number());
        assert_eq!(desk.call_i32("CheckDoneBuf", &[]), -1);
    }
}
