//! Checks of the wiring of an axis when a program enables it.

use kmotiondef::AxisId;
use kmotiondef::firmware::Function;
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::variables::KSTEP_PRESENT;
use vm::memory::GuestMemory;

use super::super::parts::Parts;
use crate::io::bits::bit_state;
use crate::io::kanalog;
use crate::machine::Channel;
use crate::machine::wiring::{DACS, ENCODERS, PWMS, channel_of};
use crate::out::Message;
use crate::servo::limits::{WatchedLimit, watched_limits};
use crate::views::TypedAccess;
use chips::kanalog::ADC_CHANNELS;

/// PWM channels that do not belong to an option board.
const WITHOUT_AMPLIFIER: std::ops::Range<usize> = 0..8;
/// The drive of a load with the model `motor`, if the machine file names no channel.
const SERVO: &str = "a servo amplifier (model = \"motor\"), which steps do not turn";
/// Numbers of step generators in `OutputChan0`: the low three bits are the generator, the others the kind of its pins.
const STEP_CHANNELS: usize = 64;
/// Step generators of a KStep.
const ON_KSTEP: std::ops::Range<usize> = 0..4;

/// The remarks on an axis that is enabled at a destination.
pub(super) fn messages(
    parts: &Parts,
    memory: &GuestMemory,
    function: Function,
    axis: AxisId,
    dest: f64,
) -> Vec<Message> {
    [
        no_such_output(memory, function, axis),
        no_such_input(memory, function, axis),
        shared_channel(memory, function, axis),
        shared_input(memory, function, axis),
        wrong_input(parts, memory, function, axis),
        wrong_output(parts, memory, function, axis),
        no_amplifier(parts, memory, function, axis),
        leap_message(memory, function, axis, dest),
        short_pulses(parts, memory, function, axis),
        spindle_shared(parts, memory, function, axis),
        no_feedback(parts, memory, function, axis),
        limit_fields(memory, function, axis),
        limit_active(parts, memory, function, axis),
    ]
    .into_iter()
    .flatten()
    .collect()
}

/// Limit switches whose bit numbers are in fields that `LimitSwitchOptions` does not select.
fn limit_fields(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let unused = |limit: &WatchedLimit| !limit.is_extended && limit.bit.get() == 0 && limit.field > 0;
    let WatchedLimit { end, field: bit, bit: used, .. } =
        watched_limits(memory, axis).into_iter().find(unused)?;
    Some(Message::LimitFields { function, axis, end, bit, used })
}

/// A limit switch that counts as active although the axis is not at it, or although nothing is connected to its input.
pub(super) fn limit_active(
    parts: &Parts,
    memory: &GuestMemory,
    function: Function,
    axis: AxisId,
) -> Option<Message> {
    let is_idle = |limit: &WatchedLimit| {
        let (level, is_input) = bit_state(&parts.io, memory, limit.bit);
        let is_pressed = match parts.machine.mechanics.contact(limit.bit) {
            Some((_, _, closed)) => level == closed,
            None => !is_input || parts.io.pins.is_driven(limit.bit),
        };
        level == limit.active && !is_pressed
    };
    let WatchedLimit { end, bit, active, polarity, .. } =
        watched_limits(memory, axis).into_iter().find(is_idle)?;
    Some(Message::LimitActive { function, axis, end, bit, level: active.into(), polarity })
}

/// Every other enabled axis.
fn other_enabled_axes(memory: &GuestMemory, axis: AxisId) -> impl Iterator<Item = AxisId> {
    memory.axes().iter().filter(move |other| *other != axis && memory.axis(*other, Chan::ENABLE) != 0)
}

fn shared_channel(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let channel = channel_of(memory, axis)?;
    let other = other_enabled_axes(memory, axis).find(|other| channel_of(memory, *other) == Some(channel))?;
    Some(Message::ChannelShared { function, axis, other, channel: channel.to_string() })
}

/// The encoder input of a closed-loop axis.
pub(super) fn loop_input(memory: &GuestMemory, axis: AxisId) -> Option<i32> {
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    let is_loop = mode.is_some_and(|mode| mode != OutputMode::None) && !OutputMode::is_open_loop(mode);
    let is_encoder = memory.axis(axis, Chan::INPUT_MODE) == InputMode::Encoder.get();
    (is_loop && is_encoder).then(|| memory.axis(axis, Chan::INPUT_CHAN0))
}

fn shared_input(memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let input = loop_input(memory, axis)?;
    let other = other_enabled_axes(memory, axis).find(|other| loop_input(memory, *other) == Some(input))?;
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

/// A PWM channel without an amplifier: a machine with a Kanalog or a SnapAmp has its amplifiers there. A channel that
/// the machine file connects drives an external bridge.
fn no_amplifier(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let Some(Channel::Pwm(channel)) = channel_of(memory, axis) else { return None };
    let is_described = |axis: AxisId| parts.machine.wiring.drive(axis) == Some(Channel::Pwm(channel));
    if WITHOUT_AMPLIFIER.contains(&channel) && memory.axes().iter().any(is_described) {
        return None;
    }
    let has_motor = parts.machine.loads[axis].has_motor();
    if has_motor && !WITHOUT_AMPLIFIER.contains(&channel) && !parts.io.snapamps.is_present() {
        return Some(Message::NoSnapAmp { function, axis, channel });
    }
    let has_kanalog = kanalog::is_served(&parts.io.fpga, memory);
    // The pins of a KFLOP cannot drive a motor that needs currents in several coils.
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    let has_coils = mode != Some(OutputMode::DcServo) && has_motor;
    let has_other = has_kanalog || parts.io.snapamps.is_present();
    (WITHOUT_AMPLIFIER.contains(&channel) && (has_other || has_coils)).then_some(Message::NoAmplifier {
        function,
        axis,
        channel,
    })
}

/// An analog output that also drives the spindle.
fn spindle_shared(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let Some(Channel::Dac(dac)) = channel_of(memory, axis) else { return None };
    parts.machine.mechanics.has_spindle_on(dac, axis).then_some(Message::SpindleShared {
        function,
        axis,
        dac,
    })
}

/// A closed-loop motor whose analog feedback input is not connected.
fn no_feedback(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    let is_analog = memory.axis(axis, Chan::INPUT_MODE) == InputMode::Adc.get();
    let channel = usize::try_from(memory.axis(axis, Chan::INPUT_CHAN0)).ok()?;
    let is_loop = mode.is_some_and(|mode| mode != OutputMode::None) && !OutputMode::is_open_loop(mode);
    let is_undriven = channel < ADC_CHANNELS && !parts.io.kanalog.is_connected(channel);
    (is_loop && is_analog && is_undriven && parts.machine.loads[axis].has_motor())
        .then_some(Message::NoFeedback { function, axis, channel })
}

/// A closed-loop axis that is enabled far from its commanded position.
fn leap_message(memory: &GuestMemory, function: Function, axis: AxisId, dest: f64) -> Option<Message> {
    const FAR: f64 = 100.0;
    loop_input(memory, axis)?;
    let position = memory.axis(axis, Chan::POSITION);
    ((position - dest).abs() > FAR).then_some(Message::Leap { function, axis, position, dest })
}

/// The power-up pulse settings on a KStep, whose inputs need longer pulses of the other polarity.
fn short_pulses(parts: &Parts, memory: &GuestMemory, function: Function, axis: AxisId) -> Option<Message> {
    let Some(Channel::Generator(generator)) = channel_of(memory, axis) else { return None };
    let is_kstep = memory.get(KSTEP_PRESENT) != 0 && ON_KSTEP.contains(&generator);
    (is_kstep && parts.io.stepgens.has_start_pulses()).then_some(Message::KstepPulses { function, axis })
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
