//! Output stages: what an axis' amplifier, analog output or step generator receives.
//!
//! Source: axes-and-motion.md sections 11 and 12.

use std::f64::consts::TAU;

use kmotiondef::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAXV};
use kmotiondef::modes::OutputMode;
use kmotiondef::structs::Chan;
use kmotiondef::variables::DAC_BUFFER;
use kmotiondef::{AxisId, Field};
use vm::memory::GuestMemory;

use crate::event::EventKind;
use crate::firmware::io::{antiphase, current, recirculate, store_pwm};
use crate::kernel::Kernel;
use crate::plant::{Applied, Drive};
use crate::views::{AxisView, Typed};

/// The first PWM channel of a SnapAmp: its loops control current.
const SNAP_AMP: i32 = 8;
/// Marks a word of a brushless vector; the magnitude is in the low half.
const VECTOR: u32 = 0x8000_0000;

/// Puts out one tick of an enabled axis.
#[inline]
pub(crate) fn drive(
    kernel: &mut Kernel,
    memory: &mut GuestMemory,
    axis: AxisId,
    mode: Option<OutputMode>,
    command: f64,
    output: f32,
) {
    let chan = AxisView::of(memory, axis);
    let channel = chan.get(Chan::OUTPUT_CHAN0);
    if matches!(mode, Some(OutputMode::StepDir | OutputMode::ClosedLoopStepDir)) {
        kernel.stepgens.claim(axis, channel, &mut kernel.pins, kernel.tick_start);
    } else {
        kernel.stepgens.release(axis, &mut kernel.pins, kernel.tick_start);
    }
    let is_faulted = kernel.snapamps.is_present() && kernel.snapamps.is_off(channel, kernel.tick_start);
    kernel.servo.plants[axis.index()].drive = match mode {
        None | Some(OutputMode::None) => Drive::None,
        // The bridges of a SnapAmp that has a fault are off.
        Some(OutputMode::DcServo | OutputMode::Brushless3Ph | OutputMode::Brushless4Ph) if is_faulted => {
            Drive::None
        }
        Some(OutputMode::StepDir | OutputMode::Microstep) => Drive::Steps(command),
        // The load is where the axis' command is; the correction is for real mechanics.
        Some(OutputMode::ClosedLoopStepDir | OutputMode::ClosedLoopMicrostep) => Drive::Steps(command),
        Some(OutputMode::DcServo) if channel >= SNAP_AMP => {
            let limit = f64::from(MAX_PWMC_VALUE);
            Drive::Loop(command, Applied::Current(f64::from(output).clamp(-limit, limit)))
        }
        Some(OutputMode::DcServo) => {
            let limit = f64::from(MAX_PWM_VALUE);
            Drive::Loop(command, Applied::Pwm(f64::from(output).clamp(-limit, limit)))
        }
        Some(OutputMode::DacServo) => Drive::Loop(command, Applied::Dac(f64::from(analog(&chan, output)))),
        Some(OutputMode::Brushless3Ph | OutputMode::Brushless4Ph) => {
            let magnitude = f64::from(output.clamp(-MAXV, MAXV));
            Drive::Loop(command, Applied::Vector(magnitude, phase(&chan)))
        }
    };
    if matches!(mode, Some(OutputMode::Brushless3Ph | OutputMode::Brushless4Ph)) {
        let angle = phase(&chan);
        let cycles = chan.get(Chan::INV_DIST_PER_CYCLE);
        check_commutation(kernel, axis, angle, cycles);
    }
    match mode {
        Some(OutputMode::DcServo) => store_pwm(memory, channel, pwm(channel, output as i32)),
        Some(OutputMode::DacServo) => write_dac(memory, axis, output),
        Some(OutputMode::Brushless3Ph) => three_phase(memory, axis, output),
        Some(OutputMode::Brushless4Ph) => {
            let angle = phase(&chan);
            four_phase(memory, axis, output, angle);
        }
        Some(OutputMode::Microstep) => {
            let gain = f64::from(memory.axis(axis, Chan::OUTPUT_GAIN));
            microstep(memory, axis, gain * command);
        }
        Some(OutputMode::ClosedLoopMicrostep) => microstep(memory, axis, command + f64::from(output)),
        _ => {}
    }
}

/// Tells once of a brushless axis whose real motor would not follow as the simulated one does.
fn check_commutation(kernel: &mut Kernel, axis: AxisId, angle: f64, cycles: f64) {
    if kernel.servo.plants[axis.index()].would_not_turn(angle, cycles) {
        let text = format!(
            "axis {axis}: with this CommutationOffset a real brushless motor would not turn as it is told; the \
             simulated one follows (model \"follow\")"
        );
        kernel.tell(kernel.tick_start, EventKind::Diagnostic(text));
    }
}

/// The word of a value in the mode that its channel has.
fn pwm(channel: i32, value: i32) -> i32 {
    if channel >= SNAP_AMP { current(value) } else { antiphase(value) }
}

/// Where in its electrical cycle a brushless axis is, in cycles.
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

/// Writes it.
fn write_dac(memory: &mut GuestMemory, axis: AxisId, output: f32) {
    let chan = AxisView::of(memory, axis);
    let (value, channel) = (analog(&chan, output), chan.get(Chan::OUTPUT_CHAN0));
    if let Some(channel) = usize::try_from(channel).ok().filter(|&channel| channel < 8) {
        memory.set(DAC_BUFFER.element(channel), (value.wrapping_sub(2048) & 0xfff) as i16);
    }
}

/// Sine and cosine currents with lead compensation.
fn microstep(memory: &mut GuestMemory, axis: AxisId, position: f64) {
    let angle = TAU * position * memory.axis(axis, Chan::INV_DIST_PER_CYCLE);
    let amplitude = f64::from(memory.axis(axis, Chan::STEPPER_AMPLITUDE));
    let lead = f64::from(memory.axis(axis, Chan::LEAD));
    let phases: [(f64, Field<f32>, Field<i32>); 2] = [
        (amplitude * libm::sin(angle), Chan::X1_LAST, Chan::OUTPUT_CHAN0),
        (amplitude * libm::cos(angle), Chan::X2_LAST, Chan::OUTPUT_CHAN1),
    ];
    for (value, last, channel) in phases {
        let led = value + (value - f64::from(memory.axis(axis, last))) * lead;
        memory.set_axis(axis, last, value as f32);
        let channel = memory.axis(axis, channel);
        store_pwm(memory, channel, pwm(channel, libm::round(led) as i32));
    }
}

/// Applies a three-phase vector. The word says its magnitude only; the phases are the amplifier's.
pub(crate) fn three_phase(memory: &mut GuestMemory, axis: AxisId, v: f32) {
    let value = v.clamp(-MAXV, MAXV) as i16;
    let word = VECTOR | u32::from(value.cast_unsigned());
    let channel = memory.axis(axis, Chan::OUTPUT_CHAN0);
    store_pwm(memory, channel, word.cast_signed());
}

/// Applies a vector to two coils a quarter of a cycle apart; the angle is in cycles.
pub(crate) fn four_phase(memory: &mut GuestMemory, axis: AxisId, v: f32, angle: f64) {
    let magnitude = f64::from(v.clamp(-MAXV, MAXV));
    let angle = TAU * (angle - libm::floor(angle));
    for (value, channel) in [(libm::sin(angle), Chan::OUTPUT_CHAN0), (libm::cos(angle), Chan::OUTPUT_CHAN1)] {
        let channel = memory.axis(axis, channel);
        store_pwm(memory, channel, pwm(channel, libm::round(magnitude * value) as i32));
    }
}

/// Disables an axis: its output goes to zero; profile, destination and filters stay as they are.
pub(crate) fn switch_off(kernel: &mut Kernel, memory: &mut GuestMemory, axis: AxisId) {
    memory.set_axis(axis, Chan::ENABLE, 0);
    kernel.servo.still.interrupt();
    kernel.servo.plants[axis.index()].drive = Drive::None;
    let channels = [memory.axis(axis, Chan::OUTPUT_CHAN0), memory.axis(axis, Chan::OUTPUT_CHAN1)];
    match OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE)) {
        Some(OutputMode::DcServo) => store_pwm(memory, channels[0], recirculate(0)),
        Some(OutputMode::Microstep | OutputMode::ClosedLoopMicrostep | OutputMode::Brushless4Ph) => {
            channels.into_iter().for_each(|channel| store_pwm(memory, channel, recirculate(0)));
        }
        Some(OutputMode::Brushless3Ph) => {
            let pair = [channels[0], channels[0].wrapping_add(1)];
            pair.into_iter().for_each(|channel| store_pwm(memory, channel, recirculate(0)));
        }
        Some(OutputMode::DacServo) => write_dac(memory, axis, 0.0),
        _ => {}
    }
}
