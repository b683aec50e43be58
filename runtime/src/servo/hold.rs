//! Feedhold of the coordinate system: of its path, or of its axes if they move independently.
//!
//! Source: coordinated-motion.md sections 4 and 5. The path's part is [`feedhold`].

use kmotiondef::AxisId;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use kmotiondef::variables::CS0_STOPPING_STATE;
use vm::memory::GuestMemory;

use super::coordinated::feedhold::{self, HoldState};
use super::coordinated::path;
use super::coordinated::system::{is_member, members};
use super::independent::has_motion;
use super::moves::{limits, start_jog, start_move_to};
use super::profile::Limits;
use super::spindle;
use super::state::Servo;
use crate::views::TypedAccess;

/// Ends the path to which an axis belongs, running or not, when the axis is disabled or zeroed (coordinated-motion.md
/// section 3.4). A write to its `Enable` field does not do that.
pub(crate) fn abort_if_member(memory: &mut GuestMemory, axis: AxisId) {
    if is_member(memory, axis) {
        path::drop_all(memory);
    }
}

/// Returns whether there is a motion that a feedhold can stop. A path driven by the spindle is only held at its end.
pub(crate) fn may_stop(memory: &GuestMemory) -> bool {
    HoldState::of(memory) == HoldState::Running && !spindle::is_threading(memory)
}

/// Computes how long a stop takes, for [`stop_next`].
pub(crate) fn prepare_stop(memory: &mut GuestMemory) {
    if may_stop(memory) {
        feedhold::note_time(memory);
    }
}

/// Begins a feedhold that was prepared, if something in the coordinate system moves; returns whether it does. Axes that
/// move independently are stopped in the following slices.
pub(super) fn begin(servo: &mut Servo, memory: &mut GuestMemory) -> bool {
    if !may_stop(memory) {
        return false;
    }
    if feedhold::stop(memory) {
        return true;
    }
    let mut moving = moving_members(memory);
    let moves = !moving.is_empty();
    moving.retain(|&axis| memory.axis(axis, Chan::ENABLE) != 0);
    if moves && moving.is_empty() {
        memory.set(CS0_STOPPING_STATE, HoldState::StoppingAxes.number());
    }
    servo.stop_request.stop_in_turn(moving);
    moves
}

/// Stops the next of the axes that a feedhold stops one by one; returns whether there was one.
pub(super) fn stop_next(servo: &mut Servo, memory: &mut GuestMemory) -> bool {
    let Some((axis, is_last)) = servo.stop_request.next_axis() else { return false };
    stop_axis(servo, memory, axis);
    if is_last {
        memory.set(CS0_STOPPING_STATE, HoldState::StoppingAxes.number());
    }
    true
}

/// Requests a feedhold for a command; the primary thread begins it in its next slice.
pub(crate) fn ask(servo: &mut Servo, memory: &mut GuestMemory) {
    let moves = path::is_under_way(memory) || !moving_members(memory).is_empty();
    if moves && may_stop(memory) {
        feedhold::note_time(memory);
        servo.stop_request.ask_by_command();
    }
}

/// Executes the rest of a feedhold immediately, for a command that ends it.
pub(crate) fn complete(servo: &mut Servo, memory: &mut GuestMemory) {
    if servo.stop_request.take().is_some() {
        begin(servo, memory);
    }
    while stop_next(servo, memory) {}
}

/// The axes of the coordinate system with a motion of their own, including disabled ones.
pub(crate) fn moving_members(memory: &GuestMemory) -> Vec<AxisId> {
    members(memory).filter(|&axis| has_motion(memory, axis)).collect()
}

/// Decelerates an axis to rest.
pub(crate) fn stop_axis(servo: &mut Servo, memory: &mut GuestMemory, axis: AxisId) {
    if let Some(limits) = limits(memory, axis, Some(1.0)) {
        let kind = LastMotion::new(memory.axis(axis, Chan::LAST_MOTION_TYPE));
        start_jog(memory, axis, 0.0, &limits, servo.planner);
        // The axis is jogged to rest; its motion is kept for a resume.
        servo.axes[axis.index()].held = Some(kind.unwrap_or(LastMotion::Jog));
    }
}

/// Ends the second phase of a feedhold when the axes have stopped.
pub(crate) fn update_state(memory: &mut GuestMemory) {
    let stopped = members(memory).all(|axis| !has_motion(memory, axis));
    if HoldState::of(memory) == HoldState::StoppingAxes && stopped {
        memory.set(CS0_STOPPING_STATE, HoldState::AxesStopped.number());
    }
}

/// The target and the limits of the move with which a held axis continues, if it does.
pub(crate) fn resumed_move(servo: &Servo, memory: &GuestMemory, axis: AxisId) -> Option<(f64, Limits)> {
    servo.axes[axis.index()].held.filter(|kind| *kind != LastMotion::Jog)?;
    Some((memory.axis(axis, Chan::LAST_MOTION_DEST), limits(memory, axis, None)?))
}

/// Restarts the motion that a feedhold interrupted. A jog is not resumed; an exponential approach becomes a move.
pub(crate) fn resume_axis(servo: &mut Servo, memory: &mut GuestMemory, axis: AxisId) {
    let Some(kind) = servo.axes[axis.index()].held.take() else { return };
    // As recorded, it counts as part of a move of several axes, whatever it was and whether it continues or not.
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Multi.get());
    if kind == LastMotion::Jog {
        return;
    }
    let target = memory.axis(axis, Chan::LAST_MOTION_DEST);
    if let Some(limits) = limits(memory, axis, None) {
        start_move_to(memory, axis, target, (&limits, limits.a), kind, servo.planner);
        memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Multi.get());
    }
}

/// Drops the motions held by a feedhold, and the path.
pub(crate) fn clear(servo: &mut Servo, memory: &mut GuestMemory) {
    feedhold::clear(memory);
    servo.axes.iter_mut().for_each(|axis| axis.held = None);
}
