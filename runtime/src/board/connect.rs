//! Connects the contents of a machine file to the parts of the board.

use std::sync::Arc;

use kmotiondef::variables::{KANALOG_PRESENT, SNAP_AMP_PRESENT};
use kmotiondef::{AxisId, Cycles};
use vm::memory::GuestMemory;

use super::machine_file::MachineFile;
use crate::firmware::parts::Parts;
use crate::io::kanalog::{COUNTS_PER_VOLT, is_volts};
use crate::io::konnect::Port;
use crate::machine::description::{Analog, AnalogSource, Axis, Connection, Encoder, Model};
use crate::machine::wiring::Wiring;
use crate::machine::{Mechanics, Notes, Plant, connect_snapamp};
use crate::out::Message;
use crate::views::TypedAccess;
use crate::world::outside::wire::Wire;

/// Connects a machine to the board at power-up.
pub(crate) fn install(parts: &mut Parts, machine: &MachineFile) {
    let Parts { out, io, machine: connected, pc, calls, .. } = parts;
    for axis in AxisId::all() {
        connected.loads[axis] = Plant::new(&machine.axes[axis.index()]);
    }
    connected.wiring = Wiring::new(&machine.axes);
    machine.connected.encoders.iter().for_each(|wheel| connected.wiring.turn_by_hand(wheel.channel));
    for spindle in &machine.connected.spindles {
        // The load of that axis counts in the same direction as its encoder.
        let connection = Connection { encoder: Encoder::Connected, ..Connection::default() };
        let load = Axis { model: Model::None, connection, ..Axis::default() };
        connected.loads[spindle.axis] = Plant::new(&load);
    }
    connected.mechanics = Mechanics::new(&machine.axes, &machine.connected);
    connected.notes = Arc::new(Notes::new(machine.name.clone(), &machine.axes, &machine.connected));
    for (bit, axis, place) in connected.mechanics.places() {
        let travel = machine.axes[axis.index()].travel;
        if let Some((side, end)) = place.beyond(&travel) {
            let place = place.to_string();
            let source = connected.notes.contact(bit).unwrap_or_default();
            let key = connected.notes.key(axis, side);
            out.remark(Cycles::default(), Message::SwitchUnreachable { bit, axis, place, source, end, key });
        }
    }
    connected.needs_enable = machine.boards.has_kstep && machine.boards.respect_enable;
    (0..machine.boards.snapamps).for_each(|board| connect_snapamp(&mut io.snapamps, &mut io.pins, board));
    for (port, present) in
        [(Port::Aux0, machine.boards.konnects[0]), (Port::Aux1, machine.boards.konnects[1])]
    {
        io.konnects.set_present(port, present);
    }
    for Analog { channel, source } in &machine.connected.analog {
        if let AnalogSource::Value(value) = *source
            && is_volts(value)
        {
            let (channel, volts) = (*channel, value / COUNTS_PER_VOLT);
            let (wanted, place) = (format!("\"{value}V\""), String::new());
            out.remark(Cycles::default(), Message::FewCounts { place, channel, value, volts, wanted });
        }
    }
    for &bit in &machine.idle_high {
        io.pins.idle_high(bit);
        connected.pulses.idle_high(bit);
    }
    pc.disk.latency = Cycles::new((machine.pc.disk_latency_s * Cycles::PER_SECOND.get() as f64) as i64);
    out.hints = machine.hints;
    machine.unwanted_remarks.iter().for_each(|code| out.disable_remark(code));
    calls.plan_ticks = machine.cpu.plan_ticks;
    if machine.cpu.fresh_globals {
        calls.globals.enable();
    }
}

/// Connects to the board everything that acts without a program: wires, devices and the events of the machine file.
pub(crate) fn connect_surroundings(parts: &mut Parts, machine: &MachineFile, memory: &mut GuestMemory) {
    if machine.boards.has_kanalog || !machine.connected.analog.is_empty() {
        memory.set(KANALOG_PRESENT, 1);
    }
    if machine.boards.snapamps > 0 {
        memory.set(SNAP_AMP_PRESENT, 1);
    }
    let (world, mut access) = parts.access(Cycles::default());
    for wire in &machine.wires {
        access.io.pins.declare(wire.to);
        access.attach(Box::new(Wire::of(wire)), memory);
    }
    if !machine.stimulus.is_empty() {
        world.play(machine.stimulus.clone(), &mut access, memory);
    }
}
