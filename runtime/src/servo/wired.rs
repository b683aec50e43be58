//! Motors that the machine file connects to an output: they are driven by the output's value, whoever writes it.
//!
//! The analog outputs and the words of the PWM channels are in guest memory, where the servo and programs write them. A
//! load with a motor whose axis drives an analog output is driven by that in the same way.

use kmotiondef::AxisId;
use kmotiondef::limits::{MAX_PWM_VALUE, MAX_PWMC_VALUE, MAX_PWMR_VALUE};
use kmotiondef::modes::OutputMode;
use kmotiondef::structs::Chan;
use kmotiondef::variables::LAST_PWM;
use vm::memory::GuestMemory;

use super::output::load_drive;
use crate::io::Io;
use crate::io::bits::bit_state;
use crate::machine::wiring::{channel_of, dac_value};
use crate::machine::{AmplifierSignal, Channel, Drive, Machine};
use crate::views::{AxisView, TypedAccess};

/// Returns the drive of an axis' load in this tick, if it is not the axis' own output.
#[inline(always)]
pub(crate) fn drive(machine: &Machine, io: &Io, memory: &mut GuestMemory, axis: AxisId) -> Option<Drive> {
    let wired = machine.wiring.drive(axis);
    if wired.is_none() && !machine.loads[axis].has_motor() {
        return None;
    }
    carried_to(io, memory, axis, wired)
}

/// Returns the drive of an axis whose drive is wired, or whose load has a motor.
fn carried_to(io: &Io, memory: &mut GuestMemory, axis: AxisId, wired: Option<Channel>) -> Option<Drive> {
    let own = channel_of(memory, axis);
    match wired.or(own.filter(|channel| matches!(channel, Channel::Dac(_))))? {
        // The steps of another axis are applied as pushes, those of its own axis as usual.
        Channel::Generator(_) if matches!(own, Some(Channel::Generator(_))) => None,
        Channel::Generator(_) => Some(Drive::None),
        Channel::Dac(dac) => {
            let applied = AmplifierSignal::Dac(f64::from(dac_value(memory, dac)));
            Some(match driver(memory, Channel::Dac(dac)) {
                Some(axis) => Drive::Loop(command(memory, axis), applied),
                None => Drive::Open(applied),
            })
        }
        Channel::Relays(forward, back) => {
            let level = |bit| f64::from(u8::from(bit_state(io, memory, bit).0));
            // One count of an analog output: `ku` is the speed.
            Some(Drive::Open(AmplifierSignal::Dac(level(forward) - level(back))))
        }
        Channel::Pwm(pwm) => Some(match driver(memory, Channel::Pwm(pwm)) {
            Some(axis) => load_drive(&AxisView::of(memory, axis), 0.0),
            None => Drive::Open(amplifier_signal(memory.get(LAST_PWM.element(pwm)))),
        }),
    }
}

/// The enabled axis that outputs to a channel.
pub(crate) fn driver(memory: &GuestMemory, channel: Channel) -> Option<AxisId> {
    memory
        .axes()
        .iter()
        .find(|axis| memory.axis(*axis, Chan::ENABLE) != 0 && channel_of(memory, *axis) == Some(channel))
}

fn command(memory: &mut GuestMemory, axis: AxisId) -> f64 {
    super::command(&AxisView::of(memory, axis))
}

/// Returns the signal to a motor from a PWM channel's word. A vector turns nothing without an angle from an axis.
fn amplifier_signal(word: i32) -> AmplifierSignal {
    let within = |value: i32, limit: i32| (-limit..=limit).contains(&value).then(|| f64::from(value));
    let current = within(word.wrapping_sub(41_984), MAX_PWMC_VALUE).map(AmplifierSignal::Current);
    let antiphase = within(word.wrapping_sub(1280), MAX_PWM_VALUE);
    let recirculate = within(if word < 512 { word } else { 512_i32.wrapping_sub(word) }, MAX_PWMR_VALUE);
    current.unwrap_or_else(|| {
        AmplifierSignal::Pwm(antiphase.or(recirculate.filter(|_| word >= 0)).unwrap_or(0.0))
    })
}

/// Returns whether the steps of an axis move its own load, unless a machine file connects the generator or the motor
/// elsewhere.
pub(crate) fn steps_are_own(machine: &Machine, memory: &GuestMemory, axis: AxisId) -> bool {
    let Some(Channel::Generator(generator)) = channel_of(memory, axis) else { return true };
    let owner = machine.wiring.motor_on(generator);
    let wired = machine.wiring.drive(axis);
    owner.is_none_or(|owner| owner == axis)
        && wired.is_none_or(|wired| wired == Channel::Generator(generator))
}

/// Moves the load that a machine file connects to the generator of an axis, if it belongs to another axis.
pub(crate) fn step_other(machine: &mut Machine, memory: &GuestMemory, axis: AxisId, steps: f64) {
    if !OutputMode::has_generator(OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE))) {
        return;
    }
    let Some(Channel::Generator(generator)) = channel_of(memory, axis) else { return };
    let Some(owner) = machine.wiring.motor_on(generator).filter(|owner| *owner != axis) else { return };
    let gain = f64::from(memory.axis(owner, Chan::OUTPUT_GAIN));
    if gain != 0.0 && steps != 0.0 {
        machine.loads.push(owner, steps / gain);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::io::amplifiers::{antiphase, current, recirculate};

    #[test]
    fn words_of_every_kind_are_decoded() {
        for value in [-100, 0, 100] {
            let number = f64::from(value);
            assert_eq!(amplifier_signal(antiphase(value)), AmplifierSignal::Pwm(number));
            assert_eq!(amplifier_signal(recirculate(value)), AmplifierSignal::Pwm(number));
            assert_eq!(amplifier_signal(current(value)), AmplifierSignal::Current(number));
        }
        assert_eq!(amplifier_signal(0x8000_0064_u32.cast_signed()), AmplifierSignal::Pwm(0.0));
    }
}
