//! Checks of the settings of an axis when a program enables or moves it: what is wired wrong, and what keeps it from
//! moving.
//!
//! The board accepts all of it silently. Each check is one remark, with the call that made it come to light.

mod enabling;

use kmotiondef::firmware::Function;
use kmotiondef::modes::{BacklashMode, InputMode, LastMotion, OutputMode};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::COORD_SYSTEM0;
use kmotiondef::{AxisId, Bit, Cycles, Field};
use vm::firmware::Caller;
use vm::memory::GuestMemory;

use enabling::{limit_active, loop_input};

use super::calls::{EndedWait, JogRecord, Overlap, PositionShift, SmallMove};
use super::parts::Parts;
use crate::machine::UnitMismatch;
use crate::machine::description::Condition;
use crate::out::{Message, OtherPlace, Speaker};
use crate::servo::CallPlace;
use crate::servo::coordinated::system::is_member;
use crate::servo::independent::{has_motion, is_exponential};
use crate::servo::limits::{WatchedLimit, unwatched_limits, watched_limits};
use crate::views::{TypedAccess, chan};

/// A program enables an axis at a destination.
pub(crate) fn enabled(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId, dest: f64) {
    let messages = enabling::messages(parts, caller.memory, function, axis, dest);
    for message in messages {
        parts.out.diagnose(caller, message);
    }
    let motions = &mut parts.calls.motions;
    motions.enabled(axis, connection(caller.memory, axis));
    if loop_input(caller.memory, axis).is_none() {
        motions.goes_on_from(axis, dest, caller.thread, caller.at);
    }
}

/// A program disables an axis, perhaps in the middle of a move.
pub(crate) fn disables(parts: &mut Parts, memory: &GuestMemory, axis: AxisId) {
    let is_move = memory.axis(axis, Chan::LAST_MOTION_TYPE) == LastMotion::Move.get();
    if memory.axis(axis, Chan::ENABLE) != 0 && is_move && has_motion(memory, axis) {
        parts.calls.motions.record_disabled(axis, memory.axis(axis, Chan::DEST));
    }
}

/// A move to a place, after the zero of the axis has shifted.
pub(crate) fn check_shifted_move(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId) {
    if let Some(PositionShift { from, to, thread, at }) = parts.calls.motions.take_shift(axis) {
        let other = OtherPlace { thread, at };
        parts
            .out
            .diagnose(caller, Message::ZeroShifted { function, axis, from, to, shift: from - to, other });
    }
}

/// Mode and channels of an axis, by name: what should not change while it is enabled.
const CONNECTION: [(&str, Field<i32>); 4] = [
    ("OutputMode", Chan::OUTPUT_MODE),
    ("OutputChan0", Chan::OUTPUT_CHAN0),
    ("InputMode", Chan::INPUT_MODE),
    ("InputChan0", Chan::INPUT_CHAN0),
];

fn connection(memory: &GuestMemory, axis: AxisId) -> [i32; CONNECTION.len()] {
    CONNECTION.map(|(_, field)| memory.axis(axis, field))
}

/// A limit switch that only another axis trips.
fn limit_of_other(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let mechanics = &parts.machine.mechanics;
    let is_others = |limit: &WatchedLimit| {
        mechanics.contact(limit.bit).is_some() && !mechanics.owners(limit.bit).any(|owner| owner == axis)
    };
    let WatchedLimit { end, bit, .. } = watched_limits(memory, axis).into_iter().find(is_others)?;
    let other = mechanics.owners(bit).next()?;
    Some(Message::LimitOfOther { function, axis, end, bit, other })
}

/// A unit of the machine file in which the axis cannot be moved: it would cross its travel within a second.
fn units_differ(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let UnitMismatch { units, place, field, unit, travel } = parts.machine.notes.other_units(memory, axis)?;
    let speed = f64::from(memory.axis(axis, Chan::VEL));
    let travel = travel.filter(|travel| speed > *travel)?;
    Some(Message::UnitsDiffer { function, axis, units, place, speed, unit, travel, field })
}

/// A limit switch that the machine has at the other end.
fn limit_at_other_end(
    parts: &Parts,
    memory: &GuestMemory,
    function: Function,
    axis: AxisId,
) -> Option<Message> {
    let limits = watched_limits(memory, axis);
    if limits.windows(2).any(|pair| pair[0].bit == pair[1].bit) {
        return None;
    }
    limits.into_iter().find_map(|WatchedLimit { end, bit, is_upper, .. }| {
        let contacts = parts.machine.mechanics.contacts(bit).filter(|(owner, ..)| *owner == axis);
        let places: Vec<_> = contacts.filter_map(|(_, place, _)| place).collect();
        let is_wrong = |place: &Condition| match place {
            Condition::AtMost(_) => is_upper,
            Condition::AtLeast(_) => !is_upper,
            Condition::Between(..) => false,
        };
        let place = places.first().filter(|_| places.iter().all(is_wrong))?.to_string();
        Some(Message::LimitAtOtherEnd { function, axis, end, bit, place })
    })
}

/// A thread hears that the motion of an axis has ended for which it has waited.
pub(crate) fn check_arrival(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId) {
    const FAR: f64 = 100.0;
    let memory = &*caller.memory;
    let (dest, position) = (memory.axis(axis, Chan::DEST), memory.axis(axis, Chan::POSITION));
    let rest = (dest - position).abs();
    let is_far = rest > FAR && rest > parts.calls.motions.last_distance(axis) / 2.0;
    let settles = parts.servo.axes[axis.index()].is_settling(rest);
    if is_far && !settles && loop_input(memory, axis).is_some() {
        let advice = advice(memory, axis, rest);
        parts.out.diagnose(caller, Message::NotThere { axis, position, dest, advice });
    }
}

/// The first thing to look at where a motor stays away from Dest by `rest`.
fn advice(memory: &GuestMemory, axis: AxisId, rest: f64) -> String {
    let band = memory.axis(axis, Chan::DEAD_BAND_RANGE);
    if memory.axis(axis, Chan::DEAD_BAND_GAIN) < 1.0 && f64::from(band) >= rest {
        return format!("its dead band, DeadBandRange = {band}, covers the rest");
    }
    "check P, OutputMode and the wiring".to_owned()
}

/// A thread begins a jog, or ends one: whether a switch of the axis was as the thread waited for before it has moved.
pub(crate) fn jogs(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, speed: f64) {
    const MOVED: f64 = 1.0;
    parts.calls.motions.is_found(axis);
    let Some(thread) = caller.thread else { return };
    let dest = caller.memory.axis(axis, Chan::DEST);
    let wait = parts.calls.waits.wait_of(thread);
    let is_at_switch = |bit| parts.machine.mechanics.owners(bit).any(|owner| owner == axis);
    if speed == 0.0 && wait.last_bit.is_some_and(is_at_switch) {
        parts.calls.motions.record_homing(thread, axis);
    }
    let wait = parts.calls.waits.wait_of(thread);
    let (looked, last_bit, has_repeated) = (wait.looked, wait.last_bit, wait.has_repeated);
    let now = (speed != 0.0).then_some(JogRecord { thread, dest, speed, last_poll: looked });
    let to = speed;
    let is_over = |before: &JogRecord| speed == 0.0 || before.speed * speed < 0.0;
    let before =
        parts.calls.motions.jogs(axis, now).filter(|before| is_over(before) && before.thread == thread);
    if let Some(message) = before
        .filter(|_| speed == 0.0 && parts.calls.waits.wait_of(thread).has_read)
        .and(last_bit)
        .and_then(|bit| watches_other(parts, caller.memory, axis, bit))
    {
        parts.out.diagnose(caller, message);
    }
    let Some(JogRecord { speed, .. }) = before
        .filter(|before| (dest - before.dest).abs() < MOVED && looked > before.last_poll && !has_repeated)
    else {
        return;
    };
    let of_axis = |bit: &Bit| parts.machine.mechanics.contact(*bit).is_some_and(|(owner, ..)| owner == axis);
    if let Some(bit) = last_bit.filter(of_axis) {
        let switch = described_switch(parts, axis, bit, to == 0.0);
        parts.out.diagnose(caller, Message::JogEnded { axis, to, speed, bit, switch });
    }
}

/// The switch of an axis as the machine file has it, and the place of the axis.
fn described_switch(parts: &Parts, axis: AxisId, bit: Bit, is_stopped: bool) -> String {
    let Some((_, Some(place), active)) = parts.machine.mechanics.contact(bit) else {
        return "is the switch inverted?".to_owned();
    };
    let source = parts.machine.notes.contact(bit).unwrap_or_default();
    let (active, load) = (u8::from(active), parts.machine.table(axis));
    // A program that goes back off its switch has only not searched for it.
    let question = match is_stopped {
        true => "is the switch inverted, or at the other end?",
        false => "an axis begins at `start` in the machine file, 0 without it",
    };
    format!("its switch is {active} {place} ({source}), and the axis is at {load:.0} ({question})")
}

/// A switch that only axes can press which rest, watched while another axis moves: one that has switches of its own, or
/// the only one of them that is in use.
fn watches_other(parts: &Parts, memory: &GuestMemory, axis: AxisId, bit: Bit) -> Option<Message> {
    let mechanics = &parts.machine.mechanics;
    let is_unused =
        |owner| memory.axis(owner, Chan::ENABLE) == 0 && memory.axis(owner, Chan::OUTPUT_MODE) == 0;
    let other = mechanics.owners(bit).next()?;
    if !mechanics.has_contacts(axis) && !is_unused(other) {
        return None;
    }
    let rests = |owner: AxisId| {
        let is_slave = memory.axis(owner, Chan::MASTER_AXIS) == i32::from(axis.get());
        owner != axis && !is_slave && !has_motion(memory, owner)
    };
    mechanics.owners(bit).all(rests).then_some(Message::WatchesOther { axis, bit, other })
}

/// A thread zeroes an axis: whether it is the one that it has moved to its switch.
pub(crate) fn check_zero(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId) {
    const MOVED: f64 = 1.0;
    parts.calls.motions.is_found(axis);
    let Some(thread) = caller.thread else { return };
    let is_away = |homed: AxisId| caller.memory.axis(homed, Chan::DEST).abs() > MOVED;
    parts.calls.motions.record_zero(thread, axis, caller.at, is_away);
}

/// An approach that takes minutes.
pub(crate) fn check_approach(
    parts: &mut Parts,
    caller: &Caller<'_>,
    function: Function,
    axis: AxisId,
    tau: f64,
) {
    const LONG: f64 = 10.0;
    if tau >= LONG {
        parts.out.diagnose(caller, Message::LongTau { function, axis, tau });
    }
}

/// A mode or channel that has changed since the axis was enabled.
fn changed_connection(
    parts: &Parts,
    memory: &GuestMemory,
    function: Function,
    axis: AxisId,
) -> Option<Message> {
    let before = parts.calls.motions.connection(axis)?;
    let changed = before.iter().zip(connection(memory, axis)).position(|(before, now)| *before != now)?;
    Some(Message::SetWhileEnabled { function, axis, field: CONNECTION[changed].0 })
}

/// An analog output that the limit of the axis does not keep in its range.
fn output_wraps(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    const RANGE: f64 = 2048.0;
    let get = |field: Field<f32>| f64::from(memory.axis(axis, field)).abs();
    let is_dac = memory.axis(axis, Chan::OUTPUT_MODE) == OutputMode::DacServo.get();
    let most = get(Chan::MAX_OUTPUT) * get(Chan::OUTPUT_GAIN) + get(Chan::OUTPUT_OFFSET);
    (is_dac && most > RANGE).then_some(Message::OutputWraps { function, axis, most })
}

/// Motions to a place whose distance is known.
const MOVES: &[Function] = &[Function::Move, Function::MoveRel, Function::MoveAtVel, Function::MoveRelAtVel];

/// A program moves an enabled axis.
pub(crate) fn check_move(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId) {
    parts.servo.commands[axis.index()] = Some(CallPlace { thread: caller.thread, at: caller.at });
    let memory = &*caller.memory;
    let messages = [
        swapped_limits(memory, function, axis),
        no_gain(memory, function, axis),
        no_backlash_rate(memory, function, axis),
        backlash_off(memory, function, axis),
        changed_connection(parts, memory, function, axis),
        output_wraps(memory, function, axis),
        limit_at_other_end(parts, memory, function, axis),
        limit_of_other(parts, memory, function, axis),
        units_differ(parts, memory, function, axis),
        limit_active(parts, memory, function, axis),
    ];
    for message in messages.into_iter().flatten() {
        parts.out.diagnose(caller, message);
    }
    if !MOVES.contains(&function) {
        parts.calls.motions.goes_on(axis);
    }
    let Some(thread) = caller.thread else { return };
    let is_on_its_way = |axis| is_on_its_way(memory, axis);
    let overlap = Overlap { thread, function, axis, moving: axis, at: caller.at };
    parts.calls.motions.overlaps(overlap, is_on_its_way);
    let before = parts.calls.motions.record_mover(thread, axis);
    if function == Function::MoveXYZABC {
        parts.calls.motions.moves_together(thread, axis);
    }
    if let Some(other) = before.filter(|_| has_motion(caller.memory, axis)) {
        parts.out.diagnose(caller, Message::OtherThreadMoves { function, axis, other });
    }
}

/// Returns whether an axis moves to a place.
fn is_on_its_way(memory: &GuestMemory, axis: AxisId) -> bool {
    let last = memory.axis(axis, Chan::LAST_MOTION_TYPE);
    let has_place = last == LastMotion::Move.get() || last == LastMotion::Multi.get();
    has_place && has_motion(memory, axis) && memory.axis(axis, Chan::ENABLE) != 0
}

/// A thread switches an output: whether it has waited for one axis of a MoveXYZABC that still moves others.
pub(crate) fn switches(parts: &mut Parts, caller: &Caller<'_>, function: Function, switched: Bit) {
    let Some(thread) = caller.thread else { return };
    let part = parts.calls.motions.part_left(thread, |axis| is_on_its_way(caller.memory, axis));
    if let Some((asked, moving)) = part {
        parts.out.diagnose(caller, Message::WaitsForPart { function, switched, asked, moving });
    }
}

/// A thread continues after a wait: whether it has taken the end of the axis for that of its motion.
pub(crate) fn goes_on(parts: &mut Parts, caller: &Caller<'_>) {
    let ended = caller.thread.and_then(|thread| parts.calls.motions.take_ended(thread));
    if let Some(EndedWait { thread, axis, at }) = ended {
        let message =
            axis.map_or(Message::PathEndedWhileWaiting {}, |axis| Message::DisabledWhileWaiting { axis });
        parts.out.remark_of(caller.now(), Speaker::Thread(thread), at, message);
    }
}

/// A target beyond a soft limit, which only stops the axis on its way.
pub(crate) fn target_beyond(
    parts: &mut Parts,
    caller: &Caller<'_>,
    function: Function,
    axis: AxisId,
    target: f64,
) {
    let get = |field: Field<f32>| caller.memory.axis(axis, field);
    let (neg, pos) = (get(Chan::SOFT_LIMIT_NEG), get(Chan::SOFT_LIMIT_POS));
    let dest = caller.memory.axis(axis, Chan::DEST);
    let (name, limit, is_inside) = if target > f64::from(pos) {
        ("SoftLimitPos", pos, dest <= f64::from(pos))
    } else if target < f64::from(neg) {
        ("SoftLimitNeg", neg, dest >= f64::from(neg))
    } else {
        return;
    };
    if is_inside && neg <= pos {
        parts.out.diagnose(caller, Message::TargetBeyond { function, axis, target, name, limit });
    }
}

/// A thread looks at a move: whether Vel was changed on the way, as if it applied to it.
pub(crate) fn speed_changed(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId) {
    let (from, to) = (parts.calls.motions.speed(axis), caller.memory.axis(axis, Chan::VEL));
    let is_move = caller.memory.axis(axis, Chan::LAST_MOTION_TYPE) == LastMotion::Move.get();
    if is_move && from > 0.0 && from != to {
        parts.out.diagnose(caller, Message::SpeedChanged { axis, from, to });
    }
}

/// A move of a few counts of an axis that counts in them.
pub(crate) fn check_small_move(
    parts: &mut Parts,
    caller: &Caller<'_>,
    function: Function,
    axis: AxisId,
    way: f64,
) {
    const FEW: f64 = 10.0;
    let is_unit = |field: Field<f32>| f64::from(caller.memory.axis(axis, field)).abs() == 1.0;
    let is_plain = is_unit(Chan::OUTPUT_GAIN) && is_unit(Chan::INPUT_GAIN0);
    let is_tiny = is_plain && way < FEW && way != libm::floor(way);
    let small =
        caller.thread.filter(|_| is_tiny).map(|thread| SmallMove { thread, at: caller.at, function, way });
    parts.calls.motions.record_move_length(axis, way, small);
    let has_own_speed = matches!(function, Function::MoveAtVel | Function::MoveRelAtVel);
    let speed = if has_own_speed { 0.0 } else { caller.memory.axis(axis, Chan::VEL) };
    parts.calls.motions.begins_at(axis, speed);
}

/// A motion that takes minutes, most of them for its acceleration, or several seconds because of one limit.
pub(crate) fn check_plan(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId, way: f64) {
    const LONG: f64 = 60.0;
    /// A time that is long for a move which the other limits let end in an eighth of it.
    const SLOW: f64 = 4.0;
    const ENDLESS: f64 = 600.0;
    let get = |field: Field<f32>| f64::from(caller.memory.axis(axis, field));
    let (velocity, accel, jerk) = (get(Chan::VEL), get(Chan::ACCEL), get(Chan::JERK));
    if !(velocity > 0.0 && accel > 0.0 && jerk > 0.0) {
        return;
    }
    // The shortest time of the way with each limit alone.
    let cruise = way / velocity;
    let by_accel = 2.0 * libm::sqrt(way / accel);
    let by_jerk = libm::cbrt(32.0 * way / jerk);
    let (seconds, field) = if by_accel > by_jerk { (by_accel, "Accel") } else { (by_jerk, "Jerk") };
    if cruise > ENDLESS {
        let message = Message::SlowRamp { function, axis, seconds: cruise, field: "Vel", value: velocity };
        return parts.out.diagnose(caller, message);
    }
    let others = cruise.max(by_accel.min(by_jerk));
    if (seconds > LONG && seconds > 3.0 * cruise) || (seconds > SLOW && seconds > 8.0 * others) {
        let value = if field == "Accel" { accel } else { jerk };
        parts.out.diagnose(caller, Message::SlowRamp { function, axis, seconds, field, value });
    }
}

/// A call that ends the motion of an axis: whether it still moves.
pub(crate) fn ends_motion(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId) {
    let memory = &*caller.memory;
    if caller.thread.is_none() || memory.axis(axis, Chan::ENABLE) == 0 || !has_motion(memory, axis) {
        return;
    }
    // An approach to a place never ends, but nobody sees its last part.
    const SLOW: f64 = 1.0;
    let speed = f64::from(memory.axis(axis, Chan::LAST_VEL)).abs();
    if speed > SLOW || !is_exponential(memory, axis) {
        let how = match speed {
            ..SLOW => "has only just begun to move".to_owned(),
            _ => format!("still moves at {speed:.0} units/s"),
        };
        parts.out.diagnose(caller, Message::MotionEnded { function, axis, how });
    }
}

/// A thread disables an axis of a path that it has started itself: the path ends for all of them.
pub(crate) fn ends_path(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId) {
    let memory = &*caller.memory;
    let is_own = caller.thread.is_some() && parts.calls.motions.mover(axis) == caller.thread;
    let moves = has_motion(memory, axis)
        && memory.axis(axis, Chan::LAST_MOTION_TYPE) == LastMotion::Multi.get()
        || !memory.get(COORD_SYSTEM0).is_null();
    if is_own && memory.axis(axis, Chan::ENABLE) != 0 && is_member(memory, axis) && moves {
        parts.out.diagnose(caller, Message::PathEnded { function, axis });
    }
}

fn swapped_limits(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let (neg, pos) = (memory.axis(axis, Chan::SOFT_LIMIT_NEG), memory.axis(axis, Chan::SOFT_LIMIT_POS));
    (neg > pos).then_some(Message::SoftLimitsSwapped { function, axis, neg, pos })
}

/// A setting of 0, and its effect.
type ZeroSetting = (&'static str, &'static str);

/// The usual effect: nothing drives the motor.
const STAYS: &str = "its output stays 0 and its motor does not move";

/// Settings that keep an axis from moving.
fn no_gain(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let mode =
        OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)).filter(|mode| *mode != OutputMode::None)?;
    let (field, effect) = zero_of_output(memory, axis, mode).or_else(|| {
        if OutputMode::is_open_loop(Some(mode)) { None } else { zero_of_loop(memory, axis, mode) }
    })?;
    Some(Message::NoGain { function, axis, field, effect })
}

/// A setting of 0 of the output stage.
fn zero_of_output(memory: &GuestMemory, axis: AxisId, mode: OutputMode) -> Option<ZeroSetting> {
    let has_gain = OutputMode::has_generator(Some(mode)) || mode == OutputMode::DacServo;
    let is_microstep = matches!(mode, OutputMode::Microstep | OutputMode::ClosedLoopMicrostep);
    let is_commutated = is_microstep || matches!(mode, OutputMode::Brushless3Ph | OutputMode::Brushless4Ph);
    if has_gain && memory.axis(axis, Chan::OUTPUT_GAIN) == 0.0 {
        Some(("OutputGain", STAYS))
    } else if is_commutated && memory.axis(axis, Chan::INV_DIST_PER_CYCLE) == 0.0 {
        Some(("invDistPerCycle", "its motor is not commutated and does not turn"))
    } else if is_microstep && memory.axis(axis, Chan::STEPPER_AMPLITUDE) == 0.0 {
        Some(("StepperAmplitude", "the coils of its motor have no current"))
    } else {
        None
    }
}

/// A setting of 0 of a closed loop.
fn zero_of_loop(memory: &GuestMemory, axis: AxisId, mode: OutputMode) -> Option<ZeroSetting> {
    // Steps follow the command, to which the loop only adds its output: without that they are those of an open loop.
    let has_steps = matches!(mode, OutputMode::ClosedLoopStepDir | OutputMode::ClosedLoopMicrostep);
    let output = if has_steps { None } else { zero_of_compensation(memory, axis) };
    output.or_else(|| zero_of_feedback(memory, axis))
}

/// Returns whether a gain of an axis is 0.
fn is_zero(memory: &GuestMemory, axis: AxisId, field: Field<f32>) -> bool {
    memory.axis(axis, field) == 0.0
}

/// A setting of 0 that keeps the output at 0.
fn zero_of_compensation(memory: &GuestMemory, axis: AxisId) -> Option<ZeroSetting> {
    let is_zero = |field| is_zero(memory, axis, field);
    let blocks = |filter: usize| {
        let filter = chan(axis).field(Chan::IIR.element(filter));
        [Iir::B0, Iir::B1, Iir::B2].into_iter().all(|field| memory.get(filter.field(field)) == 0.0)
    };
    let has_no_forward = is_zero(Chan::FF_VEL) && is_zero(Chan::FF_ACCEL);
    if [Chan::P, Chan::I, Chan::D].into_iter().all(is_zero) && has_no_forward {
        Some(("P, I, D, FFVel and FFAccel", STAYS))
    } else if is_zero(Chan::MAX_OUTPUT) {
        Some(("MaxOutput", STAYS))
    } else if is_zero(Chan::MAX_ERR) && has_no_forward {
        Some(("MaxErr", STAYS))
    } else if blocks(2) {
        Some(("iir[2].B0, B1 and B2", STAYS))
    } else if has_no_forward && (blocks(0) || blocks(1)) {
        Some(("iir[0] or iir[1].B0, B1 and B2", STAYS))
    } else {
        None
    }
}

/// A setting of 0 that leaves the position or the integrator without effect.
fn zero_of_feedback(memory: &GuestMemory, axis: AxisId) -> Option<ZeroSetting> {
    let is_zero = |field| is_zero(memory, axis, field);
    let has_no_forward = is_zero(Chan::FF_VEL) && is_zero(Chan::FF_ACCEL);
    let input = memory.axis(axis, Chan::INPUT_MODE);
    let is_encoder = input == InputMode::Encoder.get();
    if is_encoder && is_zero(Chan::INPUT_GAIN0) {
        Some(("InputGain0", "its Position never changes"))
    } else if input == InputMode::None.get() && has_no_forward {
        Some(("InputMode", "its Position never changes (ENCODER_MODE is 1)"))
    } else if !is_zero(Chan::I) && is_zero(Chan::MAX_I) {
        Some(("MaxI", "its integrator has no effect"))
    } else if memory.axis(axis, Chan::MAX_FOLLOWING_ERROR) == 0.0 {
        Some(("MaxFollowingError", "the least error while it moves disables it"))
    } else {
        None
    }
}

fn backlash_off(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let is_off = memory.axis(axis, Chan::BACKLASH_MODE) == BacklashMode::Off.get();
    let amount = memory.axis(axis, Chan::BACKLASH_AMOUNT);
    (is_off && amount != 0.0).then_some(Message::BacklashOff { function, axis, amount })
}

/// Tells at the end of a run of limit switches that an axis which was moved has never watched.
pub(crate) fn note_unwatched_limits(parts: &mut Parts, memory: &GuestMemory, now: Cycles) {
    for axis in memory.axes().iter() {
        let Some(CallPlace { thread, at }) = parts.servo.commands[axis.index()] else { continue };
        let is_own = |bit| parts.machine.mechanics.contacts(bit).any(|(owner, ..)| owner == axis);
        let unwatched = unwatched_limits(memory, axis).into_iter().find(|(_, bit)| is_own(*bit));
        if let Some((end, bit)) = unwatched {
            parts.out.remark_of(now, thread.into(), at, Message::LimitsOff { axis, end, bit });
        }
    }
}

fn no_backlash_rate(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let is_linear = memory.axis(axis, Chan::BACKLASH_MODE) == BacklashMode::Linear.get();
    let is_zero =
        memory.axis(axis, Chan::BACKLASH_RATE) == 0.0 && memory.axis(axis, Chan::BACKLASH_AMOUNT) != 0.0;
    (is_linear && is_zero).then_some(Message::NoBacklashRate { function, axis })
}
