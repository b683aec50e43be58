//! Typed access to guest structures. The bytes in guest memory are the only copy.

use kmotiondef::limits::N_CHANNELS;
use kmotiondef::structs::Chan;
use kmotiondef::variables::CHAN;
pub(crate) use kmotiondef::variables::chan;
use kmotiondef::{AxisId, Field, GuestAddr, GuestType, Place, Plain, Scalar};
use vm::memory::GuestMemory;

/// Reads and writes typed places.
pub(crate) trait TypedAccess {
    /// The value in a place.
    fn get<T: Scalar>(&self, place: Place<T>) -> T::Value;
    /// Stores a value in a place.
    fn set<T: Scalar>(&mut self, place: Place<T>, value: T::Value);

    /// The address of a place in this memory.
    fn locate<T>(&self, place: Place<T>) -> GuestAddr;

    /// The structure of an axis.
    fn chan(&self, axis: AxisId) -> Place<Chan>;

    /// The value of a field of an axis.
    #[inline]
    fn axis<T: Scalar>(&self, axis: AxisId, field: Field<T>) -> T::Value {
        self.get(self.chan(axis).field(field))
    }

    /// Stores a value in a field of an axis.
    #[inline]
    fn set_axis<T: Scalar>(&mut self, axis: AxisId, field: Field<T>, value: T::Value) {
        self.set(self.chan(axis).field(field), value);
    }
}

impl TypedAccess for GuestMemory {
    #[inline]
    fn chan(&self, axis: AxisId) -> Place<Chan> {
        // Only a board with objects at other addresses has more axes than the tables.
        if self.is_by_tables() { CHAN.element(axis.index()) } else { chan(axis) }
    }

    #[inline]
    fn locate<T>(&self, place: Place<T>) -> GuestAddr {
        self.place_of(place.address())
    }

    #[inline]
    fn get<T: Scalar>(&self, place: Place<T>) -> T::Value {
        let address = self.locate(place);
        T::Value::from_bits(match T::SIZE {
            1 => u64::from(self.peek::<u8>(address)),
            2 => u64::from(self.peek::<u16>(address)),
            4 => u64::from(self.peek::<u32>(address)),
            _ => self.peek::<u64>(address),
        })
    }

    #[inline]
    fn set<T: Scalar>(&mut self, place: Place<T>, value: T::Value) {
        let (address, bits) = (self.locate(place), value.into_bits());
        match T::SIZE {
            1 => self.poke(address, bits as u8),
            2 => self.poke(address, bits as u16),
            4 => self.poke(address, bits as u32),
            _ => self.poke(address, bits),
        }
    }
}

/// Bytes of an axis' structure, and of all eight of the tables.
const CHAN_SIZE: usize = Chan::SIZE as usize;
const CHANS_SIZE: usize = CHAN_SIZE * N_CHANNELS;

/// The structure of an axis, located once for the many fields that a tick needs.
pub(crate) struct AxisView<'a>(&'a mut [u8; CHAN_SIZE]);

impl<'a> AxisView<'a> {
    /// The structure of `axis` in `memory`.
    #[inline(always)]
    pub(crate) fn of(memory: &'a mut GuestMemory, axis: AxisId) -> Self {
        // All eight, because their address is a constant: their location is then known at compile time.
        if !memory.is_by_tables() {
            let place = memory.locate(chan(axis));
            return Self(memory.block_mut(place).expect("the axis structures lie in RAM"));
        }
        let all: Option<&mut [u8; CHANS_SIZE]> = memory.block_mut(CHAN.address());
        let (chans, _) = all.expect("the axis structures lie in RAM").as_chunks_mut();
        Self(&mut chans[axis.index()])
    }

    /// The value of a field.
    #[inline(always)]
    pub(crate) fn get<T: Scalar>(&self, field: Field<T>) -> T::Value {
        field_of(self.0, field)
    }

    /// Stores a value in a field.
    #[inline(always)]
    pub(crate) fn set<T: Scalar>(&mut self, field: Field<T>, value: T::Value) {
        let (offset, bits) = (field.offset() as usize, value.into_bits());
        match T::SIZE {
            1 => self.0[offset] = bits as u8,
            2 => set_chunk(self.0, offset, (bits as u16).to_le_bytes()),
            4 => set_chunk(self.0, offset, (bits as u32).to_le_bytes()),
            _ => set_chunk(self.0, offset, bits.to_le_bytes()),
        }
    }
}

#[inline(always)]
fn set_chunk<const N: usize>(bytes: &mut [u8], offset: usize, value: [u8; N]) {
    *bytes[offset..].first_chunk_mut().expect("a field lies in its structure") = value;
}

/// The value of a field in the bytes of its structure.
#[inline(always)]
pub(crate) fn field_of<T: Scalar, const N: usize>(bytes: &[u8; N], field: Field<T>) -> T::Value {
    let offset = field.offset() as usize;
    T::Value::from_bits(match T::SIZE {
        1 => u64::from(bytes[offset]),
        2 => u64::from(u16::from_le_bytes(chunk(bytes, offset))),
        4 => u64::from(u32::from_le_bytes(chunk(bytes, offset))),
        _ => u64::from_le_bytes(chunk(bytes, offset)),
    })
}

#[inline(always)]
fn chunk<const N: usize>(bytes: &[u8], offset: usize) -> [u8; N] {
    *bytes[offset..].first_chunk().expect("a field lies in its structure")
}

/// The axis whose structure starts at an address.
pub(crate) fn axis_at(memory: &GuestMemory, address: GuestAddr) -> Option<AxisId> {
    memory.axes().iter().find(|&axis| memory.locate(chan(axis)) == address)
}
