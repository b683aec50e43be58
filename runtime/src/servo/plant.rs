//! The ideal machine behind an axis: its load goes where the axis is driven, and an encoder counts it.
//!
//! Source: plant.md sections 1 and 2, model `follow`. Step generators move the load by their steps, one tick late;
//! closed loops follow with a first-order lag. An axis in NO_OUTPUT mode has no motor.

use kmotiondef::structs::Chan;

use super::TIMEBASE;
use crate::views::AxisView;

/// What a closed loop with a time constant of 0.5 ms follows of the rest in one tick: 1 − exp(−0.09 / 0.5).
const FOLLOWED: f64 = 0.164_729_788_588_728;
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
    /// Position units of one count, and what the encoder has counted at the load `counted`.
    gain: f64,
    register: i64,
    counted: f64,
    /// Where the gain last changed, and the count there.
    base: f64,
    base_count: i64,
    pub(crate) drive: Drive,
}

impl Plant {
    /// The register of the encoder that the load turns; `gain` position units are one count.
    #[inline]
    pub(crate) fn encoder(&mut self, gain: f64) -> i8 {
        if self.load != self.counted || gain != self.gain {
            self.count(gain);
        }
        self.register as i8
    }

    /// Counts to where the load is. Another gain counts from here on: the register does not jump.
    fn count(&mut self, gain: f64) {
        if gain != self.gain {
            (self.base, self.base_count, self.gain) = (self.counted, self.register, gain);
        }
        self.counted = self.load;
        if gain != 0.0 && gain.is_finite() {
            let counts = (self.load - self.base) / gain + 0.5;
            let whole = counts as i64;
            let whole = if counts < whole as f64 { whole - 1 } else { whole };
            self.register = self.base_count.wrapping_add(whole);
        }
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

    /// Something outside moves the load; step generators go on from there.
    pub(crate) fn push(&mut self, units: f64) {
        self.load += units;
        self.origin += units;
    }

    /// Moves the load by what the last tick put out, and takes up a position that a program has written; whether
    /// anything changed.
    #[inline]
    pub(crate) fn advance(&mut self, chan: &AxisView<'_>) -> bool {
        let position = chan.get(Chan::POSITION);
        let was_written = position != self.position;
        if was_written {
            self.shift += position - self.position;
            self.position = position;
        }
        let moved = match self.drive {
            Drive::None => false,
            Drive::Steps(command) if command == self.reached => false,
            Drive::Steps(command) => {
                let steps_per_unit = f64::from(chan.get(Chan::OUTPUT_GAIN)).abs();
                self.step(command, if steps_per_unit > 0.0 { STEPS_PER_TICK / steps_per_unit } else { 0.0 })
            }
            Drive::Loop(command) => self.follow(command, f64::from(chan.get(Chan::INPUT_GAIN0))),
        };
        was_written | moved
    }

    /// Steps towards a command; whether the load moves.
    fn step(&mut self, command: f64, limit: f64) -> bool {
        let before = self.load;
        let step = command - self.reached;
        let limited = step.clamp(-limit, limit);
        self.reached = if step == limited { command } else { self.reached + limited };
        self.load = self.origin + self.reached;
        self.load != before
    }

    /// Follows a command with a lag; whether the load moves.
    fn follow(&mut self, command: f64, gain: f64) -> bool {
        let before = self.load;
        let rest = command - (self.load + self.shift);
        if rest == 0.0 {
            return false;
        }
        let reach = COUNTS_PER_TICK * gain.abs();
        let step = if rest.abs() < NEGLIGIBLE { rest } else { rest * FOLLOWED };
        self.load += if reach > 0.0 { step.clamp(-reach, reach) } else { step };
        self.origin = self.load - self.reached;
        self.load != before
    }
}

/// Fastest stepping: 1 / (2 · 32 clocks of 16.67 MHz), the pulse length at power-up.
const STEPS_PER_TICK: f64 = 16.666_7e6 / 64.0 * TIMEBASE;

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_loop_settles_on_its_command() {
        let mut plant = Plant::default();
        for _ in 0..1000 {
            plant.follow(50.25, 1.0);
        }
        assert_eq!((plant.load, plant.encoder(1.0)), (50.25, 50));
    }

    #[test]
    fn steps_are_limited_in_rate() {
        let mut plant = Plant::default();
        plant.step(100.0, 30.0);
        assert_eq!(plant.load, 30.0);
    }
}
