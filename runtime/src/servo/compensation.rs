//! The servo compensation: dead band, PID, feed forward and three filters.
//!
//! Source: axes-and-motion.md section 10. The board computes in singles from the error on; the expressions here have
//! the same order of operations, as measured with random gains and filters.

use kmotiondef::Field;
use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::{Chan, Iir};

use super::plan::{Filter, Gains};
use super::state::AxisMemory;
use super::trajectory::TICKS_PER_SECOND;
use crate::views::AxisView;

/// Limits `value` to ±`limit`, which is not below 0; NaN is unchanged.
#[inline(always)]
fn clamp(value: f32, limit: f32) -> f32 {
    let value = if limit < value { limit } else { value };
    if -limit > value { -limit } else { value }
}

/// The error after the dead band.
fn dead_band(error: f32, range: f32, gain: f32) -> f32 {
    if error.abs() <= range {
        gain * error
    } else {
        error - libm::copysignf(1.0, error) * (range * (1.0 - gain))
    }
}

/// One tick: returns the output and stores it.
#[inline(always)]
pub(crate) fn advance(own: &AxisMemory, gains: &Gains, chan: &mut AxisView<'_>, command: f64) -> f32 {
    let position = chan.get(Chan::POSITION);
    let mut error = (command - position) as f32;
    if let Some((range, slope)) = gains.dead_band {
        error = dead_band(error, range, slope);
    }
    let error = clamp(error, gains.max_err);
    let integrator = clamp(chan.get(Chan::INTEGRATOR) + gains.i * error, gains.max_i);
    chan.set(Chan::INTEGRATOR, integrator);
    let moved = position - chan.get(Chan::LAST_POSITION);
    chan.set(Chan::LAST_POSITION, position);
    let moved = if gains.derives_error { moved - f64::from(own.velocity) * TIMEBASE } else { moved };
    let pid = gains.p * error + integrator - gains.d * moved as f32;
    let [first, second, last] = &gains.filters;
    let filtered = filter(chan, Chan::IIR.element(0), first, pid);
    let filtered = filter(chan, Chan::IIR.element(1), second, filtered);
    // The feed forward only depends on the destination, without backlash and offset.
    let mut forward = gains.ff_vel * own.velocity;
    if gains.ff_accel != 0.0 {
        let change = f64::from(own.velocity - own.last_velocity);
        forward += gains.ff_accel * (change * TICKS_PER_SECOND) as f32;
    }
    let filtered = filter_forward(chan, Chan::IIR.element(2), last, filtered, forward);
    let output = clamp(filtered, gains.max_output);
    let last = chan.get(Chan::OUTPUT);
    chan.set(Chan::PREV_OUTPUT, last);
    chan.set(Chan::OUTPUT, output);
    output
}

/// One tick of a second-order filter, direct form II.
#[inline(always)]
fn filter(chan: &mut AxisView<'_>, iir: Field<Iir>, filter: &Filter, input: f32) -> f32 {
    filter_with(chan, iir, filter, input, |inner| inner)
}

/// One tick of the last filter: the board adds the feed forward to the sum of the input and the kept values.
#[inline(always)]
fn filter_forward(
    chan: &mut AxisView<'_>,
    iir: Field<Iir>,
    filter: &Filter,
    input: f32,
    forward: f32,
) -> f32 {
    filter_with(chan, iir, filter, input, |inner| forward + inner)
}

#[inline(always)]
fn filter_with(
    chan: &mut AxisView<'_>,
    iir: Field<Iir>,
    filter: &Filter,
    input: f32,
    add: impl Fn(f32) -> f32,
) -> f32 {
    let (d0, d1) = (chan.get(iir.field(Iir::D0)), chan.get(iir.field(Iir::D1)));
    chan.set(iir.field(Iir::D1), d0);
    // NaN and infinities also pass through factors of 0.
    if filter.is_plain && (d0 + d1).is_finite() {
        let output = add(input);
        chan.set(iir.field(Iir::D0), output);
        return output;
    }
    let inner = add(input + (filter.a1 * d0 + filter.a2 * d1));
    chan.set(iir.field(Iir::D0), inner);
    filter.b0 * inner + (filter.b1 * d0 + filter.b2 * d1)
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
