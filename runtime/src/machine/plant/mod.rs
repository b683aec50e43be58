//! The simulated machine behind the board: loads, switches, probes, sources, a spindle.
//!
//! Nothing of it exists on a real board; a machine file describes it. It is moved once a tick, before the axes read
//! their inputs.

mod axis;
mod motor;

use kmotiondef::limits::N_CHANNELS;
use kmotiondef::structs::Chan;
use kmotiondef::variables::{DAC_BUFFER, KANALOG_PRESENT, SNAP_AMP_PRESENT};
use kmotiondef::{AxisId, Bit, Cycles};
use vm::memory::GuestMemory;

pub(crate) use axis::{COUNTS_PER_TICK, Drive, Plant};
pub(crate) use motor::Applied;

use crate::board::machine_file::{
    Analog, AnalogSource, Axis, Condition, Encoder, Handwheel, MachineFile, Model, Spindle, SpindleDrive,
};
use crate::firmware::io::bit_state;
use crate::io::konnect::Port;
use crate::kernel::Kernel;
use crate::servo::TIMEBASE;
use crate::views::Typed;
use crate::world::outside::wire::Wire as Line;
use crate::world::stimulus::conversion;

/// Opto inputs of a SnapAmp, and the first of each board.
const OPTOS: i32 = 8;
const FIRST_OPTOS: [i32; 2] = [72, 104];

/// Something that makes contact along an axis.
#[derive(Clone, Copy, Debug)]
struct Contact {
    bit: Bit,
    axis: AxisId,
    closes: Closes,
    active: bool,
}

/// Where it does.
#[derive(Clone, Copy, Debug)]
enum Closes {
    Where(Condition),
    /// Once in a distance: every, width, offset.
    Every(f64, f64, f64),
}

impl Contact {
    fn is_closed(&self, plants: &[Plant; N_CHANNELS]) -> bool {
        let load = plants[self.axis.index()].load;
        match self.closes {
            Closes::Where(condition) => condition.holds(load),
            Closes::Every(every, width, offset) => {
                let turns = (load - offset) / every;
                (turns - libm::floor(turns)) * every < width
            }
        }
    }
}

/// What a machine file connects to the board, beside the loads themselves.
#[derive(Clone, Debug, Default)]
pub(crate) struct Mechanics {
    contacts: Vec<Contact>,
    analog: Vec<Analog>,
    handwheels: Vec<Handwheel>,
    spindle: Option<Spindle>,
    /// Revolutions a second.
    spindle_speed: f64,
    /// Whether there is anything of all that.
    is_any: bool,
    /// Axes with contacts of which it was told that nothing moves them.
    unmoved: [bool; N_CHANNELS],
}

impl Mechanics {
    fn new(machine: &MachineFile) -> Self {
        let switches = machine.switches.iter().map(|switch| Contact {
            bit: switch.bit,
            axis: switch.axis,
            closes: Closes::Where(switch.when),
            active: switch.active,
        });
        let probes = machine.probes.iter().map(|probe| Contact {
            bit: probe.bit,
            axis: probe.axis,
            closes: Closes::Where(probe.touches),
            active: true,
        });
        let indexes = AxisId::all().filter_map(|axis| {
            let index = machine.axes[axis.index()].index?;
            let closes = Closes::Every(index.every, index.width, index.offset);
            Some(Contact { bit: index.bit, axis, closes, active: true })
        });
        let contacts: Vec<_> = switches.chain(probes).chain(indexes).collect();
        let (analog, handwheels) = (machine.analog.clone(), machine.encoders.clone());
        let spindle = machine.spindle;
        let is_any =
            !(contacts.is_empty() && analog.is_empty() && handwheels.is_empty() && spindle.is_none());
        let unmoved = [false; N_CHANNELS];
        Self { contacts, analog, handwheels, spindle, spindle_speed: 0.0, is_any, unmoved }
    }

    /// Whether it is to be told, once, that an axis with contacts is commanded and drives nothing.
    pub(crate) fn take_unmoved(&mut self, axis: AxisId) -> bool {
        let has_contacts = self.contacts.iter().any(|contact| contact.axis == axis);
        has_contacts && !std::mem::replace(&mut self.unmoved[axis.index()], true)
    }

    /// Whether it moves by itself after `time`, so that ticks cannot be skipped.
    fn goes_on(&self, time: f64) -> bool {
        let turns =
            |wheel: &Handwheel| wheel.moves.iter().any(|[start, _, duration]| time <= start + duration);
        self.spindle_speed != 0.0
            || self.handwheels.iter().any(turns)
            || self.analog.iter().any(|analog| matches!(analog.source, AnalogSource::Sine { .. }))
    }
}

/// Connects a machine to the board at power-up.
pub(crate) fn install(kernel: &mut Kernel, machine: &MachineFile) {
    for axis in AxisId::all() {
        kernel.servo.plants[axis.index()] = Plant::new(&machine.axes[axis.index()]);
    }
    if let Some(spindle) = machine.spindle {
        // The load of that axis counts as its encoder does.
        let load = Axis { model: Model::None, encoder: Encoder::Connected, ..Axis::default() };
        kernel.servo.plants[spindle.axis.index()] = Plant::new(&load);
    }
    kernel.mechanics = Mechanics::new(machine);
    (0..machine.snapamps).for_each(|board| connect_snapamp(kernel, board));
    kernel.servo.needs_enable = machine.has_kstep && machine.respect_enable;
    for (port, present) in [(Port::Aux0, machine.konnects[0]), (Port::Aux1, machine.konnects[1])] {
        kernel.konnects.set_present(port, present);
    }
    kernel.disk.latency = Cycles::new((machine.disk_latency_s * Cycles::PER_SECOND.get() as f64) as i64);
    kernel.hints = machine.hints;
    kernel.plan_ticks = machine.plan_ticks;
    if machine.fresh_globals {
        kernel.globals.keep();
    }
    for &bit in &machine.idle_high {
        kernel.pins.idle_high(bit);
    }
}

/// Puts a SnapAmp on the bus. Its opto inputs read 1 while no current flows.
pub(crate) fn connect_snapamp(kernel: &mut Kernel, board: usize) {
    kernel.snapamps.connect(board);
    let Some(first) = FIRST_OPTOS.get(board) else { return };
    (*first..first + OPTOS).filter_map(Bit::new).for_each(|bit| kernel.pins.idle_high(bit));
}

/// What a machine does by itself: its wires and devices, and its events.
pub(crate) fn play(kernel: &mut Kernel, machine: &MachineFile, memory: &mut GuestMemory) {
    if machine.has_kanalog || !machine.analog.is_empty() {
        memory.set(KANALOG_PRESENT, 1);
    }
    if machine.snapamps > 0 {
        memory.set(SNAP_AMP_PRESENT, 1);
    }
    for wire in &machine.wires {
        kernel.pins.declare(wire.to);
        kernel.attach(Box::new(Line::of(wire)), memory, Cycles::default());
    }
    if !machine.stimulus.is_empty() {
        kernel.play(machine.stimulus.clone(), memory);
    }
}

/// Whether a machine file connects anything to the board beside the loads themselves.
#[inline]
pub(crate) const fn has_mechanics(kernel: &Kernel) -> bool {
    kernel.mechanics.is_any
}

/// What moves by time and by other outputs than the axes' own; whether it will move in the next tick too.
#[inline]
pub(crate) fn drive(kernel: &mut Kernel, memory: &GuestMemory, now: Cycles) -> bool {
    kernel.mechanics.is_any && turn(kernel, memory, now)
}

fn turn(kernel: &mut Kernel, memory: &GuestMemory, now: Cycles) -> bool {
    let time = now.get() as f64 / Cycles::PER_SECOND.get() as f64;
    turn_handwheels(kernel, memory, time);
    turn_spindle(kernel, memory);
    kernel.mechanics.goes_on(time)
}

fn turn_handwheels(kernel: &mut Kernel, memory: &GuestMemory, time: f64) {
    let wheels = std::mem::take(&mut kernel.mechanics.handwheels);
    for wheel in &wheels {
        let Some(axis) = AxisId::new(wheel.channel as i32) else { continue };
        let gain = f64::from(memory.axis(axis, Chan::INPUT_GAIN0));
        let turned: f64 =
            wheel.moves.iter().map(|turn| turned(turn, time) - turned(turn, time - TIMEBASE)).sum();
        if turned != 0.0 {
            kernel.servo.push(axis, turned * gain);
        }
    }
    kernel.mechanics.handwheels = wheels;
}

/// The counts of a move that are done at a time.
fn turned(&[start, counts, duration]: &[f64; 3], time: f64) -> f64 {
    if time < start {
        0.0
    } else if time >= start + duration {
        counts
    } else {
        counts * (time - start) / duration
    }
}

fn turn_spindle(kernel: &mut Kernel, memory: &GuestMemory) {
    let Some(spindle) = kernel.mechanics.spindle else { return };
    let target = spindle.full_scale_rps * fraction(kernel, memory, &spindle);
    let speed = &mut kernel.mechanics.spindle_speed;
    *speed = target + (*speed - target) * libm::exp(-TIMEBASE / spindle.tau_s);
    if target == 0.0 && speed.abs() < 1e-6 {
        *speed = 0.0;
    }
    let counts = *speed * spindle.counts_per_rev * TIMEBASE;
    if counts != 0.0 {
        kernel.servo.push(spindle.axis, counts);
    }
}

/// How far a spindle is driven, −1 to 1.
fn fraction(kernel: &Kernel, memory: &GuestMemory, spindle: &Spindle) -> f64 {
    const FULL: f64 = 2047.0;
    let dac = |channel: usize| {
        // The buffer holds the value in offset binary, from the other side.
        let value = (i32::from(memory.get(DAC_BUFFER.element(channel))) + 2048) & 0xfff;
        f64::from(if value >= 2048 { value - 4096 } else { value }) / FULL
    };
    match spindle.drive {
        SpindleDrive::Dac(channel) => dac(channel),
        SpindleDrive::Axis(axis) if memory.axis(axis, Chan::ENABLE) == 0 => 0.0,
        SpindleDrive::Axis(axis) => usize::try_from(memory.axis(axis, Chan::OUTPUT_CHAN0))
            .ok()
            .filter(|&channel| channel < 8)
            .map_or(0.0, dac),
        SpindleDrive::Bits { cw, ccw } => {
            let level = |bit| f64::from(u8::from(bit_state(kernel, memory, bit).0));
            level(cw) - level(ccw)
        }
    }
}

/// Shows the board what switches, probes and sources say where the loads are now.
#[inline]
pub(crate) fn signal(kernel: &mut Kernel, now: Cycles) {
    if kernel.mechanics.is_any {
        show(kernel, now);
    }
}

fn show(kernel: &mut Kernel, now: Cycles) {
    let mechanics = std::mem::take(&mut kernel.mechanics);
    for (index, contact) in mechanics.contacts.iter().enumerate() {
        let mut others = mechanics.contacts.iter().filter(|other| other.bit == contact.bit);
        // The first contact of a bit speaks for all of them: one that is closed decides.
        if mechanics.contacts[..index].iter().any(|before| before.bit == contact.bit) {
            continue;
        }
        let closed = others.find(|other| other.is_closed(&kernel.servo.plants));
        let level = closed.map_or(!contact.active, |contact| contact.active);
        set(kernel, contact.bit, level, now);
    }
    let time = now.get() as f64 / Cycles::PER_SECOND.get() as f64;
    for analog in &mechanics.analog {
        let value = match analog.source {
            AnalogSource::Value(value) => value,
            AnalogSource::Sine { mean, amp, hz } => mean + amp * libm::sin(std::f64::consts::TAU * hz * time),
            AnalogSource::Follows { axis, gain, offset } => {
                kernel.servo.plants[axis.index()].load * gain + offset
            }
        };
        kernel.kanalog.drive(analog.channel, conversion(value));
    }
    kernel.mechanics = mechanics;
}

/// Drives an input, if that is news.
fn set(kernel: &mut Kernel, bit: Bit, level: bool, now: Cycles) {
    if kernel.pins.input(bit) != level || !kernel.pins.is_driven(bit) {
        kernel.pins.drive(bit, level, now);
    }
}

#[cfg(test)]
mod tests;
