//! The loads of the axes, which follow as on the modelled board without a machine file (`plant.md` 2, model `follow`).
//!
//! The load of a closed loop follows the axis' command with a lag of 0.5 ms while the axis is enabled; a step generator
//! moves its load by its steps. Encoders count the loads. The axes are read from the firmware's memory, at its
//! addresses for them.

use chips::stepgen::generator_of;
use kmotiondef::limits::{N_CHANNELS, TIMEBASE};
use kmotiondef::modes::{InputMode, OutputMode};
use kmotiondef::structs::Chan;
use kmotiondef::{Field, GuestAddr};
use vm::memory::GuestMemory;

use super::external::ExternalHardware;
use super::window::Window;

/// The lag of a closed loop in seconds.
const LAG: f64 = 0.000_5;
/// The maximum number of counts in a tick for which an 8-bit register shows the right direction, with a margin.
const REACH: f64 = 120.0;
/// A distance that is treated as 0.
const NEGLIGIBLE: f64 = 1e-9;

/// One load, in position units, with the state of its encoder.
#[derive(Clone, Copy, Debug, Default)]
struct Load {
    load: f64,
    counts: f64,
    /// The steps of the generator at the last update.
    steps: Option<f64>,
}

/// The loads of all axes.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Loads([Load; N_CHANNELS]);

/// An axis in the firmware's memory.
struct Axis<'a> {
    memory: &'a GuestMemory,
    base: GuestAddr,
}

impl Axis<'_> {
    fn int(&self, field: Field<i32>) -> i32 {
        self.memory.peek(self.base.offset(field.offset()))
    }

    fn single(&self, field: Field<f32>) -> f64 {
        f64::from(self.memory.peek::<f32>(self.base.offset(field.offset())))
    }

    fn double(&self, field: Field<f64>) -> f64 {
        self.memory.peek(self.base.offset(field.offset()))
    }
}

impl Loads {
    /// Moves all loads by the output of the last tick, and updates the encoders.
    pub(super) fn tick<A: ExternalHardware>(
        &mut self,
        chan: GuestAddr,
        memory: &GuestMemory,
        window: &mut Window<A>,
        now: u64,
    ) {
        for (number, load) in (0..).zip(&mut self.0) {
            let axis = Axis { memory, base: chan.offset(Chan::STRUCTURE.size * number) };
            let before = load.load;
            load.advance(&axis, window, now);
            if InputMode::new(axis.int(Chan::INPUT_MODE)) == Some(InputMode::Encoder) {
                load.count(load.load - before, axis.single(Chan::INPUT_GAIN0));
                let channel = axis.int(Chan::INPUT_CHAN0);
                if let Ok(channel) = usize::try_from(channel) {
                    window.chips.encoders.set(channel, libm::floor(load.counts + 0.5) as i64 as u8);
                }
            }
        }
    }
}

impl Load {
    fn advance<A: ExternalHardware>(&mut self, axis: &Axis<'_>, window: &mut Window<A>, now: u64) {
        let is_enabled = axis.int(Chan::ENABLE) != 0;
        let mode = OutputMode::new(axis.int(Chan::OUTPUT_MODE));
        match mode {
            Some(OutputMode::StepDir) if is_enabled => self.step(axis, window, now),
            Some(OutputMode::Microstep) if is_enabled => self.load = axis.double(Chan::DEST),
            Some(
                OutputMode::DcServo
                | OutputMode::Brushless3Ph
                | OutputMode::Brushless4Ph
                | OutputMode::DacServo
                | OutputMode::ClosedLoopStepDir
                | OutputMode::ClosedLoopMicrostep,
            ) if is_enabled => self.follow_command(axis),
            Some(_) | None => self.steps = None,
        }
    }

    /// Moves the load by the generator's steps since the last tick.
    fn step<A: ExternalHardware>(&mut self, axis: &Axis<'_>, window: &mut Window<A>, now: u64) {
        let (steps, _) = window.steps(generator_of(axis.int(Chan::OUTPUT_CHAN0)), now);
        let made = steps - self.steps.replace(steps).unwrap_or(steps);
        let gain = axis.single(Chan::OUTPUT_GAIN);
        if gain != 0.0 {
            self.load += made / gain;
        }
    }

    /// Moves the load towards the command, limited by the number of counts that an encoder can follow.
    fn follow_command(&mut self, axis: &Axis<'_>) {
        let rest = axis.double(Chan::DEST) - axis.double(Chan::POSITION);
        let step = if rest.abs() < NEGLIGIBLE { 0.0 } else { rest * (1.0 - libm::exp(-TIMEBASE / LAG)) };
        let reach = REACH * axis.single(Chan::INPUT_GAIN0).abs();
        self.load += step.clamp(-reach, reach);
    }

    fn count(&mut self, moved: f64, gain: f64) {
        if gain != 0.0 && moved != 0.0 {
            self.counts += moved / gain;
        }
    }
}
