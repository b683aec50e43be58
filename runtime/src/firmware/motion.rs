//! Single axes: enabling, independent moves. Source: axes-and-motion.md sections 3 to 6 and 12.

mod replaced;
pub(super) mod schedule;
mod structure;
mod together;

pub(crate) use schedule::PlanningStage;
pub(crate) use structure::{
    do_resolver_input2, setup_for_motion_end, setup_for_motion_pause, setup_for_move, stop_motion, write_3ph,
    write_4ph,
};
pub(crate) use together::move_xyzabc;

use kmotiondef::AxisId;
use kmotiondef::firmware::Function;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::modes::{InputMode, LastMotion, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::{COORD_SYSTEM0, CS0_STOPPING_STATE};
use vm::firmware::{Caller, Outcome};
use vm::memory::GuestMemory;

use super::calls::{CommandedMotion, Continuation};
use super::parts::Parts;
use super::{axis_check, costs, float_bits};
use crate::arithmetic::division::divide;
use crate::arithmetic::doubles::exp;
use crate::io::bits;
use crate::machine::wiring::generator;
use crate::out::Message;
use crate::servo::coordinated::system;
use crate::servo::independent::{has_motion, is_planned, present, run, start, state};
use crate::servo::moves::{Accelerations, Planner, limits_with, start_jog, start_move_to};
use crate::servo::planning;
use crate::servo::profile::{LEAD, Mode, MotionState};
use crate::servo::{hold, switching};
use crate::views::TypedAccess;
use chips::stepgen::GENERATORS;
use schedule::row_cost;

/// Returns whether a number is that after the last axis, which the board does not refuse: it takes what comes after the
/// axes in memory for one.
fn is_after_axes(caller: &Caller<'_>, axis: i32) -> bool {
    usize::try_from(axis) == Ok(caller.memory.axes().count())
}

/// Prints the board's message about an axis that does not exist.
fn print_invalid_axis(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: i32, what: &str) {
    parts.out.diagnose(caller, Message::NoSuchAxis { function, axis });
    if !is_after_axes(caller, axis) {
        parts.out.console.message(&format!("Attempt to {what} invalid Chan"));
    }
}

/// An axis that does not exist is enabled; that after the last ends the program.
fn enable_invalid(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: i32) -> Outcome<()> {
    print_invalid_axis(parts, caller, function, axis, "enable");
    if is_after_axes(caller, axis) { Outcome::End } else { Outcome::Done(()) }
}

/// Checks an axis number that a program names.
fn checked(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: i32) -> Option<AxisId> {
    let checked = caller.memory.axes().get(axis);
    if checked.is_none() {
        parts.out.diagnose(caller, Message::NoSuchAxis { function, axis });
    }
    checked
}

pub(crate) fn enable_axis(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32) -> Outcome<()> {
    axis_check::goes_on(parts, caller);
    let Some(axis) = caller.memory.axes().get(axis) else {
        return enable_invalid(parts, caller, Function::EnableAxis, axis);
    };
    let mode = OutputMode::new(caller.memory.axis(axis, Chan::OUTPUT_MODE));
    let keeps_dest = mode.is_some_and(|mode| mode.traits().keeps_dest);
    let field = if keeps_dest { Chan::DEST } else { Chan::POSITION };
    let dest = caller.memory.axis(axis, field);
    enable(parts, caller, Function::EnableAxis, axis, dest);
    Outcome::Done(())
}

/// An axis is enabled: the pins of its step output become outputs, and stay so when it is disabled. Tells which of them
/// the machine drives too.
fn take_pins(parts: &mut Parts, caller: &mut Caller<'_>, axis: AxisId) {
    let mode = OutputMode::new(caller.memory.axis(axis, Chan::OUTPUT_MODE));
    if !OutputMode::has_generator(mode) {
        return;
    }
    let channel = caller.memory.axis(axis, Chan::OUTPUT_CHAN0);
    let generator = generator(caller.memory, channel);
    if generator >= GENERATORS {
        return parts.out.diagnose(caller, Message::ChannelNotSimulated { axis, channel });
    }
    for bit in parts.io.stepgens.pins(generator).into_iter().flatten() {
        if parts.machine.mechanics.contact(bit).is_some() || parts.io.pins.is_declared(bit) {
            parts.out.diagnose(caller, Message::StepPins { axis, bit, channel });
        }
        bits::set_direction(&mut parts.io, caller.memory, bit, true, caller.now());
    }
    parts.lines(caller.now()).settle();
}

pub(crate) fn enable_axis_dest(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    dest: f64,
) -> Outcome<()> {
    axis_check::goes_on(parts, caller);
    let Some(axis) = caller.memory.axes().get(axis) else {
        return enable_invalid(parts, caller, Function::EnableAxisDest, axis);
    };
    enable(parts, caller, Function::EnableAxisDest, axis, dest);
    Outcome::Done(())
}

/// Puts an axis at a destination and turns it on.
fn enable(parts: &mut Parts, caller: &mut Caller<'_>, function: Function, axis: AxisId, dest: f64) {
    axis_check::ends_motion(parts, caller, function, axis);
    axis_check::enabled(parts, caller, function, axis, dest);
    switching::enable(&mut parts.servo, &mut parts.machine, caller.memory, axis, dest);
    take_pins(parts, caller, axis);
}

pub(crate) fn disable_axis(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32) {
    let Some(axis) = caller.memory.axes().get(axis) else {
        return print_invalid_axis(parts, caller, Function::DisableAxis, axis, "Disable");
    };
    axis_check::ends_path(parts, caller, Function::DisableAxis, axis);
    replaced::check_end(parts, caller, axis, Function::DisableAxis);
    axis_check::disables(parts, caller.memory, axis);
    switching::switch_off(&mut parts.servo, &mut parts.machine, caller.memory, axis);
    hold::abort_if_member(caller.memory, axis);
}

pub(crate) fn zero(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32) {
    axis_check::goes_on(parts, caller);
    let Some(axis) = caller.memory.axes().get(axis) else {
        return print_invalid_axis(parts, caller, Function::Zero, axis, Function::Zero.name());
    };
    axis_check::ends_motion(parts, caller, Function::Zero, axis);
    axis_check::check_zero(parts, caller, axis);
    switching::zero(&mut parts.servo, &mut parts.machine, caller.memory, axis);
    hold::abort_if_member(caller.memory, axis);
}

pub(crate) fn reset_filters(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32) {
    let Some(axis) = checked(parts, caller, Function::ResetFilters, axis) else { return };
    switching::reset_filters(&mut parts.servo, caller.memory, axis);
}

/// Returns whether a motion call may act on an axis now.
fn may_move(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, function: Function) -> bool {
    let memory = &*caller.memory;
    if memory.axis(axis, Chan::ENABLE) == 0 {
        parts.out.diagnose(caller, Message::AxisDisabled { function, axis });
        return false;
    }
    let is_member = system::is_member(memory, axis);
    if is_member && !memory.get(COORD_SYSTEM0).is_null() {
        // The motion begins, and shows when the path has ended.
        parts.out.diagnose(caller, Message::AxisOnPath { function, axis });
    }
    let may = !(is_member && memory.get(CS0_STOPPING_STATE) != 0);
    let drives_nothing = memory.axis(axis, Chan::OUTPUT_MODE) == OutputMode::None.get();
    if may && drives_nothing {
        // A program that plays the encoder moves nothing on purpose.
        let plays_encoder = memory.axis(axis, Chan::INPUT_MODE) == InputMode::User.get();
        if parts.machine.mechanics.has_contacts(axis) {
            parts.out.diagnose(caller, Message::AxisUndriven { function, axis });
        } else if !plays_encoder && caller.thread.is_some() {
            parts.out.diagnose(caller, Message::NoOutput { function, axis });
        }
    }
    check_slaves(parts, caller, axis, function);
    may
}

/// Reports axes that do not follow a motion of their master, or that are moved while it moves.
fn check_slaves(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, function: Function) {
    let memory = &*caller.memory;
    let master_of = |slave| memory.axes().get(memory.axis(slave, Chan::MASTER_AXIS)).filter(|&m| m != slave);
    for slave in memory.axes().iter().filter(|&slave| master_of(slave) == Some(axis)) {
        if memory.axis(slave, Chan::ENABLE) == 0 {
            parts.out.diagnose(caller, Message::SlaveDisabled { axis: slave, master: axis });
        } else if memory.axis(slave, Chan::SLAVE_GAIN) == 0.0 {
            parts.out.diagnose(caller, Message::NoSlaveGain { axis: slave, master: axis });
        } else if has_motion(memory, slave) {
            parts.out.diagnose(caller, Message::SlaveMoves { function, axis: slave, master: axis });
        }
    }
    if let Some(master) = master_of(axis).filter(|&master| has_motion(memory, master)) {
        parts.out.diagnose(caller, Message::SlaveMoves { function, axis, master });
    }
}

/// Returns whether an axis is beyond a soft limit and a call would move it further out: the board refuses that silently
/// (axes-and-motion.md section 7.3).
fn is_beyond(
    parts: &mut Parts,
    caller: &Caller<'_>,
    function: Function,
    axis: AxisId,
    direction: f64,
) -> bool {
    let dest = caller.memory.axis(axis, Chan::DEST);
    let (pos, neg) =
        (caller.memory.axis(axis, Chan::SOFT_LIMIT_POS), caller.memory.axis(axis, Chan::SOFT_LIMIT_NEG));
    let (name, limit) = if direction > 0.0 && dest > f64::from(pos) {
        ("SoftLimitPos", pos)
    } else if direction < 0.0 && dest < f64::from(neg) {
        ("SoftLimitNeg", neg)
    } else {
        return false;
    };
    if neg <= pos {
        parts.out.diagnose(caller, Message::BeyondSoftLimit { function, axis, dest, name, limit });
    }
    true
}

/// Tells a program that calls motions faster than the board plans them why the axis does not get on.
fn notice_hurry(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, function: Function) {
    /// That many in a row are not a coincidence; it is reported once.
    const CALLS: u8 = 50;
    let calls = &mut parts.calls.hurried_calls[axis.index()];
    if is_planned(caller.memory, axis) {
        *calls = calls.saturating_add(1);
    } else if *calls < CALLS {
        *calls = 0;
    }
    if *calls == CALLS {
        parts.out.diagnose(caller, Message::Hurried { function, axis, ms: 1e3 * LEAD, calls: CALLS });
    }
}

/// Returns whether a target or speed is a number; reports one that is not finite.
fn is_number(parts: &mut Parts, caller: &Caller<'_>, function: Function, value: f64) -> bool {
    if !value.is_finite() {
        let effect = if value.is_nan() {
            "the board makes Dest a NaN, which no motion leaves (here nothing moves)"
        } else {
            "the axis moves on without an end"
        };
        parts.out.diagnose(caller, Message::NotAPlace { function, value, effect });
    }
    !value.is_nan()
}

/// A place or speed that no axis reaches, in units or units per second: that of a motion without an end.
const FARTHEST: f64 = 1e12;

/// One of the moves.
struct MoveRequest {
    function: Function,
    axis: i32,
    target: f64,
    is_relative: bool,
    velocity: Option<f32>,
    /// Its own accelerations.
    own: Option<Accelerations>,
    /// True if the target is brought within the soft limits.
    is_soft: bool,
}

fn request(parts: &mut Parts, caller: &mut Caller<'_>, request: &MoveRequest) -> Outcome<()> {
    axis_check::goes_on(parts, caller);
    let function = request.function;
    let Some(axis) = checked(parts, caller, function, request.axis) else {
        return Outcome::Done(());
    };
    let (target, progress) = match (caller.woken, parts.calls.take(caller)) {
        (Some(_), Some(Continuation::Motion(target, progress))) => (target, progress),
        _ => (requested_target(caller.memory, axis, request), PlanningStage::Called),
    };
    let target = target.clamp(-FARTHEST, FARTHEST);
    if progress == PlanningStage::Called && !may_begin(parts, caller, request, axis, target) {
        return Outcome::Done(());
    }
    let Some((limits, decel)) = limits_with(caller.memory, axis, request.velocity, request.own) else {
        match request.velocity.filter(|speed| *speed <= 0.0) {
            Some(speed) => parts.out.diagnose(caller, Message::NoSpeed { function, axis, speed }),
            None => no_limits(parts, caller, axis, function),
        }
        return Outcome::Done(());
    };
    let is_direct = parts.servo.planner == Planner::Direct;
    let planning = |caller: &Caller<'_>| {
        if is_direct { costs::AFTER_MOVE } else { planning::of_move(caller.memory, axis, target, &limits) }
    };
    if let Some(pause) = schedule::plan(parts, caller, axis, progress, row_cost(function), planning) {
        parts.calls.store(caller, Continuation::Motion(target, pause.then));
        return Outcome::Wait(pause.wake);
    }
    notice_hurry(parts, caller, axis, function);
    let planner = parts.servo.planner;
    let is_full = start_move_to(caller.memory, axis, target, (&limits, decel), LastMotion::Move, planner);
    if is_full && is_direct {
        costs::spend(caller, costs::FULL_SPEED);
    }
    Outcome::Done(())
}

/// The target that a move names.
fn requested_target(memory: &GuestMemory, axis: AxisId, request: &MoveRequest) -> f64 {
    let target = request.target + if request.is_relative { memory.axis(axis, Chan::DEST) } else { 0.0 };
    if request.is_soft { within_soft_limits(memory, axis, target) } else { target }
}

/// Returns whether a move may begin; the cycles of a refusal are spent if not.
fn may_begin(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    request: &MoveRequest,
    axis: AxisId,
    target: f64,
) -> bool {
    let function = request.function;
    if !may_move(parts, caller, axis, function) {
        costs::spend_refusal(caller, function);
        return false;
    }
    let motion = match request.is_relative {
        true => CommandedMotion::MoveRel(request.target, target),
        false => CommandedMotion::Move(target),
    };
    replaced::check_begin(parts, caller, axis, function, motion);
    let is_bits = float_bits::check(parts, caller, function, request.target);
    let way = target - caller.memory.axis(axis, Chan::DEST);
    axis_check::check_move(parts, caller, function, axis);
    if !request.is_relative {
        axis_check::check_shifted_move(parts, caller, function, axis);
    }
    if request.target.is_finite() {
        axis_check::check_small_move(parts, caller, function, axis, way.abs());
        if !is_bits {
            axis_check::check_plan(parts, caller, function, axis, way.abs());
        }
        axis_check::target_beyond(parts, caller, function, axis, target);
    }
    // A destination that is not a number makes a relative target another one.
    if !is_number(parts, caller, function, request.target) || is_beyond(parts, caller, function, axis, way) {
        costs::spend_refusal(caller, function);
        return false;
    }
    true
}

fn no_limits(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, function: Function) {
    parts.out.diagnose(caller, Message::NoLimits { function, axis });
}

pub(crate) fn move_to(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32, x: f64) -> Outcome<()> {
    request(
        parts,
        caller,
        &MoveRequest {
            function: Function::Move,
            axis,
            target: x,
            is_relative: false,
            velocity: None,
            own: None,
            is_soft: false,
        },
    )
}

pub(crate) fn move_rel(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32, dx: f64) -> Outcome<()> {
    request(
        parts,
        caller,
        &MoveRequest {
            function: Function::MoveRel,
            axis,
            target: dx,
            is_relative: true,
            velocity: None,
            own: None,
            is_soft: false,
        },
    )
}

pub(crate) fn move_at_vel(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    x: f64,
    velocity: f32,
) -> Outcome<()> {
    let velocity = Some(velocity);
    request(
        parts,
        caller,
        &MoveRequest {
            function: Function::MoveAtVel,
            axis,
            target: x,
            is_relative: false,
            velocity,
            own: None,
            is_soft: false,
        },
    )
}

pub(crate) fn move_rel_at_vel(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    dx: f64,
    velocity: f32,
) -> Outcome<()> {
    let velocity = Some(velocity);
    request(
        parts,
        caller,
        &MoveRequest {
            function: Function::MoveRelAtVel,
            axis,
            target: dx,
            is_relative: true,
            velocity,
            own: None,
            is_soft: false,
        },
    )
}

/// A target brought within the soft limits of an axis.
fn within_soft_limits(memory: &GuestMemory, axis: AxisId, target: f64) -> f64 {
    let limit = |field| f64::from(memory.axis(axis, field));
    target.min(limit(Chan::SOFT_LIMIT_POS)).max(limit(Chan::SOFT_LIMIT_NEG))
}

/// A move to a place with its own accelerations.
fn accelerated(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    (axis, target): (i32, f64),
    velocity: f32,
    own: Accelerations,
) -> Outcome<()> {
    let velocity = Some(velocity);
    let (function, own) = (Function::MoveAtVel, Some(own));
    request(
        parts,
        caller,
        &MoveRequest { function, axis, target, is_relative: false, velocity, own, is_soft: false },
    )
}

pub(crate) fn move_at_vel_accel(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    x: f64,
    velocity: f32,
    accel: f32,
) -> Outcome<()> {
    accelerated(parts, caller, (axis, x), velocity, Accelerations { accel, decel: accel })
}

pub(crate) fn move_at_vel_accel_decel(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    x: f64,
    velocity: f32,
    accel: f32,
    decel: f32,
) -> Outcome<()> {
    accelerated(parts, caller, (axis, x), velocity, Accelerations { accel, decel })
}

pub(crate) fn move_rel_at_vel_accel(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    dx: f64,
    velocity: f32,
    accel: f32,
) -> Outcome<()> {
    let (function, own) = (Function::MoveRelAtVel, Some(Accelerations { accel, decel: accel }));
    let velocity = Some(velocity);
    request(
        parts,
        caller,
        &MoveRequest { function, axis, target: dx, is_relative: true, velocity, own, is_soft: false },
    )
}

pub(crate) fn move_rel_at_vel_accel_decel_soft(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    dx: f64,
    velocity: f32,
    accel: f32,
    decel: f32,
) -> Outcome<()> {
    let (function, own) = (Function::MoveRelAtVel, Some(Accelerations { accel, decel }));
    let velocity = Some(velocity);
    request(
        parts,
        caller,
        &MoveRequest { function, axis, target: dx, is_relative: true, velocity, own, is_soft: true },
    )
}

pub(crate) fn jog(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32, velocity: f64) -> Outcome<()> {
    begin_jog(parts, caller, axis, velocity, None)
}

pub(crate) fn jog_at_accel(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    velocity: f64,
    accel: f64,
) -> Outcome<()> {
    begin_jog(parts, caller, axis, velocity, Some(accel as f32))
}

/// A jog, with its own acceleration if it has one.
fn begin_jog(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    velocity: f64,
    accel: Option<f32>,
) -> Outcome<()> {
    axis_check::goes_on(parts, caller);
    let Some(axis) = checked(parts, caller, Function::Jog, axis) else { return Outcome::Done(()) };
    let is_enabled = caller.memory.axis(axis, Chan::ENABLE) != 0;
    // To stop an axis that is disabled is no mistake.
    if !is_enabled && velocity == 0.0 {
        costs::spend_refusal(caller, Function::Jog);
        return Outcome::Done(());
    }
    // Odd and kept: to stop an axis of the coordinate system gives up a feedhold, and the path that it holds.
    let is_held = caller.memory.get(CS0_STOPPING_STATE) != 0;
    if velocity == 0.0 && is_held && system::is_member(caller.memory, axis) {
        hold::clear(&mut parts.servo, caller.memory);
        caller.memory.set_axis(axis, Chan::LAST_NON_ZERO_DIR, 0);
        caller.memory.set_axis(axis, Chan::DIRECTION_OF_MOTION, 0);
    }
    if !may_move(parts, caller, axis, Function::Jog) || !is_number(parts, caller, Function::Jog, velocity) {
        costs::spend_refusal(caller, Function::Jog);
        return Outcome::Done(());
    }
    let velocity = velocity.clamp(-FARTHEST, FARTHEST);
    let progress = match (caller.woken, parts.calls.take(caller)) {
        (Some(_), Some(Continuation::Motion(_, progress))) => progress,
        _ => PlanningStage::Called,
    };
    if progress == PlanningStage::Called {
        axis_check::jogs(parts, caller, axis, velocity);
        _ = float_bits::check(parts, caller, Function::Jog, velocity);
        if is_beyond(parts, caller, Function::Jog, axis, velocity) {
            costs::spend_refusal(caller, Function::Jog);
            return Outcome::Done(());
        }
        // At rest there is nothing to stop. What counts is whether a motion is executed, not its speed.
        if velocity == 0.0 && !has_motion(caller.memory, axis) {
            costs::spend(caller, costs::NOTHING_TO_STOP - row_cost(Function::Jog));
            return Outcome::Done(());
        }
        if velocity == 0.0 {
            replaced::check_end(parts, caller, axis, Function::Jog);
        } else {
            replaced::check_begin(parts, caller, axis, Function::Jog, CommandedMotion::Jog(velocity));
            axis_check::check_move(parts, caller, Function::Jog, axis);
        }
    }
    // Any speed will do: only acceleration and jerk limit a jog.
    let own = accel.map(|accel| Accelerations { accel, decel: accel });
    let Some((limits, _)) = limits_with(caller.memory, axis, Some(1.0), own) else {
        no_limits(parts, caller, axis, Function::Jog);
        return Outcome::Done(());
    };
    let is_direct = parts.servo.planner == Planner::Direct;
    let planning = |caller: &Caller<'_>| {
        if is_direct { costs::AFTER_JOG } else { planning::of_jog(caller.memory, axis, velocity, &limits) }
    };
    let charged = row_cost(Function::Jog);
    if let Some(pause) = schedule::plan(parts, caller, axis, progress, charged, planning) {
        parts.calls.store(caller, Continuation::Motion(velocity, pause.then));
        return Outcome::Wait(pause.wake);
    }
    let point = present(caller.memory, axis);
    if point.v != velocity {
        notice_hurry(parts, caller, axis, Function::Jog);
    }
    start_jog(caller.memory, axis, velocity, &limits, parts.servo.planner);
    Outcome::Done(())
}

pub(crate) fn move_exp(
    parts: &mut Parts,
    caller: &mut Caller<'_>,
    axis: i32,
    x: f64,
    tau: f64,
) -> Outcome<()> {
    if tau <= 0.0 || tau.is_nan() {
        return move_to(parts, caller, axis, x);
    }
    let Some(axis) = checked(parts, caller, Function::MoveExp, axis) else { return Outcome::Done(()) };
    if !may_move(parts, caller, axis, Function::MoveExp) || !is_number(parts, caller, Function::MoveExp, x) {
        return Outcome::Done(());
    }
    let x = x.clamp(-FARTHEST, FARTHEST);
    if caller.woken.is_none() {
        axis_check::check_move(parts, caller, Function::MoveExp, axis);
        axis_check::check_approach(parts, caller, Function::MoveExp, axis, tau);
    }
    let progress = if caller.woken.is_some() { PlanningStage::Due } else { PlanningStage::Called };
    let is_direct = parts.servo.planner == Planner::Direct;
    let planning = |_: &Caller<'_>| match progress {
        PlanningStage::Called => row_cost(Function::MoveExp),
        PlanningStage::Due | PlanningStage::Planned => {
            if is_direct {
                0
            } else {
                costs::AFTER_EXP
            }
        }
    };
    let charged = row_cost(Function::MoveExp);
    if let Some(pause) = schedule::plan(parts, caller, axis, progress, charged, planning) {
        return Outcome::Wait(pause.wake);
    }
    let memory = &mut *caller.memory;
    let accel = f64::from(memory.axis(axis, Chan::ACCEL));
    let vc = (accel * tau) as f32;
    memory.set_axis(axis, Chan::EXP_MOTION_VC, vc);
    memory.set_axis(axis, Chan::EXP_MOTION_XC, (f64::from(vc) * tau) as f32);
    // Only mode, ratio and target of the first state are written; the rest keeps what stood there.
    let first = MotionState {
        mode: Mode::Exponential,
        a: exp(divide(-TIMEBASE, tau)),
        b: x,
        ..state(memory, axis, 0)
    };
    // It has no time: that of a motion before stays.
    let t = memory.axis(axis, Chan::T);
    if !has_motion(memory, axis) {
        memory.set_axis(axis, Chan::LAST_VEL, 0.0);
    }
    run(memory, axis, &[first]);
    memory.set_axis(axis, Chan::T, t);
    memory.set_axis(axis, Chan::LAST_MOTION_TYPE, LastMotion::Exp.get());
    memory.set_axis(axis, Chan::LAST_MOTION_DEST, x);
    Outcome::Done(())
}

/// −1 disabled, 1 done, 0 moving.
fn done(memory: &GuestMemory, axis: AxisId) -> i32 {
    if memory.axis(axis, Chan::ENABLE) == 0 { -1 } else { i32::from(!has_motion(memory, axis)) }
}

pub(crate) fn check_done(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32) -> i32 {
    let Some(axis) = checked(parts, caller, Function::CheckDone, axis) else { return -1 };
    let memory = &*caller.memory;
    let done = done(memory, axis);
    let is_moving = |axis| has_motion(memory, axis) && memory.axis(axis, Chan::ENABLE) != 0;
    if let Some(thread) = caller.thread {
        let has_waited = parts.calls.motions.waits_for(thread, axis);
        parts.calls.motions.record_poll(thread, axis, done, caller.at, is_moving);
        parts.calls.notices.record_poll(thread, axis);
        if done == 1 && has_waited {
            axis_check::check_arrival(parts, caller, axis);
        }
        if done == 0 || has_waited {
            axis_check::speed_changed(parts, caller, axis);
        }
    }
    done
}

pub(crate) fn check_done_xyzabc(parts: &mut Parts, caller: &mut Caller<'_>) -> i32 {
    // Recorded: a feedhold is not done, not even when its axes have stopped or one of them is disabled.
    let is_held = caller.memory.get(CS0_STOPPING_STATE) != 0;
    let members: Vec<_> = system::members(caller.memory).map(|axis| done(caller.memory, axis)).collect();
    let done = if is_held { 0 } else { members.iter().copied().min().unwrap_or(1) };
    costs::spend_axes(caller, members.len(), costs::CHECK_DONE);
    if members.contains(&-1) {
        costs::spend(caller, costs::CHECK_DONE_DISABLED);
    }
    if let Some(thread) = caller.thread {
        parts.calls.motions.asked_path(thread, done, caller.at);
    }
    done
}

pub(crate) fn start_move(parts: &mut Parts, caller: &mut Caller<'_>, axis: i32) {
    if let Some(axis) = checked(parts, caller, Function::StartMove, axis) {
        start(caller.memory, axis);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::testing::TestBench;

    fn axis() -> AxisId {
        AxisId::new(0).expect("0 is an axis")
    }

    /// A step/direction axis as in the scenarios.
    fn bench() -> TestBench {
        let mut bench = TestBench::new();
        bench.memory.set_axis(axis(), Chan::OUTPUT_MODE, OutputMode::StepDir.get());
        bench.memory.set_axis(axis(), Chan::VEL, 40000.0);
        bench.memory.set_axis(axis(), Chan::ACCEL, 200_000.0);
        bench.memory.set_axis(axis(), Chan::JERK, 4e6);
        bench.call("EnableAxisDest", &[0, 0]);
        bench
    }

    /// Ticks until the motion is done.
    fn ticks(bench: &mut TestBench) -> u64 {
        (1..1_000_000)
            .find(|_| {
                bench.run(1);
                bench.call_i32("CheckDone", &[0]) == 1
            })
            .expect("motion ends")
    }

    #[test]
    fn a_move_takes_the_expected_time_and_arrives() {
        let mut bench = bench();
        bench.call("Move", &[0, 100_000.0_f64.to_bits()]);
        let taken = ticks(&mut bench) as f64 * TIMEBASE;
        assert!((taken - 2.75).abs() < 3e-4, "{taken}");
        assert_eq!(bench.memory.axis(axis(), Chan::DEST), 100_000.0);
        let position = bench.memory.axis(axis(), Chan::POSITION);
        assert!((position - 100_000.0).abs() <= 1.0, "{position}");
        bench.call("MoveRel", &[0, (-800.0_f64).to_bits()]);
        let taken = ticks(&mut bench) as f64 * TIMEBASE;
        assert!((taken - 0.185_66).abs() < 3e-4, "{taken}");
        assert_eq!(bench.memory.axis(axis(), Chan::DEST), 99_200.0);
    }

    #[test]
    fn disabling_freezes_the_destination() {
        let mut bench = bench();
        bench.call("Jog", &[0, 1000.0_f64.to_bits()]);
        bench.run(500);
        bench.call("DisableAxis", &[0]);
        let dest = bench.memory.axis(axis(), Chan::DEST);
        bench.run(10);
        assert_eq!(bench.memory.axis(axis(), Chan::DEST), dest);
        assert_eq!(bench.call_i32("CheckDone", &[0]), -1);
    }

    #[test]
    fn a_stop_from_a_jog_waits_for_the_next_slice() {
        let mut bench = bench();
        bench.call("Jog", &[0, 20000.0_f64.to_bits()]);
        bench.run(5000);
        assert_eq!(bench.call_i32("CheckDone", &[0]), 0);
        bench.call_in_slices("Jog", &[0, 0]);
        ticks(&mut bench);
        assert_eq!(bench.memory.axis(axis(), Chan::LAST_MOTION_TYPE), LastMotion::Jog.get());
    }

    #[test]
    fn zero_moves_nothing() {
        let mut bench = bench();
        bench.call("Move", &[0, 50.0_f64.to_bits()]);
        ticks(&mut bench);
        bench.run(5);
        bench.call("Zero", &[0]);
        for _ in 0..5 {
            bench.run(1);
            assert_eq!(bench.memory.axis(axis(), Chan::POSITION), 0.0);
            assert_eq!(bench.kernel.parts.machine.loads[axis()].load, 50.0);
        }
    }
}
