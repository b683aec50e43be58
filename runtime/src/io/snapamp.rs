//! Registers of the two SnapAmp boards: writes are stored, the world sets the measurements.
//!
//! Nothing runs in between: faults are updated at the time of each access. More current than the limit of a side, or no
//! limit at all, switches all bridges off until a quarter of a second after it ends; a missing board has no faults.
//! Sources: devices.md section 5, the manual's page on SnapAmp for the quarter of a second. The general pins are bits
//! 80 and 112 and on, and belong to the digital outputs; the encoders are with those of the board.

use kmotiondef::Cycles;
use kmotiondef::variables::ADC_BUFFER_IN_SNAP;
use vm::memory::GuestMemory;

use crate::views::TypedAccess;

/// Registers of a board.
const REGISTERS: usize = 32;
/// Addresses from the first register of board 0 to the last of board 1.
const BASE: usize = 0x40;
const BOARDS: usize = 2;

/// Volts and amperes of a full conversion.
const FULL_VOLTS: f64 = 102.6;
const FULL_AMPS: f64 = 35.0;
/// Degrees Fahrenheit from which a side is too hot, and from which the fan runs: 80 and 50 °C.
const TOO_HOT: f64 = 176.0;
const WARM: f64 = 122.0;
/// The time for which bridges stay off: a quarter of a second.
const FAULT_TIME: Cycles = Cycles::new(Cycles::PER_SECOND.get() / 4);

/// Registers: currents, clamp level and switch of side A, limit of side A.
const CURRENTS: usize = 12;
const CLAMP: usize = 20;
const PEAK_LIMIT: usize = 24;
/// The lowest level that acts as a limit: 2 A, and 4 A more for each further level.
const FIRST_LEVEL: u16 = 9;

/// The encoders' registers: words of the four, and the levels of all inputs of the board.
pub(crate) const ENCODERS: std::ops::RangeInclusive<usize> = 8..=11;
pub(crate) const CLEAR_ERRORS: usize = 8;
pub(crate) const LEVELS: usize = 16;

/// The general pins' registers.
pub(crate) const PINS: usize = 17;
pub(crate) const CLEAR: usize = 18;
pub(crate) const DIRECTION: usize = 19;

/// Reading it resets the board.
const RESET: usize = 31;

/// A register: the board and the number in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Register {
    pub(crate) board: usize,
    pub(crate) number: usize,
}

impl Register {
    /// The register at an address of `WriteSnapAmp` and `ReadSnapAmp`.
    pub(crate) fn new(address: i32) -> Option<Self> {
        let offset = usize::try_from(address).ok()?.checked_sub(BASE)?;
        let (board, number) = (offset / REGISTERS, offset % REGISTERS);
        (board < BOARDS).then_some(Self { board, number })
    }
}

/// A side of a board, with its own supply, limit and pair of bridges.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Side {
    /// The first one.
    A,
    /// The second one.
    B,
}

/// A measured quantity of a side.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Quantity {
    /// Amperes through the bridge, from lead A to lead C.
    Current,
    /// Volts of the supply.
    Voltage,
    /// Degrees Fahrenheit.
    Temperature,
}

/// The state of a side.
#[derive(Clone, Copy, Debug)]
struct SideState {
    amps: f64,
    volts: f64,
    degrees: f64,
    /// Until when the bridges stay off after too much current.
    off_until: Cycles,
}

impl Default for SideState {
    fn default() -> Self {
        Self { amps: 0.0, volts: 48.0, degrees: 77.0, off_until: Cycles::default() }
    }
}

/// A board.
#[derive(Clone, Debug, Default)]
struct SnapAmpBoard {
    /// True if the board is present: if not, it never reports a fault.
    is_present: bool,
    written: [u16; REGISTERS],
    sides: [SideState; 2],
}

impl SnapAmpBoard {
    /// Returns whether the current on a side exceeds its limit; without a limit any current does.
    fn is_over(&self, side: usize) -> bool {
        let level = self.written[PEAK_LIMIT + side] & 0xf;
        let limit = level.checked_sub(FIRST_LEVEL).map_or(0.0, |above| 2.0 + 4.0 * f64::from(above));
        self.is_present && (level < FIRST_LEVEL || self.sides[side].amps.abs() > limit)
    }

    /// Updates the faults to the present, before anything changes and before they are read.
    fn advance(&mut self, now: Cycles) {
        for side in 0..2 {
            if self.is_over(side) {
                self.sides[side].off_until = now + FAULT_TIME;
            }
        }
    }

    fn status(&self, now: Cycles) -> u16 {
        let over = [0, 1].map(|side| self.is_over(side) || now < self.sides[side].off_until);
        let hot = [0, 1].map(|side| self.sides[side].degrees >= TOO_HOT);
        let fan = self.sides.iter().any(|side| side.degrees >= WARM);
        let bits = [over[0] || over[1] || hot[0] || hot[1], over[0], over[1], hot[0], hot[1], fan];
        let word = bits.iter().rev().fold(0, |word, &bit| word << 1 | u16::from(bit));
        if self.is_present { word } else { 0 }
    }

    /// The conversion of the supply voltage, which the clamp limits.
    fn voltage(&self, side: usize) -> u16 {
        let volts = convert(self.sides[side].volts / FULL_VOLTS * 65_536.0 + 256.0);
        let clamp = self.written[CLAMP + 2 * side];
        if self.written[CLAMP + 2 * side + 1] != 0 { volts.min(clamp) } else { volts }
    }

    fn temperature(&self, side: usize) -> u16 {
        convert(self.sides[side].degrees * 8.0)
    }

    /// Conversions of the currents: lead A and lead C of side A, then of side B.
    fn currents(&self) -> [u16; 4] {
        let [a, b] = self.sides.map(|side| side.amps / FULL_AMPS * 8192.0);
        [a, -a, b, -b].map(|counts| convert((counts + 8192.0).min(16_383.0)))
    }
}

/// A conversion, which stays within its word.
fn convert(counts: f64) -> u16 {
    libm::round(counts) as u16
}

/// The boards.
#[derive(Clone, Debug, Default)]
pub(crate) struct SnapAmps([SnapAmpBoard; BOARDS]);

impl SnapAmps {
    /// Puts a board on the bus.
    pub(crate) fn connect(&mut self, board: usize) {
        if let Some(board) = self.0.get_mut(board) {
            board.is_present = true;
        }
    }

    /// Returns whether the bridges of an amplifier's channel are off after excessive current. Channels 8 and 9 belong
    /// to side A of board 0, 10 and 11 to its side B, and so on.
    pub(crate) fn is_off(&mut self, channel: i32, now: Cycles) -> bool {
        let Some(pair) = usize::try_from(channel).ok().and_then(|channel| channel.checked_sub(8)) else {
            return false;
        };
        let Some(board) = self.0.get_mut(pair / 4).filter(|board| board.is_present) else { return false };
        board.advance(now);
        now < board.sides[pair % 4 / 2].off_until
    }

    /// The board of an amplifier channel whose bridges are off, and the reason.
    pub(crate) fn cause(&self, channel: i32, now: Cycles) -> Option<(usize, String)> {
        let pair = usize::try_from(channel).ok()?.checked_sub(8)?;
        let (number, index) = (pair / 4, pair % 4 / 2);
        let board = self.0.get(number).filter(|board| board.is_present)?;
        let (side, name) = (&board.sides[index], ["A", "B"][index]);
        let level = board.written[PEAK_LIMIT + index] & 0xf;
        let why = if level < FIRST_LEVEL {
            format!("the peak current limit of side {name}, {level}, is below {FIRST_LEVEL} (2 A)")
        } else if board.is_over(index) {
            format!("{} A on side {name} exceed its peak current limit", side.amps.abs())
        } else if now < side.off_until {
            format!("a fault of side {name} lasts for 0.25 s after its limit was set or exceeded")
        } else {
            return None;
        };
        Some((number, why))
    }

    /// Returns whether a board is on the bus.
    #[inline]
    pub(crate) fn is_present(&self) -> bool {
        self.0.iter().any(|board| board.is_present)
    }

    /// Changes a measurement of a side from outside.
    pub(crate) fn set(&mut self, board: usize, side: Side, quantity: Quantity, value: f64, now: Cycles) {
        let Some(board) = self.0.get_mut(board) else { return };
        board.advance(now);
        let side = &mut board.sides[side as usize];
        match quantity {
            Quantity::Current => side.amps = value,
            Quantity::Voltage => side.volts = value,
            Quantity::Temperature => side.degrees = value,
        }
    }

    /// Stores a word.
    pub(crate) fn write(&mut self, register: Register, value: u16, now: Cycles) {
        let board = &mut self.0[register.board];
        board.advance(now);
        board.written[register.number] = value;
    }

    /// A measurement, or the value that was written.
    pub(crate) fn read(&mut self, register: Register, now: Cycles) -> u16 {
        let board = &mut self.0[register.board];
        board.advance(now);
        match register.number {
            number @ CURRENTS..=15 => board.currents()[number - CURRENTS],
            number @ (22 | 23) => board.voltage(number - 22),
            number @ (24 | 25) => board.temperature(number - 24),
            30 => board.status(now),
            RESET => {
                board.written = Default::default();
                0
            }
            number => board.written[number],
        }
    }

    /// Puts the analog readings of boards that are there into their table.
    pub(crate) fn tick(&self, memory: &mut GuestMemory) {
        for (board, first) in self.0.iter().zip([0, 8]).filter(|(board, _)| board.is_present) {
            let supply = [board.voltage(0), board.voltage(1)];
            let degrees = [board.temperature(0), board.temperature(1)];
            let readings = board.currents().into_iter().chain(supply).chain(degrees);
            for (index, reading) in readings.enumerate() {
                memory.set(ADC_BUFFER_IN_SNAP.element(first + index), reading.into());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn addresses_name_board_and_register() {
        for (address, expect) in [
            (0x40, Some((0, 0))),
            (0x5f, Some((0, 31))),
            (0x60, Some((1, 0))),
            (0x7f, Some((1, 31))),
            (0x3f, None),
            (0x80, None),
            (-1, None),
        ] {
            let register = Register::new(address).map(|register| (register.board, register.number));
            assert_eq!(register, expect, "{address:#x}");
        }
    }

    /// A register of board 1.
    fn register(number: usize) -> Register {
        Register { board: 1, number }
    }

    fn ms(ms: i64) -> Cycles {
        Cycles::new(ms * Cycles::PER_SECOND.get() / 1000)
    }

    #[test]
    fn pulse_widths_are_kept_until_a_reset() {
        let mut boards = SnapAmps::default();
        boards.write(register(2), 77, ms(0));
        assert_eq!(boards.read(register(2), ms(0)), 77);
        boards.read(register(RESET), ms(0));
        assert_eq!(boards.read(register(2), ms(0)), 0);
    }

    #[test]
    fn a_fault_lasts_until_limits_are_set_and_returns_after_over_current() {
        let mut boards = SnapAmps::default();
        assert_eq!(boards.read(register(30), ms(0)), 0);
        boards.connect(1);
        assert_eq!(boards.read(register(30), ms(0)), 0b111);
        boards.write(register(24), 9, ms(100));
        boards.write(register(25), 9, ms(100));
        boards.set(1, Side::A, Quantity::Current, -2.5, ms(1000));
        boards.set(1, Side::A, Quantity::Current, 1.0, ms(1010));
        for (at, expect) in [(349, 0b111), (350, 0), (1000, 0b11), (1259, 0b11), (1260, 0)] {
            let mut boards = boards.clone();
            if at < 1000 {
                boards.0[1].sides[0] = SideState { off_until: ms(350), ..SideState::default() };
            }
            assert_eq!(boards.read(register(30), ms(at)), expect, "{at}");
        }
    }

    #[test]
    fn a_fault_switches_off_both_channels_of_its_side() {
        let mut boards = SnapAmps::default();
        boards.connect(1);
        for limit in [24, 25] {
            boards.write(register(limit), 9, ms(0));
        }
        boards.set(1, Side::B, Quantity::Current, 5.0, ms(1000));
        boards.set(1, Side::B, Quantity::Current, 0.0, ms(1000));
        let off =
            |boards: &mut SnapAmps, at| [7, 9, 12, 13, 14, 15].map(|channel| boards.is_off(channel, ms(at)));
        assert_eq!(off(&mut boards, 1100), [false, false, false, false, true, true]);
        assert_eq!(off(&mut boards, 1250), [false; 6]);
    }

    #[test]
    fn the_clamp_limits_the_supply_voltage() {
        let mut boards = SnapAmps::default();
        boards.set(1, Side::B, Quantity::Voltage, 95.0, ms(0));
        let clamp = convert(90.0 / FULL_VOLTS * 65_536.0 + 256.0);
        boards.write(register(22), clamp, ms(0));
        assert!(boards.read(register(23), ms(0)) > clamp);
        boards.write(register(23), 1, ms(0));
        assert_eq!(boards.read(register(23), ms(0)), clamp);
    }
}
