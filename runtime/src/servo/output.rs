//! Output stages: the signals to an axis' amplifier, analog output or step generator.
//!
//! Source: axes-and-motion.md sections 11 and 12.

#![deny(clippy::wildcard_enum_match_arm, reason = "a new instruction, operator or mode must be decided")]

use kmotiondef::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAXV};
use kmotiondef::modes::OutputMode;
use kmotiondef::structs::Chan;
use kmotiondef::variables::DAC_BUFFER;
use kmotiondef::{AxisId, Field};
use vm::memory::GuestMemory;

use super::sine::{QUARTER, THIRD, sine};
use super::state::Tick;
use crate::io::amplifiers::{antiphase, current, store_pwm};
use crate::machine::wiring::{DACS, channel_of};
use crate::machine::{AmplifierSignal, Channel, Drive};
use crate::out::Message;
use crate::views::{AxisView, TypedAccess};

/// The first PWM channel of a SnapAmp: its loops control current.
const SNAP_AMP: i32 = 8;
/// Steps of a cycle in the word of a vector's angle.
const VECTOR_STEPS: f32 = 360.0;
/// Marks a word of a brushless vector; the magnitude is in the low half.
const VECTOR: u32 = 0x8000_0000;

/// The lead angle of a four-phase brushless motor, in ticks of its motion.
const FOUR_PHASE_LEAD: f64 = 1.33;

/// Outputs one tick of an enabled axis.
#[inline(always)]
pub(crate) fn drive(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId, command: f64, output: f32) {
    let mode = tick.servo.cache.plan(axis).mode;
    if mode == Some(OutputMode::DcServo) {
        tick.io.stepgens.release(axis, &mut tick.io.pins, tick.now);
        let channel = AxisView::of(memory, axis).get(Chan::OUTPUT_CHAN0);
        store_pwm(memory, channel, pwm(channel, output as i32));
        let drive = match channel >= SNAP_AMP {
            true if is_faulted(tick, channel) => Drive::None,
            true => Drive::Loop(command, AmplifierSignal::Current(clamp_output(output, MAX_PWMC_VALUE))),
            false => Drive::Loop(command, AmplifierSignal::Pwm(clamp_output(output, MAX_PWM_VALUE))),
        };
        tick.machine.loads[axis].drive = drive;
    } else {
        drive_otherwise(tick, memory, axis, command, output);
    }
}

/// Drives the output in any mode other than that of a brushed motor.
fn drive_otherwise(tick: &mut Tick<'_>, memory: &mut GuestMemory, axis: AxisId, command: f64, output: f32) {
    let mode = tick.servo.cache.plan(axis).mode;
    let has_more_generators = memory.has_other_map();
    let chan = AxisView::of(memory, axis);
    let channel = chan.get(Chan::OUTPUT_CHAN0);
    // Generators 8 to 15 of a Kogna have no pins here.
    if OutputMode::has_generator(mode) && !(has_more_generators && channel & 8 != 0) {
        tick.io.stepgens.assign(axis, channel, &mut tick.io.pins, tick.now);
    } else {
        tick.io.stepgens.release(axis, &mut tick.io.pins, tick.now);
    }
    let drive = match mode {
        None | Some(OutputMode::None | OutputMode::DcServo) => Drive::None,
        // The load of a closed loop is where the axis' command is; the correction is for real mechanics.
        Some(OutputMode::StepDir | OutputMode::ClosedLoopStepDir) => Drive::Steps(command),
        Some(OutputMode::Microstep) => {
            let angle = stepped_to(&chan);
            microstep(memory, axis, angle);
            Drive::Steps(command)
        }
        Some(OutputMode::ClosedLoopMicrostep) => {
            let gain = chan.get(Chan::OUTPUT_GAIN);
            let angle = stepped_to(&chan) + f64::from(gain * output);
            microstep(memory, axis, angle);
            Drive::Steps(command)
        }
        Some(OutputMode::DacServo) => {
            let (value, channel) = (analog(&chan, output), chan.get(Chan::OUTPUT_CHAN0));
            note_overwritten(tick, memory, axis);
            tick.servo.axes[axis.index()].analog = write_dac(memory, channel, value);
            Drive::Loop(command, AmplifierSignal::Dac(f64::from(value)))
        }
        Some(mode @ (OutputMode::Brushless3Ph | OutputMode::Brushless4Ph)) => {
            let applied = turn(tick, memory, axis, mode, output);
            applied.map_or(Drive::None, |applied| Drive::Loop(command, applied))
        }
    };
    tick.machine.loads[axis].drive = drive;
}

/// Returns the position of the phases of a microstepped axis: its command without the offset of the destination.
fn stepped_to(chan: &AxisView<'_>) -> f64 {
    chan.get(Chan::DEST) + f64::from(chan.get(Chan::BACKLASH))
}

/// Returns the drive of an enabled axis whose outputs were computed elsewhere; `stepped` is the position of its step
/// generator.
pub(crate) fn load_drive(chan: &AxisView<'_>, stepped: f64) -> Drive {
    let output = chan.get(Chan::OUTPUT);
    let command = super::command(chan);
    match OutputMode::new(chan.get(Chan::OUTPUT_MODE)) {
        None | Some(OutputMode::None) => Drive::None,
        Some(OutputMode::StepDir | OutputMode::ClosedLoopStepDir) => Drive::Steps(stepped),
        Some(OutputMode::Microstep | OutputMode::ClosedLoopMicrostep) => Drive::Steps(command),
        Some(OutputMode::DcServo) if chan.get(Chan::OUTPUT_CHAN0) >= SNAP_AMP => {
            Drive::Loop(command, AmplifierSignal::Current(clamp_output(output, MAX_PWMC_VALUE)))
        }
        Some(OutputMode::DcServo) => {
            Drive::Loop(command, AmplifierSignal::Pwm(clamp_output(output, MAX_PWM_VALUE)))
        }
        Some(OutputMode::DacServo) => {
            Drive::Loop(command, AmplifierSignal::Dac(f64::from(analog(chan, output))))
        }
        Some(OutputMode::Brushless3Ph | OutputMode::Brushless4Ph) => {
            let magnitude = f64::from(output.clamp(-MAXV, MAXV));
            Drive::Loop(command, AmplifierSignal::Vector(magnitude, phase(chan)))
        }
    }
}

/// The bridges of a SnapAmp that has a fault are off.
fn is_faulted(tick: &mut Tick<'_>, channel: i32) -> bool {
    tick.io.snapamps.is_present() && tick.io.snapamps.is_off(channel, tick.now)
}

/// An output within ±`limit`.
#[inline(always)]
fn clamp_output(output: f32, limit: i32) -> f64 {
    let limit = f64::from(limit);
    f64::from(output).clamp(-limit, limit)
}

/// Outputs the vector of a brushless axis; `None` if its amplifier is off.
fn turn(
    tick: &mut Tick<'_>,
    memory: &mut GuestMemory,
    axis: AxisId,
    mode: OutputMode,
    output: f32,
) -> Option<AmplifierSignal> {
    let chan = AxisView::of(memory, axis);
    let (angle, channel) = (phase(&chan), chan.get(Chan::OUTPUT_CHAN0));
    let cycles = chan.get(Chan::INV_DIST_PER_CYCLE);
    check_commutation(tick, axis, angle, cycles);
    if mode == OutputMode::Brushless3Ph {
        three_phase(memory, axis, output, angle);
    } else {
        let turned = tick.servo.axes[axis.index()].moved * cycles;
        four_phase(memory, axis, output, angle + FOUR_PHASE_LEAD * turned);
    }
    let magnitude = f64::from(output.clamp(-MAXV, MAXV));
    (!is_faulted(tick, channel)).then_some(AmplifierSignal::Vector(magnitude, angle))
}

/// Makes a remark, once, on a brushless axis whose real motor would not follow as the simulated one does.
fn check_commutation(tick: &mut Tick<'_>, axis: AxisId, angle: f64, cycles: f64) {
    if tick.machine.loads[axis].would_not_turn(angle, cycles) {
        tick.out.remark(tick.now, Message::WouldNotTurn { axis });
    }
}

/// The word of a value in the mode that its channel has.
#[inline]
fn pwm(channel: i32, value: i32) -> i32 {
    if channel >= SNAP_AMP { current(value) } else { antiphase(value) }
}

/// Returns the position of a brushless axis in its electrical cycle, in cycles.
fn phase(chan: &AxisView<'_>) -> f64 {
    (chan.get(Chan::POSITION) + f64::from(chan.get(Chan::COMMUTATION_OFFSET)))
        * chan.get(Chan::INV_DIST_PER_CYCLE)
}

/// The analog output of an axis: 12 bits, which wrap.
fn analog(chan: &AxisView<'_>, output: f32) -> i32 {
    let gain = f64::from(chan.get(Chan::OUTPUT_GAIN));
    let value = (f64::from(output) * gain + f64::from(chan.get(Chan::OUTPUT_OFFSET))) as i32;
    (value.wrapping_add(2048) & 0xfff) - 2048
}

/// Sets the analog output of an axis whose compensation has an output of 0.
pub(super) fn clear_dac(memory: &mut GuestMemory, axis: AxisId) {
    let chan = AxisView::of(memory, axis);
    let (value, channel) = (analog(&chan, 0.0), chan.get(Chan::OUTPUT_CHAN0));
    write_dac(memory, channel, value);
}

/// Writes a value to an analog output, and returns which one has got which word.
#[inline]
fn write_dac(memory: &mut GuestMemory, channel: i32, value: i32) -> Option<(usize, i16)> {
    let channel = usize::try_from(channel).ok().filter(|&channel| channel < DACS)?;
    let word = (value.wrapping_sub(2048) & 0xfff) as i16;
    memory.set(DAC_BUFFER.element(channel), word);
    Some((channel, word))
}

/// Makes a remark on an analog output that was written since the axis wrote it, unless another axis has done so.
#[inline]
fn note_overwritten(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId) {
    if let Some((dac, word)) = tick.servo.axes[axis.index()].analog
        && memory.get(DAC_BUFFER.element(dac)) != word
    {
        report_overwritten(tick, memory, axis, dac);
    }
}

#[cold]
fn report_overwritten(tick: &mut Tick<'_>, memory: &GuestMemory, axis: AxisId, dac: usize) {
    let drives = |other: AxisId| {
        memory.axis(other, Chan::ENABLE) != 0 && channel_of(memory, other) == Some(Channel::Dac(dac))
    };
    if memory.axes().iter().filter(|other| drives(*other)).eq([axis]) {
        tick.out.remark(tick.now, Message::DacOverwritten { axis, dac });
    }
}

/// Sine and cosine currents.
fn microstep(memory: &mut GuestMemory, axis: AxisId, position: f64) {
    let angle = position * memory.axis(axis, Chan::INV_DIST_PER_CYCLE);
    let amplitude = memory.axis(axis, Chan::STEPPER_AMPLITUDE);
    four_phase(memory, axis, amplitude, angle);
}

/// Applies a three-phase vector with an angle in cycles; the phases are the amplifier's. On the board its magnitude is
/// limited; the loops of a SnapAmp have their own limits, and the phases are remembered.
pub(crate) fn three_phase(memory: &mut GuestMemory, axis: AxisId, v: f32, angle: f64) {
    let channel = memory.axis(axis, Chan::OUTPUT_CHAN0);
    let is_snap_amp = channel >= SNAP_AMP;
    let value = libm::rintf(if is_snap_amp { v } else { v.clamp(-MAXV, MAXV) }) as i16;
    let word = VECTOR | u32::from(value.cast_unsigned());
    store_pwm(memory, channel, word.cast_signed());
    let fraction = (angle - libm::floor(angle)) as f32;
    store_pwm(memory, channel.wrapping_add(1), libm::rintf(fraction * VECTOR_STEPS) as i32);
    if is_snap_amp {
        memory.set_axis(axis, Chan::X1_LAST, v * sine(angle, 0));
        memory.set_axis(axis, Chan::X2_LAST, v * sine(angle, THIRD));
    }
}

/// Applies a vector to two coils a quarter of a cycle apart; the angle is in cycles. Each coil has its own limit. The
/// board's own channels have lead compensation.
pub(crate) fn four_phase(memory: &mut GuestMemory, axis: AxisId, v: f32, angle: f64) {
    let leads = memory.axis(axis, Chan::OUTPUT_CHAN0) < SNAP_AMP;
    let lead = memory.axis(axis, Chan::LEAD);
    let phases: [(f32, Field<f32>, Field<i32>); 2] = [
        (v * sine(angle, 0), Chan::X1_LAST, Chan::OUTPUT_CHAN0),
        (v * sine(angle, QUARTER), Chan::X2_LAST, Chan::OUTPUT_CHAN1),
    ];
    for (value, last, channel) in phases {
        let mut led = value;
        if leads {
            led += (value - memory.axis(axis, last)) * lead;
            memory.set_axis(axis, last, value);
        }
        let channel = memory.axis(axis, channel);
        let value = libm::rintf(led) as i32;
        store_pwm(memory, channel, if leads { antiphase(value) } else { current(value) });
    }
}
