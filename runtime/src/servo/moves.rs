//! Moves of single axes: from where an axis is now, within its limits.

use kmotiondef::AxisId;
use kmotiondef::modes::LastMotion;
use kmotiondef::structs::Chan;
use vm::memory::GuestMemory;

use super::direct::{jog_direct, move_direct};
use super::independent::{present, run, run_kept};
use super::profile::{self, Limits};
use crate::views::TypedAccess;

/// The way in which moves and jogs are planned.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) enum Planner {
    /// Firmware 4.34: a move in motion that does not fit stops the axis first, and every jog waits 20 ticks.
    #[default]
    Stopping,
    /// Firmware 5: a move goes directly to its target, and a jog from rest starts at once.
    Direct,
}

/// The accelerations of a move that has its own; none if they come from the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Accelerations {
    /// That with which it gets faster.
    pub(crate) accel: f32,
    /// That with which it gets slower.
    pub(crate) decel: f32,
}

/// The limits of an axis, with another velocity if one is given.
pub(crate) fn limits(memory: &GuestMemory, axis: AxisId, velocity: Option<f32>) -> Option<Limits> {
    let velocity = velocity.map_or_else(|| memory.axis(axis, Chan::VEL), f32::abs);
    Limits::new(velocity, memory.axis(axis, Chan::ACCEL), memory.axis(axis, Chan::JERK))
}

/// The limits of an axis with another velocity and other accelerations, and that with which it gets slower.
pub(crate) fn limits_with(
    memory: &GuestMemory,
    axis: AxisId,
    velocity: Option<f32>,
    own: Option<Accelerations>,
) -> Option<(Limits, f64)> {
    let Some(Accelerations { accel, decel }) = own else {
        let limits = limits(memory, axis, velocity)?;
        return Some((limits, limits.a));
    };
    let velocity = velocity.map_or_else(|| memory.axis(axis, Chan::VEL), f32::abs);
    let limits = Limits::new(velocity, accel, memory.axis(axis, Chan::JERK))?;
    (decel > 0.0 && decel.is_finite()).then(|| (limits, f64::from(decel)))
}

/// Starts a jog.
pub(crate) fn start_jog(
    memory: &mut GuestMemory,
    axis: AxisId,
    velocity: f64,
    limits: &Limits,
    planner: Planner,
) {
    let point = present(memory, axis);
    match planner {
        Planner::Stopping => run(memory, axis, &profile::jog(point, velocity, limits)),
        // Board quirk: at rest the mode of the first state is unchanged.
        Planner::Direct if point.v == 0.0 && point.a == 0.0 => {
            run_kept(memory, axis, &jog_direct(point, velocity, limits));
        }
        Planner::Direct => run(memory, axis, &jog_direct(point, velocity, limits)),
    }
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Jog.get());
}

/// Starts a move to `target`, from rest or in motion; returns whether it reaches full speed.
pub(crate) fn start_move_to(
    memory: &mut GuestMemory,
    axis: AxisId,
    target: f64,
    (limits, decel): (&Limits, f64),
    kind: LastMotion,
    planner: Planner,
) -> bool {
    let point = present(memory, axis);
    let is_resting = point.v == 0.0 && point.a == 0.0;
    let states = match planner {
        Planner::Direct if !point.x.is_nan() => move_direct(point, target, limits, decel),
        _ if is_resting => profile::move_from_rest(point.x, target, limits),
        _ => profile::move_in_motion(point, target, limits),
    };
    run(memory, axis, &states);
    // A move in motion uses the jog planner, and is marked as a jog unless it is one of several axes (recorded).
    let is_jog = planner == Planner::Stopping && !is_resting && kind != LastMotion::Multi;
    let kind = if is_jog { LastMotion::Jog } else { kind };
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, kind.get());
    memory.set_axis(axis, Chan::LAST_MOTION_DEST, target);
    states.iter().any(|state| state.b == 0.0 && state.t > 0.0 && state.c.abs() >= limits.v * (1.0 - 1e-9))
}
