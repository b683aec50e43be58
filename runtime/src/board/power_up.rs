//! The contents of guest memory when the board starts.

use chips::kanalog::{ADC_CHANNELS, ZERO};
use kmotiondef::boards::TargetBoard;
use kmotiondef::limits::N_CHANNELS;
use kmotiondef::start::{StartValue, StoreCondition};
use kmotiondef::structs::{Chan, STRUCTURES, Structure, StructureField};
use kmotiondef::variables::{
    ADC_BUFFER_IN, FIRMWARE_VARIABLES, FirmwareVariable, VERSION_AND_BUILD_TIME, trip_coeffs,
};
use kmotiondef::{CType, GuestAddr};
use vm::memory::GuestMemory;

use crate::io::kanalog::set_conversion;
use crate::views::{TypedAccess, chan};

/// The contents of memory before it is filled.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum InitialMemory {
    /// All zero.
    Zero,
    /// The flashed contents; some values are kept from them.
    Flashed,
}

impl InitialMemory {
    /// Returns whether a value is stored over these contents.
    fn is_overwritten(self, stored: StoreCondition) -> bool {
        self == Self::Zero || stored == StoreCondition::Always
    }
}

/// Stores the power-up value of every firmware variable.
///
/// Addresses are those of the tables; they are mapped when a value is stored.
pub(crate) fn fill(memory: &mut GuestMemory, version: &str, before: InitialMemory) {
    for variable in FIRMWARE_VARIABLES {
        if !is_narrow(memory, variable) {
            start_variable(memory, variable, before);
        }
    }
    // The tables end with the axes that every board has.
    for axis in memory.axes().iter().skip(N_CHANNELS) {
        start_structure(memory, chan(axis).address(), &Chan::STRUCTURE, (axis.index() as u32, before));
    }
    for axis in memory.axes().iter() {
        memory.set_axis(axis, Chan::C, memory.locate(trip_coeffs(axis)));
    }
    let ends = ["\n", "\0"].into_iter().flat_map(str::bytes);
    for (offset, byte) in (0..).zip(version.bytes().chain(ends)) {
        memory.poke(memory.locate(VERSION_AND_BUILD_TIME).offset(offset), byte);
    }
}

/// Stores values that the tables lack or that differ: the pointers to further axes, no axis for any letter of the
/// primed coordinate system, analog inputs at zero.
pub(crate) fn fill_later(memory: &mut GuestMemory, board: &TargetBoard) {
    if memory.has_other_map() {
        (0..ADC_CHANNELS).for_each(|channel| set_conversion(memory, channel, ZERO));
    }
    for axis in memory.axes().iter().skip(N_CHANNELS) {
        if let Some(pointer) = board.variable(&format!("ch{axis}")) {
            memory.poke(pointer, memory.locate(chan(axis)).get());
        }
    }
    for letter in ["xp", "yp", "zp", "ap", "bp", "cp", "up", "vp"] {
        if let Some(place) = board.variable(&format!("CS0_axis_{letter}")) {
            memory.poke(place, -1_i32);
        }
    }
}

/// Returns whether the elements of a variable are narrower on this board than in the tables.
fn is_narrow(memory: &GuestMemory, variable: &FirmwareVariable) -> bool {
    memory.has_other_map() && variable.address == ADC_BUFFER_IN.address()
}

fn start_variable(memory: &mut GuestMemory, variable: &FirmwareVariable, before: InitialMemory) {
    if variable.start == StartValue::Fields {
        return start_structures(memory, variable.address, variable.ty, before);
    }
    if before.is_overwritten(variable.stored) {
        clear(memory, variable.address, variable.size, before);
        store(memory, variable.address, variable.start, variable.ty, 0);
    }
}

/// Clears the space of a value, flashed contents included.
fn clear(memory: &mut GuestMemory, address: GuestAddr, size: u32, before: InitialMemory) {
    if before == InitialMemory::Flashed {
        let cleared = memory.poke_bytes(memory.place_of(address), &vec![0; size as usize]);
        debug_assert!(cleared.is_ok(), "variables are mapped");
    }
}

/// Stores the power-up values of a structure, or of each of an array of them.
fn start_structures(memory: &mut GuestMemory, address: GuestAddr, ty: CType, before: InitialMemory) {
    match ty.resolved() {
        CType::Array(element, count) => {
            let Some(structure) = structure(*element) else { return };
            for index in 0..count {
                start_structure(memory, address.offset(index * structure.size), structure, (index, before));
            }
        }
        ty => {
            if let Some(structure) = structure(ty) {
                start_structure(memory, address, structure, (0, before));
            }
        }
    }
}

fn structure(ty: CType) -> Option<&'static Structure> {
    match ty.resolved() {
        CType::Named(name) => STRUCTURES.iter().find(|structure| structure.name == name),
        _ => None,
    }
}

fn start_structure(
    memory: &mut GuestMemory,
    address: GuestAddr,
    structure: &Structure,
    (index, before): (u32, InitialMemory),
) {
    for StructureField { offset, size, start, stored, ty, .. } in structure.fields {
        let address = address.offset(*offset);
        if *start == StartValue::Fields {
            start_structures(memory, address, *ty, before);
        } else if before.is_overwritten(*stored) {
            clear(memory, address, *size, before);
            store(memory, address, *start, *ty, index);
        }
    }
}

/// Stores one value in memory that is still zero.
fn store(memory: &mut GuestMemory, address: GuestAddr, start: StartValue, ty: CType, index: u32) {
    let address = memory.place_of(address);
    match start {
        StartValue::Zero | StartValue::Fields => {}
        StartValue::Int(value) => memory.poke(address, value),
        StartValue::Each(value) => {
            if let CType::Array(element, count) = ty.resolved() {
                fill_array(memory, address, *element, count, value);
            }
        }
        StartValue::Float(value) => memory.poke(address, value),
        StartValue::Double(value) => memory.poke(address, value),
        StartValue::Text(text) => {
            for (offset, byte) in (0..).zip(text.bytes()) {
                memory.poke(address.offset(offset), byte);
            }
        }
        StartValue::Address(value) => memory.poke(address, memory.place_of(value).get()),
        StartValue::Words(words) => {
            for (index, word) in (0..).zip(words) {
                memory.poke(address.offset(4 * index), *word);
            }
        }
        StartValue::PerAxis { first, step } => memory.poke(address, first + index * step),
    }
}

/// Stores the same integer in every element of an array.
fn fill_array(memory: &mut GuestMemory, address: GuestAddr, element: CType, count: u32, value: i32) {
    for index in 0..count {
        match element.resolved() {
            CType::Short | CType::UnsignedShort => memory.poke(address.offset(2 * index), value as i16),
            _ => memory.poke(address.offset(4 * index), value),
        }
    }
}

#[cfg(test)]
mod tests {
    use kmotiondef::AxisId;
    use kmotiondef::limits::VERSION;
    use kmotiondef::structs::{Gather, Iir};
    use kmotiondef::variables::{CH3, CHAN, CS0_TIME_BASE, DAC_BUFFER, GATHER};

    use super::*;

    #[test]
    fn variables_and_fields_have_their_power_up_values() {
        let mut memory = GuestMemory::new();
        fill(&mut memory, VERSION.trim_end(), InitialMemory::Zero);
        let axis = AxisId::new(3).expect("3 is an axis");
        assert_eq!(memory.get(CH3), CHAN.element(3).address());
        assert_eq!(memory.get(CS0_TIME_BASE), 9e-5);
        assert_eq!(memory.get(DAC_BUFFER.element(7)), 2048);
        assert_eq!(memory.get(ADC_BUFFER_IN.element(7)), 2048);
        assert_eq!(memory.get(GATHER.field(Gather::BUFPTR)).get(), 0xFFFF_FFF8);
        assert_eq!(memory.axis(axis, Chan::VEL), 4000.0);
        assert_eq!(memory.axis(axis, Chan::MASTER_AXIS), -1);
        assert_eq!(memory.axis(axis, Chan::OUTPUT_CHAN1), 7);
        assert_eq!(memory.axis(axis, Chan::C).get(), 0x80FF_9020 + 3 * 960);
        assert_eq!(memory.axis(axis, Chan::IIR.element(2).field(Iir::B0)), 1.0);
        let text = memory.read_c_string(VERSION_AND_BUILD_TIME.address(), 64).expect("mapped");
        assert_eq!(text, b"KFLOP 4.34 Build 16:07:06 Aug 14 2018\n");
    }
}
