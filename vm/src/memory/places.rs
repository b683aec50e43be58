//! Objects whose addresses in a memory differ from those of the tables.
//!
//! The tables have the addresses of one firmware. A memory in which another one runs maps them to the addresses of the
//! same objects there; code that has an address of the tables maps it before it accesses the memory.

use std::sync::Arc;

use kmotiondef::GuestAddr;

use super::GuestMemory;

/// An object with its address in the tables and its address in memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Object {
    table: u32,
    size: u32,
    place: u32,
}

/// The addresses of objects; by default those of the tables.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Places(Option<Arc<[Object]>>);

impl Places {
    /// Objects by their address in the tables, their size and their place, in any order.
    #[must_use]
    pub fn new(objects: impl IntoIterator<Item = (GuestAddr, u32, GuestAddr)>) -> Self {
        let object = |(table, size, place): (GuestAddr, u32, GuestAddr)| Object {
            table: table.get(),
            size,
            place: place.get(),
        };
        let mut objects: Vec<Object> = objects.into_iter().map(object).collect();
        objects.sort_by_key(|object| (object.table, object.size));
        let is_moved = objects.iter().any(|object| object.table != object.place);
        Self(is_moved.then(|| objects.into()))
    }

    /// Returns whether all objects are where the tables have them.
    #[inline(always)]
    #[must_use]
    pub const fn is_by_tables(&self) -> bool {
        self.0.is_none()
    }

    /// The address of an object from its address in the tables; addresses outside of any object are unchanged.
    #[inline(always)]
    #[must_use]
    pub fn of(&self, address: GuestAddr) -> GuestAddr {
        match &self.0 {
            None => address,
            Some(objects) => place_in(objects, address),
        }
    }

    /// The address in the tables for an address of an object; addresses outside of any object are unchanged.
    #[must_use]
    pub fn table_of(&self, place: GuestAddr) -> GuestAddr {
        let objects = self.0.iter().flat_map(|objects| objects.iter());
        let holds = |object: &&Object| place.get().wrapping_sub(object.place) < object.size;
        let object = objects.into_iter().find(holds);
        object.map_or(place, |object| GuestAddr::new(object.table + (place.get() - object.place)))
    }
}

impl GuestMemory {
    /// Says where the objects of the tables are in this memory.
    pub fn set_places(&mut self, places: Places) {
        self.places = places;
    }

    /// Returns whether all objects are where the tables have them.
    #[inline(always)]
    #[must_use]
    pub const fn is_by_tables(&self) -> bool {
        self.places.is_by_tables()
    }

    /// The place of an address of the tables.
    #[inline(always)]
    #[must_use]
    pub fn place_of(&self, address: GuestAddr) -> GuestAddr {
        self.places.of(address)
    }

    /// The address of the tables for a place.
    #[must_use]
    pub fn table_of(&self, place: GuestAddr) -> GuestAddr {
        self.places.table_of(place)
    }
}

#[inline(never)]
fn place_in(objects: &[Object], address: GuestAddr) -> GuestAddr {
    let next = objects.partition_point(|object| object.table <= address.get());
    let object = next.checked_sub(1).and_then(|at| objects.get(at));
    let inside = object.filter(|object| address.get() - object.table < object.size);
    inside.map_or(address, |object| GuestAddr::new(object.place + (address.get() - object.table)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_moved_object_takes_its_bytes_along_and_others_stay() {
        let at = GuestAddr::new;
        let places = Places::new([(at(0x200), 8, at(0x200)), (at(0x100), 16, at(0x900))]);
        for (address, expect) in
            [(0xFF, 0xFF), (0x100, 0x900), (0x10F, 0x90F), (0x110, 0x110), (0x204, 0x204)]
        {
            assert_eq!(places.of(at(address)), at(expect), "{address:#x}");
        }
        for (place, expect) in [(0x900, 0x100), (0x90F, 0x10F), (0x910, 0x910), (0x204, 0x204)] {
            assert_eq!(places.table_of(at(place)), at(expect), "{place:#x}");
        }
        assert_eq!(Places::new([(at(0x200), 8, at(0x200))]), Places::default());
    }
}
