//! The simulated machine that the board moves: loads of the axes, the switches that they trip, devices on the board's
//! lines.
//!
//! The board's outputs move it, and it sees only inputs, outputs and guest memory.

pub(crate) mod attached;
pub(crate) mod description;
mod hand;
mod lines;
mod mechanics;
mod motor;
mod notes;
pub(crate) mod plant;
mod pulses;
mod table;
#[cfg(test)]
mod tests;
pub(crate) mod wiring;

use std::ops::{Index, IndexMut};
use std::sync::Arc;

use kmotiondef::{Axes, AxisId, Bit, Cycles};
use vm::memory::GuestMemory;

pub use mechanics::ConnectedEquipment;

pub(crate) use description::Channel;
pub(crate) use lines::Lines;
pub(crate) use mechanics::{LateRead, Mechanics, RackedGantry};
pub(crate) use motor::AmplifierSignal;
pub(crate) use notes::{Notes, UnitMismatch};
pub(crate) use plant::{COUNTS_PER_TICK, Drive, Plant};
pub(crate) use pulses::{MissedPulse, Pulses, ReadNotice};

use crate::io::Io;
use crate::io::bits::bit_state;
use crate::io::changes;
use crate::io::konnect::KonnectBoard;
use crate::io::snapamp::SnapAmps;
use crate::machine::attached::{AttachedDevice, DeviceContext};
use crate::machine::wiring::{ENCODERS, Wiring};
use crate::out::{EventKind, Message, Out};
use chips::changes::BitChange;
use chips::pins::Pins;

/// Edges that devices may answer at the same instant.
const EDGES_AT_ONCE: usize = 10_000;

/// Opto inputs of a SnapAmp, and the first of each board.
const OPTOS: i32 = 8;
const FIRST_OPTOS: [i32; 2] = [72, 104];

/// The loads of the axes.
#[derive(Clone, Debug, Default)]
pub(crate) struct Loads {
    plants: [Plant; Axes::MAX],
    /// The counts of encoders that are turned by hand, and whether there are any.
    by_hand: [f64; ENCODERS],
    has_hands: bool,
    /// True if a load was moved by anything other than the servo since the servo's last query.
    is_pushed: bool,
}

impl Loads {
    /// Something outside moves the load of an axis.
    pub(crate) fn push(&mut self, axis: AxisId, units: f64) {
        self[axis].push(units);
        self.is_pushed = true;
    }

    /// Turns the encoder on an input by hand.
    fn turn(&mut self, input: usize, counts: f64) {
        self.by_hand[input] += counts;
        self.has_hands = true;
        self.is_pushed = true;
    }

    /// The register of an encoder that is turned by hand.
    #[inline(always)]
    pub(crate) fn by_hand(&self, input: Option<u32>) -> i8 {
        if !self.has_hands {
            return 0;
        }
        let counts = input.and_then(|input| self.by_hand.get(input as usize));
        counts.map_or(0, |counts| libm::floor(counts + 0.5) as i64 as i8)
    }

    /// Another constant load pulls at the motor of an axis.
    pub(crate) fn set_load(&mut self, axis: AxisId, speed: f64) {
        self[axis].set_load(speed);
        self.is_pushed = true;
    }

    /// Returns whether a load was moved from outside since the last call.
    #[inline]
    pub(crate) fn take_pushed(&mut self) -> bool {
        std::mem::take(&mut self.is_pushed)
    }
}

impl Index<AxisId> for Loads {
    type Output = Plant;

    #[inline(always)]
    fn index(&self, axis: AxisId) -> &Plant {
        &self.plants[axis.index()]
    }
}

impl IndexMut<AxisId> for Loads {
    #[inline(always)]
    fn index_mut(&mut self, axis: AxisId) -> &mut Plant {
        &mut self.plants[axis.index()]
    }
}

/// A character that the serial port has sent.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SentByte {
    pub(crate) at: Cycles,
    pub(crate) byte: u8,
}

/// The equipment at the board's outputs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Machine {
    pub(crate) loads: Loads,
    /// The connections of encoders and motors.
    pub(crate) wiring: Wiring,
    pub(crate) mechanics: Mechanics,
    /// The places of its description.
    pub(crate) notes: Arc<Notes>,
    /// The pulses at inputs.
    pub(crate) pulses: Pulses,
    /// Devices on the board's lines.
    attached: Vec<Box<dyn AttachedDevice>>,
    /// True if motors on the first four step generators need the enable signal of a KStep.
    pub(crate) needs_enable: bool,
}

impl Machine {
    /// Attaches a device and reports the bits that are high to it.
    pub(crate) fn attach(
        &mut self,
        mut device: Box<dyn AttachedDevice>,
        io: &mut Io,
        out: &mut Out,
        memory: &GuestMemory,
        now: Cycles,
    ) {
        changes::switch_on(&mut io.pins.changes, memory);
        Bit::all().filter(|&bit| device.watches(bit)).for_each(|bit| io.pins.watch(bit));
        io.uart.listen();
        let high = Bit::all().filter(|&bit| bit_state(io, memory, bit).0).collect::<Vec<_>>();
        let (mut outside, _) = self.device_context(io);
        for bit in high {
            device.edge(BitChange { at: now, bit, level: true }, &mut outside);
        }
        device.tick(now, &mut outside);
        self.attached.push(device);
        self.settle(io, out, now);
    }

    /// Returns the parts that devices reach, and the devices.
    fn device_context<'a>(
        &'a mut self,
        io: &'a mut Io,
    ) -> (DeviceContext<'a>, &'a mut [Box<dyn AttachedDevice>]) {
        let outside = DeviceContext {
            pins: &mut io.pins,
            kanalog: &mut io.kanalog,
            uart: &mut io.uart,
            fpga: &io.fpga,
            loads: &mut self.loads,
        };
        (outside, &mut self.attached)
    }

    /// Bits may have changed: devices that listen to them answer.
    pub(crate) fn settle(&mut self, io: &mut Io, out: &mut Out, now: Cycles) {
        if self.attached.is_empty() {
            return;
        }
        // Devices that respond to each other endlessly do so at a single instant, where the exchange is cut off.
        for _ in 0..EDGES_AT_ONCE {
            let Some(change) = io.pins.changes.next_unseen() else { return };
            let (mut outside, devices) = self.device_context(io);
            for device in devices {
                device.edge(change, &mut outside);
            }
        }
        self.attached.clear();
        out.remark(now, Message::DevicesEndless {});
    }

    /// Runs the devices at the beginning of a tick; `hears_uart` if characters of the UART are reported. Returns the
    /// characters that the UART has sent since the last tick.
    pub(crate) fn run_devices(
        &mut self,
        io: &mut Io,
        out: &mut Out,
        hears_uart: bool,
        now: Cycles,
    ) -> Vec<SentByte> {
        let mut sent = Vec::new();
        while let Some((at, byte)) = io.uart.take_sent(now) {
            let (mut outside, devices) = self.device_context(io);
            for device in devices {
                device.sent(byte, at, &mut outside);
            }
            if hears_uart {
                out.emit(at, EventKind::UartSent(byte));
            }
            sent.push(SentByte { at, byte });
        }
        let (mut outside, devices) = self.device_context(io);
        for device in devices {
            device.tick(now, &mut outside);
        }
        self.settle(io, out, now);
        sent
    }

    /// The outputs of a Konnect board have changed.
    pub(crate) fn konnect(&mut self, board: KonnectBoard, outputs: u16, at: Cycles) {
        self.attached.iter_mut().for_each(|device| device.konnect(board, outputs, at));
    }

    /// Returns whether the devices would repeat the last tick.
    pub(crate) fn is_settled(&self) -> bool {
        self.attached.iter().all(|device| device.is_settled())
    }
}

/// Puts a SnapAmp on the bus. Its opto inputs read 1 while no current flows.
pub(crate) fn connect_snapamp(snapamps: &mut SnapAmps, pins: &mut Pins, board: usize) {
    snapamps.connect(board);
    let Some(first) = FIRST_OPTOS.get(board) else { return };
    (*first..first + OPTOS).filter_map(Bit::new).for_each(|bit| pins.idle_high(bit));
}
