//! Checks of the settings of an axis when a program enables or moves it: what is wired wrong, and what keeps it from
//! moving.
//!
//! The board accepts all of it silently. Each check is one remark, with the call that made it come to light.

use kmotiondef::firmware::Function;
use kmotiondef::modes::{BacklashMode, InputMode, OutputMode};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::variables::KSTEP_PRESENT;
use kmotiondef::{AxisId, Bit, Field};
use vm::firmware::Caller;
use vm::memory::GuestMemory;

use super::calls::{EndedWait, Jogged};
use super::parts::Parts;
use crate::io::kanalog;
use crate::machine::Channel;
use crate::machine::description::Condition;
use crate::machine::wiring::{DACS, PWMS, channel_of};
use crate::out::{Message, Speaker};
use crate::servo::independent::has_motion;
use crate::servo::limits::{WatchedLimit, watched_limits};
use crate::views::{Typed, chan};

/// PWM channels that belong to no option board.
const WITHOUT_AMPLIFIER: std::ops::Range<usize> = 0..8;
/// The drive of a load with the model `motor`, if the machine file names no channel.
const SERVO: &str = "a servo amplifier (model = \"motor\"), which steps do not turn";
/// Encoder inputs of a board and its SnapAmps.
const ENCODERS: usize = 16;
/// Numbers of step generators in `OutputChan0`: the low three bits are the generator, the others the kind of its pins.
const STEP_CHANNELS: usize = 64;
/// Step generators of a KStep.
const ON_KSTEP: std::ops::Range<usize> = 0..4;

/// A program enables an axis at a destination.
pub(crate) fn enabled(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId, dest: f64) {
    let memory = &*caller.memory;
    let messages = [
        no_such_output(memory, function, axis),
        no_such_input(memory, function, axis),
        shared_channel(memory, function, axis),
        shared_input(memory, function, axis),
        wrong_input(parts, memory, function, axis),
        wrong_output(parts, memory, function, axis),
        no_amplifier(parts, memory, function, axis),
        leap(memory, function, axis, dest),
        short_pulses(parts, memory, function, axis),
    ];
    for message in messages.into_iter().flatten() {
        parts.out.diagnose(caller, message);
    }
    parts.calls.motions.enabled(axis, connection(caller.memory, axis));
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

/// A limit switch that the machine has at the other end.
fn limit_at_other_end(
    parts: &Parts,
    memory: &GuestMemory,
    function: Function,
    axis: AxisId,
) -> Option<Message> {
    watched_limits(memory, axis).into_iter().find_map(|WatchedLimit { end, bit, is_upper }| {
        let (owner, place, _) = parts.machine.mechanics.contact(bit)?;
        let place = place.filter(|_| owner == axis)?;
        let is_wrong = match place {
            Condition::AtMost(_) => is_upper,
            Condition::AtLeast(_) => !is_upper,
            Condition::Between(..) => false,
        };
        let place = place.to_string();
        is_wrong.then_some(Message::LimitAtOtherEnd { function, axis, end, bit, place })
    })
}

/// A thread hears that the motion of an axis has ended for which it has waited.
pub(crate) fn arrived(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId) {
    const FAR: f64 = 100.0;
    let memory = &*caller.memory;
    let (dest, position) = (memory.axis(axis, Chan::DEST), memory.axis(axis, Chan::POSITION));
    let rest = (dest - position).abs();
    let is_far = rest > FAR && rest > parts.calls.motions.way(axis) / 2.0;
    if is_far && loop_input(memory, axis).is_some() {
        parts.out.diagnose(caller, Message::NotThere { axis, position, dest });
    }
}

/// A thread begins a jog, or ends one: whether a switch of the axis was as the thread waited for before it has moved.
pub(crate) fn jogs(parts: &mut Parts, caller: &Caller<'_>, axis: AxisId, speed: f64) {
    const MOVED: f64 = 1.0;
    let Some(thread) = caller.thread else { return };
    let dest = caller.memory.axis(axis, Chan::DEST);
    let wait = parts.calls.waits.of(thread);
    let (looked, last_bit) = (wait.looked, wait.last_bit);
    let now = (speed != 0.0).then_some(Jogged { thread, dest, speed, looked });
    let before =
        parts.calls.motions.jogs(axis, now).filter(|before| now.is_none() && before.thread == thread);
    let Some(Jogged { speed, .. }) =
        before.filter(|before| (dest - before.dest).abs() < MOVED && looked > before.looked)
    else {
        return;
    };
    let of_axis = |bit: &Bit| parts.machine.mechanics.contact(*bit).is_some_and(|(owner, ..)| owner == axis);
    if let Some(bit) = last_bit.filter(of_axis) {
        parts.out.diagnose(caller, Message::JogEnded { axis, speed, bit });
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

/// A program moves an enabled axis.
pub(crate) fn moved(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId) {
    let memory = &*caller.memory;
    let messages = [
        swapped_limits(memory, function, axis),
        no_gain(memory, function, axis),
        no_backlash_rate(memory, function, axis),
        changed_connection(parts, memory, function, axis),
        output_wraps(memory, function, axis),
        limit_at_other_end(parts, memory, function, axis),
    ];
    for message in messages.into_iter().flatten() {
        parts.out.diagnose(caller, message);
    }
    let Some(thread) = caller.thread else { return };
    let before = parts.calls.motions.moves(thread, axis);
    if let Some(other) = before.filter(|_| has_motion(caller.memory, axis)) {
        parts.out.diagnose(caller, Message::OtherThreadMoves { function, axis, other });
    }
}

/// A thread continues after a wait: whether it has taken the end of the axis for that of its motion.
pub(crate) fn goes_on(parts: &mut Parts, caller: &Caller<'_>) {
    let ended = caller.thread.and_then(|thread| parts.calls.motions.take_ended(thread));
    if let Some(EndedWait { thread, axis, at }) = ended {
        let message = Message::DisabledWhileWaiting { axis };
        parts.out.remark_of(caller.now(), Speaker::Thread(thread), at, message);
    }
}

/// A motion that takes minutes, most of them for its acceleration.
pub(crate) fn planned(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId, way: f64) {
    const LONG: f64 = 60.0;
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
    if seconds > LONG && seconds > 3.0 * cruise {
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
    if speed > SLOW {
        parts.out.diagnose(caller, Message::MotionEnded { function, axis, speed });
    }
}

/// Every other enabled axis.
fn others(memory: &GuestMemory, axis: AxisId) -> impl Iterator<Item = AxisId> {
    AxisId::all().filter(move |other| *other != axis && memory.axis(*other, Chan::ENABLE) != 0)
}

fn shared_channel(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let channel = channel_of(memory, axis)?;
    let other = others(memory, axis).find(|other| channel_of(memory, *other) == Some(channel))?;
    Some(Message::ChannelShared { function, axis, other, channel: channel.to_string() })
}

/// The encoder input of an axis whose loop closes over it.
fn loop_input(memory: &GuestMemory, axis: AxisId) -> Option<i32> {
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    let is_loop = mode.is_some_and(|mode| mode != OutputMode::None) && !OutputMode::is_open_loop(mode);
    let is_encoder = memory.axis(axis, Chan::INPUT_MODE) == InputMode::Encoder.get();
    (is_loop && is_encoder).then(|| memory.axis(axis, Chan::INPUT_CHAN0))
}

fn shared_input(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let input = loop_input(memory, axis)?;
    let other = others(memory, axis).find(|other| loop_input(memory, *other) == Some(input))?;
    Some(Message::InputShared { function, axis, other, input })
}

fn wrong_input(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let wired = parts.machine.wiring.input(axis)?;
    let input = loop_input(memory, axis)?;
    (usize::try_from(input) != Ok(wired)).then_some(Message::WrongInput { function, axis, input, wired })
}

fn wrong_output(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let channel = channel_of(memory, axis)?;
    let is_stepped = matches!(channel, Channel::Generator(_));
    let wired = match parts.machine.wiring.drive(axis) {
        Some(wired) => wired.to_string(),
        None if is_stepped && parts.machine.loads[axis].has_motor() => SERVO.to_owned(),
        None => return None,
    };
    let channel = channel.to_string();
    (channel != wired).then_some(Message::WrongOutput { function, axis, channel, wired })
}

/// A PWM channel on which nothing is: a machine with a Kanalog has amplifiers with analog inputs.
fn no_amplifier(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let Some(Channel::Pwm(channel)) = channel_of(memory, axis) else { return None };
    let has_kanalog = kanalog::is_served(&parts.io.fpga, memory);
    (WITHOUT_AMPLIFIER.contains(&channel) && has_kanalog).then_some(Message::NoAmplifier {
        function,
        axis,
        channel,
    })
}

/// An axis in a closed loop that is enabled far from where it is.
fn leap(memory: &GuestMemory, function: Function, axis: AxisId, dest: f64) -> Option<Message> {
    const FAR: f64 = 100.0;
    loop_input(memory, axis)?;
    let position = memory.axis(axis, Chan::POSITION);
    ((position - dest).abs() > FAR).then_some(Message::Leap { function, axis, position, dest })
}

/// The pulses of power-up on a KStep, whose inputs need longer ones of the other polarity.
fn short_pulses(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let Some(Channel::Generator(generator)) = channel_of(memory, axis) else { return None };
    let is_kstep = memory.get(KSTEP_PRESENT) != 0 && ON_KSTEP.contains(&generator);
    (is_kstep && parts.io.stepgens.has_start_pulses()).then_some(Message::KstepPulses { function, axis })
}

fn swapped_limits(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let (neg, pos) = (memory.axis(axis, Chan::SOFT_LIMIT_NEG), memory.axis(axis, Chan::SOFT_LIMIT_POS));
    (neg > pos).then_some(Message::SoftLimitsSwapped { function, axis, neg, pos })
}

/// A setting of 0, and its effect.
type Zero = (&'static str, &'static str);

/// The usual effect: nothing drives the motor.
const STAYS: &str = "its output stays 0 and its motor does not move";

/// Settings that keep an axis from moving.
fn no_gain(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let mode =
        OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)).filter(|mode| *mode != OutputMode::None)?;
    let (field, effect) = zero_of_output(memory, axis, mode)
        .or_else(|| if OutputMode::is_open_loop(Some(mode)) { None } else { zero_of_loop(memory, axis) })?;
    Some(Message::NoGain { function, axis, field, effect })
}

/// A setting of 0 of the output stage.
fn zero_of_output(memory: &GuestMemory, axis: AxisId, mode: OutputMode) -> Option<Zero> {
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
fn zero_of_loop(memory: &GuestMemory, axis: AxisId) -> Option<Zero> {
    let is_zero = |field: Field<f32>| memory.axis(axis, field) == 0.0;
    let blocks = |filter: usize| {
        let filter = chan(axis).field(Chan::IIR.element(filter));
        [Iir::B0, Iir::B1, Iir::B2].into_iter().all(|field| memory.get(filter.field(field)) == 0.0)
    };
    let has_no_forward = is_zero(Chan::FF_VEL) && is_zero(Chan::FF_ACCEL);
    let input = memory.axis(axis, Chan::INPUT_MODE);
    let is_encoder = input == InputMode::Encoder.get();
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
    } else if is_encoder && is_zero(Chan::INPUT_GAIN0) {
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

/// An output number that no board has.
fn no_such_output(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let channel = memory.axis(axis, Chan::OUTPUT_CHAN0);
    let mode =
        OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)).filter(|mode| *mode != OutputMode::None)?;
    let (kind, count) = if OutputMode::has_generator(Some(mode)) {
        ("step generators", STEP_CHANNELS)
    } else if mode == OutputMode::DacServo {
        ("analog outputs", DACS)
    } else {
        ("PWM channels", PWMS)
    };
    let is_there = usize::try_from(channel).is_ok_and(|number| number < count);
    (!is_there).then_some(Message::NoSuchOutput { function, axis, channel, kind, most: count - 1 })
}

/// An encoder input that no board has.
fn no_such_input(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let input = loop_input(memory, axis)?;
    let is_there = usize::try_from(input).is_ok_and(|number| number < ENCODERS);
    (!is_there).then_some(Message::NoSuchInput { function, axis, input })
}

fn no_backlash_rate(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let is_linear = memory.axis(axis, Chan::BACKLASH_MODE) == BacklashMode::Linear.get();
    let is_zero =
        memory.axis(axis, Chan::BACKLASH_RATE) == 0.0 && memory.axis(axis, Chan::BACKLASH_AMOUNT) != 0.0;
    (is_linear && is_zero).then_some(Message::NoBacklashRate { function, axis })
}
