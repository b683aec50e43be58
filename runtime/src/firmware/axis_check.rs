//! Checks of the settings of an axis when a program enables or moves it: what is wired wrong, and what keeps it from
//! moving.
//!
//! The board accepts all of it silently. Each check is one remark, with the call that made it come to light.

use kmotiondef::firmware::Function;
use kmotiondef::modes::{BacklashMode, InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::KSTEP_PRESENT;
use kmotiondef::{AxisId, Field};
use vm::firmware::Caller;
use vm::memory::GuestMemory;

use super::calls::EndedWait;
use super::parts::Parts;
use crate::io::kanalog;
use crate::machine::Channel;
use crate::machine::wiring::channel_of;
use crate::out::{Message, Speaker};
use crate::servo::independent::has_motion;
use crate::views::Typed;

/// PWM channels that belong to no option board.
const WITHOUT_AMPLIFIER: std::ops::Range<usize> = 0..8;
/// Step generators of a KStep.
const ON_KSTEP: std::ops::Range<usize> = 0..4;

/// A program enables an axis at a destination.
pub(crate) fn enabled(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId, dest: f64) {
    let memory = &*caller.memory;
    let messages = [
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
}

/// A program moves an enabled axis.
pub(crate) fn moved(parts: &mut Parts, caller: &Caller<'_>, function: Function, axis: AxisId) {
    let memory = &*caller.memory;
    let messages = [
        swapped_limits(memory, function, axis),
        no_gain(memory, function, axis),
        no_backlash_rate(memory, function, axis),
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
    let wired = parts.machine.wiring.drive(axis)?;
    let channel = channel_of(memory, axis)?;
    let (channel, wired) = (channel.to_string(), wired.to_string());
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

/// Settings that keep the output of an axis at 0.
fn no_gain(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let is_zero = |field: Field<f32>| memory.axis(axis, field) == 0.0;
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE))?;
    let field = if mode == OutputMode::None {
        return None;
    } else if (OutputMode::has_generator(Some(mode)) || mode == OutputMode::DacServo)
        && is_zero(Chan::OUTPUT_GAIN)
    {
        "OutputGain"
    } else if OutputMode::is_open_loop(Some(mode)) {
        return None;
    } else if [Chan::P, Chan::I, Chan::D, Chan::FF_VEL, Chan::FF_ACCEL].into_iter().all(is_zero) {
        "P, I, D, FFVel and FFAccel"
    } else if is_zero(Chan::MAX_OUTPUT) {
        "MaxOutput"
    } else if is_zero(Chan::MAX_ERR) && is_zero(Chan::FF_VEL) && is_zero(Chan::FF_ACCEL) {
        "MaxErr"
    } else {
        return None;
    };
    Some(Message::NoGain { function, axis, field })
}

fn no_backlash_rate(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let is_linear = memory.axis(axis, Chan::BACKLASH_MODE) == BacklashMode::Linear.get();
    let is_zero =
        memory.axis(axis, Chan::BACKLASH_RATE) == 0.0 && memory.axis(axis, Chan::BACKLASH_AMOUNT) != 0.0;
    (is_linear && is_zero).then_some(Message::NoBacklashRate { function, axis })
}
