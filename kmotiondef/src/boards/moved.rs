//! The places of a firmware for the variables of the tables.

use super::StructureLayout;
use crate::ctype::CType;
use crate::ctype::GuestType;
use crate::ids::{Axes, GuestAddr};
use crate::limits::{MAX_TRIP, N_CHANNELS};
use crate::map::BUFFERS;
use crate::structs::{Chan, STRUCTURES, TripCoeff};
use crate::variables::{FIRMWARE_VARIABLES, FirmwareVariable, LATER_CHAN, LATER_TRIP_COEFFS};

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
    axes: Axes,
) -> Vec<MovedObject> {
    let variables =
        FIRMWARE_VARIABLES.iter().filter_map(|variable| Some((variable, address(variable.name)?)));
    let objects = variables.flat_map(|(variable, place)| objects(variable, place, layouts));
    objects.chain(later_axes(&address, axes)).collect()
}

/// Structures and profiles of the axes that the tables lack; on a board they follow those of the other axes.
fn later_axes(address: &impl Fn(&str) -> Option<GuestAddr>, axes: Axes) -> impl Iterator<Item = MovedObject> {
    let count = axes.count().saturating_sub(N_CHANNELS) as u32;
    let arrays = [
        ("chan", LATER_CHAN.address(), Chan::SIZE),
        ("TripCoeffs", LATER_TRIP_COEFFS.address(), <[TripCoeff; MAX_TRIP]>::SIZE),
    ];
    let objects = arrays.map(|(name, table, element)| {
        let place = address(name)?.offset(element * N_CHANNELS as u32);
        Some(MovedObject { table, size: element * count, place })
    });
    objects.into_iter().flatten().filter(|object| object.size > 0)
}

/// Splits an array of words into one object for each element, if the board has half words there.
pub(super) fn halve(objects: &mut Vec<MovedObject>, table: GuestAddr) {
    let Some(at) = objects.iter().position(|object| object.table == table) else { return };
    let array = objects.remove(at);
    objects.extend((0..array.size / 4).map(|index| MovedObject {
        table: table.offset(4 * index),
        size: 2,
        place: array.place.offset(2 * index),
    }));
}

/// The buffers and the heap in the tables, up to the first variable after them, if a board has them at other addresses.
pub(super) fn buffers(objects: &[MovedObject], place: GuestAddr) -> Option<MovedObject> {
    let table = BUFFERS;
    let after = objects.iter().map(|object| object.table.get()).filter(|address| *address > table.get());
    let size = after.min()? - table.get();
    (place != table).then_some(MovedObject { table, size, place })
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
