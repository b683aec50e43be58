//! Mechanics that move independently or are tripped by the loads: handwheels, a spindle, switches, probes, analog
//! sources.
//!
//! None of it is part of the board; a machine file describes it. It is moved once a tick, before the axes read their
//! inputs.

use kmotiondef::limits::TIMEBASE;
use kmotiondef::structs::Chan;
use kmotiondef::{Axes, AxisId, Bit, Cycles};
use vm::memory::GuestMemory;

use super::description::{
    Analog, AnalogSource, Axis, Condition, Gantry, Handwheel, Probe, Spindle, SpindleDrive, Switch,
};
use super::table::Table;
use super::wiring::dac_value;
use super::{Channel, Loads, Machine};
use crate::io::Io;
use crate::io::bits::bit_state;
use crate::out::Out;
use crate::views::TypedAccess;
use chips::kanalog::conversion;

/// A contact that is made at some position along an axis.
#[derive(Clone, Copy, Debug)]
struct Contact {
    bit: Bit,
    axis: AxisId,
    closes: ClosedRange,
    active: bool,
    /// The time at which a program last read the bit, and the position of the load then.
    read: Option<(Cycles, f64)>,
    /// The level that it read, if it was the switch's.
    level: Option<bool>,
}

/// A switch that has changed long before a program reads it.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LateRead {
    pub(crate) axis: AxisId,
    /// Time since the previous read, and the distance in units that the axis has moved since.
    pub(crate) ms: f64,
    pub(crate) step: f64,
}

/// The range in which it is closed.
#[derive(Clone, Copy, Debug)]
enum ClosedRange {
    Where(Condition),
    /// Once in a distance: every, width, offset.
    Every(f64, f64, f64),
}

impl Contact {
    fn is_closed(&self, loads: &Loads, tables: &[Table]) -> bool {
        let load = loads[self.axis].load;
        match self.closes {
            ClosedRange::Where(condition) => condition.holds(table(tables, self.axis).unwrap_or(load)),
            ClosedRange::Every(every, width, offset) => {
                let turns = (load - offset) / every;
                (turns - libm::floor(turns)) * every < width
            }
        }
    }
}

/// A spindle and its speed.
#[derive(Clone, Copy, Debug)]
struct TurningSpindle {
    spindle: Spindle,
    /// Revolutions per second.
    speed: f64,
}

/// Two sides of a gantry that are further apart than it tolerates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RackedGantry {
    pub(crate) gantry: Gantry,
    /// Their difference in units.
    pub(crate) apart: f64,
}

/// The equipment that a machine file connects to the board, without the loads, as the file describes it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct ConnectedEquipment {
    /// Switches that axes trip.
    pub switches: Vec<Switch>,
    /// Probes.
    pub probes: Vec<Probe>,
    /// Encoders turned by hand.
    pub encoders: Vec<Handwheel>,
    /// Analog inputs.
    pub analog: Vec<Analog>,
    /// The spindles.
    pub spindles: Vec<Spindle>,
    /// Pairs of motors that move one beam.
    pub gantries: Vec<Gantry>,
}

/// The equipment of the machine file with its simulated state.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mechanics {
    contacts: Vec<Contact>,
    analog: Vec<Analog>,
    handwheels: Vec<Handwheel>,
    spindles: Vec<TurningSpindle>,
    /// Tables that couplings with backlash or a spring move.
    tables: Vec<Table>,
    gantries: Vec<Gantry>,
    /// A gantry with its sides too far apart.
    racked: Option<RackedGantry>,
    /// Inputs that a stimulus has detached from their switches, and analog inputs detached from their sources.
    held: Vec<Bit>,
    held_analog: Vec<usize>,
    /// True if there is any such equipment.
    is_any: bool,
}

impl Mechanics {
    /// Creates the mechanics of a description.
    pub(crate) fn new(axes: &[Axis; Axes::MAX], described: &ConnectedEquipment) -> Self {
        let switches = described.switches.iter().map(|switch| Contact {
            bit: switch.bit,
            axis: switch.axis,
            closes: ClosedRange::Where(switch.when),
            active: switch.active,
            read: None,
            level: None,
        });
        let probes = described.probes.iter().map(|probe| Contact {
            bit: probe.bit,
            axis: probe.axis,
            closes: ClosedRange::Where(probe.touches),
            active: true,
            read: None,
            level: None,
        });
        let indexes = AxisId::all().filter_map(|axis| {
            let index = axes[axis.index()].index?;
            let closes = ClosedRange::Every(index.every, index.width, index.offset);
            Some(Contact { bit: index.bit, axis, closes, active: true, read: None, level: None })
        });
        let contacts: Vec<_> = switches.chain(probes).chain(indexes).collect();
        let (analog, handwheels) = (described.analog.clone(), described.encoders.clone());
        let spindles: Vec<_> =
            described.spindles.iter().map(|&spindle| TurningSpindle { spindle, speed: 0.0 }).collect();
        let tables = AxisId::all().filter_map(|axis| Table::new(axis, &axes[axis.index()].travel));
        let tables: Vec<_> = tables.collect();
        let gantries = described.gantries.clone();
        let is_any = !(contacts.is_empty()
            && analog.is_empty()
            && handwheels.is_empty()
            && spindles.is_empty()
            && tables.is_empty()
            && gantries.is_empty());
        Self {
            contacts,
            analog,
            handwheels,
            spindles,
            tables,
            gantries,
            racked: None,
            held: Vec::new(),
            held_analog: Vec::new(),
            is_any,
        }
    }

    /// Returns whether an axis trips a switch or carries a probe.
    pub(crate) fn has_contacts(&self, axis: AxisId) -> bool {
        self.contacts.iter().any(|contact| contact.axis == axis)
    }

    /// Returns whether an axis trips a contact, or an analog input depends on it.
    pub(super) fn depends_on(&self, axis: AxisId) -> bool {
        let follows = |analog: &Analog| matches!(analog.source, AnalogSource::Follows { axis: seen, .. } if seen == axis);
        self.has_contacts(axis) || self.analog.iter().any(follows)
    }

    /// Returns the contact on a bit: its axis, the range in which it is closed (`None` if it closes periodically), and
    /// its level there.
    pub(crate) fn contact(&self, bit: Bit) -> Option<(AxisId, Option<Condition>, bool)> {
        self.contacts(bit).next()
    }

    /// All contacts on a bit, as [`contact`](Self::contact) returns them.
    pub(crate) fn contacts(&self, bit: Bit) -> impl Iterator<Item = (AxisId, Option<Condition>, bool)> + '_ {
        self.contacts.iter().filter(move |contact| contact.bit == bit).map(|contact| {
            let condition = match contact.closes {
                ClosedRange::Where(condition) => Some(condition),
                ClosedRange::Every(..) => None,
            };
            (contact.axis, condition, contact.active)
        })
    }

    /// The axes that trip contacts on a bit.
    pub(crate) fn owners(&self, bit: Bit) -> impl Iterator<Item = AxisId> + '_ {
        self.contacts(bit).map(|(axis, ..)| axis)
    }

    /// The counts per revolution of the spindle that uses the encoder of an axis.
    pub(crate) fn spindle_counts(&self, axis: AxisId) -> Option<f64> {
        let mut spindles = self.spindles.iter().map(|turning| turning.spindle);
        spindles.find(|spindle| spindle.axis == axis).map(|spindle| spindle.counts_per_rev)
    }

    /// The ranges of switches and probes, with their bits and axes.
    pub(crate) fn places(&self) -> impl Iterator<Item = (Bit, AxisId, Condition)> + '_ {
        self.contacts.iter().filter_map(|contact| match contact.closes {
            ClosedRange::Where(condition) => Some((contact.bit, contact.axis, condition)),
            ClosedRange::Every(..) => None,
        })
    }

    /// Reports whether a spindle is connected to an analog output, another one than an axis drives as its spindle.
    pub(crate) fn has_spindle_on(&self, dac: usize, axis: AxisId) -> bool {
        let mut spindles = self.spindles.iter().map(|turning| turning.spindle);
        spindles.any(|spindle| spindle.drive == SpindleDrive::Dac(dac) && spindle.axis != axis)
    }

    /// A gantry whose sides have been too far apart since the last call.
    #[inline]
    pub(crate) fn take_racked(&mut self) -> Option<RackedGantry> {
        self.racked.take()
    }

    /// Changes the load of the spindles that turn the encoder of an axis, from 0 to 1.
    pub(crate) fn load_spindle(&mut self, axis: AxisId, load: f64) {
        let turning = self.spindles.iter_mut().filter(|turning| turning.spindle.axis == axis);
        turning.for_each(|turning| turning.spindle.load = load);
    }

    /// Detaches an input from its switch; returns whether the switch has driven it so far.
    pub(crate) fn hold(&mut self, bit: Bit) -> bool {
        let is_new = !self.held.contains(&bit);
        if is_new {
            self.held.push(bit);
        }
        is_new
    }

    /// Returns whether an action has detached an input from its switch.
    pub(crate) fn is_held(&self, bit: Bit) -> bool {
        self.held.contains(&bit)
    }

    /// Returns whether the machine file gives an analog input its signal.
    pub(crate) fn has_source(&self, channel: usize) -> bool {
        self.analog.iter().any(|analog| analog.channel == channel)
    }

    /// Detaches an analog input from its source; returns whether a source has driven it so far.
    pub(crate) fn hold_analog(&mut self, channel: usize) -> bool {
        let is_new = self.has_source(channel) && !self.held_analog.contains(&channel);
        if is_new {
            self.held_analog.push(channel);
        }
        is_new
    }

    /// Gives an input back to its switch.
    pub(crate) fn let_go(&mut self, bit: Bit) {
        self.held.retain(|held| *held != bit);
    }

    /// Returns whether it moves independently after `time`, so that ticks cannot be skipped.
    fn goes_on(&self, time: f64) -> bool {
        let turns =
            |wheel: &Handwheel| wheel.moves.iter().any(|[start, _, duration]| time <= start + duration);
        self.spindles.iter().any(|spindle| spindle.speed != 0.0)
            || self.handwheels.iter().any(turns)
            || self.tables.iter().any(Table::is_moving)
            || self.analog.iter().any(|analog| {
                matches!(analog.source, AnalogSource::Sine { .. })
                    && !self.held_analog.contains(&analog.channel)
            })
    }
}

impl Machine {
    /// Notes that a program reads a bit; if an index pulse on the bit has passed since its previous, recent read,
    /// returns the axis, the width of the pulse and the distance that the axis has moved since.
    pub(crate) fn index_missed(&mut self, bit: Bit, now: Cycles) -> Option<(AxisId, f64, f64)> {
        /// Reads that are further apart than this do not wait for a pulse.
        const MOMENT: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 100);
        let contact = self.mechanics.contacts.iter_mut().find(|contact| contact.bit == bit)?;
        let ClosedRange::Every(every, width, offset) = contact.closes else { return None };
        let load = self.loads[contact.axis].load;
        let (at, before) = contact.read.replace((now, load))?;
        let turn = |load: f64| libm::floor((load - offset) / every);
        let is_in_pulse = |load: f64| load - offset - turn(load) * every < width;
        let passed = turn(load) != turn(before) && !is_in_pulse(load) && !is_in_pulse(before);
        (passed && now - at < MOMENT).then_some((contact.axis, width, (load - before).abs()))
    }

    /// A program reads the bit of a switch, in a wait that began at `since`: whether it reads so rarely that the axis has
    /// moved on far since the switch changed.
    pub(crate) fn read_late(
        &mut self,
        bit: Bit,
        level: bool,
        now: Cycles,
        since: Option<Cycles>,
    ) -> Option<LateRead> {
        /// Slices of other threads do not count.
        const LONG: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 50);
        const FAR: f64 = 100.0;
        let contact = self.mechanics.contacts.iter_mut().find(|contact| contact.bit == bit)?;
        let ClosedRange::Where(_) = contact.closes else { return None };
        let (axis, load) = (contact.axis, self.loads[contact.axis].load);
        let before = contact.level.replace(level);
        let (at, place) = contact.read.replace((now, load))?;
        let (step, time) = ((load - place).abs(), now - at);
        let is_late = since? < at && before? != level && time >= LONG && step >= FAR;
        let ms = 1e3 * time.get() as f64 / Cycles::PER_SECOND.get() as f64;
        is_late.then_some(LateRead { axis, ms, step })
    }

    /// The output that switches the same motor to the other direction.
    pub(crate) fn opposite_output(&self, bit: Bit) -> Option<Bit> {
        let spindles = self.mechanics.spindles.iter().filter_map(|turning| match turning.spindle.drive {
            SpindleDrive::Bits { cw, ccw } => Some((cw, ccw)),
            SpindleDrive::Axis(_) | SpindleDrive::Dac(_) => None,
        });
        let motors = AxisId::all().filter_map(|axis| match self.wiring.drive(axis) {
            Some(Channel::Relays(forward, back)) => Some((forward, back)),
            _ => None,
        });
        spindles.chain(motors).find_map(
            |(one, other)| {
                if one == bit { Some(other) } else { (other == bit).then_some(one) }
            },
        )
    }

    /// Returns whether the machine file describes an axis, or something on it.
    pub(crate) fn has_axis(&self, axis: AxisId) -> bool {
        let Mechanics { gantries, spindles, .. } = &self.mechanics;
        self.notes.has_axis(axis)
            || self.mechanics.has_contacts(axis)
            || gantries.iter().any(|gantry| gantry.axes.contains(&axis))
            || spindles.iter().any(|turning| turning.spindle.axis == axis)
    }

    /// Returns the outputs to which the machine file connects a motor or a spindle.
    pub(crate) fn outputs(&self) -> Vec<Channel> {
        let spindles = self.mechanics.spindles.iter().filter_map(|turning| match turning.spindle.drive {
            SpindleDrive::Dac(number) => Some(Channel::Dac(number)),
            SpindleDrive::Bits { cw, ccw } => Some(Channel::Relays(cw, ccw)),
            SpindleDrive::Axis(_) => None,
        });
        AxisId::all().filter_map(|axis| self.wiring.drive(axis)).chain(spindles).collect()
    }

    /// Returns whether a machine file connects any equipment other than the loads.
    #[inline]
    pub(crate) const fn has_mechanics(&self) -> bool {
        self.mechanics.is_any
    }

    /// Moves everything that depends on time and on outputs other than those of the axes; returns whether the next tick
    /// moves something, too.
    #[inline]
    pub(crate) fn drive(&mut self, io: &Io, out: &mut Out, memory: &GuestMemory, now: Cycles) -> bool {
        self.mechanics.is_any && self.turn(io, out, memory, now)
    }

    fn turn(&mut self, io: &Io, out: &mut Out, memory: &GuestMemory, now: Cycles) -> bool {
        let time = now.get() as f64 / Cycles::PER_SECOND.get() as f64;
        self.turn_handwheels(out, memory, now);
        self.turn_spindles(io, memory);
        self.mechanics.goes_on(time)
    }

    fn turn_handwheels(&mut self, out: &mut Out, memory: &GuestMemory, now: Cycles) {
        let time = now.get() as f64 / Cycles::PER_SECOND.get() as f64;
        let way = |turn: &[f64; 3]| turned_counts(turn, time) - turned_counts(turn, time - TIMEBASE);
        let ends = |&[start, _, duration]: &[f64; 3]| (time - TIMEBASE..time).contains(&(start + duration));
        for index in 0..self.mechanics.handwheels.len() {
            let wheel = &self.mechanics.handwheels[index];
            let input = wheel.channel;
            let counts: f64 = wheel.moves.iter().map(way).sum();
            let has_ended = wheel.moves.iter().any(ends);
            if counts != 0.0 {
                self.turn_encoder(memory, out, input, counts, now);
            }
            if has_ended {
                self.check_read(memory, out, input, now);
            }
        }
    }

    fn turn_spindles(&mut self, io: &Io, memory: &GuestMemory) {
        for TurningSpindle { spindle, speed } in &mut self.mechanics.spindles {
            let free = spindle.full_scale_rps * drive_fraction(io, memory, spindle);
            let lost = (spindle.droop_rps * spindle.load).min(free.abs());
            let target = free - libm::copysign(lost, free);
            *speed = target + (*speed - target) * libm::exp(-TIMEBASE / spindle.tau_s);
            if target == 0.0 && speed.abs() < 1e-6 {
                *speed = 0.0;
            }
            let counts = *speed * spindle.counts_per_rev * TIMEBASE;
            if counts != 0.0 {
                self.loads.push(spindle.axis, counts);
            }
        }
    }

    /// Machine coordinate of the table that the load of an axis moves through a screw, which may have backlash.
    pub(crate) fn table(&self, axis: AxisId) -> f64 {
        table(&self.mechanics.tables, axis).unwrap_or(self.loads[axis].load)
    }

    /// Shows the board the levels of switches, probes and sources at the present positions of the loads.
    #[inline]
    pub(crate) fn signal(&mut self, io: &mut Io, now: Cycles) {
        if self.mechanics.is_any {
            for table in &mut self.mechanics.tables {
                table.follow(self.loads[table.axis].load);
            }
            self.check_racking();
            self.show(io, now);
        }
    }

    /// Notes a gantry whose sides are too far apart.
    fn check_racking(&mut self) {
        for gantry in &self.mechanics.gantries {
            let [a, b] = gantry.axes.map(|axis| self.loads[axis].load);
            let apart = (a - b).abs();
            if apart > gantry.most {
                self.mechanics.racked = Some(RackedGantry { gantry: *gantry, apart });
            }
        }
    }

    fn show(&self, io: &mut Io, now: Cycles) {
        let mechanics = &self.mechanics;
        for (index, contact) in mechanics.contacts.iter().enumerate() {
            let mut others = mechanics.contacts.iter().filter(|other| other.bit == contact.bit);
            // The first contact of a bit handles all of them: a closed one determines the level.
            if mechanics.held.contains(&contact.bit)
                || mechanics.contacts[..index].iter().any(|before| before.bit == contact.bit)
            {
                continue;
            }
            let closed = others.find(|other| other.is_closed(&self.loads, &mechanics.tables));
            let level = closed.map_or(!contact.active, |contact| contact.active);
            set(io, contact.bit, level, now);
        }
        let time = now.get() as f64 / Cycles::PER_SECOND.get() as f64;
        for analog in
            mechanics.analog.iter().filter(|analog| !mechanics.held_analog.contains(&analog.channel))
        {
            let value = match analog.source {
                AnalogSource::Value(value) => value,
                AnalogSource::Sine { mean, amp, hz } => {
                    mean + amp * libm::sin(std::f64::consts::TAU * hz * time)
                }
                AnalogSource::Follows { axis, gain, offset } => self.table(axis) * gain + offset,
            };
            io.kanalog.drive(analog.channel, conversion(value));
        }
    }
}

/// The coordinate of the table of an axis with play.
fn table(tables: &[Table], axis: AxisId) -> Option<f64> {
    tables.iter().find(|table| table.axis == axis).map(|table| table.place)
}

/// The counts of a move that are done at a time.
fn turned_counts(&[start, counts, duration]: &[f64; 3], time: f64) -> f64 {
    if time < start {
        0.0
    } else if time >= start + duration {
        counts
    } else {
        counts * (time - start) / duration
    }
}

/// Returns the drive of a spindle as a fraction of full speed, −1 to 1.
fn drive_fraction(io: &Io, memory: &GuestMemory, spindle: &Spindle) -> f64 {
    const FULL: f64 = 2047.0;
    let dac = |channel: usize| f64::from(dac_value(memory, channel)) / FULL;
    match spindle.drive {
        SpindleDrive::Dac(channel) => dac(channel),
        SpindleDrive::Axis(axis) if memory.axis(axis, Chan::ENABLE) == 0 => 0.0,
        SpindleDrive::Axis(axis) => usize::try_from(memory.axis(axis, Chan::OUTPUT_CHAN0))
            .ok()
            .filter(|&channel| channel < 8)
            .map_or(0.0, dac),
        SpindleDrive::Bits { cw, ccw } => {
            let level = |bit| f64::from(u8::from(bit_state(io, memory, bit).0));
            level(cw) - level(ccw)
        }
    }
}

/// Drives an input, if that is news.
fn set(io: &mut Io, bit: Bit, level: bool, now: Cycles) {
    if io.pins.input(bit) != level || !io.pins.is_driven(bit) {
        io.pins.drive(bit, level, now);
    }
}
