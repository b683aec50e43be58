//! The eight step generators: the number of steps that each has made, and the pins that it claims.
//!
//! An enabled axis in a step mode owns its generator; a program that writes the rate register drives one itself.
//! Positions are updated once per tick; the pulses of a tick are generated only for watched pins, distributed evenly
//! over it. With a real firmware, which writes rates at any cycle, a position is the rate integrated over the cycles
//! since it was written. Sources: io.md sections 5 and 6, axes-and-motion.md section 11, dsp-board.md section 7.3.

use kmotiondef::{AxisId, Bit, Cycles};

use crate::pins::Pins;

/// The number of generators.
pub const GENERATORS: usize = 8;

/// The step pins of the generators, and the pins to which a bit of the pulse register moves the first four; the
/// direction pin is the next one.
const STEP_PINS: [i32; GENERATORS] = [8, 10, 12, 14, 36, 38, 40, 42];
const MOVED_PINS: [i32; 4] = [22, 24, 32, 34];

/// Bits of the pulse register: length, alternative pins, inverted polarity.
const LENGTH: u8 = 0x3f;
const MOVED: u8 = 0x40;
const INVERTED: u8 = 0x80;
/// The pulse length at power-up, in clocks.
const START: u8 = 32;

/// Bits of an axis' output channel: the generator, and quadrature instead of step and direction.
const GENERATOR_BITS: i32 = 7;
const QUADRATURE: i32 = 16;

/// The clocks per second, the processor cycles per clock, and the unit of the rate register.
const CLOCK: f64 = 50e6 / 3.0;
const CLOCK_CYCLES: i64 = 12;
const RATE_UNIT: f64 = CLOCK / (1 << 23) as f64;
/// The unit of a rate, in steps per cycle.
const RATE_UNIT_PER_CYCLE: f64 = 1.0 / CLOCK_CYCLES as f64 / (1 << 23) as f64;
/// The maximum step rate, independent of the pulse length.
const FASTEST: f64 = 2.5e6;
/// The maximum step rate with the pulses of power-up, in steps per second.
const LIMIT: f64 = CLOCK / 2.0 / START as f64;

/// Fields of the rate register: signed rate, an unused bit, generator, enable.
const RATE_BITS: u32 = 23;
const NUMBER_SHIFT: u32 = 24;
const ENABLE: u32 = 1 << 31;

/// The number of fractions of a step in the position register.
const FRACTIONS: f64 = 128.0;

#[derive(Clone, Copy, Debug, Default)]
struct Generator {
    /// The number of steps made since power-up.
    position: f64,
    /// The rate set by a program, in steps per second.
    rate: f64,
    /// The rate as written, without the limit.
    units: i32,
    /// The time up to which `position` includes the rate, if steps are counted exactly.
    since: Cycles,
    /// The upper byte of the position when the lower one was last read.
    upper: u8,
    /// The axis that owns it, and whether its pins carry quadrature.
    owner: Option<(AxisId, bool)>,
    goes_back: bool,
}

/// All generators.
#[derive(Clone, Debug)]
pub struct StepGenerators {
    generators: [Generator; GENERATORS],
    /// The output channel through which each axis owns a generator.
    channels: [Option<i32>; AxisId::MAX as usize + 1],
    settings: u8,
    /// The maximum step rate in steps per second.
    fastest: f64,
    /// Set while a program drives a generator.
    is_driven: bool,
    counting: Counting,
}

/// The method of counting the steps of a rate.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Counting {
    /// Once per tick, by the owner of the board.
    ByTick,
    /// Exactly, to the cycle of each access.
    Exact,
}

/// The step rate that the pulses of a generator allow.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StepLimit {
    /// The maximum step rate in steps per second.
    pub fastest: f64,
    /// The length of a pulse in microseconds.
    pub length: f64,
}

impl Default for StepGenerators {
    fn default() -> Self {
        Self {
            generators: [Generator::default(); GENERATORS],
            channels: [None; AxisId::MAX as usize + 1],
            settings: START,
            fastest: LIMIT,
            is_driven: false,
            counting: Counting::ByTick,
        }
    }
}

/// The maximum step rate in steps per second: a pulse is followed by a pause of its length.
fn max_step_rate(settings: u8) -> f64 {
    FASTEST.min(CLOCK / 2.0 / f64::from((settings & LENGTH).max(1)))
}

/// The generator of an output channel.
pub fn generator_of(channel: i32) -> usize {
    (channel & GENERATOR_BITS) as usize
}

impl StepGenerators {
    /// Generators that a firmware drives through their registers: steps are counted to the cycle, without a limit.
    #[must_use]
    pub fn exact() -> Self {
        Self { counting: Counting::Exact, ..Self::default() }
    }

    /// Assigns the generator of an output channel to an axis; its pins become outputs.
    #[inline]
    pub fn assign(&mut self, axis: AxisId, channel: i32, pins: &mut Pins, now: Cycles) {
        if self.channels[axis.index()] != Some(channel) {
            self.release(axis, pins, now);
            self.channels[axis.index()] = Some(channel);
            let generator = generator_of(channel);
            self.generators[generator].owner = Some((axis, channel & QUADRATURE != 0));
            self.generators[generator].rate = 0.0;
            self.drive(generator, pins, now);
        }
    }

    /// Releases an axis' generator.
    #[inline]
    pub fn release(&mut self, axis: AxisId, pins: &mut Pins, now: Cycles) {
        if self.channels[axis.index()].is_some() {
            self.give_up(axis, pins, now);
        }
    }

    fn give_up(&mut self, axis: AxisId, pins: &mut Pins, now: Cycles) {
        let Some(channel) = self.channels[axis.index()].take() else { return };
        let generator = generator_of(channel);
        if self.generators[generator].owner.is_some_and(|(owner, _)| owner == axis) {
            self.generators[generator].owner = None;
            self.drive(generator, pins, now);
        }
    }

    /// Returns whether a generator in use has its pulses on a pin.
    pub fn drives_pin(&self, bit: Bit) -> bool {
        let in_use = |generator: &usize| self.generators[*generator].owner.is_some();
        (0..self.generators.len()).filter(in_use).any(|generator| self.pins(generator).contains(&Some(bit)))
    }

    /// Returns whether pulses have the length and polarity that they have at power-up.
    pub fn has_start_pulses(&self) -> bool {
        self.settings & (LENGTH | INVERTED) == START
    }

    /// The pins of a generator: step and direction.
    pub fn pins(&self, generator: usize) -> [Option<Bit>; 2] {
        let moved = MOVED_PINS.get(generator).filter(|_| self.settings & MOVED != 0);
        let step = moved.copied().unwrap_or(STEP_PINS[generator]);
        [Bit::new(step), Bit::new(step + 1)]
    }

    /// The levels of both pins between pulses.
    fn levels(&self, generator: usize) -> [bool; 2] {
        let Generator { position, owner, goes_back, .. } = self.generators[generator];
        let is_inverted = self.settings & INVERTED != 0;
        if owner.is_some_and(|(_, is_quadrature)| is_quadrature) {
            let step = (libm::floor(position + 0.5) as i64) & 3;
            return [step == 1 || step == 2, step >= 2];
        }
        [!is_inverted, goes_back == is_inverted]
    }

    /// Sets the pins to their levels between pulses, or returns them to their latches.
    fn drive(&self, generator: usize, pins: &mut Pins, now: Cycles) {
        let Generator { owner, rate, .. } = self.generators[generator];
        let is_on = owner.is_some() || rate != 0.0;
        for (bit, level) in self.pins(generator).into_iter().zip(self.levels(generator)) {
            let Some(bit) = bit else { continue };
            pins.generate(bit, is_on.then_some(level), now);
            if is_on {
                pins.report_level(bit, level, now);
            }
        }
    }

    /// Adds an axis' steps of the tick that ends now.
    pub fn step(&mut self, axis: AxisId, steps: f64, pins: &mut Pins, now: Cycles) {
        if let Some(channel) = self.channels[axis.index()] {
            self.advance(generator_of(channel), steps, pins, now);
        }
    }

    /// Takes the total steps of all generators at the end of a tick, from a board that counts them itself.
    pub fn follow(&mut self, made: [f64; GENERATORS], pins: &mut Pins, now: Cycles) {
        for (generator, made) in made.into_iter().enumerate() {
            let steps = made - self.generators[generator].position;
            if steps != 0.0 {
                self.advance(generator, steps, pins, now);
                self.generators[generator].position = made;
            }
        }
    }

    /// Adds the steps of a tick, and generates their pulses for watched pins.
    fn advance(&mut self, generator: usize, steps: f64, pins: &mut Pins, now: Cycles) {
        let from = self.generators[generator].position;
        self.generators[generator].position += steps;
        let goes_back = steps < 0.0;
        let start = now - Cycles::PER_TICK;
        let Generator { owner, goes_back: went_back, .. } = self.generators[generator];
        let is_quadrature = owner.is_some_and(|(_, is_quadrature)| is_quadrature);
        if steps != 0.0 && went_back != goes_back {
            self.generators[generator].goes_back = goes_back;
            if !is_quadrature {
                self.drive(generator, pins, start);
            }
        }
        if pins.watches_any() {
            self.pulse(generator, (from, from + steps), is_quadrature, pins, start);
        }
        if is_quadrature {
            self.drive(generator, pins, now);
        }
    }

    /// The edges for the steps of a tick: one at each time when the position passes the middle between two steps.
    fn pulse(
        &self,
        generator: usize,
        range: (f64, f64),
        is_quadrature: bool,
        pins: &mut Pins,
        start: Cycles,
    ) {
        let (from, to) = range;
        let (first, last) = (libm::floor(from + 0.5) as i64, libm::floor(to + 0.5) as i64);
        let [Some(step), Some(direction)] = self.pins(generator) else { return };
        if first == last || !pins.is_watched(step) && !pins.is_watched(direction) {
            return;
        }
        let count = last.abs_diff(first) as i64;
        let spacing = Cycles::PER_TICK.get() / count;
        let length = i64::from((self.settings & LENGTH).max(1)) * CLOCK_CYCLES;
        let idle = self.levels(generator)[0];
        for index in 0..count {
            let passed = if last > first { first + index } else { first - index - 1 };
            let part = (passed as f64 + 0.5 - from) / (to - from);
            let at = start + Cycles::new(libm::round(part * Cycles::PER_TICK.get() as f64) as i64);
            if is_quadrature {
                let now = (if last > first { passed + 1 } else { passed }) & 3;
                pins.report_level(step, now == 1 || now == 2, at);
                pins.report_level(direction, now >= 2, at);
            } else {
                pins.report_level(step, !idle, at);
                pins.report_level(step, idle, at + Cycles::new(length.min(spacing / 2)));
            }
        }
    }

    /// Applies the settings of all generators: length and polarity of the pulses, and the selection of pins.
    pub fn set_up(&mut self, settings: u8, pins: &mut Pins, now: Cycles) {
        if settings == self.settings {
            return;
        }
        let in_use = |generator: &usize| {
            let Generator { owner, rate, .. } = self.generators[*generator];
            owner.is_some() || rate != 0.0
        };
        let in_use: Vec<usize> = (0..GENERATORS).filter(in_use).collect();
        for &generator in &in_use {
            self.pins(generator).into_iter().flatten().for_each(|bit| pins.generate(bit, None, now));
        }
        self.settings = settings;
        self.fastest = max_step_rate(settings);
        for &generator in &in_use {
            self.drive(generator, pins, now);
        }
    }

    /// Sets the rate of a generator for a program. In the next tick, a generator owned by an axis returns to that axis'
    /// rate.
    pub fn command(&mut self, word: u32, pins: &mut Pins, now: Cycles) {
        let generator = (word >> NUMBER_SHIFT & 7) as usize;
        if self.generators[generator].owner.is_some() {
            return;
        }
        self.count(generator, now);
        let unused = u32::BITS - RATE_BITS;
        let signed = (word << unused).cast_signed() >> unused;
        let units = if word & ENABLE != 0 { signed } else { 0 };
        let rate = f64::from(units) * RATE_UNIT;
        let held = &mut self.generators[generator];
        held.units = units;
        held.rate = rate.clamp(-self.fastest, self.fastest);
        if self.counting == Counting::Exact && units != 0 {
            held.goes_back = units < 0;
        }
        self.is_driven = self.generators.iter().any(|generator| generator.rate != 0.0);
        self.drive(generator, pins, now);
    }

    /// The maximum number of steps of an axis in a tick.
    #[inline]
    pub fn steps_per_tick(&self, axis: AxisId) -> f64 {
        let per_second = if self.channels[axis.index()].is_some() { self.fastest } else { LIMIT };
        per_second * (Cycles::PER_TICK.get() as f64 / Cycles::PER_SECOND.get() as f64)
    }

    /// The limit of an axis' generator.
    pub fn limit(&self, axis: AxisId) -> Option<StepLimit> {
        let length = f64::from((self.settings & LENGTH).max(1)) / CLOCK * 1e6;
        let has_generator = self.channels[axis.index()].is_some();
        has_generator.then_some(StepLimit { fastest: self.fastest, length })
    }

    /// Returns whether a program drives a generator.
    pub const fn is_driven(&self) -> bool {
        self.is_driven
    }

    /// Advances the generators driven by programs by a tick; returns the steps of each.
    pub fn run(&mut self, seconds: f64, pins: &mut Pins, now: Cycles) -> [f64; GENERATORS] {
        let mut moved = [0.0; GENERATORS];
        for (generator, moved) in moved.iter_mut().enumerate() {
            let steps = self.generators[generator].rate * seconds;
            if steps != 0.0 {
                self.advance(generator, steps, pins, now);
                *moved = steps;
            }
        }
        moved
    }

    /// The number of steps made by a generator.
    pub fn position(&self, generator: usize) -> f64 {
        self.generators.get(generator).map_or(0.0, |generator| generator.position)
    }

    /// The rate of a generator from its rate register, in steps per second.
    pub fn rate(&self, generator: usize) -> f64 {
        self.generators.get(generator).map_or(0.0, |generator| f64::from(generator.units) * RATE_UNIT)
    }

    /// Counts the steps of a generator up to a given time, if they are counted exactly.
    pub fn count(&mut self, generator: usize, now: Cycles) {
        if self.counting == Counting::Exact
            && let Some(Generator { position, units, since, .. }) = self.generators.get_mut(generator)
        {
            let passed = now - std::mem::replace(since, now);
            *position += f64::from(*units) * RATE_UNIT_PER_CYCLE * passed.get() as f64;
        }
    }

    /// The position in the format of its register: nine bits of steps, seven bits of fraction. Its upper byte is stored
    /// for [`position_high_byte`](Self::position_high_byte).
    pub fn read(&mut self, generator: usize, now: Cycles) -> u16 {
        self.count(generator, now);
        let position = libm::floor(self.position(generator) * FRACTIONS) as i64 as u16;
        if let Some(generator) = self.generators.get_mut(generator) {
            generator.upper = (position >> 8) as u8;
        }
        position
    }

    /// The upper byte of the position at the last [read](Self::read), so that both bytes belong to the same time.
    pub fn position_high_byte(&self, generator: usize) -> u8 {
        self.generators.get(generator).map_or(0, |generator| generator.upper)
    }
}

#[cfg(test)]
mod tests {

    use super::*;

    fn bit(number: i32) -> Bit {
        Bit::new(number).expect("a bit")
    }

    fn tick(tick: i64) -> Cycles {
        Cycles::new(tick * Cycles::PER_TICK.get())
    }

    /// Generators with pins 8 and 9 watched, and axis 0 on a channel.
    fn bench(channel: i32) -> (StepGenerators, Pins) {
        let (mut generators, mut pins) = (StepGenerators::default(), Pins::default());
        pins.changes.switch_on(Vec::new());
        pins.watch(bit(8));
        pins.watch(bit(9));
        generators.assign(AxisId::new(0).expect("0"), channel, &mut pins, tick(1));
        (generators, pins)
    }

    /// The changes since the last call: pin, level, nanoseconds since a given time.
    fn told(pins: &mut Pins, since: Cycles) -> Vec<(u16, u8, i64)> {
        let changes = pins.changes.take();
        changes
            .iter()
            .map(|change| (change.bit.get(), u8::from(change.level), (change.at - since).get() * 5))
            .collect()
    }

    #[test]
    fn an_axis_claims_its_pins_and_gives_them_back() {
        let (mut generators, mut pins) = bench(8);
        assert!(pins.is_output(bit(8)) && pins.level(bit(8)) && pins.level(bit(9)));
        assert_eq!(told(&mut pins, tick(1)), [(8, 1, 0), (9, 1, 0)]);
        generators.set_up(32 | INVERTED | MOVED, &mut pins, tick(2));
        assert!(!pins.is_output(bit(8)) && pins.is_output(bit(22)));
        assert!(!pins.level(bit(22)) && !pins.level(bit(23)));
        generators.release(AxisId::new(0).expect("0"), &mut pins, tick(3));
        assert!(!pins.is_output(bit(22)));
    }

    #[test]
    fn steps_are_low_pulses_with_a_direction() {
        let (mut generators, mut pins) = bench(0);
        pins.changes.take();
        let axis = AxisId::new(0).expect("0");
        generators.step(axis, 2.0, &mut pins, tick(2));
        // Between 0 and 1 after a quarter of the tick, between 1 and 2 after three quarters; 1.92 µs long.
        let expect = [(8, 0, 22_500), (8, 1, 24_420), (8, 0, 67_500), (8, 1, 69_420)];
        assert_eq!(told(&mut pins, tick(1)), expect);
        generators.step(axis, -1.0, &mut pins, tick(3));
        assert_eq!(told(&mut pins, tick(2)), [(9, 0, 0), (8, 0, 45_000), (8, 1, 46_920)]);
        assert_eq!(generators.read(0, tick(3)), 128);
    }

    #[test]
    fn quadrature_has_one_edge_per_step() {
        let (mut generators, mut pins) = bench(16);
        pins.changes.take();
        let axis = AxisId::new(0).expect("0");
        generators.step(axis, 3.0, &mut pins, tick(2));
        generators.step(axis, -1.0, &mut pins, tick(3));
        let levels: Vec<_> = told(&mut pins, tick(1)).iter().map(|(bit, level, _)| (*bit, *level)).collect();
        assert_eq!(levels, [(8, 1), (9, 1), (8, 0), (8, 1)]);
    }

    #[test]
    fn a_rate_register_runs_a_generator_that_no_axis_owns() {
        let (mut generators, mut pins) = (StepGenerators::default(), Pins::default());
        // 1000 steps per second on generator 2, and as many back.
        let rate = libm::round(1000.0 / RATE_UNIT) as u32;
        generators.command(ENABLE | 2 << 24 | rate, &mut pins, tick(1));
        assert!(generators.is_driven() && pins.is_output(bit(12)));
        for at in 2..1002 {
            generators.run(90e-6, &mut pins, tick(at));
        }
        assert!((generators.position(2) - 90.0).abs() < 0.1, "{}", generators.position(2));
        // Bit 23 is not part of the rate, and the firmware leaves it clear.
        let back = rate.wrapping_neg() & 0x7f_ffff;
        generators.command(ENABLE | 2 << 24 | back, &mut pins, tick(1002));
        for at in 1003..3003 {
            generators.run(90e-6, &mut pins, tick(at));
        }
        assert!((generators.position(2) + 90.0).abs() < 0.1, "{}", generators.position(2));
        generators.command(2 << 24 | rate, &mut pins, tick(3003));
        assert!(!generators.is_driven() && !pins.is_output(bit(12)));
        let position = f64::from(generators.read(2, tick(3003)).cast_signed()) / FRACTIONS;
        assert!((position + 90.0).abs() < 0.1, "{position}");
    }

    #[test]
    fn long_pulses_limit_the_rate() {
        let (mut generators, mut pins) = (StepGenerators::default(), Pins::default());
        generators.command(ENABLE | 0x3f_ffff, &mut pins, tick(1));
        let [steps, ..] = generators.run(1.0, &mut pins, tick(2));
        assert_eq!(libm::round(steps), 260_417.0);
        let axis = AxisId::new(3).expect("3");
        generators.assign(axis, 8 + 3, &mut pins, tick(3));
        for (settings, expect) in [(63, 132_275.0), (1, 2_500_000.0), (32, 260_417.0)] {
            generators.set_up(settings, &mut pins, tick(3));
            assert_eq!(libm::round(generators.steps_per_tick(axis) / 90e-6), expect, "{settings}");
        }
        let limit = generators.limit(axis).expect("it owns a generator");
        assert_eq!((libm::round(limit.fastest), libm::round(limit.length * 100.0)), (260_417.0, 192.0));
    }

    #[test]
    fn an_exact_generator_counts_to_the_cycle_of_each_access() {
        let (mut generators, mut pins) = (StepGenerators::exact(), Pins::at_power_up());
        generators.command(ENABLE | 2 << NUMBER_SHIFT | 1 << 20, &mut pins, Cycles::new(100));
        assert!((generators.rate(2) - 2_083_333.333).abs() < 0.01, "{}", generators.rate(2));
        // An eighth of a step in twelve cycles.
        for (cycles, steps) in [(12, 0.125), (13, 0.125 * 13.0 / 12.0), (9600, 100.0)] {
            generators.count(2, Cycles::new(100 + cycles));
            assert!((generators.position(2) - steps).abs() < 1e-9, "{}", generators.position(2));
        }
        let position = generators.read(2, Cycles::new(100 + 9600));
        generators.count(2, Cycles::new(1_000_000));
        assert_eq!(u16::from(generators.position_high_byte(2)), position >> 8);
        generators.command(2 << NUMBER_SHIFT, &mut pins, Cycles::new(1_000_000));
        assert_eq!(generators.rate(2), 0.0);
    }
}
