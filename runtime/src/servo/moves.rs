//! Moves of single axes: from where an axis is now, within its limits.

use kmotiondef::AxisId;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use vm::memory::GuestMemory;

use super::independent::{present, run};
use super::profile::{self, Limits};
use crate::views::Typed;

/// The limits of an axis, with another velocity if one is given.
pub(crate) fn limits(memory: &GuestMemory, axis: AxisId, velocity: Option<f32>) -> Option<Limits> {
    let velocity = velocity.map_or_else(|| memory.axis(axis, Chan::VEL), f32::abs);
    Limits::new(velocity, memory.axis(axis, Chan::ACCEL), memory.axis(axis, Chan::JERK))
}

/// Starts a move to `target`, from rest or in motion; whether it reaches its full speed.
pub(crate) fn start_move_to(
    memory: &mut GuestMemory,
    axis: AxisId,
    target: f64,
    limits: &Limits,
    kind: LastMotion,
) -> bool {
    let point = present(memory, axis);
    let is_resting = point.v == 0.0 && point.a == 0.0;
    let states = if is_resting {
        profile::move_from_rest(point.x, target, limits)
    } else {
        profile::move_in_motion(point, target, limits)
    };
    run(memory, axis, &states);
    // A move in motion goes through the jog planner, and says so unless it is one of several axes (recorded).
    let kind = if is_resting || kind == LastMotion::Multi { kind } else { LastMotion::Jog };
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, kind.get());
    memory.set_axis(axis, Chan::LAST_MOTION_DEST, target);
    states.iter().any(|state| state.b == 0.0 && state.t > 0.0 && state.c.abs() >= limits.v * (1.0 - 1e-9))
}
