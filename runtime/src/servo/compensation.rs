//! The servo compensation: dead band, PID, feed forward and three filters.
//!
//! Source: axes-and-motion.md section 10. Memories are singles, as their fields are.

use kmotiondef::limits::N_IIR_FILTERS;
use kmotiondef::structs::{Chan, Iir};
use kmotiondef::{AxisId, Field};
use vm::memory::GuestMemory;

use super::{AxisMemory, TIMEBASE};
use crate::views::Typed;

/// Limits `value` to ±`limit`; no limit below 0.
fn clamp(value: f64, limit: f32) -> f64 {
    let limit = f64::from(limit).max(0.0);
    value.clamp(-limit, limit)
}

/// The error after the dead band.
fn dead_band(error: f64, range: f64, gain: f64) -> f64 {
    if error.abs() <= range {
        gain * error
    } else {
        error - libm::copysign(1.0, error) * range * (1.0 - gain)
    }
}

/// One tick: returns the output and stores it.
pub(crate) fn advance(own: &AxisMemory, memory: &mut GuestMemory, axis: AxisId, command: f64) -> f32 {
    let gain = |memory: &GuestMemory, field: Field<f32>| f64::from(memory.axis(axis, field));
    let position = memory.axis(axis, Chan::POSITION);
    let range = gain(memory, Chan::DEAD_BAND_RANGE);
    let error = dead_band(command - position, range, gain(memory, Chan::DEAD_BAND_GAIN));
    let error = clamp(error, memory.axis(axis, Chan::MAX_ERR));
    let sum = gain(memory, Chan::INTEGRATOR) + gain(memory, Chan::I) * error;
    let integrator = clamp(sum, memory.axis(axis, Chan::MAX_I)) as f32;
    memory.set_axis(axis, Chan::INTEGRATOR, integrator);
    let moved = position - memory.axis(axis, Chan::LAST_POSITION);
    memory.set_axis(axis, Chan::LAST_POSITION, position);
    let pid = gain(memory, Chan::P) * error + f64::from(integrator) - gain(memory, Chan::D) * moved;
    let filtered = filter(memory, axis, 0, pid);
    let filtered = filter(memory, axis, 1, filtered);
    // The feed forward sees the destination alone, without backlash and offset.
    let acceleration = (own.velocity - own.last_velocity) / TIMEBASE;
    let forward = gain(memory, Chan::FF_VEL) * own.velocity + gain(memory, Chan::FF_ACCEL) * acceleration;
    let filtered = filter(memory, axis, 2, filtered + forward);
    let output = clamp(filtered, memory.axis(axis, Chan::MAX_OUTPUT)) as f32;
    let last = memory.axis(axis, Chan::OUTPUT);
    memory.set_axis(axis, Chan::PREV_OUTPUT, last);
    memory.set_axis(axis, Chan::OUTPUT, output);
    output
}

/// One tick of a second-order filter, direct form II.
fn filter(memory: &mut GuestMemory, axis: AxisId, number: usize, input: f64) -> f64 {
    debug_assert!(number < N_IIR_FILTERS);
    let iir = Chan::IIR.element(number);
    let get = |memory: &GuestMemory, field: Field<f32>| f64::from(memory.axis(axis, iir.field(field)));
    let (d0, d1) = (get(memory, Iir::D0), get(memory, Iir::D1));
    let inner = input + get(memory, Iir::A1) * d0 + get(memory, Iir::A2) * d1;
    let output = get(memory, Iir::B0) * inner + get(memory, Iir::B1) * d0 + get(memory, Iir::B2) * d1;
    memory.set_axis(axis, iir.field(Iir::D1), d0 as f32);
    memory.set_axis(axis, iir.field(Iir::D0), inner as f32);
    output
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_dead_band_is_continuous() {
        for (error, expect) in [(2.0, 0.0), (3.0, 1.0), (-5.0, -3.0)] {
            assert_eq!(dead_band(error, 2.0, 0.0), expect);
        }
        assert_eq!(dead_band(7.0, 0.0, 1.0), 7.0);
    }
}
