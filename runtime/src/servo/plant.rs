//! The ideal machine behind an axis: its load goes where the axis is driven, and an encoder counts it.
//!
//! Source: plant.md sections 1 and 2, model `follow`. Step generators move the load by their steps, one tick late;
//! closed loops follow with a first-order lag. An axis in NO_OUTPUT mode has no motor.

use kmotiondef::AxisId;
use kmotiondef::structs::Chan;
use vm::memory::GuestMemory;

use super::TIMEBASE;
use crate::views::Typed;

/// Time constant of a closed loop in seconds.
const LAG: f64 = 0.000_5;
/// Counts in one tick that an 8-bit encoder register can tell from going backwards, with some room.
const COUNTS_PER_TICK: f64 = 120.0;
/// A remaining distance that counts as none.
const NEGLIGIBLE: f64 = 1e-9;

/// What drives the load in the next tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Drive {
    /// Nothing.
    #[default]
    None,
    /// A step generator or microstepping: the command it goes to, in position units.
    Steps(f64),
    /// A closed loop with this command.
    Loop(f64),
}

/// One axis' load, in position units of the axis.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Plant {
    /// Machine coordinate of the load; 0 at power-up.
    pub(crate) load: f64,
    /// What the axis' position is beyond the load.
    shift: f64,
    /// The position as the board last stored it.
    position: f64,
    /// Command that the step generator has reached.
    reached: f64,
    /// Where the load is when that command is 0.
    origin: f64,
    pub(crate) drive: Drive,
}

impl Plant {
    /// The register of the encoder that the load turns; `gain` position units are one count.
    pub(crate) fn encoder(&self, gain: f64) -> i8 {
        if gain == 0.0 || !gain.is_finite() {
            return 0;
        }
        let counts = libm::floor(self.load / gain + 0.5);
        // The register is the low byte.
        (counts as i64) as i8
    }

    /// The board has stored this position.
    pub(crate) fn note_position(&mut self, position: f64) {
        self.position = position;
    }

    /// The step generator stands at this command: enabling moves nothing.
    pub(crate) fn refer_to(&mut self, command: f64) {
        self.reached = command;
        self.origin = self.load - command;
    }

    /// Moves the load for one tick.
    fn advance(&mut self, gain: f64, step_limit: f64) {
        match self.drive {
            Drive::None => {}
            Drive::Steps(command) => {
                let step = command - self.reached;
                let limited = step.clamp(-step_limit, step_limit);
                self.reached = if step == limited { command } else { self.reached + limited };
                self.load = self.origin + self.reached;
            }
            Drive::Loop(command) => {
                let rest = command - (self.load + self.shift);
                let reach = COUNTS_PER_TICK * gain.abs();
                let step =
                    if rest.abs() < NEGLIGIBLE { rest } else { rest * (1.0 - libm::exp(-TIMEBASE / LAG)) };
                self.load += if reach > 0.0 { step.clamp(-reach, reach) } else { step };
                self.origin = self.load - self.reached;
            }
        }
    }
}

/// Fastest stepping: 1 / (2 · 32 clocks of 16.67 MHz), the pulse length at power-up.
const STEPS_PER_TICK: f64 = 16.666_7e6 / 64.0 * TIMEBASE;

/// Moves the load of an axis by what the last tick put out, and takes up positions that a program has written.
pub(crate) fn advance(plant: &mut Plant, memory: &GuestMemory, axis: AxisId) {
    let position = memory.axis(axis, Chan::POSITION);
    plant.shift += position - plant.position;
    plant.position = position;
    let steps_per_unit = f64::from(memory.axis(axis, Chan::OUTPUT_GAIN)).abs();
    let limit = if steps_per_unit > 0.0 { STEPS_PER_TICK / steps_per_unit } else { 0.0 };
    plant.advance(f64::from(memory.axis(axis, Chan::INPUT_GAIN0)), limit);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_settles_on_its_command() {
        let mut plant = Plant { drive: Drive::Loop(50.25), ..Plant::default() };
        for _ in 0..1000 {
            plant.advance(1.0, 1.0);
        }
        assert_eq!((plant.load, plant.encoder(1.0), plant.encoder(-1.0)), (50.25, 50, -50));
    }

    #[test]
    fn steps_are_limited_in_rate() {
        let mut plant = Plant { drive: Drive::Steps(100.0), ..Plant::default() };
        plant.advance(1.0, 30.0);
        assert_eq!(plant.load, 30.0);
    }
}
