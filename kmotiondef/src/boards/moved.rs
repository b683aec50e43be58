//! The places of a firmware for the variables of the tables.

use super::StructureLayout;
use crate::ctype::CType;
use crate::ids::GuestAddr;
use crate::structs::STRUCTURES;
use crate::variables::{FIRMWARE_VARIABLES, FirmwareVariable};

/// A variable, or a field of one, of the tables of firmware 4.34, and its address in another firmware.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct MovedObject {
    /// The address in the tables.
    pub table: GuestAddr,
    /// Its size in bytes.
    pub size: u32,
    /// The address in the other firmware.
    pub place: GuestAddr,
}

/// Every variable of the tables that a firmware has; a structure whose fields are elsewhere there is given field by field.
///
/// `address` returns the address of a variable in that firmware, `layouts` are the structures that are not as in the tables.
pub fn moved_objects(
    address: impl Fn(&str) -> Option<GuestAddr>,
    layouts: &[StructureLayout],
) -> Vec<MovedObject> {
    let variables =
        FIRMWARE_VARIABLES.iter().filter_map(|variable| Some((variable, address(variable.name)?)));
    variables.flat_map(|(variable, place)| objects(variable, place, layouts)).collect()
}

fn objects(variable: &FirmwareVariable, place: GuestAddr, layouts: &[StructureLayout]) -> Vec<MovedObject> {
    let whole = || vec![MovedObject { table: variable.address, size: variable.size, place }];
    let CType::Named(name) = variable.ty.resolved() else { return whole() };
    let layout = layouts.iter().find(|layout| layout.name == name);
    let structure = STRUCTURES.iter().find(|structure| structure.name == name);
    let (Some(layout), Some(structure)) = (layout, structure) else { return whole() };
    let fields = structure.fields.iter().filter_map(|field| {
        let there = layout.fields.iter().find(|there| there.name == field.name)?;
        Some(MovedObject {
            table: variable.address.offset(field.offset),
            size: field.size,
            place: place.offset(there.offset),
        })
    });
    fields.collect()
}
