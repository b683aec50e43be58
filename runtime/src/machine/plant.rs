//! The load of one axis: its position, its drive, its encoder. Source: plant.md sections 1 to 4.
//!
//! Without a machine file, an axis goes where it is commanded: step generators move it by their steps, one tick late;
//! closed loops follow with a first-order lag, whatever their gains. With the model `motor` it is driven by the board's
//! actual outputs.

use std::f64::consts::TAU;

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;

use super::description::{Axis, Encoder, Model};
use super::motor::{AmplifierSignal, Motor};
use crate::views::AxisView;

/// The most counts per tick for which an 8-bit encoder register can still distinguish the direction, with some margin.
pub(crate) const COUNTS_PER_TICK: f64 = 120.0;
/// A remaining distance that counts as zero.
const NEGLIGIBLE: f64 = 1e-9;
/// Time constant with which a rotor turns into a constant vector, in seconds.
const DRAG_S: f64 = 0.01;

/// The drive of the load in the next tick.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) enum Drive {
    /// Nothing.
    #[default]
    None,
    /// A step generator or microstepping: the command that it follows, in position units.
    Steps(f64),
    /// A closed loop with this command, and its output.
    Loop(f64, AmplifierSignal),
    /// The output that reaches the motor of an axis that follows no command.
    Open(AmplifierSignal),
    /// A vector on the phases of a disabled axis: magnitude, and angle in cycles.
    Vector(f64, f64),
}

/// The constant properties of the load.
#[derive(Clone, Copy, Debug, PartialEq)]
struct LoadProperties {
    model: Model,
    /// The fraction of the remaining error that a closed loop removes in one tick.
    followed: f64,
    encoder: Scale,
    min: f64,
    max: f64,
    motor: Motor,
}

/// Position units per count of the encoder that the load turns.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Scale {
    /// The axis' own input gain: whatever its value, the position follows the load.
    Axis,
    Units(f64),
    /// There is no encoder.
    Absent,
}

impl Scale {
    fn of(axis: &Axis) -> Self {
        match axis.connection.encoder {
            Encoder::Auto | Encoder::Connected if axis.follows_gain() => Self::Axis,
            Encoder::Auto | Encoder::Connected => Self::Units(1.0 / axis.counts_per_unit),
            Encoder::Absent => Self::Absent,
        }
    }
}

/// The count of the encoder that the load turns.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Counter {
    /// Position units per count, and the load position at which the last count was made.
    gain: f64,
    register: i64,
    counted: f64,
    /// True if that gain allows counting.
    counts: bool,
    /// The load's position at the last change of the gain, and the count at that time.
    base: f64,
    base_count: i64,
}

impl Counter {
    /// Counts up to the position of the load. After a change, the new gain counts from here on, so that the register
    /// does not jump.
    #[inline(always)]
    fn count(&mut self, load: f64, gain: f64) {
        if gain != self.gain {
            (self.base, self.base_count, self.gain) = (self.counted, self.register, gain);
            self.counts = gain != 0.0 && gain.is_finite();
        }
        self.counted = load;
        if self.counts {
            let way = load - self.base;
            // A division would take longer here than the rest of the encoder.
            let counts = if gain == 1.0 { way } else { way / gain } + 0.5;
            let whole = counts as i64;
            let whole = if counts < whole as f64 { whole - 1 } else { whole };
            self.register = self.base_count.wrapping_add(whole);
        }
    }
}

/// The state of the load on a step generator.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Steps {
    /// Command that it has reached.
    reached: f64,
    /// The position of the load at the command 0.
    origin: f64,
    /// The steps of the last tick, whether they should be reported, and whether the amplifier is off.
    stepped: f64,
    has_stepped: bool,
    is_off: bool,
    /// True if more steps were commanded than it can make.
    is_behind: bool,
}

/// One axis' load, in position units of the axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Plant {
    build: LoadProperties,
    /// Machine coordinate of the load.
    pub(crate) load: f64,
    /// Its velocity, if it has a motor.
    velocity: f64,
    /// The difference between the axis' position and the load's.
    shift: f64,
    /// The position as the board last stored it.
    position: f64,
    counter: Counter,
    steps: Steps,
    pub(crate) drive: Drive,
    /// The position before and after a program has written it.
    rewritten: Option<(f64, f64)>,
    /// The hard stop that has held it since the last time.
    stopped_at: Option<f64>,
    torque: Torque,
}

/// The torque that a brushless motor that follows its command would have had.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
struct Torque {
    /// Sum, over some ticks, of the fraction of the current that turns the motor.
    sum: f64,
    ticks: u32,
    is_told: bool,
}

impl Default for Plant {
    fn default() -> Self {
        Self::new(&Axis::default())
    }
}

impl Plant {
    /// The load that a machine file describes.
    pub(crate) fn new(axis: &Axis) -> Self {
        let build = LoadProperties {
            model: axis.model,
            followed: if axis.lag_s > 0.0 { 1.0 - libm::exp(-TIMEBASE / axis.lag_s) } else { 1.0 },
            encoder: Scale::of(axis),
            min: axis.travel.min,
            max: axis.travel.max,
            motor: Motor::new(axis),
        };
        let start = axis.travel.start;
        Self {
            build,
            load: start,
            velocity: 0.0,
            shift: -start,
            position: 0.0,
            counter: Counter {
                gain: 0.0,
                register: 0,
                counted: start,
                counts: false,
                base: start,
                base_count: 0,
            },
            steps: Steps { origin: start, ..Steps::default() },
            drive: Drive::None,
            rewritten: None,
            stopped_at: None,
            torque: Torque::default(),
        }
    }

    /// Position units per count of the encoder that the load turns, if there is one; `gain` is the axis' input gain.
    #[inline(always)]
    pub(crate) fn unit(&self, gain: f64) -> Option<f64> {
        match self.build.encoder {
            Scale::Axis => Some(gain),
            Scale::Units(units) => Some(units),
            Scale::Absent => None,
        }
    }

    /// The register of the encoder that the load turns; `gain` is the axis' input gain.
    #[inline(always)]
    pub(crate) fn encoder(&mut self, gain: f64) -> i8 {
        let Some(gain) = self.unit(gain) else { return 0 };
        let counter = &mut self.counter;
        if self.load != counter.counted || gain != counter.gain {
            counter.count(self.load, gain);
        }
        counter.register as i8
    }

    /// Detaches the encoder from the load: its register keeps its value, and continues from it if the load turns it
    /// again.
    pub(crate) fn hold_encoder(&mut self) -> i8 {
        let counter = &mut self.counter;
        (counter.counted, counter.base, counter.base_count) = (self.load, self.load, counter.register);
        counter.register as i8
    }

    /// Returns, once, whether a real motor would hardly turn under a vector at this angle in cycles, where this model
    /// follows any vector. `own_cycles` is the axis' own value of its cycles.
    pub(crate) fn would_not_turn(&mut self, angle: f64, own_cycles: f64) -> bool {
        const TICKS: u32 = 100;
        const ENOUGH: f64 = 0.3;
        if self.build.model != Model::Follow || self.torque.is_told {
            return false;
        }
        let motor = &self.build.motor;
        let lead = angle - motor.angle(self.load, motor.cycles(own_cycles));
        self.torque.sum += libm::sin(TAU * (lead - libm::floor(lead)));
        self.torque.ticks += 1;
        if self.torque.ticks < TICKS {
            return false;
        }
        let is_enough = self.torque.sum >= ENOUGH * f64::from(TICKS);
        self.torque = Torque { is_told: !is_enough, ..Torque::default() };
        !is_enough
    }

    /// The board has stored this position.
    pub(crate) fn note_position(&mut self, position: f64) {
        self.position = position;
    }

    /// Sets the reference of the step generator to this command, so that enabling does not move the load.
    pub(crate) fn refer_to(&mut self, command: f64) {
        self.steps.reached = command;
        self.steps.origin = self.load - command;
        // The command of the last tick is also relative to it.
        if let Drive::Steps(last) = &mut self.drive {
            *last = command;
        }
    }

    /// Moves the load from outside; step generators continue from the new position.
    pub(crate) fn push(&mut self, units: f64) {
        self.load += units;
        self.steps.origin += units;
    }

    /// The position before and after a program has written it since the last call.
    #[inline(always)]
    pub(crate) fn take_rewritten(&mut self) -> Option<(f64, f64)> {
        self.rewritten.take()
    }

    /// The hard stop that has held the load since the last time.
    #[inline(always)]
    pub(crate) fn take_stopped(&mut self) -> Option<f64> {
        self.stopped_at.take()
    }

    /// Its hard stops.
    pub(crate) const fn ends(&self) -> (f64, f64) {
        (self.build.min, self.build.max)
    }

    /// Another constant load pulls at the motor.
    pub(super) fn set_load(&mut self, speed: f64) {
        self.build.motor.load_with(speed);
    }

    /// The remaining distance to the command of its axis, if it goes there regardless of the output.
    pub(crate) fn rest(&self) -> Option<f64> {
        match self.drive {
            Drive::Steps(command) => Some(command - self.steps.reached),
            Drive::Loop(command, _) if self.build.model == Model::Follow => {
                Some(command - (self.load + self.shift))
            }
            Drive::None | Drive::Loop(..) | Drive::Open(_) | Drive::Vector(..) => None,
        }
    }

    /// Returns whether the board's outputs move it now.
    pub(crate) fn is_driven(&self) -> bool {
        self.build.model != Model::None && self.drive != Drive::None
    }

    /// Returns whether it has a motor that the board's outputs drive.
    #[inline(always)]
    pub(crate) fn has_motor(&self) -> bool {
        self.build.model == Model::Motor
    }

    /// The axis is disabled: its amplifier is off, unless a program applies a vector.
    pub(crate) fn release(&mut self) {
        if !matches!(self.drive, Drive::Vector(..)) {
            self.drive = Drive::None;
        }
    }

    /// Moves the load by the output of the last tick, and adopts a position that a program has written; returns whether
    /// anything changed. An encoder can follow `reach` per tick, a step generator makes at most `steps_per_tick`.
    #[inline(always)]
    pub(crate) fn advance(
        &mut self,
        chan: &AxisView<'_>,
        reach: f64,
        steps_per_tick: impl FnOnce() -> f64,
    ) -> bool {
        let position = chan.get(Chan::POSITION);
        let was_written = position != self.position;
        if was_written {
            self.shift += position - self.position;
            self.rewritten = Some((self.position, position));
            self.position = position;
        }
        let moves = match self.drive {
            Drive::Loop(command, _) if self.build.model == Model::Follow => {
                let before = self.load;
                self.follow(command, reach);
                self.stop_hard();
                self.load != before
            }
            Drive::None if self.velocity == 0.0 && !self.build.motor.is_pulled() => false,
            _ => self.moves(chan, steps_per_tick()),
        };
        was_written | moves
    }

    /// Moves the load for a tick; returns whether it is neither at rest nor equal to its command.
    fn moves(&mut self, chan: &AxisView<'_>, steps_per_tick: f64) -> bool {
        let before = self.load;
        match (self.build.model, self.drive) {
            (Model::None, _) | (Model::Follow, Drive::Loop(..)) => return false,
            (Model::Follow | Model::Motor, Drive::None) => self.run(AmplifierSignal::Pwm(0.0), chan),
            (_, Drive::Open(applied)) => self.run(applied, chan),
            (_, Drive::Steps(command)) if command == self.steps.reached => return false,
            (_, Drive::Steps(command)) => {
                let steps_per_unit = f64::from(chan.get(Chan::OUTPUT_GAIN)).abs();
                if steps_per_unit == 0.0 || !steps_per_unit.is_finite() {
                    // The command makes no steps.
                    self.refer_to(command);
                    return false;
                }
                self.step(command, steps_per_tick / steps_per_unit);
            }
            (_, Drive::Vector(magnitude, angle)) => self.turn(magnitude, angle, chan),
            (Model::Motor, Drive::Loop(_, applied)) => self.run(applied, chan),
        }
        self.stop_hard();
        self.load != before || self.velocity != 0.0 || self.steps.stepped != 0.0
    }

    /// Steps towards a command.
    fn step(&mut self, command: f64, limit: f64) {
        let step = command - self.steps.reached;
        self.steps.stepped = step.clamp(-limit, limit);
        self.steps.has_stepped = true;
        self.steps.is_behind |= step != self.steps.stepped;
        self.steps.reached =
            if step == self.steps.stepped { command } else { self.steps.reached + self.steps.stepped };
        if self.steps.is_off {
            self.steps.origin = self.load - self.steps.reached;
        } else {
            self.load = self.steps.origin + self.steps.reached;
        }
    }

    /// Returns whether the step generator has made steps since the last call, or was commanded to.
    pub(crate) const fn has_stepped(&self) -> bool {
        self.steps.has_stepped
    }

    /// Position units that the step generator has output since the last call.
    pub(crate) fn take_stepped(&mut self) -> f64 {
        self.steps.has_stepped = false;
        std::mem::take(&mut self.steps.stepped)
    }

    /// Returns whether the step generator could not follow its command since the last call.
    pub(crate) fn take_behind(&mut self) -> bool {
        std::mem::take(&mut self.steps.is_behind)
    }

    /// Switches the amplifier of the step generator on or off; without it the steps are lost.
    pub(crate) fn set_amplifier(&mut self, is_on: bool) {
        self.steps.is_off = !is_on;
    }

    /// Follows a command with a lag, by at most `reach` per tick; 0 for no limit.
    #[inline(always)]
    fn follow(&mut self, command: f64, reach: f64) {
        let rest = command - (self.load + self.shift);
        if rest == 0.0 {
            return;
        }
        let step = if rest.abs() < NEGLIGIBLE { rest } else { rest * self.build.followed };
        self.load += if step.abs() > reach && reach > 0.0 { libm::copysign(reach, step) } else { step };
        self.steps.origin = self.load - self.steps.reached;
    }

    /// Runs its motor for a tick.
    fn run(&mut self, applied: AmplifierSignal, chan: &AxisView<'_>) {
        let last = self.velocity;
        let cycles = f64::from_bits(chan.get(Chan::INV_DIST_PER_CYCLE).to_bits());
        self.velocity = self.build.motor.advance(last, applied, self.load, cycles);
        self.load += f64::midpoint(last, self.velocity) * TIMEBASE;
        self.steps.origin = self.load - self.steps.reached;
    }

    /// Turns the rotor towards a vector: to the nearest place where it rests.
    fn turn(&mut self, magnitude: f64, angle: f64, chan: &AxisView<'_>) {
        if magnitude == 0.0 {
            return;
        }
        let cycles = self.build.motor.cycles(chan.get(Chan::INV_DIST_PER_CYCLE));
        let lead = angle - self.build.motor.angle(self.load, cycles);
        let lead = lead - libm::floor(lead + 0.5);
        if lead.abs() > NEGLIGIBLE && cycles != 0.0 {
            self.load += lead / cycles * (1.0 - libm::exp(-TIMEBASE / DRAG_S));
            self.steps.origin = self.load - self.steps.reached;
        }
    }

    /// Holds the load at its hard stops: a stepper loses steps there, a motor stalls.
    #[inline(always)]
    fn stop_hard(&mut self) {
        let is_beyond = self.load > self.build.max;
        if is_beyond || self.load < self.build.min {
            let held = if is_beyond { self.build.max } else { self.build.min };
            self.load = held;
            self.stopped_at = Some(held);
            self.velocity = 0.0;
            self.steps.origin = held - self.steps.reached;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::machine::description::Travel;

    #[test]
    fn a_loop_settles_on_its_command() {
        let mut plant = Plant::default();
        for _ in 0..1000 {
            plant.follow(50.25, COUNTS_PER_TICK);
        }
        assert_eq!((plant.load, plant.encoder(1.0)), (50.25, 50));
    }

    #[test]
    fn steps_are_limited_in_rate() {
        let mut plant = Plant::default();
        plant.step(100.0, 30.0);
        assert_eq!(plant.load, 30.0);
    }

    #[test]
    fn steps_are_lost_while_the_amplifier_is_off() {
        let mut plant = Plant::default();
        for (is_on, command, expect) in [(true, 10.0, 10.0), (false, 30.0, 10.0), (true, 35.0, 15.0)] {
            plant.set_amplifier(is_on);
            plant.step(command, 100.0);
            assert_eq!(plant.load, expect, "{command}");
        }
        assert_eq!(plant.take_stepped(), 5.0);
    }

    #[test]
    fn changing_the_gain_does_not_move_the_register() {
        let mut plant = Plant::default();
        plant.push(100.0);
        assert_eq!(plant.encoder(1.0), 100);
        assert_eq!(plant.encoder(0.5), 100);
        plant.push(1.0);
        assert_eq!(plant.encoder(0.5), 102);
    }

    #[test]
    fn a_stepper_loses_steps_at_its_stop() {
        let mut plant =
            Plant::new(&Axis { travel: Travel { max: 50.0, ..Travel::default() }, ..Axis::default() });
        plant.step(100.0, 1000.0);
        plant.stop_hard();
        plant.step(90.0, 1000.0);
        assert_eq!(plant.load, 40.0);
    }
}
