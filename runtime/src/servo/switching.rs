//! Switching axes on and off, and setting them to zero.

use kmotiondef::modes::{OutputMode, RestOutputs};
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::{AxisId, GuestAddr};
use vm::memory::GuestMemory;

use super::cache::Invalidation;
use super::output::clear_dac;
use super::state::{AxisMemory, Servo};
use crate::io::amplifiers::{recirculate, store_pwm};
use crate::machine::{Drive, Machine};
use crate::views::TypedAccess;

/// Puts an axis at a destination and enables it.
pub(crate) fn enable(
    servo: &mut Servo,
    machine: &mut Machine,
    memory: &mut GuestMemory,
    axis: AxisId,
    dest: f64,
) {
    memory.set_axis(axis, Chan::PCOEFF, GuestAddr::NULL);
    for field in [Chan::DEST, Chan::LAST_DEST, Chan::PREV_DEST] {
        memory.set_axis(axis, field, dest);
    }
    clear_filters(memory, axis);
    clear_backlash(memory, axis, dest);
    memory.set_axis(axis, Chan::LAST_NON_ZERO_DIR, 0);
    memory.set_axis(axis, Chan::DIRECTION_OF_MOTION, 0);
    memory.set_axis(axis, Chan::LAST_VEL, 0.0);
    memory.set_axis(axis, Chan::ENABLE, 1);
    servo.cache.invalidate(Invalidation::Motion);
    servo.axes[axis.index()] = AxisMemory::rest(dest);
    machine.loads[axis].refer_to(dest);
}

/// Makes the present place of an axis its zero.
pub(crate) fn zero(servo: &mut Servo, machine: &mut Machine, memory: &mut GuestMemory, axis: AxisId) {
    memory.set_axis(axis, Chan::PCOEFF, GuestAddr::NULL);
    // The place in the electrical cycle stays the same.
    let commutation =
        f64::from(memory.axis(axis, Chan::COMMUTATION_OFFSET)) + memory.axis(axis, Chan::POSITION);
    memory.set_axis(axis, Chan::COMMUTATION_OFFSET, commutation as f32);
    memory.set_axis(axis, Chan::POSITION, 0.0);
    for field in [Chan::DEST, Chan::LAST_DEST, Chan::PREV_DEST] {
        memory.set_axis(axis, field, 0.0);
    }
    clear_filters(memory, axis);
    memory.set_axis(axis, Chan::LAST_NON_ZERO_DIR, 0);
    memory.set_axis(axis, Chan::DIRECTION_OF_MOTION, 0);
    // An axis that is already enabled is enabled again.
    if memory.axis(axis, Chan::ENABLE) != 0 {
        memory.set_axis(axis, Chan::LAST_VEL, 0.0);
        clear_backlash(memory, axis, 0.0);
    }
    output_nothing(memory, axis);
    servo.cache.invalidate(Invalidation::Motion);
    servo.axes[axis.index()] = AxisMemory::rest(0.0);
    machine.loads[axis].refer_to(0.0);
}

/// Clears the state of an axis' compensation; its feed forward continues.
pub(crate) fn reset_filters(servo: &mut Servo, memory: &mut GuestMemory, axis: AxisId) {
    clear_filters(memory, axis);
    servo.cache.invalidate(Invalidation::Motion);
}

/// Takes backlash as compensated at a destination.
fn clear_backlash(memory: &mut GuestMemory, axis: AxisId, dest: f64) {
    memory.set_axis(axis, Chan::BACKLASH, 0.0);
    memory.set_axis(axis, Chan::BACKLASH_DIRECTION, 0);
    memory.set_axis(axis, Chan::PREV_BACKLASH_DEST, dest as f32);
}

/// Clears the state of the compensation.
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

/// Disables an axis: its output goes to zero; profile, destination and filters are unchanged.
pub(crate) fn switch_off(servo: &mut Servo, machine: &mut Machine, memory: &mut GuestMemory, axis: AxisId) {
    memory.set_axis(axis, Chan::ENABLE, 0);
    servo.cache.invalidate(Invalidation::SwitchedOff);
    machine.loads[axis].drive = Drive::None;
    output_nothing(memory, axis);
}

/// Sets the outputs of an axis to zero.
fn output_nothing(memory: &mut GuestMemory, axis: AxisId) {
    let channels = [memory.axis(axis, Chan::OUTPUT_CHAN0), memory.axis(axis, Chan::OUTPUT_CHAN1)];
    let mode = OutputMode::new(memory.axis(axis, Chan::OUTPUT_MODE));
    let mut stop = |channels: &[i32]| {
        channels.iter().for_each(|&channel| store_pwm(memory, channel, recirculate(0)));
    };
    let Some(mode) = mode else { return };
    match mode.traits().at_rest {
        RestOutputs::Nothing => {}
        RestOutputs::First => stop(&channels[..1]),
        RestOutputs::Both => stop(&channels),
        RestOutputs::FirstAndNext => stop(&[channels[0], channels[0].wrapping_add(1)]),
        RestOutputs::Analog => {
            clear_dac(memory, axis);
        }
    }
}
