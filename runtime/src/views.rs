//! Typed access to guest structures. The bytes in guest memory are the only copy.

use kmotiondef::structs::Chan;
use kmotiondef::variables::CHAN;
use kmotiondef::{AxisId, Field, GuestAddr, GuestType, Place, Plain, Scalar};
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

/// Bytes of an axis' structure.
const CHAN_SIZE: usize = Chan::SIZE as usize;

/// The structure of an axis, found once for the many fields that a tick needs.
pub(crate) struct AxisView<'a> {
    bytes: &'a mut [u8; CHAN_SIZE],
    /// Whether a store has changed anything.
    pub(crate) changed: bool,
}

impl<'a> AxisView<'a> {
    /// The structure of `axis` in `memory`.
    #[inline]
    pub(crate) fn of(memory: &'a mut GuestMemory, axis: AxisId) -> Self {
        let bytes = memory.block_mut(chan(axis).address()).expect("the axis structures lie in RAM");
        Self { bytes, changed: false }
    }

    /// The value of a field.
    #[inline(always)]
    pub(crate) fn get<T: Scalar>(&self, field: Field<T>) -> T::Value {
        T::Value::from_bits(match T::SIZE {
            1 => u64::from(self.bytes[field.offset() as usize]),
            2 => u64::from(u16::from_le_bytes(self.chunk(field.offset()))),
            4 => u64::from(u32::from_le_bytes(self.chunk(field.offset()))),
            _ => u64::from_le_bytes(self.chunk(field.offset())),
        })
    }

    /// Stores a value in a field.
    #[inline(always)]
    pub(crate) fn set<T: Scalar>(&mut self, field: Field<T>, value: T::Value) {
        let (offset, bits) = (field.offset(), value.into_bits());
        match T::SIZE {
            1 => self.set_chunk(offset, (bits as u8).to_le_bytes()),
            2 => self.set_chunk(offset, (bits as u16).to_le_bytes()),
            4 => self.set_chunk(offset, (bits as u32).to_le_bytes()),
            _ => self.set_chunk(offset, bits.to_le_bytes()),
        }
    }

    #[inline(always)]
    fn chunk<const N: usize>(&self, offset: u32) -> [u8; N] {
        *self.bytes[offset as usize..].first_chunk().expect("a field lies in its structure")
    }

    #[inline(always)]
    fn set_chunk<const N: usize>(&mut self, offset: u32, value: [u8; N]) {
        let place = self.bytes[offset as usize..].first_chunk_mut().expect("a field lies in its structure");
        self.changed |= *place != value;
        *place = value;
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
