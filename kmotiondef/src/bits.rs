//! I/O bit numbers and what answers them.
//!
//! Source: `io.md` section 1 of the specification.

use crate::ids::Bit;

/// The hardware or variable that a range of bits belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitKind {
    /// A pin of the FPGA whose direction programs choose.
    Pin,
    /// A light-emitting diode of the board.
    Led,
    /// A bit of the variable `VirtualBits`.
    Virtual,
    /// A differential input of a SnapAmp.
    SnapDifferential,
    /// An opto input of a SnapAmp.
    SnapOpto,
    /// A pin of a SnapAmp whose direction programs choose.
    SnapGpio,
    /// A general input of Kanalog.
    KanalogInput,
    /// An opto input of Kanalog.
    KanalogOptoInput,
    /// An opto output of Kanalog.
    KanalogOptoOutput,
    /// A FET or relay driver of Kanalog.
    KanalogFet,
    /// A general output of Kanalog.
    KanalogOutput,
    /// An opto input of KStep.
    KstepInput,
    /// A bit of the variable `VirtualBitsEx`.
    VirtualEx,
    /// A pin of a Kogna whose direction programs choose.
    KognaPin,
    /// A differential input of a Kogna.
    KognaInput,
    /// An output of a Kogna.
    KognaOutput,
}

/// The direction of the bits of a range.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BitDirection {
    /// Chosen by programs; inputs at power-up.
    Programmable,
    /// Inputs for good: a write is ignored.
    Input,
    /// Outputs.
    Output,
    /// Memory, read and written.
    Memory,
}

/// A range of bit numbers with one answer.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BitRange {
    /// The first number.
    pub first: u16,
    /// The last number.
    pub last: u16,
    /// The name in messages.
    pub name: &'static str,
    /// The hardware or variable that its bits belong to.
    pub kind: BitKind,
    /// The direction of its bits.
    pub direction: BitDirection,
    /// The purpose of its bits.
    pub doc: &'static str,
}

/// A row is ``/// meaning`` then `first..=last "name", Kind, Direction;`.
macro_rules! ranges {
    ($($(#[doc = $doc:literal])+ $first:literal..=$last:literal $name:literal, $kind:ident, $direction:ident;)*) => {
        &[$(BitRange {
            first: $first,
            last: $last,
            name: $name,
            kind: BitKind::$kind,
            direction: BitDirection::$direction,
            doc: concat!($($doc),+).trim_ascii_start(),
        }),*]
    };
}

/// Every range, in ascending order. Numbers in no range read 0 and ignore writes.
pub const BIT_RANGES: &[BitRange] = ranges! {
    /// Encoders 0 to 3 (A on even, B on odd numbers), also plain pins.
    0..=7 "JP7", Pin, Programmable;
    /// Homes and limits, or step and direction of generators 0 to 3.
    8..=15 "JP7", Pin, Programmable;
    /// Auxiliary port 0: Kanalog, SnapAmp or Konnect bus; 22 to 25 also generators 0 and 1.
    16..=25 "JP4", Pin, Programmable;
    /// Auxiliary port 1: I/O PWM 0 to 7 on 26 to 33; 32 to 35 also generators 2 and 3.
    26..=35 "JP6", Pin, Programmable;
    /// Encoders 4 to 7, or step and direction of generators 4 to 7.
    36..=43 "JP5", Pin, Programmable;
    /// Transmit and receive of the UART, if enabled.
    44..=45 "JP7", Pin, Programmable;
    /// The two diodes of the board, lit at power-up.
    46..=47 "LED", Led, Output;
    /// Bit n is bit n - 48 of `VirtualBits`.
    48..=63 "virtual bits", Virtual, Memory;
    /// Differential inputs of SnapAmp 0.
    64..=71 "SnapAmp 0", SnapDifferential, Input;
    /// Opto inputs of SnapAmp 0.
    72..=79 "SnapAmp 0", SnapOpto, Input;
    /// General pins of SnapAmp 0.
    80..=93 "SnapAmp 0", SnapGpio, Programmable;
    /// Differential inputs of SnapAmp 1.
    96..=103 "SnapAmp 1", SnapDifferential, Input;
    /// Opto inputs of SnapAmp 1.
    104..=111 "SnapAmp 1", SnapOpto, Input;
    /// General pins of SnapAmp 1.
    112..=125 "SnapAmp 1", SnapGpio, Programmable;
    /// General inputs of Kanalog.
    128..=135 "Kanalog GPIN", KanalogInput, Input;
    /// Opto inputs of Kanalog.
    136..=143 "Kanalog opto in", KanalogOptoInput, Input;
    /// Opto outputs of Kanalog.
    144..=151 "Kanalog opto out", KanalogOptoOutput, Output;
    /// FET and relay drivers of Kanalog.
    152..=159 "Kanalog FET", KanalogFet, Output;
    /// General outputs of Kanalog.
    160..=167 "Kanalog GPOUT", KanalogOutput, Output;
    /// Opto inputs of KStep, if `KStepPresent` is set.
    168..=183 "KStep", KstepInput, Input;
    /// Bit n is bit (n - 1024) % 32 of `VirtualBitsEx[(n - 1024) / 32]`.
    1024..=2047 "extended virtual bits", VirtualEx, Memory;
};

/// The ranges that only a Kogna has, in ascending order. Source: its header.
pub const KOGNA_BIT_RANGES: &[BitRange] = ranges! {
    /// Ten pins of AUX2 and fourteen of EXIO, also step and direction of generators 11 to 15.
    200..=223 "Kogna AUX2 and EXIO", KognaPin, Programmable;
    /// Differential inputs.
    225..=248 "Kogna differential in", KognaInput, Input;
    /// Differential outputs.
    250..=273 "Kogna differential out", KognaOutput, Output;
    /// Relay drivers.
    274..=277 "Kogna relay", KognaOutput, Output;
    /// RS485 in place of RS422.
    278..=278 "Kogna RS485 mode", KognaOutput, Output;
    /// Enable of the supply of 15 V.
    279..=279 "Kogna 15 V supply", KognaOutput, Output;
    /// Pins of fast PWM channels 0 to 3.
    280..=283 "Kogna HRPWM", KognaPin, Programmable;
    /// Pins of the SPI port.
    284..=289 "Kogna SPI", KognaPin, Programmable;
};

/// The range of a bit that only a Kogna has.
#[must_use]
pub fn kogna_range_of(bit: Bit) -> Option<&'static BitRange> {
    KOGNA_BIT_RANGES.iter().find(|range| (range.first..=range.last).contains(&bit.get()))
}

/// The range that `bit` is in, if anything answers it.
#[must_use]
pub fn range_of(bit: Bit) -> Option<&'static BitRange> {
    BIT_RANGES.iter().find(|range| (range.first..=range.last).contains(&bit.get()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_ascend_without_overlap() {
        assert!(BIT_RANGES.iter().all(|range| range.first <= range.last && range.last <= Bit::MAX));
        for pair in BIT_RANGES.windows(2) {
            assert!(pair[0].last < pair[1].first, "{:?}", pair[1]);
        }
    }

    #[test]
    fn a_bit_finds_its_range() {
        let kind = |number| range_of(Bit::new(number).expect("a bit")).map(|range| range.kind);
        assert_eq!(kind(46), Some(BitKind::Led));
        assert_eq!(kind(63), Some(BitKind::Virtual));
        assert_eq!(kind(94), None);
        assert_eq!(kind(184), None);
        assert_eq!(kind(2047), Some(BitKind::VirtualEx));
    }
}
