//! Typed access to guest structures. The bytes in guest memory are the only copy.

use kmotiondef::structs::Chan;
use kmotiondef::variables::CHAN;
use kmotiondef::{AxisId, Field, GuestAddr, Place, Plain, Scalar};
use vm::memory::GuestMemory;

/// Reads and writes typed places.
pub(crate) trait Typed {
    /// The value in a place.
    fn get<T: Scalar>(&self, place: Place<T>) -> T::Value;
    /// Stores a value in a place.
    fn set<T: Scalar>(&mut self, place: Place<T>, value: T::Value);

    /// The value of a field of an axis.
    fn axis<T: Scalar>(&self, axis: AxisId, field: Field<T>) -> T::Value {
        self.get(chan(axis).field(field))
    }

    /// Stores a value in a field of an axis.
    fn set_axis<T: Scalar>(&mut self, axis: AxisId, field: Field<T>, value: T::Value) {
        self.set(chan(axis).field(field), value);
    }
}

impl Typed for GuestMemory {
    fn get<T: Scalar>(&self, place: Place<T>) -> T::Value {
        let address = place.address();
        T::Value::from_bits(match T::SIZE {
            1 => u64::from(self.peek::<u8>(address)),
            2 => u64::from(self.peek::<u16>(address)),
            4 => u64::from(self.peek::<u32>(address)),
            _ => self.peek::<u64>(address),
        })
    }

    fn set<T: Scalar>(&mut self, place: Place<T>, value: T::Value) {
        let (address, bits) = (place.address(), value.into_bits());
        match T::SIZE {
            1 => self.poke(address, bits as u8),
            2 => self.poke(address, bits as u16),
            4 => self.poke(address, bits as u32),
            _ => self.poke(address, bits),
        }
    }
}

/// The structure of an axis.
pub(crate) fn chan(axis: AxisId) -> Place<Chan> {
    CHAN.element(axis.index())
}

/// The axis whose structure starts at an address.
pub(crate) fn axis_at(address: GuestAddr) -> Option<AxisId> {
    AxisId::all().find(|&axis| chan(axis).address() == address)
}
