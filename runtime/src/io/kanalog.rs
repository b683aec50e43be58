//! Kanalog's conversions in guest memory, and its outputs.
//!
//! All inputs are converted again in each tick while the board's port serves it. The outputs are switched in groups of
//! 16, for each of which the firmware keeps the last written word.

use chips::fpga::Fpga;
use chips::kanalog::Kanalog;
use chips::pins::Pins;
use kmotiondef::bits::{BitKind, range_of};
use kmotiondef::variables::{ADC_BUFFER_IN, KANALOG_PRESENT};
use kmotiondef::{Bit, Cycles};
use vm::memory::GuestMemory;

use crate::views::TypedAccess;

/// Counts of an analog input in a volt: 2048 in 10 V.
pub(crate) const COUNTS_PER_VOLT: f64 = 204.8;

/// Reports whether a number of counts looks like volts: at most 10, with one decimal digit.
pub(crate) fn is_volts(value: f64) -> bool {
    const MOST: f64 = 10.0;
    const TENTHS: f64 = 10.0;
    value != 0.0 && value.abs() <= MOST && (value * TENTHS).fract() == 0.0
}

/// The first output.
const FIRST_OUTPUT: u16 = 144;
/// The number of outputs.
const N_OUTPUTS: u16 = 24;
/// The outputs of a group.
const GROUP: u16 = 16;

/// The outputs as the firmware last wrote them.
#[derive(Clone, Debug, Default)]
pub(crate) struct Outputs {
    groups: [u16; 2],
}

/// A group of outputs that are switched together, and their levels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Group {
    index: u16,
    levels: u16,
}

impl Outputs {
    /// The group of an output with another level of it; `None` for any other bit.
    pub(crate) fn group_with(&self, bit: Bit, level: bool) -> Option<Group> {
        let (index, mask) = place(bit)?;
        let levels = self.groups[usize::from(index)];
        Some(Group { index, levels: if level { levels | mask } else { levels & !mask } })
    }

    /// Keeps the levels of a group.
    pub(crate) fn store(&mut self, group: Group) {
        self.groups[usize::from(group.index)] = group.levels;
    }

    /// The level of an output as the firmware has it; `None` for any other bit.
    pub(crate) fn level(&self, bit: Bit) -> Option<bool> {
        let (index, mask) = place(bit)?;
        Some(self.groups[usize::from(index)] & mask != 0)
    }
}

impl Group {
    /// Switches the outputs of the group.
    pub(crate) fn put_out(self, pins: &mut Pins, now: Cycles) {
        let first = FIRST_OUTPUT + GROUP * self.index;
        for number in first..(first + GROUP).min(FIRST_OUTPUT + N_OUTPUTS) {
            if let Some(bit) = Bit::new(i32::from(number)) {
                pins.write(bit, self.levels >> (number - first) & 1 != 0, now);
            }
        }
    }
}

/// The group of an output and its mask in the group.
fn place(bit: Bit) -> Option<(u16, u16)> {
    let kind = range_of(bit)?.kind;
    let is_output = matches!(kind, BitKind::KanalogOptoOutput | BitKind::KanalogFet | BitKind::KanalogOutput);
    let number = bit.get().checked_sub(FIRST_OUTPUT).filter(|_| is_output)?;
    Some((number / GROUP, 1 << (number % GROUP)))
}

/// The conversion of an input in memory: an `int` on a KFLOP, a `short` on a Kogna.
#[inline]
pub(crate) fn conversion(memory: &GuestMemory, channel: usize) -> i32 {
    let place = ADC_BUFFER_IN.element(channel);
    if memory.has_other_map() { memory.peek::<i16>(memory.locate(place)).into() } else { memory.get(place) }
}

/// Stores the conversion of an input.
pub(crate) fn set_conversion(memory: &mut GuestMemory, channel: usize, level: i32) {
    let place = ADC_BUFFER_IN.element(channel);
    if memory.has_other_map() {
        memory.poke(memory.locate(place), level as i16);
    } else {
        memory.set(place, level);
    }
}

/// Converts all inputs, if anything is connected to them and the port serves Kanalog.
pub(crate) fn tick(kanalog: &Kanalog, fpga: &Fpga, memory: &mut GuestMemory) {
    if !kanalog.is_driven() || !is_served(fpga, memory) {
        return;
    }
    for (channel, level) in kanalog.conversions().into_iter().enumerate() {
        set_conversion(memory, channel, level);
    }
}

/// Returns whether the next tick yields the same conversions as the last one.
pub(crate) fn is_settled(kanalog: &Kanalog, fpga: &Fpga, memory: &GuestMemory) -> bool {
    let is_same = |(channel, level): (usize, i32)| conversion(memory, channel) == level;
    !kanalog.is_driven()
        || !is_served(fpga, memory)
        || kanalog.conversions().into_iter().enumerate().all(is_same)
}

/// Returns whether the port serves Kanalog: detected at power-up, or switched on by the program.
pub(crate) fn is_served(fpga: &Fpga, memory: &GuestMemory) -> bool {
    fpga.serves_kanalog() || memory.get(KANALOG_PRESENT) != 0
}

#[cfg(test)]
mod tests {
    use chips::kanalog::ZERO;

    use super::*;

    #[test]
    fn inputs_are_converted_only_while_kanalog_is_present() {
        let (mut kanalog, fpga, mut memory) = (Kanalog::default(), Fpga::default(), GuestMemory::new());
        memory.set(ADC_BUFFER_IN.element(3), ZERO);
        kanalog.drive(3, 4000);
        for (present, expect) in [(0, ZERO), (1, 4000)] {
            memory.set(KANALOG_PRESENT, present);
            tick(&kanalog, &fpga, &mut memory);
            assert_eq!(memory.get(ADC_BUFFER_IN.element(3)), expect);
        }
    }
}
