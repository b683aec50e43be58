//! The fields of the status record that only a Kogna fills. Source: its header; never compared.

use kmotiondef::Bit;
use kmotiondef::boards::StructureLayout;
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::structs::Chan;
use vm::memory::GuestMemory;

use crate::firmware::parts::Parts;
use crate::io::kogna::{INPUTS, Kogna, OUTPUTS};
use crate::views::TypedAccess;

/// The bits whose states and directions the record contains, and the words of their states.
const FIRST_BIT: u16 = 200;
const STATE_WORDS: u16 = 3;
const FIRST_PIN: u16 = 280;
/// The converters' word for zero.
const ZERO: i32 = 2048;

/// A record with its common fields filled.
struct Record<'a> {
    bytes: Vec<u8>,
    layout: &'a StructureLayout,
}

impl Record<'_> {
    /// Stores bytes at an offset of a field.
    fn set(&mut self, name: &str, offset: usize, value: &[u8]) {
        let field = self.layout.fields.iter().find(|field| field.name == name);
        let start = field.map(|field| field.offset as usize + offset);
        if let Some(place) = start.and_then(|start| self.bytes.get_mut(start..start + value.len())) {
            place.copy_from_slice(value);
        }
    }

    /// Adds bits to a word.
    fn add(&mut self, name: &str, bits: u32) {
        let Some(field) = self.layout.fields.iter().find(|field| field.name == name) else { return };
        if let Some(word) = self.bytes.get_mut(field.offset as usize..).and_then(<[u8]>::first_chunk_mut) {
            *word = (u32::from_le_bytes(*word) | bits).to_le_bytes();
        }
    }
}

/// Fills the fields that a KFLOP leaves empty: axes 8 to 15, bits from 200 on, converters of the board.
pub(super) fn complete(
    bytes: Vec<u8>,
    layout: &StructureLayout,
    (parts, memory): (&Parts, &GuestMemory),
    kogna: &Kogna,
) -> Vec<u8> {
    let mut record = Record { bytes, layout };
    axes(&mut record, memory);
    let state = |first: u16| {
        let bit = |offset: u16| Bit::new(i32::from(first + offset));
        let is_high = |offset: &u16| bit(*offset).is_some_and(|bit| parts.level(memory, bit));
        (0..32).filter(is_high).fold(0_u32, |word, offset| word | 1 << offset)
    };
    for word in 0..STATE_WORDS {
        let states = state(FIRST_BIT + 32 * word);
        record.set("BitsState200", 4 * usize::from(word), &states.to_le_bytes());
    }
    record.add("BitsDirection200", kogna.directions_from(FIRST_BIT) & 0xFF_FFFF);
    record.add("BitsDirection280", kogna.directions_from(FIRST_PIN));
    for index in 0..INPUTS {
        let input = kogna.analog_input(memory, index) as i16;
        record.set("Kogna_ADC", 2 * index, &input.to_le_bytes());
    }
    for index in 0..OUTPUTS {
        let output = i32::from(kogna.analog_output(memory, index)) - ZERO;
        record.set("Kogna_DAC", 2 * index, &(output as i16).to_le_bytes());
    }
    record.bytes
}

/// Fills the fields of the axes from 8 on.
fn axes(record: &mut Record<'_>, memory: &GuestMemory) {
    for axis in memory.axes().iter().skip(N_CHANNELS) {
        let index = axis.index();
        record.set("Position", 8 * index, &memory.axis(axis, Chan::POSITION).to_le_bytes());
        record.set("Dest", 8 * index, &memory.axis(axis, Chan::DEST).to_le_bytes());
        record.set("OutputChan0", index, &[memory.axis(axis, Chan::OUTPUT_CHAN0) as u8]);
        let shift = index % 4 * 4;
        let (inputs, outputs) = match index / 4 {
            2 => ("InputModes3", "OutputModes3"),
            _ => ("InputModes4", "OutputModes4"),
        };
        record.add(inputs, ((memory.axis(axis, Chan::INPUT_MODE) & 0xF) as u32) << shift);
        record.add(outputs, ((memory.axis(axis, Chan::OUTPUT_MODE) & 0xF) as u32) << shift);
        let is_enabled = memory.axis(axis, Chan::ENABLE) != 0;
        let is_done = is_enabled && memory.axis(axis, Chan::PCOEFF).is_null();
        record.add("Enables", u32::from(is_enabled) << index);
        record.add("AxisDone", u32::from(is_done) << index);
    }
}
