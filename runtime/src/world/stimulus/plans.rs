//! Planned and active actions: due statements, ends of pulses, curves of analog inputs, turning encoders.

use std::collections::BTreeMap;

use kmotiondef::{AxisId, Bit, Cycles};
use vm::firmware::TickContext;

use super::wave::Wave;
use crate::world::WorldAccess;
use chips::kanalog::{ADC_CHANNELS, conversion};

/// The limit of planned actions.
pub const MOST_PLANNED: usize = 100_000;

/// An event that is due at an instant.
#[derive(Clone, Copy, Debug)]
pub(super) enum DueEvent {
    /// A rule.
    Rule(usize),
    /// A pulse ends: the level before it.
    Level(Bit, bool),
    /// A pulse ends on an input that a switch drives.
    Release(Bit),
    /// The deadline of an expected event has passed.
    Check,
}

/// Something that moves for a time.
#[derive(Clone, Copy, Debug)]
pub(crate) enum MovingObject {
    /// The encoder on an input, by counts.
    Encoder(usize),
    /// The load of an axis, by units.
    Load(AxisId),
}

/// A motion in progress.
#[derive(Clone, Copy, Debug)]
struct TimedMotion {
    moved: MovingObject,
    distance: f64,
    begun: Cycles,
    over: Cycles,
    /// The distance already covered.
    done: f64,
}

/// All actions that continue by themselves.
#[derive(Clone, Debug)]
pub(crate) struct Plans {
    /// The pending events, by time and then in the order of planning.
    due: BTreeMap<(Cycles, u64), DueEvent>,
    count: u64,
    waves: [Option<(Wave, Cycles)>; ADC_CHANNELS],
    turning: Vec<TimedMotion>,
    /// The last analog value given to each input.
    converted: [i32; ADC_CHANNELS],
}

impl Default for Plans {
    fn default() -> Self {
        Self {
            due: BTreeMap::new(),
            count: 0,
            waves: [None; ADC_CHANNELS],
            turning: Vec::new(),
            converted: [-1; ADC_CHANNELS],
        }
    }
}

impl Plans {
    /// Adds an action that is due at a time.
    pub(super) fn add(&mut self, at: Cycles, due: DueEvent) {
        self.due.insert((at, self.count), due);
        self.count += 1;
    }

    /// Plans the return of a bit to a level.
    pub(crate) fn level(&mut self, at: Cycles, bit: Bit, level: bool) {
        self.add(at, DueEvent::Level(bit, level));
    }

    /// Plans the return of a bit to its switch.
    pub(crate) fn release(&mut self, at: Cycles, bit: Bit) {
        self.add(at, DueEvent::Release(bit));
    }

    /// An analog input begins a course.
    pub(crate) fn begin_wave(&mut self, channel: usize, wave: Wave, now: Cycles) {
        self.waves[channel] = Some((wave, now));
    }

    /// Returns whether an analog input is still on its course.
    pub(super) fn has_wave(&self, channel: usize, now: Cycles) -> bool {
        let wave = self.waves.get(channel).and_then(Option::as_ref);
        wave.is_some_and(|(wave, begun)| !wave.is_over(now - *begun))
    }

    /// An encoder or a load begins to move.
    pub(crate) fn begin_turn(&mut self, moved: MovingObject, way: f64, over: Cycles, now: Cycles) {
        self.turning.push(TimedMotion { moved, distance: way, begun: now, over, done: 0.0 });
    }

    /// Drops the latest actions if too many are planned; returns whether it did.
    pub(super) fn limit(&mut self) -> bool {
        let is_too_much = self.due.len() > MOST_PLANNED;
        while self.due.len() > MOST_PLANNED {
            self.due.pop_last();
        }
        is_too_much
    }

    /// All planned actions.
    pub(super) fn all(&self) -> impl Iterator<Item = DueEvent> {
        self.due.values().copied()
    }

    /// Takes all planned actions.
    pub(super) fn take_all(&mut self) -> impl Iterator<Item = DueEvent> + use<> {
        std::mem::take(&mut self.due).into_values()
    }

    /// Takes the first event that is due now.
    pub(super) fn take(&mut self, now: Cycles) -> Option<DueEvent> {
        let entry = self.due.first_entry()?;
        (entry.key().0 <= now).then(|| entry.remove())
    }

    /// Returns whether an encoder turns.
    pub(super) fn is_turning(&self) -> bool {
        !self.turning.is_empty()
    }

    /// Returns the number of ticks without any action after the one that began at `now`.
    pub(super) fn quiet_ticks(&self, now: Cycles) -> u64 {
        let moves = self.waves.iter().flatten().any(|(wave, begun)| !wave.is_over(now - *begun));
        if moves || self.is_turning() {
            return 0;
        }
        let Some((&(at, _), _)) = self.due.first_key_value() else { return u64::MAX };
        let tick = Cycles::PER_TICK.get();
        let first = at.get().saturating_add(tick - 1) / tick;
        u64::try_from(first - now.get() / tick - 1).unwrap_or(0)
    }

    /// Turns encoders and updates analog inputs.
    pub(super) fn run(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        self.turn_encoders(access, context);
        self.run_waves(access, context);
    }

    fn turn_encoders(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        for turning in &mut self.turning {
            let elapsed = context.now - turning.begun;
            let part =
                if elapsed < turning.over { elapsed.get() as f64 / turning.over.get() as f64 } else { 1.0 };
            let step = turning.distance * part - turning.done;
            turning.done += step;
            match turning.moved {
                MovingObject::Load(axis) => access.machine.loads.push(axis, step),
                MovingObject::Encoder(input) => {
                    let WorldAccess { machine, out, now, .. } = &mut *access;
                    machine.turn_encoder(context.memory, out, input, step, *now);
                    if part >= 1.0 {
                        machine.check_read(context.memory, out, input, *now);
                    }
                }
            }
        }
        self.turning.retain(|turning| context.now - turning.begun < turning.over);
    }

    fn run_waves(&mut self, access: &mut WorldAccess<'_>, context: &TickContext<'_>) {
        for channel in 0..ADC_CHANNELS {
            let Some((wave, begun)) = &self.waves[channel] else { continue };
            let load = |axis: AxisId| access.machine.table(axis);
            let value = conversion(wave.value(context.now - *begun, load));
            if self.converted[channel] != value {
                self.converted[channel] = value;
                access.io.kanalog.drive(channel, value);
            }
        }
    }
}
