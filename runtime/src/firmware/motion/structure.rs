//! Functions that take a pointer to the structure of an axis: states of a motion by hand, commutation, resolver.
//! Source: axes-and-motion.md sections 3 to 6 and 12.

use kmotiondef::firmware::Function;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;
use kmotiondef::{AxisId, GuestAddr};
use vm::firmware::Caller;
use vm::memory::GuestMemory;
use vm::trap::TrapKind;

use super::super::parts::Parts;
use super::no_limits;
use crate::machine::Drive;
use crate::out::Message;
use crate::servo::cache::Invalidation;
use crate::servo::independent::{start, state, write};
use crate::servo::input::turn_resolver;
use crate::servo::moves::limits;
use crate::servo::profile::{self, MAX_STATES, MotionState, Ramp};
use crate::servo::{four_phase, three_phase};
use crate::views::{TypedAccess, axis_at};

/// The axis to whose structure a program's pointer leads.
fn axis_of_structure(
    parts: &mut Parts,
    caller: &Caller<'_>,
    function: Function,
    chan: GuestAddr,
) -> Option<AxisId> {
    let axis = axis_at(caller.memory, chan);
    if axis.is_none() {
        parts.out.diagnose(caller, Message::NotAnAxis { function, chan });
    }
    axis
}

pub(crate) fn stop_motion(parts: &mut Parts, caller: &mut Caller<'_>, chan: GuestAddr) {
    if let Some(axis) = axis_of_structure(parts, caller, Function::StopMotion, chan) {
        caller.memory.set_axis(axis, Chan::PCOEFF, GuestAddr::NULL);
    }
}

#[expect(clippy::too_many_arguments, reason = "the C function has nine parameters")]
pub(crate) fn setup_for_move(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    from: f64,
    to: f64,
    velocity: f32,
    chan: GuestAddr,
    offset: i32,
    abrupt_start: i32,
    abrupt_end: i32,
    starts: i32,
    count: GuestAddr,
) -> Result<(), TrapKind> {
    let Some(axis) = axis_of_structure(parts, caller, Function::SetupForMove, chan) else { return Ok(()) };
    let Some(limits) = limits(caller.memory, axis, Some(velocity)) else {
        no_limits(parts, caller, axis, Function::SetupForMove);
        return Ok(());
    };
    let ramps = [abrupt_start, abrupt_end].map(|flag| if flag != 0 { Ramp::Abrupt } else { Ramp::Smooth });
    // Without the end state, which comes from SetupForMotionEnd.
    let mut states = profile::bare_move(from, to, ramps, &limits);
    if !count.is_null() {
        caller.memory.store(count, states.len() as i32)?;
    }
    // Board quirk: the resting tick is repeated after the end, uncounted.
    states.extend([MotionState::END, MotionState::hold(to, TIMEBASE)]);
    write(caller.memory, axis, index(offset), &states);
    if starts != 0 {
        start(caller.memory, axis);
    }
    Ok(())
}

/// The index into a state list of an offset; out of range, nothing is written.
fn index(offset: i32) -> usize {
    usize::try_from(offset).unwrap_or(MAX_STATES)
}

pub(crate) fn setup_for_motion_pause(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    x: f64,
    chan: GuestAddr,
    offset: i32,
    time: f64,
) {
    if let Some(axis) = axis_of_structure(parts, caller, Function::SetupForMotionPause, chan) {
        write(caller.memory, axis, index(offset), &[MotionState::hold(x, time)]);
    }
}

pub(crate) fn setup_for_motion_end(parts: &mut Parts, caller: &mut Caller<'_>, chan: GuestAddr, offset: i32) {
    if let Some(axis) = axis_of_structure(parts, caller, Function::SetupForMotionEnd, chan) {
        let before = index(offset).checked_sub(1).map(|before| state(caller.memory, axis, before));
        let end = before.map_or(0.0, |before| before.at(before.t).x);
        write(caller.memory, axis, index(offset), &[MotionState::off(0.0, end)]);
    }
}

pub(crate) fn write_3ph(parts: &mut Parts, caller: &mut Caller<'_>, chan: GuestAddr, v: f32, angle: f64) {
    match axis_at(caller.memory, chan) {
        Some(axis) => {
            three_phase(caller.memory, axis, v, angle);
            apply(parts, caller.memory, axis, v, angle);
        }
        None => parts.out.console.message("Error Invalid Chan Pointer Write3PH"),
    }
}

pub(crate) fn write_4ph(parts: &mut Parts, caller: &mut Caller<'_>, chan: GuestAddr, v: f32, angle: f64) {
    if let Some(axis) = axis_of_structure(parts, caller, Function::Write4PH, chan) {
        four_phase(caller.memory, axis, v, angle);
        apply(parts, caller.memory, axis, v, angle);
    }
}

/// Applies a vector to the phases: the rotor of a disabled axis turns; on an enabled axis the servo overrides it.
fn apply(parts: &mut Parts, memory: &GuestMemory, axis: AxisId, v: f32, angle: f64) {
    if memory.axis(axis, Chan::ENABLE) == 0 {
        parts.servo.cache.invalidate(Invalidation::Motion);
        parts.machine.loads[axis].drive = Drive::Vector(f64::from(v), angle);
    }
}

pub(crate) fn do_resolver_input2(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    chan: GuestAddr,
    x: f32,
    y: f32,
) {
    if let Some(axis) = axis_of_structure(parts, caller, Function::DoResolverInput2, chan) {
        turn_resolver(caller.memory, axis, (x, y));
    }
}
