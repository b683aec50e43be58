//! The registers of the FPGA (`dsp-board.md` 6 and 7): cells that keep what was written, and those that act.
//!
//! Register r has its byte or half word at offset 2 of word r; writes elsewhere in the word do nothing.

use super::around::Around;
use super::generators::Generators;
use super::link::Link;
use super::pins::Pins;
use super::uart::Uart;

/// Registers.
const REGISTERS: usize = 0x400;
/// The lane of a register in its word.
const LANE: u32 = 2;

/// Registers of the link: status and data. The transmitter (0x008, bit 0) is never full.
const LINK_STATUS: usize = 0x004;
const LINK_DATA: usize = 0x005;
/// First and last register that is status in reading and configuration in writing.
const ERRORS: usize = 0x008;
/// The SnapAmps' bus: what is there when none is.
const SNAP_WAITING: usize = 0x003;
const SNAP_LOW: usize = 0x00C;
const SNAP_HIGH: usize = 0x00D;
/// Encoders.
const ENCODERS: usize = 0x020;
/// Bytes of a rate, and positions.
const RATE: usize = 0x03C;
const RATE_LAST: usize = 0x03F;
const POSITIONS: usize = 0x040;
const POSITIONS_END: usize = 0x050;
/// The Kanalog: its converters and inputs.
const CONVERTERS: usize = 0x090;
const KANALOG_INPUTS: usize = 0x098;
/// The serial port.
const UART_DATA: usize = 0x0C0;
const UART_STATUS: usize = 0x0C1;
/// Pins.
const SET: usize = 0x100;
const KEEP: usize = 0x110;
const DIRECT: usize = 0x120;
const READ: usize = 0x130;
const GROUPS: usize = 6;

/// The window and what it shows.
#[derive(Clone, Debug)]
pub(super) struct Window {
    cells: Box<[u16; REGISTERS]>,
    pub(super) link: Link,
    pub(super) generators: Generators,
    pub(super) pins: Pins,
    pub(super) uart: Uart,
    /// What the encoders show.
    pub(super) encoders: [u8; 8],
    /// What the converters of a Kanalog show, if there is one.
    pub(super) converters: Option<[u16; 8]>,
    /// Inputs of the Kanalog.
    pub(super) kanalog_inputs: u16,
    /// Inputs of a KStep, if there is one: a bit is set while current flows.
    pub(super) kstep: Option<u16>,
    /// What else is connected.
    pub(super) around: Option<Box<dyn Around>>,
    /// How often anything but the status of the link was reached.
    touches: u64,
}

impl Default for Window {
    fn default() -> Self {
        Self {
            cells: Box::new([0; REGISTERS]),
            link: Link::default(),
            generators: Generators::default(),
            pins: Pins::default(),
            uart: Uart::default(),
            encoders: [0; 8],
            converters: None,
            kanalog_inputs: 0,
            kstep: None,
            around: None,
            touches: 0,
        }
    }
}

impl Window {
    /// As at power-up, except for the link and what is connected.
    pub(super) fn reset(&mut self) {
        let old = std::mem::take(self);
        *self = Self {
            link: old.link,
            encoders: old.encoders,
            converters: old.converters,
            kanalog_inputs: old.kanalog_inputs,
            kstep: old.kstep,
            around: old.around,
            ..Self::default()
        };
    }

    /// Connects what is around the board: it finds directions and latches as they are.
    pub(super) fn connect(&mut self, mut around: Box<dyn Around>, now: u64) {
        for register in [0xA0, 0x05, 0x06] {
            around.write(register, false, self.cells[register], now);
        }
        for group in 0..GROUPS {
            around.write(KEEP + group, true, u16::from(self.pins.latch(group)), now);
            around.write(SET + group, true, u16::from(self.pins.latch(group)), now);
            around.write(DIRECT + group, true, u16::from(self.pins.directions(group)), now);
        }
        self.around = Some(around);
    }

    /// The last word written to a register.
    pub(super) fn cell(&self, register: usize) -> u16 {
        self.cells.get(register).copied().unwrap_or(0)
    }

    /// How often anything but the status of the link was reached.
    pub(super) const fn touches(&self) -> u64 {
        self.touches
    }

    pub(super) fn read(&mut self, offset: u32, bytes: u32, now: u64) -> u32 {
        if offset % 4 != LANE || bytes > 2 {
            return 0;
        }
        let register = offset as usize / 4 % REGISTERS;
        if register == LINK_STATUS {
            let status = self.link.status();
            self.touches += u64::from(status != 0);
            return u32::from(status);
        }
        self.touches += 1;
        let answered = self.around.as_mut().and_then(|around| around.read(register, bytes == 1, now));
        let value = match answered {
            Some(value) if register == READ => self.with_kstep(value),
            Some(value) => value,
            None => self.value(register, now),
        };
        u32::from(if bytes == 1 { value & 0xFF } else { value })
    }

    fn value(&mut self, register: usize, now: u64) -> u16 {
        match register {
            LINK_DATA => self.link.take(),
            // Nothing waits, nothing is full; SnapAmps are not there.
            ERRORS | SNAP_WAITING | SNAP_LOW | SNAP_HIGH => 0,
            ENCODERS..0x028 => u16::from(self.encoders[register - ENCODERS]),
            POSITIONS..POSITIONS_END => self.generators.read(register - POSITIONS, now),
            CONVERTERS..KANALOG_INPUTS => {
                self.converters.map_or(0, |converters| converters[register - CONVERTERS])
            }
            KANALOG_INPUTS => self.kanalog_inputs,
            UART_DATA => self.uart.receive(now),
            UART_STATUS => self.uart.status(now),
            READ => self.with_kstep(self.pins.read(0)),
            0x131..0x136 => self.pins.read(register - READ),
            _ => self.cells[register],
        }
    }

    /// Pins 0 to 7; a KStep turns four of them among its inputs as latches 2 and 3 select.
    fn with_kstep(&self, pins: u16) -> u16 {
        let Some(inputs) = self.kstep else { return pins };
        let select = pins >> 2 & 3;
        let nibble = !(inputs >> (4 * select)) & 0xF;
        pins & 0xF | nibble << 4
    }

    pub(super) fn write(&mut self, offset: u32, bytes: u32, value: u32, now: u64) {
        if offset % 4 != LANE || bytes > 2 {
            return;
        }
        self.touches += 1;
        let register = offset as usize / 4 % REGISTERS;
        let value = if bytes == 1 { value & 0xFF } else { value } as u16;
        self.cells[register] = value;
        if register != LINK_STATUS
            && let Some(around) = &mut self.around
        {
            around.write(register, bytes == 1, value, now);
        }
        match register {
            LINK_STATUS => self.link.put(value as u8, now),
            RATE..RATE_LAST => self.generators.stage(register - RATE, value as u8),
            RATE_LAST => self.generators.commit(value as u8, now),
            UART_DATA => self.uart.send(value as u8, now),
            UART_STATUS => self.uart.set_divisor(value),
            SET..0x106 => self.pins.set(register % GROUPS.next_power_of_two(), value, now),
            KEEP..0x116 => self.pins.keep(register % GROUPS.next_power_of_two(), value, now),
            DIRECT..0x126 => self.pins.direct(register % GROUPS.next_power_of_two(), value, now),
            _ => {}
        }
    }
}
