//! Loads and stores of a program: memory first, then the bus.

use kmotiondef::GuestAddr;

use crate::engine::Slice;
use crate::firmware::Firmware;
use crate::kind::Width;
use crate::memory::Scalar;
use crate::slot::Slot;
use crate::trap::{Access, TrapKind};
use kmotiondef::AccessSize;

/// The high word of a store of eight bytes whose low word was stored in an earlier slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct HighWord {
    place: GuestAddr,
    value: u32,
}

impl<F: Firmware + ?Sized> Slice<'_, F> {
    /// Loads a value from memory or from registers of a device.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`] or [`TrapKind::Misaligned`].
    fn load<T: Scalar>(&mut self, addr: GuestAddr) -> Result<T, TrapKind> {
        self.memory.load(addr).or_else(|kind| self.load_from_bus(addr, kind))
    }

    /// Stores a value to memory or to registers of a device.
    ///
    /// # Errors
    /// [`TrapKind::Unmapped`], [`TrapKind::Misaligned`] or [`TrapKind::WriteProtected`].
    fn store<T: Scalar>(&mut self, addr: GuestAddr, value: T) -> Result<(), TrapKind> {
        self.memory.store(addr, value).or_else(|kind| self.store_to_bus(addr, value, kind))
    }

    /// Loads a value as a register slot.
    ///
    /// # Errors
    /// As [`load`](Self::load).
    pub(crate) fn load_slot(&mut self, addr: GuestAddr, width: Width) -> Result<u64, TrapKind> {
        Ok(match width {
            Width::I8S => i32::from(self.load::<i8>(addr)?).into_slot(),
            Width::I8U => i32::from(self.load::<u8>(addr)?).into_slot(),
            Width::I16S => i32::from(self.load::<i16>(addr)?).into_slot(),
            Width::I16U => i32::from(self.load::<u16>(addr)?).into_slot(),
            Width::I32 => self.load::<i32>(addr)?.into_slot(),
            Width::I64 => self.load::<i64>(addr)?.into_slot(),
            Width::F32 => self.load::<f32>(addr)?.into_slot(),
            Width::F64 => self.load::<f64>(addr)?.into_slot(),
        })
    }

    /// Stores a register slot.
    ///
    /// # Errors
    /// As [`store`](Self::store).
    pub(crate) fn store_slot(&mut self, addr: GuestAddr, width: Width, slot: u64) -> Result<(), TrapKind> {
        match width {
            Width::I8S | Width::I8U => self.store(addr, slot as u8),
            Width::I16S | Width::I16U => self.store(addr, slot as u16),
            Width::I32 => self.store(addr, i32::from_slot(slot)),
            Width::I64 => self.store(addr, i64::from_slot(slot)),
            Width::F32 => self.store(addr, f32::from_slot(slot)),
            Width::F64 => self.store(addr, f64::from_slot(slot)),
        }
    }

    /// Stores the low word of a slot of eight bytes; the high one is yielded, to be stored in a later slice.
    ///
    /// Where that cannot be done in two words, all is stored.
    ///
    /// # Errors
    /// Those of the whole store.
    pub(crate) fn store_low_word(
        &mut self,
        addr: GuestAddr,
        width: Width,
        slot: u64,
    ) -> Result<Option<HighWord>, TrapKind> {
        let place = addr.offset(4);
        let old = self.memory.load::<u32>(place);
        self.store_slot(addr, width, slot)?;
        let Ok(old) = old else { return Ok(None) };
        self.memory.store(place, old)?;
        Ok(Some(HighWord { place, value: (slot >> 32) as u32 }))
    }

    /// Stores the rest of a slot.
    ///
    /// # Errors
    /// The address may have become unmapped or write-protected since the low word was stored.
    pub(crate) fn store_high_word(&mut self, word: HighWord) -> Result<(), TrapKind> {
        self.memory.store(word.place, word.value)
    }

    /// A load that memory has refused as `kind`.
    #[cold]
    fn load_from_bus<T: Scalar>(&mut self, addr: GuestAddr, kind: TrapKind) -> Result<T, TrapKind> {
        if !self.memory.is_on_bus(addr, Access::Read) {
            return Err(kind);
        }
        let addr = self.memory.aligned(addr, T::LOAD_ALIGN);
        if !addr.get().is_multiple_of(T::LOAD_ALIGN) {
            return Err(TrapKind::Misaligned { addr, size: T::SIZE, access: Access::Read });
        }
        let mut bytes = [0; 8];
        for (offset, part) in (0..).step_by(4).zip(bytes.chunks_exact_mut(4)).take(parts(T::SIZE)) {
            let addr = addr.offset(offset);
            self.budget -= self.firmware.access_cycles(addr);
            let value = self.firmware.read(addr, size_of_part(T::SIZE), self.now());
            part.copy_from_slice(&value.to_le_bytes());
        }
        self.note_access();
        T::get(&bytes, 0).ok_or(kind)
    }

    /// A store that memory has refused as `kind`.
    #[cold]
    fn store_to_bus<T: Scalar>(&mut self, addr: GuestAddr, value: T, kind: TrapKind) -> Result<(), TrapKind> {
        if !self.memory.is_on_bus(addr, Access::Write) {
            return Err(kind);
        }
        let addr = self.memory.aligned(addr, T::STORE_ALIGN);
        if !addr.get().is_multiple_of(T::STORE_ALIGN) {
            return Err(TrapKind::Misaligned { addr, size: T::SIZE, access: Access::Write });
        }
        let mut bytes = [0; 8];
        value.set(&mut bytes, 0).ok_or(kind)?;
        for (offset, part) in (0..).step_by(4).zip(bytes.as_chunks::<4>().0).take(parts(T::SIZE)) {
            let addr = addr.offset(offset);
            self.budget -= self.firmware.access_cycles(addr);
            let now = self.now();
            self.firmware.write(addr, size_of_part(T::SIZE), u32::from_le_bytes(*part), now);
        }
        Ok(())
    }
}

/// Number of bus accesses that an access of `size` bytes needs.
const fn parts(size: u32) -> usize {
    if size == 8 { 2 } else { 1 }
}

/// Width of each of them.
const fn size_of_part(size: u32) -> AccessSize {
    match size {
        1 => AccessSize::Byte,
        2 => AccessSize::Half,
        _ => AccessSize::Word,
    }
}
