//! The servo compensation: dead band, PID, feed forward and three filters.
//!
//! Source: axes-and-motion.md section 10. Memories are singles, as their fields are.

use kmotiondef::Field;
use kmotiondef::structs::{Chan, Iir};

use super::{AxisMemory, TIMEBASE};
use crate::views::AxisView;

/// Limits `value` to ±`limit`; no limit below 0.
#[inline]
fn clamp(value: f64, limit: f32) -> f64 {
    let limit = f64::from(limit).max(0.0);
    if value > limit {
        limit
    } else if value < -limit {
        -limit
    } else {
        value
    }
}

/// The error after the dead band.
#[inline]
fn dead_band(error: f64, range: f64, gain: f64) -> f64 {
    if range == 0.0 && gain == 1.0 {
        // None, as at power-up.
        error
    } else if error.abs() <= range {
        gain * error
    } else {
        error - libm::copysign(1.0, error) * range * (1.0 - gain)
    }
}

/// One tick: returns the output and stores it.
pub(crate) fn advance(own: &AxisMemory, chan: &mut AxisView<'_>, command: f64) -> f32 {
    let gain = |chan: &AxisView<'_>, field: Field<f32>| f64::from(chan.get(field));
    let position = chan.get(Chan::POSITION);
    let error =
        dead_band(command - position, gain(chan, Chan::DEAD_BAND_RANGE), gain(chan, Chan::DEAD_BAND_GAIN));
    let error = clamp(error, chan.get(Chan::MAX_ERR));
    let sum = gain(chan, Chan::INTEGRATOR) + gain(chan, Chan::I) * error;
    let integrator = clamp(sum, chan.get(Chan::MAX_I)) as f32;
    chan.set(Chan::INTEGRATOR, integrator);
    let moved = position - chan.get(Chan::LAST_POSITION);
    chan.set(Chan::LAST_POSITION, position);
    let pid = gain(chan, Chan::P) * error + f64::from(integrator) - gain(chan, Chan::D) * moved;
    let filtered = filter(chan, Chan::IIR.element(0), pid);
    let filtered = filter(chan, Chan::IIR.element(1), filtered);
    // The feed forward sees the destination alone, without backlash and offset.
    let mut forward = gain(chan, Chan::FF_VEL) * own.velocity;
    let accelerating = gain(chan, Chan::FF_ACCEL);
    if accelerating != 0.0 {
        forward += accelerating * ((own.velocity - own.last_velocity) / TIMEBASE);
    }
    let filtered = filter(chan, Chan::IIR.element(2), filtered + forward);
    let output = clamp(filtered, chan.get(Chan::MAX_OUTPUT)) as f32;
    let last = chan.get(Chan::OUTPUT);
    chan.set(Chan::PREV_OUTPUT, last);
    chan.set(Chan::OUTPUT, output);
    output
}

/// The coefficients A1, A2, B0, B1, B2 of what is no filter, as at power-up; most are like that.
const PLAIN: [u8; 20] = [0, 0, 0, 0, 0, 0, 0, 0, 0, 0, 0x80, 0x3f, 0, 0, 0, 0, 0, 0, 0, 0];

/// One tick of a second-order filter, direct form II.
#[inline]
fn filter(chan: &mut AxisView<'_>, iir: Field<Iir>, input: f64) -> f64 {
    let get = |chan: &AxisView<'_>, field: Field<f32>| f64::from(chan.get(iir.field(field)));
    let single = |chan: &AxisView<'_>, field: Field<f32>| chan.get(iir.field(field));
    if chan.holds(iir.offset(), &PLAIN) {
        let (d0, d1) = (single(chan, Iir::D0), single(chan, Iir::D1));
        if (d0 + d1).is_finite() {
            chan.set(iir.field(Iir::D1), d0);
            chan.set(iir.field(Iir::D0), input as f32);
            return input;
        }
    }
    let (d0, d1) = (get(chan, Iir::D0), get(chan, Iir::D1));
    let inner = input + get(chan, Iir::A1) * d0 + get(chan, Iir::A2) * d1;
    let output = get(chan, Iir::B0) * inner + get(chan, Iir::B1) * d0 + get(chan, Iir::B2) * d1;
    chan.set(iir.field(Iir::D1), d0 as f32);
    chan.set(iir.field(Iir::D0), inner as f32);
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
