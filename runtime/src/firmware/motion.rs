//! Single axes: enabling, independent moves, commutation. Source: axes-and-motion.md sections 3 to 6 and 12.

use std::f32::consts::{PI, TAU};

use kmotiondef::modes::{LastMotion, OutputMode};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::{COORD_SYSTEM0, CS0_STOPPING_STATE, RESOLVER_FACTOR};
use kmotiondef::{AxisId, Cycles, GuestAddr};
use vm::firmware::{Caller, Outcome, Wake};
use vm::memory::GuestMemory;
use vm::trap::TrapKind;

use super::coord;
use crate::kernel::{Continuation, Kernel};
use crate::machine::plant::Drive;
use crate::servo::independent::{has_motion, is_planned, present, run, start, state, write};
use crate::servo::profile::{self, LEAD, Limits, MAX_STATES, Mode, Ramp, State};
use crate::servo::{AxisMemory, TIMEBASE, four_phase, switch_off, three_phase};
use crate::views::{Typed, axis_at};

/// What the board prints when a program names an axis that does not exist.
fn invalid(kernel: &mut Kernel, what: &str) {
    kernel.console.message(&format!("Attempt to {what} invalid Chan"));
}

/// Checks an axis number that a program names.
fn checked(kernel: &mut Kernel, caller: &Caller<'_>, function: &str, axis: i32) -> Option<AxisId> {
    let checked = AxisId::new(axis);
    if checked.is_none() {
        kernel.diagnose(caller, format!("{function}({axis}, …): there are axes 0 to {}", AxisId::MAX));
    }
    checked
}

pub(crate) fn enable_axis(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32) {
    let Some(axis) = checked(kernel, caller, "EnableAxis", axis) else { return };
    let mode = OutputMode::new(caller.memory.axis(axis, Chan::OUTPUT_MODE));
    let field = if mode == Some(OutputMode::Microstep) { Chan::DEST } else { Chan::POSITION };
    let dest = caller.memory.axis(axis, field);
    enable(kernel, caller.memory, axis, dest);
}

pub(crate) fn enable_axis_dest(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32, dest: f64) {
    match AxisId::new(axis) {
        Some(axis) => enable(kernel, caller.memory, axis, dest),
        None => invalid(kernel, "enable"),
    }
}

/// Makes an axis stand at a destination and turns it on.
pub(crate) fn enable(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId, dest: f64) {
    memory.set_axis(axis, Chan::PCOEFF, GuestAddr::NULL);
    for field in [Chan::DEST, Chan::LAST_DEST, Chan::PREV_DEST] {
        memory.set_axis(axis, field, dest);
    }
    clear_filters(memory, axis);
    memory.set_axis(axis, Chan::BACKLASH, 0.0);
    memory.set_axis(axis, Chan::LAST_NON_ZERO_DIR, 0);
    memory.set_axis(axis, Chan::DIRECTION_OF_MOTION, 0);
    memory.set_axis(axis, Chan::LAST_VEL, 0.0);
    memory.set_axis(axis, Chan::ENABLE, 1);
    kernel.servo.still.interrupt();
    kernel.servo.axes[axis.index()] = AxisMemory::rest(dest);
    kernel.servo.plants[axis.index()].refer_to(dest);
}

pub(crate) fn disable_axis(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32) {
    let Some(axis) = AxisId::new(axis) else { return invalid(kernel, "Disable") };
    switch_off(kernel, caller.memory, axis);
    coord::abort_if_member(caller.memory, axis);
}

pub(crate) fn zero(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32) {
    let Some(axis) = AxisId::new(axis) else { return invalid(kernel, "Zero") };
    let memory = &mut *caller.memory;
    memory.set_axis(axis, Chan::PCOEFF, GuestAddr::NULL);
    memory.set_axis(axis, Chan::POSITION, 0.0);
    let zeroed =
        [Chan::DEST, Chan::UNFILTERED_DEST, Chan::LAST_DEST, Chan::PREV_DEST, Chan::LAST_FOLLOWING_ERROR];
    zeroed.into_iter().for_each(|field| memory.set_axis(axis, field, 0.0));
    clear_filters(memory, axis);
    memory.set_axis(axis, Chan::LAST_VEL, 0.0);
    memory.set_axis(axis, Chan::LAST_NON_ZERO_DIR, 0);
    memory.set_axis(axis, Chan::DIRECTION_OF_MOTION, 0);
    memory.set_axis(axis, Chan::PREV_BACKLASH_DEST, 0.0);
    kernel.servo.still.interrupt();
    kernel.servo.axes[axis.index()] = AxisMemory::rest(0.0);
    kernel.servo.plants[axis.index()].refer_to(0.0);
}

pub(crate) fn reset_filters(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32) {
    let Some(axis) = checked(kernel, caller, "ResetFilters", axis) else { return };
    clear_filters(caller.memory, axis);
    let dest = caller.memory.axis(axis, Chan::DEST);
    kernel.servo.still.interrupt();
    kernel.servo.axes[axis.index()] = AxisMemory::rest(dest);
}

/// Clears what the compensation remembers.
fn clear_filters(memory: &mut GuestMemory, axis: AxisId) {
    for field in [Chan::INTEGRATOR, Chan::OUTPUT, Chan::PREV_OUTPUT] {
        memory.set_axis(axis, field, 0.0);
    }
    for number in 0..3 {
        memory.set_axis(axis, Chan::IIR.element(number).field(Iir::D0), 0.0);
        memory.set_axis(axis, Chan::IIR.element(number).field(Iir::D1), 0.0);
    }
    let position = memory.axis(axis, Chan::POSITION);
    memory.set_axis(axis, Chan::LAST_POSITION, position);
}

/// The limits of an axis, with another velocity if one is given.
pub(crate) fn limits(memory: &GuestMemory, axis: AxisId, velocity: Option<f32>) -> Option<Limits> {
    let velocity = velocity.map_or_else(|| memory.axis(axis, Chan::VEL), f32::abs);
    Limits::new(velocity, memory.axis(axis, Chan::ACCEL), memory.axis(axis, Chan::JERK))
}

/// Whether a motion call on an axis may do anything now.
fn may_move(kernel: &mut Kernel, caller: &Caller<'_>, axis: AxisId, function: &str) -> bool {
    let memory = &*caller.memory;
    if memory.axis(axis, Chan::ENABLE) == 0 {
        kernel.diagnose(caller, format!("{function}: axis {axis} is disabled, nothing moves"));
        return false;
    }
    let is_member = coord::is_member(memory, axis);
    if is_member && !memory.get(COORD_SYSTEM0).is_null() {
        kernel
            .diagnose(caller, format!("{function}: axis {axis} executes coordinated motion, which goes on"));
        return false;
    }
    let may = !(is_member && memory.get(CS0_STOPPING_STATE) != 0);
    let drives_nothing = memory.axis(axis, Chan::OUTPUT_MODE) == OutputMode::None.get();
    if may && drives_nothing && kernel.hints && kernel.mechanics.take_unmoved(axis) {
        let text = format!(
            "{function}: axis {axis} drives nothing, its OutputMode is NO_OUTPUT_MODE: what the machine file connects to \
             it stays as it is (is a program that sets the axes up to run first?)"
        );
        kernel.diagnose(caller, text);
    }
    may
}

/// Waits for the caller's next slice if the axis is moving: the board plans there; for the planning time of the machine
/// file if it has one. The call-back cannot wait.
fn planning_wait(kernel: &Kernel, caller: &Caller<'_>, axis: AxisId) -> Option<Wake> {
    if caller.woken.is_some() || caller.thread.is_none() {
        return None;
    }
    if kernel.plan_ticks > 0 {
        let planning = Cycles::PER_TICK.get() * i64::from(kernel.plan_ticks);
        return Some(Wake::At(caller.now() + Cycles::new(planning)));
    }
    has_motion(caller.memory, axis).then_some(Wake::NextSlice)
}

/// Tells a program that calls motions faster than the board plans them why the axis does not get on.
fn notice_hurry(kernel: &mut Kernel, caller: &Caller<'_>, axis: AxisId, function: &str) {
    /// So many in a row are no chance; it is told once.
    const CALLS: u8 = 50;
    let calls = &mut kernel.hurried_calls[axis.index()];
    if is_planned(caller.memory, axis) {
        *calls = calls.saturating_add(1);
    } else if *calls < CALLS {
        *calls = 0;
    }
    if *calls == CALLS && kernel.hints {
        let text = format!(
            "{function}: axis {axis} is told where to go again within {} ms, {CALLS} times in a row. The board plans a \
             motion that is called in motion for so long, and the axis keeps its speed meanwhile: it never gets on. \
             Call less often, or use MoveExp",
            1e3 * LEAD
        );
        kernel.diagnose(caller, text);
    }
}

/// Starts a move to `target`, from rest or in motion.
pub(crate) fn start_move_to(
    memory: &mut GuestMemory,
    axis: AxisId,
    target: f64,
    limits: &Limits,
    kind: LastMotion,
) {
    let point = present(memory, axis);
    let is_resting = point.v == 0.0 && point.a == 0.0;
    let states = if is_resting {
        profile::move_from_rest(point.x, target, limits)
    } else {
        profile::move_in_motion(point, target, limits)
    };
    run(memory, axis, &states);
    // A move in motion goes through the jog planner, and says so.
    let kind = if is_resting { kind } else { LastMotion::Jog };
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, kind.get());
    memory.set_axis(axis, Chan::LAST_MOTION_DEST, target);
}

/// Whether a target or speed is a number that an axis can go to.
fn is_place(kernel: &mut Kernel, caller: &Caller<'_>, function: &str, value: f64) -> bool {
    if !value.is_finite() {
        kernel.diagnose(caller, format!("{function}: {value} is no number to go to, nothing moves"));
    }
    value.is_finite()
}

/// One of the four moves.
struct Request {
    function: &'static str,
    axis: i32,
    target: f64,
    is_relative: bool,
    velocity: Option<f32>,
}

fn request(kernel: &mut Kernel, caller: &mut Caller<'_>, request: &Request) -> Outcome<()> {
    let Some(axis) = checked(kernel, caller, request.function, request.axis) else {
        return Outcome::Done(());
    };
    let target = match (caller.woken, kernel.take(caller)) {
        (Some(_), Some(Continuation::Target(target))) => target,
        _ => request.target + if request.is_relative { caller.memory.axis(axis, Chan::DEST) } else { 0.0 },
    };
    if !may_move(kernel, caller, axis, request.function) {
        return Outcome::Done(());
    }
    if let Some(wake) = planning_wait(kernel, caller, axis) {
        kernel.keep(caller, Continuation::Target(target));
        return Outcome::Wait(wake);
    }
    if !is_place(kernel, caller, request.function, target) {
        return Outcome::Done(());
    }
    notice_hurry(kernel, caller, axis, request.function);
    match limits(caller.memory, axis, request.velocity) {
        Some(limits) => start_move_to(caller.memory, axis, target, &limits, LastMotion::Move),
        None => no_limits(kernel, caller, axis, request.function),
    }
    Outcome::Done(())
}

fn no_limits(kernel: &mut Kernel, caller: &Caller<'_>, axis: AxisId, function: &str) {
    kernel.diagnose(caller, format!("{function}: Vel, Accel and Jerk of axis {axis} are not all positive"));
}

pub(crate) fn move_to(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32, x: f64) -> Outcome<()> {
    request(
        kernel,
        caller,
        &Request { function: "Move", axis, target: x, is_relative: false, velocity: None },
    )
}

pub(crate) fn move_rel(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32, dx: f64) -> Outcome<()> {
    request(
        kernel,
        caller,
        &Request { function: "MoveRel", axis, target: dx, is_relative: true, velocity: None },
    )
}

pub(crate) fn move_at_vel(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    axis: i32,
    x: f64,
    velocity: f32,
) -> Outcome<()> {
    let velocity = Some(velocity);
    request(kernel, caller, &Request { function: "MoveAtVel", axis, target: x, is_relative: false, velocity })
}

pub(crate) fn move_rel_at_vel(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    axis: i32,
    dx: f64,
    velocity: f32,
) -> Outcome<()> {
    let velocity = Some(velocity);
    request(
        kernel,
        caller,
        &Request { function: "MoveRelAtVel", axis, target: dx, is_relative: true, velocity },
    )
}

pub(crate) fn jog(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32, velocity: f64) -> Outcome<()> {
    let Some(axis) = checked(kernel, caller, "Jog", axis) else { return Outcome::Done(()) };
    if !may_move(kernel, caller, axis, "Jog") || !is_place(kernel, caller, "Jog", velocity) {
        return Outcome::Done(());
    }
    if let Some(wake) = planning_wait(kernel, caller, axis) {
        return Outcome::Wait(wake);
    }
    // Any speed will do: only acceleration and jerk limit a jog.
    let Some(limits) = limits(caller.memory, axis, Some(1.0)) else {
        no_limits(kernel, caller, axis, "Jog");
        return Outcome::Done(());
    };
    let point = present(caller.memory, axis);
    if point.v != velocity {
        notice_hurry(kernel, caller, axis, "Jog");
    }
    let states = profile::jog(point, velocity, &limits);
    run(caller.memory, axis, &states);
    caller.memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Jog.get());
    Outcome::Done(())
}

pub(crate) fn move_exp(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    axis: i32,
    x: f64,
    tau: f64,
) -> Outcome<()> {
    if tau <= 0.0 || tau.is_nan() {
        return move_to(kernel, caller, axis, x);
    }
    let Some(axis) = checked(kernel, caller, "MoveExp", axis) else { return Outcome::Done(()) };
    if !may_move(kernel, caller, axis, "MoveExp") || !is_place(kernel, caller, "MoveExp", x) {
        return Outcome::Done(());
    }
    if let Some(wake) = planning_wait(kernel, caller, axis) {
        return Outcome::Wait(wake);
    }
    let memory = &mut *caller.memory;
    let accel = f64::from(memory.axis(axis, Chan::ACCEL));
    let vc = (accel * tau) as f32;
    memory.set_axis(axis, Chan::EXP_MOTION_VC, vc);
    memory.set_axis(axis, Chan::EXP_MOTION_XC, (f64::from(vc) * tau) as f32);
    // Only mode, ratio and target of the first state are written; the rest keeps what stood there.
    let first =
        State { mode: Mode::Exponential, a: libm::exp(-TIMEBASE / tau), b: x, ..state(memory, axis, 0) };
    run(memory, axis, &[first]);
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Exp.get());
    memory.set_axis(axis, Chan::LAST_MOTION_DEST, x);
    Outcome::Done(())
}

#[expect(clippy::too_many_arguments, reason = "the C function has six coordinates")]
pub(crate) fn move_xyzabc(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    x: f64,
    y: f64,
    z: f64,
    a: f64,
    b: f64,
    c: f64,
) -> Outcome<()> {
    let letters = coord::letters(caller.memory).into_iter().zip([x, y, z, a, b, c]);
    let moves: Vec<(AxisId, f64)> = letters.filter_map(|(axis, target)| Some((axis?, target))).collect();
    // Unlike the calls for one axis this one waits even if all axes are at rest.
    if caller.woken.is_none() && caller.thread.is_some() {
        let wake = moves.first().and_then(|&(axis, _)| planning_wait(kernel, caller, axis));
        return Outcome::Wait(wake.unwrap_or(Wake::NextSlice));
    }
    for (axis, target) in moves {
        if may_move(kernel, caller, axis, "MoveXYZABC") && is_place(kernel, caller, "MoveXYZABC", target) {
            match limits(caller.memory, axis, None) {
                Some(limits) => start_move_to(caller.memory, axis, target, &limits, LastMotion::Multi),
                None => no_limits(kernel, caller, axis, "MoveXYZABC"),
            }
        }
    }
    Outcome::Done(())
}

/// −1 disabled, 1 done, 0 moving.
fn done(memory: &GuestMemory, axis: AxisId) -> i32 {
    if memory.axis(axis, Chan::ENABLE) == 0 { -1 } else { i32::from(!has_motion(memory, axis)) }
}

pub(crate) fn check_done(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32) -> i32 {
    checked(kernel, caller, "CheckDone", axis).map_or(-1, |axis| done(caller.memory, axis))
}

pub(crate) fn check_done_xyzabc(_: &mut Kernel, caller: &mut Caller<'_>) -> i32 {
    coord::members(caller.memory).map(|axis| done(caller.memory, axis)).min().unwrap_or(1)
}

pub(crate) fn start_move(kernel: &mut Kernel, caller: &mut Caller<'_>, axis: i32) {
    if let Some(axis) = checked(kernel, caller, "StartMove", axis) {
        start(caller.memory, axis);
    }
}

/// The axis whose structure a program points at.
fn pointed(kernel: &mut Kernel, caller: &Caller<'_>, function: &str, chan: GuestAddr) -> Option<AxisId> {
    let axis = axis_at(chan);
    if axis.is_none() {
        kernel.diagnose(caller, format!("{function}: {chan} is no axis structure"));
    }
    axis
}

pub(crate) fn stop_motion(kernel: &mut Kernel, caller: &mut Caller<'_>, chan: GuestAddr) {
    if let Some(axis) = pointed(kernel, caller, "StopMotion", chan) {
        caller.memory.set_axis(axis, Chan::PCOEFF, GuestAddr::NULL);
    }
}

#[expect(clippy::too_many_arguments, reason = "the C function has nine parameters")]
pub(crate) fn setup_for_move(
    kernel: &mut Kernel,
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
    let Some(axis) = pointed(kernel, caller, "SetupForMove", chan) else { return Ok(()) };
    let Some(limits) = limits(caller.memory, axis, Some(velocity)) else {
        no_limits(kernel, caller, axis, "SetupForMove");
        return Ok(());
    };
    let ramps = [abrupt_start, abrupt_end].map(|flag| if flag != 0 { Ramp::Abrupt } else { Ramp::Smooth });
    // Without the standing tick and the end: those come from SetupForMotionPause and SetupForMotionEnd.
    let states = profile::bare_move(from, to, ramps, &limits);
    write(caller.memory, axis, index(offset), &states);
    if !count.is_null() {
        caller.memory.store(count, states.len() as i32)?;
    }
    if starts != 0 {
        start(caller.memory, axis);
    }
    Ok(())
}

/// An index into a state list; out of range it writes nothing.
fn index(offset: i32) -> usize {
    usize::try_from(offset).unwrap_or(MAX_STATES)
}

pub(crate) fn setup_for_motion_pause(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    x: f64,
    chan: GuestAddr,
    offset: i32,
    time: f64,
) {
    if let Some(axis) = pointed(kernel, caller, "SetupForMotionPause", chan) {
        write(caller.memory, axis, index(offset), &[State::hold(x, time)]);
    }
}

pub(crate) fn setup_for_motion_end(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    chan: GuestAddr,
    offset: i32,
) {
    if let Some(axis) = pointed(kernel, caller, "SetupForMotionEnd", chan) {
        let before = index(offset).checked_sub(1).map(|before| state(caller.memory, axis, before));
        let end = before.map_or(0.0, |before| before.at(before.t).x);
        write(caller.memory, axis, index(offset), &[State::off(0.0, end)]);
    }
}

pub(crate) fn write_3ph(kernel: &mut Kernel, caller: &mut Caller<'_>, chan: GuestAddr, v: f32, angle: f64) {
    match axis_at(chan) {
        Some(axis) => {
            three_phase(caller.memory, axis, v);
            apply(kernel, caller.memory, axis, v, angle);
        }
        None => kernel.console.message("Error Invalid Chan Pointer Write3PH"),
    }
}

pub(crate) fn write_4ph(kernel: &mut Kernel, caller: &mut Caller<'_>, chan: GuestAddr, v: f32, angle: f64) {
    if let Some(axis) = pointed(kernel, caller, "Write4PH", chan) {
        four_phase(caller.memory, axis, v, angle);
        apply(kernel, caller.memory, axis, v, angle);
    }
}

/// A vector on the phases of a disabled axis turns its rotor; of an enabled one the servo is stronger.
fn apply(kernel: &mut Kernel, memory: &GuestMemory, axis: AxisId, v: f32, angle: f64) {
    if memory.axis(axis, Chan::ENABLE) == 0 {
        kernel.servo.still.interrupt();
        kernel.servo.plants[axis.index()].drive = Drive::Vector(f64::from(v), angle);
    }
}

pub(crate) fn do_resolver_input2(
    kernel: &mut Kernel,
    caller: &mut Caller<'_>,
    chan: GuestAddr,
    x: f32,
    y: f32,
) {
    if let Some(axis) = pointed(kernel, caller, "DoResolverInput2", chan) {
        turn_resolver(caller.memory, axis, (x, y));
    }
}

/// Adds the turn of a resolver since the last reading to the position.
pub(crate) fn turn_resolver(memory: &mut GuestMemory, axis: AxisId, (x, y): (f32, f32)) {
    let angle = libm::atan2f(y, x) + memory.axis(axis, Chan::THETA_CORRECTION);
    let mut turned = angle - memory.axis(axis, Chan::LAST_THETA);
    if turned > PI {
        turned -= TAU;
    } else if turned <= -PI {
        turned += TAU;
    }
    memory.set_axis(axis, Chan::LAST_THETA, angle);
    let position = memory.axis(axis, Chan::POSITION) + memory.get(RESOLVER_FACTOR) * f64::from(turned);
    memory.set_axis(axis, Chan::POSITION, position);
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::Desk;

    fn axis() -> AxisId {
        AxisId::new(0).expect("0 is an axis")
    }

    /// A step/direction axis as in the scenarios.
    fn desk() -> Desk {
        let mut desk = Desk::new();
        desk.memory.set_axis(axis(), Chan::OUTPUT_MODE, OutputMode::StepDir.get());
        desk.memory.set_axis(axis(), Chan::VEL, 40000.0);
        desk.memory.set_axis(axis(), Chan::ACCEL, 200_000.0);
        desk.memory.set_axis(axis(), Chan::JERK, 4e6);
        desk.call("EnableAxisDest", &[0, 0]);
        desk
    }

    /// Ticks until the motion is done.
    fn ticks(desk: &mut Desk) -> u64 {
        (1..1_000_000)
            .find(|_| {
                desk.run(1);
                desk.call_i32("CheckDone", &[0]) == 1
            })
            .expect("motion ends")
    }

    #[test]
    fn a_move_takes_its_time_and_arrives() {
        let mut desk = desk();
        desk.call("Move", &[0, 100_000.0_f64.to_bits()]);
        let taken = ticks(&mut desk) as f64 * TIMEBASE;
        assert!((taken - 2.75).abs() < 3e-4, "{taken}");
        assert_eq!(desk.memory.axis(axis(), Chan::DEST), 100_000.0);
        let position = desk.memory.axis(axis(), Chan::POSITION);
        assert!((position - 100_000.0).abs() <= 1.0, "{position}");
        desk.call("MoveRel", &[0, (-800.0_f64).to_bits()]);
        let taken = ticks(&mut desk) as f64 * TIMEBASE;
        assert!((taken - 0.185_66).abs() < 3e-4, "{taken}");
        assert_eq!(desk.memory.axis(axis(), Chan::DEST), 99_200.0);
    }

    #[test]
    fn disabling_freezes_the_destination() {
        let mut desk = desk();
        desk.call("Jog", &[0, 1000.0_f64.to_bits()]);
        desk.run(500);
        desk.call("DisableAxis", &[0]);
        let dest = desk.memory.axis(axis(), Chan::DEST);
        desk.run(10);
        assert_eq!(desk.memory.axis(axis(), Chan::DEST), dest);
        assert_eq!(desk.call_i32("CheckDone", &[0]), -1);
    }

    #[test]
    fn a_stop_from_a_jog_waits_for_the_next_slice() {
        let mut desk = desk();
        desk.call("Jog", &[0, 20000.0_f64.to_bits()]);
        desk.run(5000);
        assert_eq!(desk.call_i32("CheckDone", &[0]), 0);
        desk.call_in_slices("Jog", &[0, 0]);
        ticks(&mut desk);
        assert_eq!(desk.memory.axis(axis(), Chan::LAST_MOTION_TYPE), LastMotion::Jog.get());
    }

    #[test]
    fn zero_moves_nothing() {
        let mut desk = desk();
        desk.call("Move", &[0, 50.0_f64.to_bits()]);
        ticks(&mut desk);
        desk.run(5);
        desk.call("Zero", &[0]);
        for _ in 0..5 {
            desk.run(1);
            assert_eq!(desk.memory.axis(axis(), Chan::POSITION), 0.0);
            assert_eq!(desk.kernel.servo.plants[0].load, 50.0);
        }
    }
}
